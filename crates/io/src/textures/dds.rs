//! DDS textures with the header of DirectX 10.

use std::path::Path;

use ddsfile::{
    AlphaMode, D3D10ResourceDimension, DxgiFormat, FourCC, Header, Header10, PixelFormat,
    PixelFormatFlags,
};
use ridgelight::{Error, Result};

use super::ktx2::{counts, level_size};
use crate::atomic::{Temporary, Written};
use crate::{Block, Texels};

/// The DXGI format of texels; none for other counts of components.
fn dxgi(texels: Texels) -> Option<DxgiFormat> {
    match texels {
        Texels::Blocks(Block::Bc4) => Some(DxgiFormat::BC4_UNorm),
        Texels::Blocks(Block::Bc6h) => Some(DxgiFormat::BC6H_UF16),
        Texels::Blocks(Block::Bc7) => Some(DxgiFormat::BC7_UNorm),
        Texels::Plain(format) => format.dxgi(),
    }
}

/// Writes a texture layer by layer, each with all its mip levels, the largest first.
///
/// The destination is untouched until [`close`](Self::close) and the placing of its result.
#[derive(Debug)]
pub struct DdsWriter {
    file: Temporary,
    left: u64,
}

impl DdsWriter {
    /// Begins a texture of `rows` × `cols` texels, the top row first, with layers and mip levels.
    ///
    /// # Errors
    /// An invalid format; sides, layers or levels out of range; a directory that cannot be written.
    pub fn create(
        path: &Path,
        texels: Texels,
        size: [usize; 2],
        (layers, levels): (usize, usize),
    ) -> Result<Self> {
        let format = dxgi(texels).ok_or_else(|| {
            Error::setting("texels", format!("{texels:?}"), "1, 2 or 4 components")
        })?;
        let [cols, rows, layers] = counts(size, layers, levels)?;
        let too_large = || {
            let found = format!("{cols} × {rows} × {layers}");
            Error::setting("texture", found, "rows and images below 2³² bytes")
        };
        // The header has the bytes of a row, or of the first image of blocks, in 32 bits.
        let first = texels.image_bytes(size).filter(|n| u32::try_from(*n).is_ok());
        first.ok_or_else(too_large)?;
        let images = (0..levels).map(|level| texels.image_bytes(level_size(size, level)));
        let left = images.sum::<Option<u64>>().and_then(|n| n.checked_mul(layers.into()));
        let left = left.ok_or_else(too_large)?;
        let unexpected =
            |error: ddsfile::Error| Error::setting("texels", error.to_string(), "a DXGI format");
        let levels = Some(levels as u32);
        let mut header = Header::new_dxgi(rows, cols, None, format, levels, Some(layers), None)
            .map_err(unexpected)?;
        // The crate also marks masks of red, green and blue as valid, which are 0. Beside DX10 only its code is valid.
        header.spf = PixelFormat {
            flags: PixelFormatFlags::FOURCC,
            fourcc: Some(FourCC(FourCC::DX10)),
            ..PixelFormat::default()
        };
        let header10 = Header10::new(
            format,
            false,
            D3D10ResourceDimension::Texture2D,
            layers,
            AlphaMode::Custom,
        );
        let mut head = b"DDS ".to_vec();
        header.write(&mut head).map_err(unexpected)?;
        header10.write(&mut head).map_err(unexpected)?;
        let mut file = Temporary::create(path)?;
        file.write(&head)?;
        Ok(Self { file, left })
    }

    /// Appends images: of each layer all levels, rows from the top.
    ///
    /// # Errors
    /// More than the texture holds; a write error.
    pub fn write(&mut self, texels: &[u8]) -> Result<()> {
        let found = || Error::setting("texels", "more bytes", format!("{} more", self.left));
        self.left = self.left.checked_sub(texels.len() as u64).ok_or_else(found)?;
        self.file.write(texels)
    }

    /// Ends the file, which waits beside its destination.
    ///
    /// # Errors
    /// Fewer texels than the texture holds; a write error.
    pub fn close(self) -> Result<Written> {
        if self.left > 0 {
            let found = format!("{} bytes too few", self.left);
            return Err(Error::setting("texels", found, "all of them before the end"));
        }
        self.file.close()
    }
}

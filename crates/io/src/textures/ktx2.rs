//! KTX 2.0 textures (Khronos KTX File Format Specification 2.0), with or without mip levels, array
//! layers and block compression.

use crate::atomic::{Temporary, Written};
use crate::{Block, Component};
use ddsfile::DxgiFormat;
use ridgelight::{Error, Result};
use std::path::Path;

/// The first twelve bytes of every file (§3.1).
const IDENTIFIER: [u8; 12] = *b"\xabKTX 20\xbb\r\n\x1a\n";
/// Identifier, header and index, before the level index (§3).
const HEADER_BYTES: usize = 80;
/// An entry of the level index.
const LEVEL_BYTES: usize = 24;

/// Texel format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelFormat {
    /// Format of each component.
    pub component: Component,
    /// 1 (R), 2 (RG) or 4 (RGBA).
    pub count: usize,
}

impl TexelFormat {
    /// The Vulkan format's number and its name without `VK_FORMAT_`; none for other counts of
    /// components.
    pub fn vulkan(self) -> Option<(u32, &'static str)> {
        self.names().map(|names| names.1)
    }

    /// The DXGI format; none for other counts of components.
    pub(crate) fn dxgi(self) -> Option<DxgiFormat> {
        self.names().map(|names| names.2)
    }

    fn names(self) -> Option<&'static Names> {
        FORMATS.iter().find(|names| names.0 == (self.component, self.count))
    }

    /// Bytes of a texel.
    pub fn bytes(self) -> usize {
        self.count * self.component.bytes()
    }
}

/// A texel format, its Vulkan format and its DXGI format.
type Names = ((Component, usize), (u32, &'static str), DxgiFormat);

static FORMATS: [Names; 18] = {
    use Component::{F16, F32, Snorm8, Snorm16, Unorm8, Unorm16};
    [
        ((Unorm8, 1), (9, "R8_UNORM"), DxgiFormat::R8_UNorm),
        ((Snorm8, 1), (10, "R8_SNORM"), DxgiFormat::R8_SNorm),
        ((Unorm8, 2), (16, "R8G8_UNORM"), DxgiFormat::R8G8_UNorm),
        ((Snorm8, 2), (17, "R8G8_SNORM"), DxgiFormat::R8G8_SNorm),
        ((Unorm8, 4), (37, "R8G8B8A8_UNORM"), DxgiFormat::R8G8B8A8_UNorm),
        ((Snorm8, 4), (38, "R8G8B8A8_SNORM"), DxgiFormat::R8G8B8A8_SNorm),
        ((Unorm16, 1), (70, "R16_UNORM"), DxgiFormat::R16_UNorm),
        ((Snorm16, 1), (71, "R16_SNORM"), DxgiFormat::R16_SNorm),
        ((F16, 1), (76, "R16_SFLOAT"), DxgiFormat::R16_Float),
        ((Unorm16, 2), (77, "R16G16_UNORM"), DxgiFormat::R16G16_UNorm),
        ((Snorm16, 2), (78, "R16G16_SNORM"), DxgiFormat::R16G16_SNorm),
        ((F16, 2), (83, "R16G16_SFLOAT"), DxgiFormat::R16G16_Float),
        ((Unorm16, 4), (91, "R16G16B16A16_UNORM"), DxgiFormat::R16G16B16A16_UNorm),
        ((Snorm16, 4), (92, "R16G16B16A16_SNORM"), DxgiFormat::R16G16B16A16_SNorm),
        ((F16, 4), (97, "R16G16B16A16_SFLOAT"), DxgiFormat::R16G16B16A16_Float),
        ((F32, 1), (100, "R32_SFLOAT"), DxgiFormat::R32_Float),
        ((F32, 2), (103, "R32G32_SFLOAT"), DxgiFormat::R32G32_Float),
        ((F32, 4), (109, "R32G32B32A32_SFLOAT"), DxgiFormat::R32G32B32A32_Float),
    ]
};

/// What an image of a texture holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texels {
    /// One texel after the other.
    Plain(TexelFormat),
    /// Compressed blocks.
    Blocks(Block),
}

impl From<TexelFormat> for Texels {
    fn from(format: TexelFormat) -> Self {
        Self::Plain(format)
    }
}

impl From<Block> for Texels {
    fn from(block: Block) -> Self {
        Self::Blocks(block)
    }
}

impl Texels {
    /// As [`TexelFormat::vulkan`].
    pub fn vulkan(self) -> Option<(u32, &'static str)> {
        match self {
            Texels::Plain(format) => format.vulkan(),
            Texels::Blocks(block) => Some(block.vulkan()),
        }
    }

    /// Bytes of a texel or a block.
    fn unit(self) -> usize {
        match self {
            Texels::Plain(format) => format.bytes(),
            Texels::Blocks(block) => block.bytes(),
        }
    }

    /// Bytes of an image, unless it is too large for any file.
    pub fn image_bytes(self, [cols, rows]: [usize; 2]) -> Option<u64> {
        let units = match self {
            Texels::Plain(_) => [cols, rows],
            Texels::Blocks(_) => [cols, rows].map(|n| n.div_ceil(4)),
        };
        (units[0] as u64).checked_mul(units[1] as u64)?.checked_mul(self.unit() as u64)
    }

    /// Size of a component in bytes; 1 for blocks (§3.3).
    fn type_size(self) -> u32 {
        match self {
            Texels::Plain(format) => format.component.bytes() as u32,
            Texels::Blocks(_) => 1,
        }
    }

    /// The basic descriptor of Khronos' Data Format Specification 1.3 (§5), after its total size: linear numbers without
    /// primaries. Texels have a sample per component, blocks of 4 × 4 (§5.6) one for all.
    fn descriptor(self) -> Vec<u8> {
        // Of each sample: its channel and qualifiers (0x40 signed, 0x80 float), the least number, and the one that stands for 1.
        let (model, sides, bits, samples) = match self {
            Texels::Plain(TexelFormat { component, count }) => {
                let one = component.one() as i32;
                let (qualifiers, low, high) = match component {
                    Component::F16 | Component::F32 => (0xc0, (-1_f32).to_bits(), 1_f32.to_bits()),
                    other if other.is_signed() => (0x40, (-one) as u32, one as u32),
                    _ => (0, 0, one as u32),
                };
                // Colour model 1 is RGBSDA: channels 0, 1, 2 and, alpha, 15.
                let channels = [0_u32, 1, 2, 15].into_iter().take(count);
                let samples: Vec<_> = channels.map(|c| [c | qualifiers, low, high]).collect();
                (1, 0, 8 * component.bytes() as u32, samples)
            }
            Texels::Blocks(block) => {
                let (model, sample) = match block {
                    Block::Bc4 => (131, [0, 0, u32::MAX]),
                    Block::Bc6h => (133, [0x80, 0, 1_f32.to_bits()]),
                    Block::Bc7 => (134, [0, 0, u32::MAX]),
                };
                // The sides are stored less one.
                (model, 3 | (3 << 8), 8 * block.bytes() as u32, vec![sample])
            }
        };
        let size = 24 + 16 * samples.len() as u32;
        // Vendor 0 and type 0; version 2; primaries 0, transfer 1 (linear), flags 0; bytes of the first plane.
        let bytes = self.unit() as u32;
        let mut words = vec![4 + size, 0, 2 | (size << 16), model | (1 << 16), sides, bytes, 0];
        for (i, [channel, low, high]) in (0_u32..).zip(samples) {
            words.extend([(i * bits) | ((bits - 1) << 16) | (channel << 24), 0, low, high]);
        }
        words.iter().flat_map(|word| word.to_le_bytes()).collect()
    }
}

/// Sides of a mip level.
pub(crate) fn level_size(size: [usize; 2], level: usize) -> [usize; 2] {
    size.map(|n| (n >> level).max(1))
}

/// The largest number of mip levels.
fn most_levels([cols, rows]: [usize; 2]) -> usize {
    cols.max(rows).max(1).ilog2() as usize + 1
}

/// Columns, rows and layers as a header holds them.
///
/// # Errors
/// A count of 0 or beyond 2³²; no mip level, or more than down to one texel.
pub(crate) fn counts(size: [usize; 2], layers: usize, levels: usize) -> Result<[u32; 3]> {
    let side = |what: &str, n: usize| {
        let found = || Error::setting(what, n.to_string(), "1 to 4294967295");
        u32::try_from(n).ok().filter(|n| *n > 0).ok_or_else(found)
    };
    let layers = side("layers", layers)?;
    let counts = [side("columns", size[0])?, side("rows", size[1])?, layers];
    if !(1..=most_levels(size)).contains(&levels) {
        let expected = format!("1 to {}", most_levels(size));
        return Err(Error::setting("mip levels", levels.to_string(), expected));
    }
    Ok(counts)
}

/// Writes a texture layer by layer, so that it may be larger than memory.
///
/// The destination is untouched until [`finish`](Self::finish); dropping the writer leaves nothing.
#[derive(Debug)]
pub struct Ktx2Writer {
    file: Temporary,
    /// Of each mip level: the place of its next byte, and how many are missing.
    levels: Vec<[u64; 2]>,
}

impl Ktx2Writer {
    /// Begins a texture of `rows` × `cols` texels, the top row first; an array where `layers` is
    /// given.
    ///
    /// `texts` are keys and values, in addition to KTXorientation and KTXwriter.
    ///
    /// # Errors
    /// An invalid format, sides of 0 or beyond 2³², an empty, reserved ("KTX…") or duplicate key; a
    /// directory that cannot be written.
    pub fn create(
        path: &Path,
        texels: impl Into<Texels>,
        size: [usize; 2],
        layers: Option<usize>,
        texts: &[(String, String)],
    ) -> Result<Self> {
        Self::with_levels(path, texels.into(), size, (layers, 1), texts)
    }

    /// As [`create`](Self::create), with mip levels: each has half the sides of the one before,
    /// rounded down to at least 1.
    ///
    /// # Errors
    /// As [`create`](Self::create); no level, or more than down to one texel.
    pub fn with_levels(
        path: &Path,
        texels: Texels,
        size: [usize; 2],
        (layers, levels): (Option<usize>, usize),
        texts: &[(String, String)],
    ) -> Result<Self> {
        let Some((vulkan, _)) = texels.vulkan() else {
            let found = format!("{texels:?}");
            return Err(Error::setting("texels", found, "1, 2 or 4 components"));
        };
        let [cols, rows, layer_count] = counts(size, layers.unwrap_or(1), levels)?;
        let bytes = |level: usize| {
            let image = texels.image_bytes(level_size(size, level));
            image.and_then(|n| n.checked_mul(u64::from(layer_count)))
        };
        let bytes: Option<Vec<u64>> = (0..levels).map(bytes).collect();
        // Each level is at most the first, and at most 32 follow.
        let bytes = bytes.filter(|all| all[0].checked_mul(64).is_some()).ok_or_else(|| {
            let found = format!("{cols} × {rows} × {layer_count}");
            Error::setting("texture", found, "below 2⁵⁸ bytes")
        })?;
        let (descriptor, keys) = (texels.descriptor(), keys(texts)?);
        let descriptor_at = HEADER_BYTES + LEVEL_BYTES * levels;
        let keys_at = descriptor_at + descriptor.len();
        // A level begins at a multiple of both 4 and the bytes of a texel or a block, which are
        // powers of two (§3.9.7). The smallest is first.
        let align = texels.unit().max(4) as u64;
        let mut places = vec![[0; 2]; levels];
        let mut end = (keys_at + keys.len()) as u64;
        for level in (0..levels).rev() {
            let at = end.next_multiple_of(align);
            places[level] = [at, bytes[level]];
            end = at + bytes[level];
        }
        let mut head = IDENTIFIER.to_vec();
        let (depth, faces, supercompression) = (0, 1, 0);
        let words = [
            vulkan,
            texels.type_size(),
            cols,
            rows,
            depth,
            // 0 for a texture that is no array.
            layers.map_or(0, |_| layer_count),
            faces,
            levels as u32,
            supercompression,
            descriptor_at as u32,
            descriptor.len() as u32,
            keys_at as u32,
            keys.len() as u32,
        ];
        head.extend(words.iter().flat_map(|word| word.to_le_bytes()));
        // No supercompression data; each level's offset, length and uncompressed length.
        let longs = [0, 0].into_iter().chain(places.iter().flat_map(|[at, n]| [*at, *n, *n]));
        head.extend(longs.flat_map(|long: u64| long.to_le_bytes()));
        head.extend(descriptor);
        head.extend(keys);
        head.resize(places[levels - 1][0] as usize, 0);
        let mut file = Temporary::create(path)?;
        file.write(&head)?;
        Ok(Self { file, levels: places })
    }

    /// Appends texels of the first level, layers in order and rows from the top.
    ///
    /// # Errors
    /// More texels than the texture holds; a write error.
    pub fn write(&mut self, texels: &[u8]) -> Result<()> {
        self.write_level(0, texels)
    }

    /// Appends texels or blocks of a mip level, layers in order and rows from the top.
    ///
    /// # Errors
    /// A level that the texture lacks; more texels than it holds; a write error.
    pub fn write_level(&mut self, level: usize, texels: &[u8]) -> Result<()> {
        let count = self.levels.len();
        let own = self.levels.get_mut(level).ok_or_else(|| {
            Error::setting("mip levels", format!("level {level}"), format!("below {count}"))
        })?;
        let [at, left] = *own;
        let found = || Error::setting("texels", "more bytes", format!("{left} more"));
        let less = left.checked_sub(texels.len() as u64).ok_or_else(found)?;
        *own = [at + texels.len() as u64, less];
        self.file.seek(at)?;
        self.file.write(texels)
    }

    /// Moves the file to its destination.
    ///
    /// # Errors
    /// As [`close`](Self::close); a destination that cannot be replaced.
    pub fn finish(self) -> Result<()> {
        self.close()?.place()
    }

    /// Ends the file, which waits beside its destination.
    ///
    /// # Errors
    /// Fewer texels than the texture holds; a write error.
    pub fn close(self) -> Result<Written> {
        let left: u64 = self.levels.iter().map(|[_, left]| left).sum();
        if left > 0 {
            let found = format!("{left} bytes too few");
            return Err(Error::setting("texels", found, "all of them before the end"));
        }
        self.file.close()
    }
}

/// Keys and values (§3.11): each prefixed by its length, both NUL-terminated, padded to 4 bytes,
/// sorted by key.
fn keys(texts: &[(String, String)]) -> Result<Vec<u8>> {
    let writer = concat!("ridgelight ", env!("CARGO_PKG_VERSION"));
    let mut all = vec![("KTXorientation", "rd"), ("KTXwriter", writer)];
    for (key, value) in texts {
        let is_free = !key.is_empty() && !key.starts_with("KTX") && !key.starts_with("ktx");
        if !is_free || key.contains('\0') || all.iter().any(|(other, _)| other == key) {
            let expected = "keys of their own that do not begin with KTX";
            return Err(Error::setting("texts", format!("the key \"{key}\""), expected));
        }
        all.push((key, value));
    }
    all.sort_by_key(|(key, _)| key.as_bytes());
    let mut bytes = Vec::new();
    for (key, value) in all {
        let length = key.len() + value.len() + 2;
        bytes.extend((length as u32).to_le_bytes());
        for part in [key, value] {
            bytes.extend(part.as_bytes());
            bytes.push(0);
        }
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    Ok(bytes)
}

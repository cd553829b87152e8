//! TIFF heights: one band of any integer or float type; [`geotiff`] reads its position.

use crate::heights::Raster;
use crate::heights::geotiff;
use crate::open;
use half::f16;
use ridgelight::{Error, Result};
use std::{io::Cursor, path::Path};
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::{ColorType, TiffError, tags::Tag};

pub(crate) type Tiff<'a> = Decoder<Cursor<&'a [u8]>>;

/// The first image of the file: strips or tiles, uncompressed, PackBits, LZW, DEFLATE or Zstandard,
/// with any predictor.
pub(crate) fn heights(path: &Path, bytes: &[u8]) -> Result<Raster> {
    let header = |e: TiffError| Error::file(path, "header", open::complaint(e), "a whole TIFF");
    let mut tiff = Decoder::new(Cursor::new(bytes)).map_err(header)?;
    let (width, height) = tiff.dimensions().map_err(header)?;
    let (rows, cols) = open::size(path, "header", height.into(), width.into())?;
    let bits = match tiff.colortype().map_err(header)? {
        ColorType::Gray(bits) | ColorType::Multiband { bit_depth: bits, num_samples: 1 } => bits,
        other => {
            let found = format!("{} colour channels ({other:?})", other.num_samples());
            return Err(Error::file(path, "header", found, "one band of heights"));
        }
    };
    if ![8, 16, 32, 64].contains(&bits) {
        let found = format!("{bits} bits a sample");
        return Err(Error::file(path, "header", found, "8, 16, 32 or 64 bits"));
    }
    let image_bytes = rows as u64 * cols as u64 * u64::from(bits / 8);
    let method = tiff.find_tag_unsigned::<u16>(Tag::Compression).map_err(header)?.unwrap_or(1);
    open::plausible(path, "header", image_bytes, bytes.len(), ratio(method))?;

    let geo = geotiff::read(path, &mut tiff, rows, cols)?;

    let mut limits = Limits::default();
    limits.decoding_buffer_size = usize::try_from(image_bytes).unwrap_or(usize::MAX);
    // A compressed strip or tile is part of the file.
    limits.intermediate_buffer_size = bytes.len();
    let mut tiff = tiff.with_limits(limits);
    let image = tiff.read_image().map_err(|e| {
        Error::file(path, "image data", open::complaint(e), "heights as the header describes")
    })?;
    let single = matches!(image, DecodingResult::F16(_) | DecodingResult::F32(_));
    let values = widened(image);
    if values.len() != rows * cols {
        let found = format!("{} samples", values.len());
        return Err(Error::file(path, "image data", found, format!("{}", rows * cols)));
    }
    Ok(Raster {
        single,
        cell: geo.cell,
        unit_m: geo.unit_m,
        scale: geo.scale,
        nodata: geo.nodata,
        is_8_bit: bits == 8,
        georeference: geo.georeference,
        ..Raster::bare(rows, cols, values)
    })
}

/// The greatest expansion of a compression method, by its TIFF number.
fn ratio(method: u16) -> u64 {
    match method {
        1 => 1,
        8 | 32946 => open::DEFLATE_RATIO,
        // PackBits: a run of 128 in two bytes. LZW: 12-bit codes for strings below 4096 bytes.
        32773 => 64,
        // Zstandard: a block of 128 KiB of one byte in 4 bytes (RFC 8878, §3.1.1.2).
        50000 => (128 << 10) / 4,
        _ => 4096 * 8 / 12,
    }
}

fn widened(image: DecodingResult) -> Vec<f64> {
    fn each<T>(samples: Vec<T>, wide: impl Fn(T) -> f64) -> Vec<f64> {
        samples.into_iter().map(wide).collect()
    }
    match image {
        DecodingResult::U8(v) => each(v, f64::from),
        DecodingResult::U16(v) => each(v, f64::from),
        DecodingResult::U32(v) => each(v, f64::from),
        DecodingResult::U64(v) => each(v, |s| s as f64),
        DecodingResult::I8(v) => each(v, f64::from),
        DecodingResult::I16(v) => each(v, f64::from),
        DecodingResult::I32(v) => each(v, f64::from),
        DecodingResult::I64(v) => each(v, |s| s as f64),
        DecodingResult::F16(v) => each(v, f16::to_f64),
        DecodingResult::F32(v) => each(v, f64::from),
        DecodingResult::F64(v) => v,
    }
}

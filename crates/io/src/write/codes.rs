//! PNG files whose samples are numbers, not colours.

use crate::open::complaint;
use crate::write::atomic::{Temporary, Written};
use ::png::{BitDepth, ColorType, Encoder, EncodingError, ScaledFloat};
use ridgelight::{Error, Result};
use std::path::Path;

/// Writes samples of 8 or 16 bits (big-endian) unchanged. 1 to 4 channels are grey, grey with
/// alpha, RGB and RGBA.
///
/// The file waits beside its destination. Its gAMA chunk is 1 (linear). `metadata` becomes text
/// chunks, as in [`write_png`](crate::write_png).
///
/// # Errors
/// Samples that are not `rows`·`cols` pixels, other channel counts or depths, names that PNG does
/// not allow, a destination that cannot be written.
pub fn write_codes_aside(
    path: &Path,
    [cols, rows]: [usize; 2],
    (channels, bits): (usize, u32),
    samples: &[u8],
    metadata: &[(String, String)],
) -> Result<Written> {
    let colour = match channels {
        1 => ColorType::Grayscale,
        2 => ColorType::GrayscaleAlpha,
        3 => ColorType::Rgb,
        4 => ColorType::Rgba,
        n => return Err(Error::setting("channels", n.to_string(), "1 to 4")),
    };
    let depth = match bits {
        8 => BitDepth::Eight,
        16 => BitDepth::Sixteen,
        n => return Err(Error::setting("bits a sample", n.to_string(), "8 or 16")),
    };
    let expected = rows * cols * channels * bits as usize / 8;
    if samples.len() != expected {
        let found = format!("{} bytes", samples.len());
        return Err(Error::setting("samples", found, format!("{expected}")));
    }
    let side = |n: usize| {
        let wrong = || Error::setting("picture", n.to_string(), "a side of 1 to 2³¹");
        u32::try_from(n).ok().filter(|n| *n > 0).ok_or_else(wrong)
    };
    let size = [side(cols)?, side(rows)?];
    let mut png = Vec::new();
    packed(&mut png, size, (colour, depth), samples, metadata)
        .map_err(|e| Error::setting("picture", complaint(e), "one that PNG can hold"))?;
    let mut file = Temporary::create(path)?;
    file.write(&png)?;
    file.close()
}

fn packed(
    png: &mut Vec<u8>,
    [width, height]: [u32; 2],
    (colour, depth): (ColorType, BitDepth),
    samples: &[u8],
    metadata: &[(String, String)],
) -> std::result::Result<(), EncodingError> {
    let mut encoder = Encoder::new(png, width, height);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    encoder.set_source_gamma(ScaledFloat::new(1.0));
    for (name, text) in metadata {
        encoder.add_itxt_chunk(name.clone(), text.clone())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(samples)?;
    writer.finish()
}

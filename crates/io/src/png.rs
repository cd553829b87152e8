//! PNG: grey heights, colour maps, pictures of results, and samples that are numbers.

use crate::atomic::{Temporary, Written};
use crate::heights::{Raster, type_name};
use crate::open;
use ::png::{BitDepth, ColorType as Kind, Encoder};
use image::codecs::png::PngDecoder;
use image::{ColorType, ImageDecoder, ImageError, Limits};
use ridgelight::scene::Tone;
use ridgelight::{Error, Result};
use std::{io::Cursor, path::Path};

/// A decoded picture with samples of 8 or 16 bits. Palettes and smaller depths are expanded; the
/// grey or colour of a `tRNS` chunk has become alpha.
struct Samples {
    rows: usize,
    cols: usize,
    colour: ColorType,
    /// Bits per sample in the file.
    depth: u8,
    /// 255 or 65 535.
    white: u16,
    /// Interleaved channels.
    values: Vec<u16>,
}

/// Decodes the first image.
fn decode(path: &Path, bytes: &[u8]) -> Result<Samples> {
    let wrong = |place: &str, e: ImageError| {
        Error::file(path, place, open::reason(e), "a whole and valid PNG")
    };
    // The decoder's memory beside the picture: rows of up to SIDE_LIMIT pixels of 8 bytes, and
    // texts and profiles, which it keeps (a chunk's buffer doubles as it grows, and is copied).
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(4 * bytes.len() as u64 + (4 << 20));
    let decoder =
        PngDecoder::with_limits(Cursor::new(bytes), limits).map_err(|e| wrong("header", e))?;
    let (cols, rows) = decoder.dimensions();
    let (rows, cols) = open::size(path, "header", rows.into(), cols.into())?;
    // The decoder reports only the expanded type. IHDR, always first and with its CRC checked by
    // now, has the depth at byte 24 and the colour type at 25.
    let depth = bytes[24];
    let channels = [1, 0, 3, 1, 2, 0, 4][usize::from(bytes[25])];
    let line = (cols as u64 * channels * u64::from(depth)).div_ceil(8);
    open::plausible(path, "header", line * rows as u64, bytes.len(), open::DEFLATE_RATIO)?;

    let colour = decoder.color_type();
    let count = rows * cols * usize::from(colour.channel_count());
    let wide = depth == 16;
    let values = if wide {
        let mut values = open::zeros::<u16>(path, count)?;
        let bytes = bytemuck::cast_slice_mut(&mut values);
        decoder.read_image(bytes).map_err(|e| wrong("image data", e))?;
        values
    } else {
        let mut values = open::zeros::<u8>(path, count)?;
        decoder.read_image(&mut values).map_err(|e| wrong("image data", e))?;
        values.into_iter().map(u16::from).collect()
    };
    // The decoder stops after the last row. A file that ends there was truncated.
    if !bytes.windows(END.len()).rev().any(|w| w == END) {
        return Err(Error::file(path, "end", "no IEND chunk", "a whole and valid PNG"));
    }
    Ok(Samples { rows, cols, colour, depth, white: if wide { 65535 } else { 255 }, values })
}

/// The chunk that ends every PNG: no bytes, its name, the CRC of that.
const END: &[u8] = b"\0\0\0\0IEND\xae\x42\x60\x82";

/// Grey of 8 or 16 bits as heights in metres; transparent pixels are voids.
pub(crate) fn heights(path: &Path, bytes: &[u8]) -> Result<Raster> {
    let png = decode(path, bytes)?;
    if png.colour.has_color() {
        let found = "a palette, or red, green and blue";
        return Err(Error::file(path, "header", found, "grey: heights have one channel"));
    }
    if png.depth < 8 {
        let found = format!("{} bits a sample", png.depth);
        return Err(Error::file(path, "header", found, "8 or 16 bits"));
    }
    let (values, voids) = if png.colour.has_alpha() {
        let pixels = png.values.as_chunks::<2>().0;
        let voids = pixels.iter().map(|[_, alpha]| *alpha == 0).collect();
        (pixels.iter().map(|[grey, _]| f64::from(*grey)).collect(), Some(voids))
    } else {
        (png.values.into_iter().map(f64::from).collect(), None)
    };
    let data_type = type_name(b'u', png.depth.into());
    let bare = Raster::bare(png.rows, png.cols, values);
    Ok(Raster { data_type, voids, is_8_bit: png.depth == 8, ..bare })
}

/// A picture in linear light.
pub(crate) struct Linear {
    pub rows: usize,
    pub cols: usize,
    /// Whether the file has one grey channel.
    pub grey: bool,
    pub rgb: Vec<[f32; 3]>,
    /// Opacity, 0 to 1, without the transfer curve.
    pub alpha: Option<Vec<f32>>,
}

/// Any PNG in linear light. Samples are sRGB-encoded, at 8 and 16 bits; `gAMA` chunks and profiles
/// are ignored.
pub(crate) fn linear(path: &Path, bytes: &[u8]) -> Result<Linear> {
    let png = decode(path, bytes)?;
    let curve: Vec<f32> =
        (0..=png.white).map(|v| decoded(f64::from(v) / f64::from(png.white)) as f32).collect();
    let light = |v: u16| curve[usize::from(v)];
    let opacity = |v: u16| f32::from(v) / f32::from(png.white);
    let (grey, has_alpha) = (!png.colour.has_color(), png.colour.has_alpha());
    let width = usize::from(png.colour.channel_count());
    let pixels = png.values.chunks_exact(width);
    let rgb = pixels
        .clone()
        .map(|p| if grey { [light(p[0]); 3] } else { [light(p[0]), light(p[1]), light(p[2])] })
        .collect();
    let alpha = has_alpha.then(|| pixels.map(|p| opacity(p[width - 1])).collect());
    Ok(Linear { rows: png.rows, cols: png.cols, grey, rgb, alpha })
}

/// sRGB to linear light (IEC 61966-2-1), both in [0..1].
fn decoded(v: f64) -> f64 {
    if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
}

/// Writes an 8-bit RGB picture of linear radiance, with alpha where `transparent` is given.
///
/// `transparent` marks pixels, row-major like `rgb`, that become black with alpha 0; their radiance
/// is ignored. `metadata` becomes text chunks: tEXt for ASCII, else iTXt (UTF-8).
///
/// # Errors
/// As [`encode_png`]; a destination that cannot be written.
pub fn write_png(
    path: &Path,
    rows: usize,
    cols: usize,
    rgb: &[[f32; 3]],
    transparent: Option<&[bool]>,
    tone: Tone,
    metadata: &[(String, String)],
) -> Result<()> {
    // Encoded in memory: the encoder loses the error of writing its last chunk.
    let png = encode_png(rows, cols, rgb, transparent, tone, metadata)?;
    let mut file = Temporary::create(path)?;
    file.write(&png)?;
    file.finish()
}

/// The bytes of [`write_png`].
///
/// # Errors
/// Lengths that are not `rows`·`cols`; NaN outside transparent pixels (with row and column); an
/// exposure out of range; metadata names that PNG does not allow (empty, over 79 bytes).
pub fn encode_png(
    rows: usize,
    cols: usize,
    rgb: &[[f32; 3]],
    transparent: Option<&[bool]>,
    tone: Tone,
    metadata: &[(String, String)],
) -> Result<Vec<u8>> {
    let count = rows.checked_mul(cols).filter(|n| *n > 0);
    if count != Some(rgb.len()) || transparent.is_some_and(|t| t.len() != rgb.len()) {
        let found = format!("{} pixels for {rows} × {cols}", rgb.len());
        return Err(Error::setting("picture", found, "rows × columns pixels and marks"));
    }
    if !(tone.exposure >= 0.0 && tone.exposure.is_finite()) {
        return Err(Error::setting("exposure", tone.exposure.to_string(), "a number, 0 or more"));
    }
    let hidden = |i: usize| transparent.is_some_and(|t| t[i]);
    if let Some(i) = (0..rgb.len()).find(|&i| !hidden(i) && rgb[i].iter().any(|v| v.is_nan())) {
        let place = format!("picture at row {}, column {}", i / cols, i % cols);
        return Err(Error::setting(place, "NaN", "a number, or a transparent pixel"));
    }
    let mut samples = Vec::with_capacity(rgb.len() * if transparent.is_some() { 4 } else { 3 });
    for (i, texel) in rgb.iter().enumerate() {
        let hidden = hidden(i);
        samples.extend(if hidden { [0; 3] } else { texel.map(|v| tone.code(v)) });
        if transparent.is_some() {
            samples.push(if hidden { 0 } else { 255 });
        }
    }
    let kind = if transparent.is_some() { Kind::Rgba } else { Kind::Rgb };
    packed([cols, rows], (kind, BitDepth::Eight), &samples, metadata)
}

/// Writes samples of 8 or 16 bits (big-endian) unchanged. 1 to 4 channels are grey, grey with
/// alpha, RGB and RGBA.
///
/// The file waits beside its destination. It has no gAMA chunk, which browsers and image editors
/// would apply to the samples. `metadata` becomes text chunks, as in [`write_png`].
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
        1 => Kind::Grayscale,
        2 => Kind::GrayscaleAlpha,
        3 => Kind::Rgb,
        4 => Kind::Rgba,
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
    let png = packed([cols, rows], (colour, depth), samples, metadata)?;
    let mut file = Temporary::create(path)?;
    file.write(&png)?;
    file.close()
}

fn packed(
    [cols, rows]: [usize; 2],
    (kind, depth): (Kind, BitDepth),
    samples: &[u8],
    metadata: &[(String, String)],
) -> Result<Vec<u8>> {
    let side = |n: usize| {
        let wrong = || Error::setting("picture", n.to_string(), "a side of 1 to 2³¹");
        u32::try_from(n).ok().filter(|n| *n > 0).ok_or_else(wrong)
    };
    let mut png = Vec::new();
    let mut encoder = Encoder::new(&mut png, side(cols)?, side(rows)?);
    encoder.set_color(kind);
    encoder.set_depth(depth);
    let write = || {
        for (name, text) in metadata {
            // Pillow takes a text `bbox` for the bounds of the pixels.
            let name = if name == "bbox" { "crop" } else { name };
            match text.is_ascii() {
                true => encoder.add_text_chunk(name.to_owned(), text.clone())?,
                false => encoder.add_itxt_chunk(name.to_owned(), text.clone())?,
            }
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(samples)?;
        writer.finish()
    };
    write().map_err(|e| Error::setting("picture", open::complaint(e), "one that PNG can hold"))?;
    Ok(png)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_where_codes_change() {
        for exposure in [1.0, 0.37, 1e-3, 250.0] {
            let tone = Tone::picture(exposure);
            let steps = tone.steps();
            assert_eq!(steps[0], 0.0);
            for (code, step) in steps.iter().enumerate().skip(1) {
                assert_eq!(usize::from(tone.code(*step)), code, "{exposure}");
                assert_eq!(usize::from(tone.code(step.next_down())), code - 1, "{exposure}");
            }
        }
        // No radiance has a code above 0, but at the least exposure infinity has every code.
        assert!(Tone::picture(0.0).steps()[1..].iter().all(|s| s.is_nan()));
        assert!(Tone::picture(1e-45).steps()[1..].iter().all(|s| s.is_infinite()));
    }

    #[test]
    fn every_code_survives_its_own_decoding() {
        for code in 0..=255_u8 {
            let light = decoded(f64::from(code) / 255.0) as f32;
            assert_eq!(Tone::default().code(light), code);
        }
    }

    #[test]
    fn tone_is_a_factor_and_a_clip() {
        let tone = Tone { exposure: 2.0, ..Tone::default() };
        assert_eq!(
            [-1.0, 0.0, 0.5, 9.0, f32::INFINITY].map(|v| tone.code(v)),
            [0, 0, 255, 255, 255]
        );
        // The shoulder at x: 1 - 0.04 / (x - 0.6). At 0.8 it meets the line with slope 1, at 1 it is 0.9.
        let picture = Tone::picture(1.0);
        for (light, shown) in [(0.5, 0.5), (0.8, 0.8), (0.801, 0.800_995), (1.0, 0.9), (4.6, 0.99)]
        {
            assert_eq!(picture.code(light), Tone::default().code(shown), "{light}");
        }
        assert_eq!(picture.code(f32::INFINITY), 255);
        // Middle grey: linear 0.214 041 is sRGB 0.5; code 127.5 rounds to 128 or 127.
        assert!((127..=128).contains(&tone.code(0.107_020_5)));
    }
}

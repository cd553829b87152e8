//! PNG: grey heights, colour maps, and pictures of results.

use super::atomic::Temporary;
use super::heights::Raster;
use super::open;
use crate::{Error, Result};
use ::png::{
    BitDepth, ColorType, Decoder, DecodingError, Encoder, EncodingError, Limits,
    SrgbRenderingIntent, Transformations,
};
use std::{io::Cursor, path::Path};

/// A decoded picture: samples of 8 or 16 bits, as they are in the file.
struct Samples {
    rows: usize,
    cols: usize,
    colour: ColorType,
    /// 255 or 65 535.
    white: u16,
    /// Interleaved channels.
    values: Vec<u16>,
    /// The transparent grey of a `tRNS` chunk.
    transparent: Option<u16>,
}

/// Decodes the first image. `expand` turns palettes and small depths into 8 bits a channel.
fn decode(path: &Path, bytes: &[u8], expand: bool) -> Result<Samples> {
    let wrong = |place: &str, e: DecodingError| {
        Error::file(path, place, open::complaint(e), "a whole and valid PNG")
    };
    let mut decoder = Decoder::new(Cursor::new(bytes));
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    if expand {
        decoder.set_transformations(Transformations::EXPAND);
    }
    let header = decoder.read_header_info().map_err(|e| wrong("header", e))?;
    let (rows, cols) = open::size(path, "header", header.height.into(), header.width.into())?;
    let line = header.raw_row_length() as u64;
    open::plausible(path, "header", line * rows as u64, bytes.len(), open::DEFLATE_RATIO)?;
    let limit = usize::try_from(line * rows as u64 + (1 << 20)).unwrap_or(usize::MAX);
    decoder.set_limits(Limits { bytes: limit });

    let mut reader = decoder.read_info().map_err(|e| wrong("header", e))?;
    let (colour, depth) = reader.output_color_type();
    let white = match depth {
        BitDepth::Eight => 255,
        BitDepth::Sixteen => 65535,
        other => {
            let found = format!("{} bits a sample", other as u8);
            return Err(Error::file(path, "header", found, "8 or 16 bits"));
        }
    };
    let info = reader.info();
    let transparent = match (info.color_type, info.trns.as_deref()) {
        (ColorType::Grayscale, Some(&[high, low])) => Some(u16::from_be_bytes([high, low])),
        // The decoder drops the upper byte where samples have 8 bits.
        (ColorType::Grayscale, Some(&[grey])) => Some(grey.into()),
        _ => None,
    };
    let size = reader.output_buffer_size().unwrap_or(usize::MAX);
    let mut buffer = Vec::new();
    buffer
        .try_reserve_exact(size)
        .map_err(|_| Error::io(path, std::io::ErrorKind::OutOfMemory.into()))?;
    buffer.resize(size, 0);
    reader.next_frame(&mut buffer).map_err(|e| wrong("image data", e))?;
    reader.finish().map_err(|e| wrong("end", e))?;
    let values = if white == 255 {
        buffer.into_iter().map(u16::from).collect()
    } else {
        buffer.as_chunks::<2>().0.iter().map(|b| u16::from_be_bytes(*b)).collect()
    };
    Ok(Samples { rows, cols, colour, white, values, transparent })
}

/// Grey of 8 or 16 bits as heights, one count one metre; transparent samples are voids.
pub(super) fn heights(path: &Path, bytes: &[u8]) -> Result<Raster> {
    let png = decode(path, bytes, false)?;
    let (values, voids) = match png.colour {
        ColorType::Grayscale => {
            let voids = png.transparent.map(|t| png.values.iter().map(|v| *v == t).collect());
            (png.values.iter().map(|v| f64::from(*v)).collect(), voids)
        }
        ColorType::GrayscaleAlpha => {
            let pixels = png.values.as_chunks::<2>().0;
            let voids = pixels.iter().map(|[_, alpha]| *alpha == 0).collect();
            (pixels.iter().map(|[grey, _]| f64::from(*grey)).collect(), Some(voids))
        }
        other => {
            let found = match other {
                ColorType::Indexed => "a palette",
                _ => "red, green and blue",
            };
            return Err(Error::file(path, "header", found, "grey: heights have one channel"));
        }
    };
    Ok(Raster { voids, ..Raster::bare(png.rows, png.cols, values) })
}

/// A picture in linear light.
pub(super) struct Linear {
    pub rows: usize,
    pub cols: usize,
    /// Whether red, green and blue are one grey channel in the file.
    pub grey: bool,
    pub rgb: Vec<[f32; 3]>,
    /// Opacity, 0 to 1, not through the transfer curve.
    pub alpha: Option<Vec<f32>>,
}

/// Any PNG in linear light: samples are sRGB-encoded, at 8 bits and at 16, whatever a `gAMA` chunk
/// or profile says.
pub(super) fn linear(path: &Path, bytes: &[u8]) -> Result<Linear> {
    let png = decode(path, bytes, true)?;
    let curve: Vec<f32> =
        (0..=png.white).map(|v| decoded(f64::from(v) / f64::from(png.white)) as f32).collect();
    let light = |v: u16| curve[usize::from(v)];
    let opacity = |v: u16| f32::from(v) / f32::from(png.white);
    let (grey, has_alpha) = match png.colour {
        ColorType::Grayscale => (true, false),
        ColorType::GrayscaleAlpha => (true, true),
        ColorType::Rgba => (false, true),
        _ => (false, false),
    };
    let width = if grey { 1 } else { 3 } + usize::from(has_alpha);
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

/// Linear light to sRGB (IEC 61966-2-1), both in [0..1].
fn encoded(l: f64) -> f64 {
    if l <= 0.003_130_8 { 12.92 * l } else { 1.055 * l.powf(1.0 / 2.4) - 0.055 }
}

/// How radiance becomes a picture: times `exposure`, clipped to [0..1], sRGB-encoded.
///
/// No shoulder: what is not clipped can be decoded back to radiance, to the step of 8 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// The factor before clipping, finite and 0 or more; 1 by default. Radiance 1/exposure is white.
    pub exposure: f32,
}

impl Default for Tone {
    fn default() -> Self {
        Self { exposure: 1.0 }
    }
}

impl Tone {
    /// The 8-bit code of a radiance. Negative is black, infinity white; NaN is the caller's to catch.
    fn code(self, radiance: f32) -> u8 {
        let light = f64::from(radiance) * f64::from(self.exposure);
        (255.0 * encoded(light.clamp(0.0, 1.0))).round() as u8
    }
}

/// Writes an 8-bit RGB picture of linear radiance, with alpha where `transparent` is given.
///
/// `transparent` marks pixels, row-major like `rgb`, that become black with alpha 0; their
/// radiance is not looked at.
///
/// # Errors
/// Lengths that are not `rows`·`cols`; NaN outside transparent pixels (named by row and column);
/// an exposure out of range; a destination that cannot be written to.
pub fn write_png(
    path: &Path,
    rows: usize,
    cols: usize,
    rgb: &[[f32; 3]],
    transparent: Option<&[bool]>,
    tone: Tone,
) -> Result<()> {
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
    let side = |n: usize| {
        u32::try_from(n).map_err(|_| Error::setting("picture", n.to_string(), "a side below 2³²"))
    };
    let (width, height) = (side(cols)?, side(rows)?);

    let mut file = Temporary::create(path)?;
    let wrong = |e: EncodingError| match e {
        EncodingError::IoError(e) => Error::io(path, e),
        other => Error::file(path, "PNG encoder", open::complaint(other), "a picture it can write"),
    };
    let mut encoder = Encoder::new(file.stream(), width, height);
    encoder.set_color(if transparent.is_some() { ColorType::Rgba } else { ColorType::Rgb });
    encoder.set_depth(BitDepth::Eight);
    encoder.set_source_srgb(SrgbRenderingIntent::RelativeColorimetric);
    let mut writer = encoder.write_header().map_err(wrong)?;
    let mut stream = writer.stream_writer().map_err(wrong)?;
    let mut line = Vec::new();
    for row in 0..rows {
        line.clear();
        for (col, texel) in rgb[row * cols..(row + 1) * cols].iter().enumerate() {
            let hidden = hidden(row * cols + col);
            line.extend(if hidden { [0; 3] } else { texel.map(|v| tone.code(v)) });
            if transparent.is_some() {
                line.push(if hidden { 0 } else { 255 });
            }
        }
        std::io::Write::write_all(&mut stream, &line).map_err(|e| Error::io(path, e))?;
    }
    stream.finish().map_err(wrong)?;
    writer.finish().map_err(wrong)?;
    file.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_code_survives_its_own_decoding() {
        for code in 0..=255_u8 {
            let light = decoded(f64::from(code) / 255.0) as f32;
            assert_eq!(Tone::default().code(light), code);
        }
    }

    #[test]
    fn tone_is_a_factor_and_a_clip() {
        let tone = Tone { exposure: 2.0 };
        assert_eq!(
            [-1.0, 0.0, 0.5, 9.0, f32::INFINITY].map(|v| tone.code(v)),
            [0, 0, 255, 255, 255]
        );
        // Middle grey: linear 0.214 041 is sRGB 0.5, code 127.5 rounds to 128 or 127.
        assert!((127..=128).contains(&tone.code(0.107_020_5)));
    }
}

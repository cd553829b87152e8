//! Radiance HDR: the `image` crate decodes texels; the header's factors are applied here.

use crate::open;
use image::{ImageDecoder, ImageError, codecs::hdr::HdrDecoder};
use ridgelight::{Error, Result};
use std::io::{self, Read};
use std::path::Path;

/// The most texels an environment may have: 16384 × 8192.
pub(crate) const TEXEL_LIMIT: u64 = 1 << 27;
/// The longest header that is read; the decoder keeps every line of it.
const HEADER_LIMIT: usize = 1 << 16;

/// Rows, columns and radiance. A texel (r, g, b, e) is (r, g, b)·2^(e-136), divided by the product
/// of the header's EXPOSURE and COLORCORR lines (the factors already applied to the values). GAMMA
/// and PRIMARIES lines are ignored.
///
/// The decoder requires lines that end in a single line feed and the top row first (-Y +X); it
/// refuses other orientations. It reads a row that begins with a texel (2, 2, below 128) as
/// new-style runs at any width, although only widths from 8 to 32767 have them. No encoder writes
/// such a texel, as one of its parts is always 128 or more.
pub(crate) fn colour(path: &Path, bytes: &[u8]) -> Result<(usize, usize, Vec<[f32; 3]>)> {
    let start = &bytes[..bytes.len().min(HEADER_LIMIT)];
    if !start.windows(2).any(|pair| pair == b"\n\n") {
        let found = format!("no empty line in the first {} bytes", start.len());
        return Err(Error::file(path, "header", found, "one after the header, without \\r"));
    }
    let wrong = |place: &str, expected: &str, e: ImageError| {
        Error::file(path, place, open::reason(e), expected)
    };
    // Strict mode would only refuse "#?RGBE" as the first line, and report malformed EXPOSURE lines
    // differently.
    let decoder = HdrDecoder::new_nonstrict(Guarded { rest: bytes, marks: 0 })
        .map_err(|e| wrong("header", "FORMAT=32-bit_rle_rgbe and then -Y rows +X columns", e))?;
    let about = decoder.metadata();
    let scale = scale(path, &about.custom_attributes)?;

    let place = "resolution line";
    let (rows, cols) = open::size(path, place, about.height.into(), about.width.into())?;
    if rows as u64 * cols as u64 > TEXEL_LIMIT {
        let found = format!("{rows} × {cols}");
        return Err(Error::file(path, place, found, format!("at most {TEXEL_LIMIT} texels")));
    }
    // A row is at least a texel and a mark of 4 bytes for each base-256 digit of its run.
    let row_bytes = 4 * (1 + [1, 256].iter().filter(|n| cols > **n).count());
    open::plausible(path, place, (row_bytes * rows) as u64, bytes.len(), 1)?;

    let mut texels = open::zeros::<[f32; 3]>(path, rows * cols)?;
    decoder
        .read_image(bytemuck::cast_slice_mut(&mut texels))
        .map_err(|e| wrong("image data", "scanlines as long as the picture is wide", e))?;
    if scale != [1.0; 3] {
        for texel in &mut texels {
            *texel = [0, 1, 2].map(|i| (f64::from(texel[i]) * scale[i]) as f32);
        }
    }
    Ok((rows, cols, texels))
}

/// The header's factor. The decoder collects EXPOSURE and COLORCORR, too, but silently skips values
/// that are no f32.
fn scale(path: &Path, lines: &[(String, String)]) -> Result<[f64; 3]> {
    let mut scale = [1.0_f64; 3];
    for (key, value) in lines {
        // A line without a value is kept whole under no key.
        let (key, value) = match key.as_str() {
            "" => value.split_once('=').unwrap_or_default(),
            key => (key, value.as_str()),
        };
        let (count, expected) = match key {
            "EXPOSURE" => (1, "a positive number"),
            "COLORCORR" => (3, "three positive numbers"),
            _ => continue,
        };
        let numbers: Vec<f64> =
            value.split_whitespace().map(|w| w.parse().unwrap_or(f64::NAN)).collect();
        if numbers.len() != count || numbers.iter().any(|v| !v.is_normal() || *v < 0.0) {
            let found: String = value.chars().take(40).filter(|c| !c.is_control()).collect();
            let place = format!("header: {key}");
            return Err(Error::file(path, place, format!("\"{found}\""), expected));
        }
        scale = [0, 1, 2].map(|i| scale[i] / numbers[i % count]);
    }
    Ok(scale)
}

/// The file's bytes, up to a fifth old-style run mark in a row. Two suffice for the widest row, and
/// the decoder multiplies its count by 256 for each without a check, which panics in debug builds
/// (image-rs/image#2714, merged, not in 0.25.10).
struct Guarded<'a> {
    rest: &'a [u8],
    /// Consecutive marks read so far; the decoder reads whole texels and marks.
    marks: u8,
}

impl Read for Guarded<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.rest.read(buffer)?;
        self.marks = if matches!(buffer, [1, 1, 1, _]) { self.marks + 1 } else { 0 };
        if self.marks > 4 {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "five run lengths in a row"));
        }
        Ok(count)
    }
}

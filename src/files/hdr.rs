//! Radiance HDR: shared-exponent texels, plain or run-length coded.

use super::open;
use crate::{Error, Result};
use std::path::Path;

/// The most texels an environment may have: 16384 × 8192.
pub(super) const TEXEL_LIMIT: u64 = 1 << 27;

/// Rows, columns and radiance. A texel (r, g, b, e) is (r, g, b)·2^(e-136), over the product of
/// the header's EXPOSURE lines (which say by what the values were multiplied) and of its COLORCORR
/// lines. GAMMA and PRIMARIES lines mean nothing here and are passed over.
pub(super) fn colour(path: &Path, bytes: &[u8]) -> Result<(usize, usize, Vec<[f32; 3]>)> {
    let mut rest = bytes;
    let mut scale = [1.0_f64; 3];
    for number in 1.. {
        let place = || format!("header line {number}");
        let line = next_line(&mut rest).ok_or_else(|| {
            Error::file(path, place(), "the end of the file", "an empty line after the header")
        })?;
        let numbers = |text: &str, expected: &str| {
            let values: Vec<f64> = text.split_whitespace().filter_map(|w| w.parse().ok()).collect();
            if values.is_empty() || values.iter().any(|v| !v.is_normal() || *v < 0.0) {
                return Err(Error::file(path, place(), shortened(line), expected));
            }
            Ok(values)
        };
        if line.is_empty() {
            break;
        } else if let Some(text) = line.strip_prefix("EXPOSURE=") {
            let exposure = numbers(text, "EXPOSURE= and a positive number")?[0];
            scale = scale.map(|s| s / exposure);
        } else if let Some(text) = line.strip_prefix("COLORCORR=") {
            match numbers(text, "COLORCORR= and three positive numbers")?[..] {
                [r, g, b] => scale = [scale[0] / r, scale[1] / g, scale[2] / b],
                _ => {
                    let found = shortened(line);
                    return Err(Error::file(path, place(), found, "three positive numbers"));
                }
            }
        } else if let Some(format) = line.strip_prefix("FORMAT=")
            && format.trim() != "32-bit_rle_rgbe"
        {
            return Err(Error::file(path, place(), shortened(line), "FORMAT=32-bit_rle_rgbe"));
        }
    }
    let line = next_line(&mut rest).unwrap_or("");
    let words: Vec<&str> = line.split_whitespace().collect();
    let sides = match words[..] {
        ["-Y", rows, "+X", cols] => rows.parse::<u64>().ok().zip(cols.parse::<u64>().ok()),
        _ => None,
    };
    let place = "resolution line";
    let (rows, cols) = sides.ok_or_else(|| {
        Error::file(path, place, shortened(line), "-Y rows +X columns (top row first)")
    })?;
    let (rows, cols) = open::size(path, place, rows, cols)?;
    if rows as u64 * cols as u64 > TEXEL_LIMIT {
        let found = format!("{rows} × {cols}");
        return Err(Error::file(path, place, found, format!("at most {TEXEL_LIMIT} texels")));
    }
    // A row takes at least one texel, or a 4-byte mark.
    open::plausible(path, place, 4 * rows as u64, bytes.len(), 1)?;

    let mut texels = Vec::new();
    let mut scanline = Vec::with_capacity(cols);
    for row in 0..rows {
        scanline.clear();
        read_row(&mut rest, cols, &mut scanline).ok_or_else(|| {
            let expected = "a scanline as long as the picture is wide";
            Error::file(path, format!("row {row}"), "truncated or broken run lengths", expected)
        })?;
        texels.extend(scanline.iter().map(|&[r, g, b, e]| {
            let unit = 2.0_f64.powi(i32::from(e) - 136);
            let value = |m: u8, s: f64| if e == 0 { 0.0 } else { (f64::from(m) * unit * s) as f32 };
            [value(r, scale[0]), value(g, scale[1]), value(b, scale[2])]
        }));
    }
    Ok((rows, cols, texels))
}

/// The text up to a line feed, which is consumed; `None` at the end or where it is no text.
fn next_line<'a>(rest: &mut &'a [u8]) -> Option<&'a str> {
    let end = rest.iter().position(|b| *b == b'\n')?;
    let line = std::str::from_utf8(&rest[..end]).ok()?;
    *rest = &rest[end + 1..];
    Some(line.trim_end_matches('\r'))
}

fn shortened(line: &str) -> String {
    format!("\"{}\"", line.chars().take(40).filter(|c| !c.is_control()).collect::<String>())
}

/// Cuts `n` bytes off the front.
fn take<'a>(rest: &mut &'a [u8], n: usize) -> Option<&'a [u8]> {
    let (front, back) = rest.split_at_checked(n)?;
    *rest = back;
    Some(front)
}

/// One scanline of RGBE in either coding; `None` where the bytes end or a run passes the row's end.
fn read_row(rest: &mut &[u8], cols: usize, row: &mut Vec<[u8; 4]>) -> Option<()> {
    if (8..0x8000).contains(&cols)
        && let [2, 2, high, low, ..] = **rest
        && usize::from(u16::from_be_bytes([high, low])) == cols
    {
        take(rest, 4)?;
        row.resize(cols, [0; 4]);
        return (0..4).try_for_each(|channel| read_channel(rest, row, channel));
    }
    // The older coding: texels, and (1, 1, 1, n) for n more of the last; marks in a row are the
    // digits of one count, lowest first.
    let mut shift = 0;
    while row.len() < cols {
        let texel = take(rest, 4)?;
        if let [1, 1, 1, n] = *texel {
            let run = usize::from(n).checked_shl(shift)?;
            let last = *row.last()?;
            if run > cols - row.len() {
                return None;
            }
            row.resize(row.len() + run, last);
            shift += 8;
        } else {
            row.push([texel[0], texel[1], texel[2], texel[3]]);
            shift = 0;
        }
    }
    Some(())
}

/// One channel of a scanline: a count above 128 repeats the next byte count-128 times, else count
/// bytes follow as they are.
fn read_channel(rest: &mut &[u8], row: &mut [[u8; 4]], channel: usize) -> Option<()> {
    let mut texels = row.iter_mut();
    while texels.len() > 0 {
        let count = usize::from(take(rest, 1)?[0]);
        if count == 0 || count > 128 && count - 128 > texels.len() {
            return None;
        }
        if count > 128 {
            let value = take(rest, 1)?[0];
            texels.by_ref().take(count - 128).for_each(|t| t[channel] = value);
        } else if count <= texels.len() {
            let values = take(rest, count)?;
            texels.by_ref().zip(values).for_each(|(t, v)| t[channel] = *v);
        } else {
            return None;
        }
    }
    Some(())
}

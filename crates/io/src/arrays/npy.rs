//! NumPy arrays: a reader of every integer and float type, a streaming writer of f32.

use crate::atomic::{Temporary, Written};
use crate::heights::{Raster, tif, type_name};
use crate::open;
use half::f16;
use ridgelight::scene::HeightField;
use ridgelight::{Error, Result};
use std::path::Path;

/// An array's header: the type of the bytes after it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Array<'a> {
    pub shape: Vec<usize>,
    kind: u8,
    size: usize,
    big_endian: bool,
    fortran: bool,
    data: &'a [u8],
}

impl<'a> Array<'a> {
    /// Parses a whole `.npy` file of version 1, 2 or 3. `inside` prefixes places in messages, for
    /// arrays in an archive ("elevation.npy: ").
    pub fn parse(path: &Path, inside: &str, bytes: &'a [u8]) -> Result<Self> {
        let wrong = |place: &str, found: String, expected: &str| {
            Error::file(path, format!("{inside}{place}"), found, expected)
        };
        let short = || wrong("header", format!("{} bytes", bytes.len()), "a whole NPY header");
        if !bytes.starts_with(b"\x93NUMPY") {
            return Err(wrong("header", "no NPY signature".into(), "an NPY array"));
        }
        let (length, start) =
            match *bytes.get(6..).and_then(|b| b.first_chunk::<6>()).ok_or_else(short)? {
                [1, _, a, b, ..] => (usize::from(u16::from_le_bytes([a, b])), 10),
                [2 | 3, _, a, b, c, d] => (u32::from_le_bytes([a, b, c, d]) as usize, 12),
                [version, ..] => {
                    return Err(wrong("header", format!("version {version}"), "version 1, 2 or 3"));
                }
            };
        let text = bytes.get(start..).and_then(|b| b.get(..length)).ok_or_else(short)?;
        let text = std::str::from_utf8(text)
            .map_err(|_| wrong("header", "bytes that are no text".into(), "a dictionary"))?;
        let data = &bytes[start + length..];

        let missing =
            |key: &str| wrong("header", format!("no {key}"), "descr, fortran_order, shape");
        let descr = value(text, "descr").ok_or_else(|| missing("descr"))?;
        let descr = descr.trim_matches(['\'', '"', ' ']);
        let (kind, size, big_endian) = match *descr.as_bytes() {
            [order @ (b'<' | b'>' | b'|' | b'='), kind @ (b'i' | b'u' | b'f'), size]
                if matches!((kind, size), (_, b'2' | b'4' | b'8') | (b'i' | b'u', b'1')) =>
            {
                // NumPy never writes '='; it would mean the writer's machine: little-endian.
                (kind, usize::from(size - b'0'), order == b'>')
            }
            _ => {
                let found = open::shortened(descr, 24);
                let expected = "integers (i1 to i8, u1 to u8) or floats (f2, f4, f8)";
                return Err(wrong("header: descr", format!("the type {found}"), expected));
            }
        };
        let order = value(text, "fortran_order").ok_or_else(|| missing("fortran_order"))?;
        let fortran = match order.trim() {
            "True" => true,
            "False" => false,
            _ => return Err(wrong("header: fortran_order", "neither".into(), "True or False")),
        };
        let shape = value(text, "shape").ok_or_else(|| missing("shape"))?;
        let shape = tuple(shape).ok_or_else(|| {
            wrong("header: shape", "no tuple of counts".into(), "as (rows, cols)")
        })?;
        let claimed = shape.iter().try_fold(size, |n, d| n.checked_mul(*d));
        if claimed != Some(data.len()) {
            let expected = match claimed {
                Some(n) => format!("{n} for the shape {shape:?}"),
                None => format!("as many as the shape {shape:?} needs"),
            };
            return Err(wrong("data", format!("{} bytes", data.len()), &expected));
        }
        Ok(Self { shape, kind, size, big_endian, fortran, data })
    }

    /// Some of its values as a raster of unknown cell size.
    fn raster(&self, rows: usize, cols: usize, values: Vec<f64>) -> Raster {
        // 16- or 32-bit floats.
        let single = self.kind == b'f' && self.size < 8;
        let data_type = type_name(self.kind, 8 * self.size);
        Raster { data_type, single, ..Raster::bare(rows, cols, values) }
    }

    /// The value at an index in memory order; 64-bit integers beyond 2⁵³ are rounded.
    fn stored(&self, i: usize) -> f64 {
        let mut b = [0_u8; 8];
        b[..self.size].copy_from_slice(&self.data[i * self.size..(i + 1) * self.size]);
        if self.big_endian {
            b[..self.size].reverse();
        }
        match (self.kind, self.size) {
            (b'f', 2) => f16::from_le_bytes([b[0], b[1]]).to_f64(),
            (b'f', 4) => f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])),
            (b'f', _) => f64::from_le_bytes(b),
            (b'u', _) => u64::from_le_bytes(b) as f64,
            // Shifting left and back right extends the sign.
            (_, size) => {
                let shift = 64 - 8 * size as u32;
                (i64::from_le_bytes(b) << shift >> shift) as f64
            }
        }
    }

    /// All values with the last index running fastest, whatever the order in the file.
    pub fn values(&self) -> impl Iterator<Item = f64> + '_ {
        let count = self.shape.iter().product();
        (0..count).map(move |i| {
            if !self.fortran {
                return self.stored(i);
            }
            // Indices from the last to the first; Fortran's stride grows from the first.
            let (mut rest, mut stride, mut at) = (i, count, 0);
            for d in self.shape.iter().rev() {
                stride /= d;
                at += rest % d * stride;
                rest /= d;
            }
            self.stored(at)
        })
    }
}

/// The text of a key's value in an NPY header's Python dictionary.
pub(crate) fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let at = [format!("'{key}'"), format!("\"{key}\"")]
        .iter()
        .find_map(|quoted| text.find(quoted).map(|at| at + quoted.len()))?;
    let rest = text.get(at..)?.trim_start().strip_prefix(':')?.trim_start();
    let end = match rest.strip_prefix('(') {
        Some(inner) => inner.find(')')? + 2,
        None => rest.find([',', '}'])?,
    };
    rest.get(..end)
}

/// `(3, 4)`, `(3,)` or `()`; NumPy 1 wrote `3L` in Python 2.
pub(crate) fn tuple(text: &str) -> Option<Vec<usize>> {
    let inner = text.trim().strip_prefix('(')?.strip_suffix(')')?.trim();
    if inner.is_empty() {
        return Some(Vec::new());
    }
    let inner = inner.strip_suffix(',').unwrap_or(inner);
    inner.split(',').map(|n| n.trim().trim_end_matches('L').parse().ok()).collect()
}

/// A 2-D array, or the plane `band` (from 1 on) of a 3-D one; its cell size is unknown.
pub(crate) fn heights(path: &Path, bytes: &[u8], band: Option<u32>) -> Result<Raster> {
    let array = Array::parse(path, "", bytes)?;
    match (array.shape.as_slice(), band) {
        (&[planes, rows, cols], Some(band)) => {
            let index = (band as usize).checked_sub(1).filter(|index| *index < planes);
            let index = index.ok_or_else(|| tif::no_band(path, band, planes))?;
            let (rows, cols) = open::size(path, "header: shape", rows as u64, cols as u64)?;
            let values = array.values().skip(index * rows * cols).take(rows * cols).collect();
            Ok(array.raster(rows, cols, values))
        }
        ([_, _], Some(band)) if band != 1 => Err(tif::no_band(path, band, 1)),
        ([_, _, _], None) => {
            let expected = "two: rows and columns; or three with a choice by `band`";
            Err(Error::file(path, "header: shape", "3 dimensions", expected))
        }
        _ => raster(path, "", &array),
    }
}

/// A 2-D array as a raster; `inside` as in [`Array::parse`].
pub(crate) fn raster(path: &Path, inside: &str, array: &Array) -> Result<Raster> {
    let place = format!("{inside}header: shape");
    let &[rows, cols] = array.shape.as_slice() else {
        let found = format!("{} dimensions", array.shape.len());
        return Err(Error::file(path, place, found, "two: rows and columns"));
    };
    let (rows, cols) = open::size(path, &place, rows as u64, cols as u64)?;
    let values = array.values().collect();
    Ok(array.raster(rows, cols, values))
}

/// The header of an array of this type ("<f4") and shape, last index running fastest.
///
/// # Errors
/// More dimensions than a header holds.
fn header(descr: &str, shape: &[usize]) -> Result<Vec<u8>> {
    let sizes: String = shape.iter().map(|n| format!("{n}, ")).collect();
    let mut text = format!(
        "{{'descr': '{descr}', 'fortran_order': False, 'shape': ({}), }}",
        sizes.trim_end()
    );
    // The data begins at a multiple of 64 bytes, after a 10-byte preamble and a line feed.
    let padded = (10 + text.len() + 1).next_multiple_of(64);
    text.push_str(&" ".repeat(padded - 10 - text.len() - 1));
    text.push('\n');
    let length = u16::try_from(text.len()).map_err(|_| {
        Error::setting("shape", format!("{} dimensions", shape.len()), "a few dimensions")
    })?;
    Ok([&b"\x93NUMPY\x01\x00"[..], &length.to_le_bytes(), text.as_bytes()].concat())
}

/// Writes an array of little-endian f32 piece by piece, so that it may be larger than memory.
///
/// The destination is untouched until [`finish`](Self::finish); dropping the writer leaves nothing.
#[derive(Debug)]
pub struct NpyWriter {
    file: Temporary,
    shape: Vec<usize>,
    /// Bytes before the values.
    start: u64,
    left: usize,
}

impl NpyWriter {
    /// Begins an array of `shape`, its last index running fastest: `[azimuths, rows, cols]` for
    /// horizons.
    ///
    /// # Errors
    /// A shape beyond the address space; a directory that cannot be written.
    pub fn create(path: &Path, shape: &[usize]) -> Result<Self> {
        let left = shape.iter().try_fold(1_usize, |n, d| n.checked_mul(*d)).ok_or_else(|| {
            Error::setting("shape", format!("{shape:?}"), "a product within the address space")
        })?;
        let mut file = Temporary::create(path)?;
        let header = header("<f4", shape)?;
        file.write(&header)?;
        Ok(Self { file, shape: shape.to_vec(), start: header.len() as u64, left })
    }

    /// Appends values in order; NaN is allowed.
    ///
    /// # Errors
    /// More values than the shape holds; a write error.
    pub fn write(&mut self, values: &[f32]) -> Result<()> {
        self.left = self.left.checked_sub(values.len()).ok_or_else(|| {
            Error::setting(
                format!("values for the shape {:?}", self.shape),
                format!("{} more", values.len()),
                format!("{} more", self.left),
            )
        })?;
        for piece in values.chunks(4096) {
            let bytes: Vec<u8> = piece.iter().flat_map(|v| v.to_le_bytes()).collect();
            self.file.write(&bytes)?;
        }
        Ok(())
    }

    /// Writes one of the planes along the first axis, in any order, each once.
    ///
    /// # Errors
    /// As [`write`](Self::write); a plane that the shape does not have.
    pub fn write_plane(&mut self, plane: usize, values: &[f32]) -> Result<()> {
        let length: usize = self.shape.iter().skip(1).product();
        if values.len() != length || plane >= self.shape.first().copied().unwrap_or(1) {
            let found = format!("{} values for plane {plane}", values.len());
            let expected = format!("{length} values for each plane");
            return Err(Error::setting(format!("the shape {:?}", self.shape), found, expected));
        }
        self.file.seek(self.start + 4 * (plane * length) as u64)?;
        self.write(values)
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
    /// Fewer values than the shape holds; a write error.
    pub fn close(self) -> Result<Written> {
        if self.left > 0 {
            return Err(Error::setting(
                format!("values for the shape {:?}", self.shape),
                format!("{} too few", self.left),
                "all of them before the end",
            ));
        }
        self.file.close()
    }
}

/// Writes a field's absolute heights as an array of little-endian f64, in its length unit, with
/// voids as NaN (read it with no-data NaN). A field read back has the same heights to a rounding of
/// f32, relative to its own base height.
///
/// # Errors
/// A write error.
pub fn write_npy_heights(path: &Path, field: &HeightField) -> Result<()> {
    let mut file = Temporary::create(path)?;
    file.write(&header("<f8", &[field.rows(), field.cols()])?)?;
    for (i, height) in field.heights_m().iter().enumerate() {
        let is_void = field.voids().is_some_and(|v| v[i]);
        let absolute = if is_void { f64::NAN } else { field.base_m() + f64::from(*height) };
        file.write(&absolute.to_le_bytes())?;
    }
    file.finish()
}

/// Writes an array of `shape` (last index fastest) from chunks of any lengths, in order.
///
/// # Errors
/// As [`NpyWriter`]: another number of values, or a write error.
pub fn write_npy_f32<'a>(
    path: &Path,
    shape: &[usize],
    chunks: impl IntoIterator<Item = &'a [f32]>,
) -> Result<()> {
    let mut writer = NpyWriter::create(path, shape)?;
    for chunk in chunks {
        writer.write(chunk)?;
    }
    writer.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_come_in_any_order() {
        let folder = tempfile::tempdir().unwrap();
        let [a, b] = ["a.npy", "b.npy"].map(|name| folder.path().join(name));
        let planes = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]];
        write_npy_f32(&a, &[2, 1, 3], planes.iter().map(|plane| plane.as_slice())).unwrap();
        let mut writer = NpyWriter::create(&b, &[2, 1, 3]).unwrap();
        writer.write_plane(1, &planes[1]).unwrap();
        let error = writer.write_plane(2, &planes[0]).unwrap_err().to_string();
        assert!(error.contains("plane 2"), "{error}");
        assert!(writer.write_plane(0, &planes[0][..2]).is_err());
        writer.write_plane(0, &planes[0]).unwrap();
        writer.finish().unwrap();
        assert_eq!(std::fs::read(a).unwrap(), std::fs::read(b).unwrap());
    }
}

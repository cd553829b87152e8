//! The bytes of a TIFF, such that `tiff` decodes its samples unchanged.
//!
//! Where the header states WhiteIsZero, `tiff` 0.11 inverts unsigned integers, replaces a float v by 1 - v, and refuses
//! signed integers. Heights are the stored values, as GDAL reads them. The reader is given BlackIsZero in the header.

use std::io::{Cursor, Read, Result, Seek, SeekFrom};

const PHOTOMETRIC: u64 = 262;

/// A file in memory.
pub(crate) struct Raw<'a> {
    cursor: Cursor<&'a [u8]>,
    /// The place of the byte that states WhiteIsZero.
    white_is_zero: Option<u64>,
}

impl<'a> Raw<'a> {
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { cursor: Cursor::new(bytes), white_is_zero: white_is_zero(bytes) }
    }

    /// Bytes of the file.
    pub fn size(&self) -> usize {
        self.cursor.get_ref().len()
    }
}

impl Read for Raw<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> Result<usize> {
        let from = self.cursor.position();
        let count = self.cursor.read(buffer)?;
        if let Some(at) = self.white_is_zero.and_then(|at| at.checked_sub(from))
            && let Some(byte) = usize::try_from(at).ok().and_then(|at| buffer[..count].get_mut(at))
        {
            *byte = 1;
        }
        Ok(count)
    }
}

impl Seek for Raw<'_> {
    fn seek(&mut self, to: SeekFrom) -> Result<u64> {
        self.cursor.seek(to)
    }
}

/// The lowest byte of a photometric interpretation of 0 in the first directory.
fn white_is_zero(bytes: &[u8]) -> Option<u64> {
    let is_little = bytes.starts_with(b"II");
    let number = |at: u64, width: usize| -> Option<u64> {
        let at = usize::try_from(at).ok()?;
        let own = bytes.get(at..at.checked_add(width)?)?;
        let add = |sum: u64, byte: &u8| sum << 8 | u64::from(*byte);
        Some(if is_little { own.iter().rev().fold(0, add) } else { own.iter().fold(0, add) })
    };
    // A TIFF or a BigTIFF: the widths of an offset and of a count of entries, and the bytes of an entry.
    let (first, wide, count_bytes, entry_bytes) = match number(2, 2)? {
        42 => (4, 4, 2, 12),
        43 => (8, 8, 8, 20),
        _ => return None,
    };
    let directory = number(first, wide)?;
    let entries = directory.checked_add(count_bytes as u64)?;
    // A longer claim ends with the file.
    let count = number(directory, count_bytes)?.min(bytes.len() as u64 / entry_bytes);
    let mut all = (0..count).map(|i| entries + entry_bytes * i);
    let entry = all.find(|at| number(*at, 2) == Some(PHOTOMETRIC))?;
    // Types of TIFF 6.0 and BigTIFF: BYTE, SHORT, LONG, LONG8.
    let width = match number(entry + 2, 2)? {
        1 => 1,
        3 => 2,
        4 => 4,
        16 => 8,
        _ => return None,
    };
    let value = entry + 4 + wide as u64;
    let lowest = if is_little { value } else { value + width as u64 - 1 };
    (number(value, width)? == 0).then_some(lowest)
}

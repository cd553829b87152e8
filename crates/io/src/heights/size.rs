//! The size of a height field, from its header.

use crate::arrays::npy::{tuple, value};
use crate::open::{self, Format};
use ::exr::meta::MetaData;
use std::fs::{self, File};
use std::io::{BufReader, Read};
use std::path::Path;
use tiff::decoder::Decoder;

/// Headers of text and of arrays are shorter.
const HEAD_BYTES: u64 = 1 << 16;

/// Rows and columns in the header of a height field, without reading the heights: a caller can
/// refuse a field that is too large before it spends time and memory.
///
/// `None` where the header has no size, as in an `.npz`, or is invalid;
/// [`read_heights`](crate::read_heights) reports why.
pub fn height_size(path: &Path) -> Option<[usize; 2]> {
    let about = fs::metadata(path).ok().filter(fs::Metadata::is_file)?;
    let mut file = BufReader::new(File::open(path).ok()?);
    let size = match Format::of_name(path)? {
        Format::Hgt => [(about.len() / 2).isqrt(); 2],
        Format::Tiff => {
            let (cols, rows) = Decoder::new(file).ok()?.dimensions().ok()?;
            [rows.into(), cols.into()]
        }
        Format::Exr => {
            let meta = MetaData::read_from_buffered(file, false).ok()?;
            let size = meta.headers.first()?.layer_size;
            [size.height() as u64, size.width() as u64]
        }
        format => {
            let mut head = Vec::new();
            file.by_ref().take(HEAD_BYTES).read_to_end(&mut head).ok()?;
            of_head(format, &head)?
        }
    };
    let (rows, cols) = open::size(path, "header", size[0], size[1]).ok()?;
    Some([rows, cols])
}

fn of_head(format: Format, head: &[u8]) -> Option<[u64; 2]> {
    match format {
        Format::Png => {
            // Columns and rows are the first two words of IHDR, which is always first.
            let word = |at: usize| {
                let bytes = head.get(at..at + 4)?.first_chunk()?;
                Some(u64::from(u32::from_be_bytes(*bytes)))
            };
            (head.get(12..16)? == b"IHDR").then_some(())?;
            Some([word(20)?, word(16)?])
        }
        Format::Npy => match tuple(value(&String::from_utf8_lossy(head), "shape")?)?.as_slice() {
            [rows, cols] => Some([*rows as u64, *cols as u64]),
            _ => None,
        },
        Format::Asc => {
            let text = String::from_utf8_lossy(head).to_ascii_lowercase();
            let count = |key: &str| {
                let mut words = text.split_ascii_whitespace();
                words.find(|word| *word == key)?;
                words.next()?.parse().ok()
            };
            Some([count("nrows")?, count("ncols")?])
        }
        _ => None,
    }
}

//! How large a field is, by its header alone.

use super::npy::{tuple, value};
use super::open::{self, Format};
use ::exr::meta::MetaData;
use std::fs::{self, File};
use std::io::{BufReader, Read};
use std::path::Path;
use tiff::decoder::Decoder;

/// Headers of text and of arrays are shorter.
const HEAD_BYTES: u64 = 1 << 16;

/// Rows and columns that the header of a height field claims, read without its samples: to refuse what
/// is too large before the time and memory that reading takes.
///
/// Nothing where the header says nothing, as of an `.npz`, or is wrong; what is wrong,
/// [`read_heights`](super::read_heights) tells.
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

//! The order of attributes in a written header.
//!
//! The `exr` crate keeps them in a `HashMap`, whose order differs between runs. OpenEXR allows any
//! order, so they are sorted where they lie: the header keeps its length and the file its offsets.

use std::io::{self, Read, Seek, SeekFrom, Write};

/// Bytes before the first attribute: the magic number and the version.
const START: u64 = 8;

/// Sorts the attributes of a file with one part by name.
///
/// # Errors
/// A file that cannot be read or written, or whose header does not end.
pub(super) fn sort(file: &mut (impl Read + Write + Seek)) -> io::Result<()> {
    file.seek(SeekFrom::Start(START))?;
    let mut reader = io::BufReader::new(&mut *file);
    let mut attributes = Vec::new();
    loop {
        let attribute = attribute(&mut reader)?;
        if attribute == [0] {
            break;
        }
        attributes.push(attribute);
    }
    // Two names that differ first at the end of one: the NUL at its end sorts before any letter.
    attributes.sort();
    file.seek(SeekFrom::Start(START))?;
    file.write_all(&attributes.concat())?;
    file.seek(SeekFrom::End(0)).map(drop)
}

/// An attribute: its name and type, each ended by NUL, the count of its bytes, and these. Only a
/// NUL at the end of the header.
fn attribute(reader: &mut impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    for part in 0..2 {
        loop {
            let mut byte = [0];
            reader.read_exact(&mut byte)?;
            bytes.push(byte[0]);
            if byte == [0] {
                break;
            }
        }
        if part == 0 && bytes == [0] {
            return Ok(bytes);
        }
    }
    let mut count = [0; 4];
    reader.read_exact(&mut count)?;
    bytes.extend(count);
    let count = u64::from(u32::from_le_bytes(count));
    match reader.take(count).read_to_end(&mut bytes)? as u64 == count {
        true => Ok(bytes),
        false => Err(io::ErrorKind::UnexpectedEof.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn attributes_are_sorted_in_place() {
        let b = b"b\0string\0\x02\0\0\0xy".as_slice();
        let ab = b"ab\0int\0\x04\0\0\0\x01\0\0\0".as_slice();
        let a = b"a\0string\0\0\0\0\0".as_slice();
        let file = |order: [&[u8]; 3]| [b"magicver", &order.concat()[..], b"\0offsets"].concat();
        let mut mixed = Cursor::new(file([b, ab, a]));
        sort(&mut mixed).unwrap();
        assert_eq!(mixed.into_inner(), file([a, ab, b]));
        assert!(sort(&mut Cursor::new(b"magicvera\0string\0\x09\0\0\0".to_vec())).is_err());
    }
}

//! The directories of a TIFF (TIFF 6.0, §2, and Adobe's BigTIFF): tags and their values in bytes.

use std::collections::BTreeMap;

/// The values of a tag.
#[derive(Clone, Debug)]
pub(super) enum Values {
    Short(Vec<u16>),
    Long(Vec<u32>),
    Double(Vec<f64>),
    Ascii(String),
    /// Places and sizes in the file: 32 bits, in a BigTIFF 64.
    Offset(Vec<u64>),
}

impl Values {
    fn count(&self) -> usize {
        match self {
            Self::Short(values) => values.len(),
            Self::Long(values) => values.len(),
            Self::Double(values) => values.len(),
            // With the NUL at its end.
            Self::Ascii(text) => text.len() + 1,
            Self::Offset(values) => values.len(),
        }
    }

    /// The type's number, and bytes of one value.
    fn kind(&self, big: bool) -> (u16, usize) {
        match self {
            Self::Short(_) => (3, 2),
            Self::Long(_) => (4, 4),
            Self::Double(_) => (12, 8),
            Self::Ascii(_) => (2, 1),
            Self::Offset(_) => {
                if big {
                    (16, 8)
                } else {
                    (4, 4)
                }
            }
        }
    }

    fn bytes(&self, big: bool) -> Vec<u8> {
        match self {
            Self::Short(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::Long(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::Double(values) => values.iter().flat_map(|v| v.to_le_bytes()).collect(),
            Self::Ascii(text) => [text.as_bytes(), b"\0"].concat(),
            Self::Offset(values) => values.iter().flat_map(|v| word(*v, big)).collect(),
        }
    }

    /// Bytes outside the entry, padded to an even count; 0 where the values fit the entry.
    fn outside(&self, big: bool) -> usize {
        let bytes = self.count() * self.kind(big).1;
        if bytes > word_bytes(big) { bytes.next_multiple_of(2) } else { 0 }
    }
}

/// An offset, in 32 or 64 bits. A file that is not big has no larger ones.
fn word(value: u64, big: bool) -> Vec<u8> {
    if big { value.to_le_bytes().into() } else { (value as u32).to_le_bytes().into() }
}

fn word_bytes(big: bool) -> usize {
    if big { 8 } else { 4 }
}

/// The header, which ends with the place of the first directory.
pub(super) fn header(big: bool, first: u64) -> Vec<u8> {
    let magic: &[u8] = if big { b"II+\0\x08\0\0\0" } else { b"II*\0" };
    [magic, &word(first, big)].concat()
}

/// The tags of one image, in the order of their numbers.
#[derive(Clone, Debug, Default)]
pub(super) struct Directory(pub BTreeMap<u16, Values>);

impl Directory {
    /// Bytes of the directory and the values after it.
    pub fn size(&self, big: bool) -> usize {
        let (count, entry) = if big { (8, 20) } else { (2, 12) };
        let entries = count + entry * self.0.len() + word_bytes(big);
        entries + self.0.values().map(|values| values.outside(big)).sum::<usize>()
    }

    /// The directory for the place `at`; `next` is the place of the next one, 0 for none.
    pub fn bytes(&self, big: bool, at: u64, next: u64) -> Vec<u8> {
        let mut bytes = match big {
            true => (self.0.len() as u64).to_le_bytes().to_vec(),
            false => (self.0.len() as u16).to_le_bytes().to_vec(),
        };
        let outside: usize = self.0.values().map(|values| values.outside(big)).sum();
        let mut place = at + (self.size(big) - outside) as u64;
        let mut after = Vec::with_capacity(outside);
        for (tag, values) in &self.0 {
            bytes.extend(tag.to_le_bytes());
            bytes.extend(values.kind(big).0.to_le_bytes());
            bytes.extend(word(values.count() as u64, big));
            let mut content = values.bytes(big);
            let length = values.outside(big);
            if length == 0 {
                content.resize(word_bytes(big), 0);
                bytes.extend(content);
            } else {
                bytes.extend(word(place, big));
                content.resize(length, 0);
                after.extend(content);
                place += length as u64;
            }
        }
        bytes.extend(word(next, big));
        bytes.extend(after);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Written out by hand after TIFF 6.0: two bytes count, entries of twelve, the next directory's
    /// place, then the values that do not fit four bytes.
    #[test]
    fn a_directory_as_the_specification_has_it() {
        let mut directory = Directory::default();
        directory.0.insert(256, Values::Long(vec![7]));
        directory.0.insert(305, Values::Ascii("four".into()));
        directory.0.insert(259, Values::Short(vec![8]));
        assert_eq!(directory.size(false), 2 + 3 * 12 + 4 + 6);
        let expected = [
            &[3, 0][..],
            &[0, 1, 4, 0, 1, 0, 0, 0, 7, 0, 0, 0],
            &[3, 1, 3, 0, 1, 0, 0, 0, 8, 0, 0, 0],
            &[49, 1, 2, 0, 5, 0, 0, 0, 100 + 42, 0, 0, 0],
            &[9, 0, 0, 0],
            b"four\0\0",
        ];
        assert_eq!(directory.bytes(false, 100, 9), expected.concat());
        assert_eq!(directory.bytes(true, 100, 9).len(), directory.size(true));
        // Five bytes fit the eight of a BigTIFF's entry.
        assert_eq!(directory.size(true), 8 + 3 * 20 + 8);
    }
}

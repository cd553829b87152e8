//! Common first steps of all readers: read the bytes, determine the format, check the header.

use ridgelight::{Error, Result};
use std::sync::atomic::{AtomicU64, Ordering};
use std::{fs, io::Read, path::Path};

/// The longest side of a field or picture that is read.
pub(crate) const SIDE_LIMIT: u64 = 1 << 16;
/// The most samples (of one channel) that are read.
pub(crate) const SAMPLE_LIMIT: u64 = 1 << 30;
/// The largest file that is read: the most samples there may be, as f64, twice over.
pub(crate) const FILE_LIMIT: u64 = 16 * SAMPLE_LIMIT;
/// DEFLATE's greatest expansion: a match of 258 bytes for two bits (RFC 1951, §3.2.5).
pub(crate) const DEFLATE_RATIO: u64 = 1032;

/// A file format that this crate reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Png,
    Exr,
    Tiff,
    Hgt,
    Asc,
    Npy,
    Npz,
    Hdr,
}

/// What messages call a format, its extensions (lower case), and its signatures.
type About = (Format, &'static str, &'static [&'static str], &'static [&'static [u8]]);

/// SRTM tiles have no signature. Read as a tile, each signature would be a height above 18 000 m or
/// below -30 000 m, so no tile is mistaken for another format.
const FORMATS: [About; 8] = [
    (Format::Png, "a PNG", &["png"], &[b"\x89PNG\r\n\x1a\n"]),
    (Format::Exr, "an OpenEXR file", &["exr"], &[b"\x76\x2f\x31\x01"]),
    (Format::Tiff, "a TIFF", &["tif", "tiff"], &[b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"]),
    (Format::Hgt, "an SRTM tile", &["hgt"], &[]),
    (Format::Asc, "an ESRI ASCII grid", &["asc"], &[]),
    (Format::Npy, "an NPY array", &["npy"], &[b"\x93NUMPY"]),
    (Format::Npz, "a ZIP archive (NPZ)", &["npz"], &[b"PK\x03\x04"]),
    (Format::Hdr, "a Radiance HDR picture", &["hdr", "pic"], &[b"#?"]),
];

impl Format {
    fn about(self) -> &'static About {
        FORMATS.iter().find(|about| about.0 == self).expect("a row for each format")
    }

    /// With its article, for messages.
    fn named(self) -> &'static str {
        self.about().1
    }

    /// The usual extensions, for messages.
    fn extensions(self) -> String {
        self.about().2.iter().map(|e| format!(" .{e}")).collect()
    }

    /// By the name's extension, case-insensitive.
    pub fn of_name(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(FORMATS.iter().find(|about| about.2.contains(&extension.as_str()))?.0)
    }

    fn of_bytes(bytes: &[u8]) -> Option<Self> {
        let has = |about: &&About| about.3.iter().any(|start| bytes.starts_with(start));
        Some(FORMATS.iter().find(has)?.0)
    }
}

/// The name's format, if it is one of `accepted` and matches the signature.
pub(crate) fn format(path: &Path, bytes: &[u8], accepted: &[Format]) -> Result<Format> {
    let format = Format::of_name(path).filter(|f| accepted.contains(f)).ok_or_else(|| {
        let found = match path.extension() {
            Some(extension) => format!("the extension .{}", extension.display()),
            None => "no extension".into(),
        };
        let names: String = accepted.iter().map(|f| f.extensions()).collect();
        // Height fields alone may be packed.
        let packed =
            if accepted.contains(&Format::Hgt) { ", or one packed as .gz or .zip" } else { "" };
        Error::file(path, "name", found, format!("one of{names}{packed}"))
    })?;
    if bytes.is_empty() {
        return Err(Error::file(path, "header", "an empty file", format.named()));
    }
    let expected = format!("{}, as its name says", format.named());
    match Format::of_bytes(bytes) {
        Some(found) if found != format => {
            Err(Error::file(path, "first bytes", found.named(), expected))
        }
        None if !matches!(format, Format::Hgt | Format::Asc) => {
            Err(Error::file(path, "first bytes", hex(bytes), expected))
        }
        _ => Ok(format),
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().take(4).map(|b| format!("{b:02x}")).collect::<Vec<_>>().join(" ")
}

/// All bytes of a regular file.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    let io = |e| Error::io(path, e);
    let about = fs::metadata(path).map_err(io)?;
    if !about.is_file() {
        let found = if about.is_dir() { "a directory" } else { "a device or a pipe" };
        return Err(Error::file(path, "path", found, "a file"));
    }
    if about.len() > FILE_LIMIT {
        let found = format!("{} bytes", about.len());
        return Err(Error::file(path, "file size", found, format!("{FILE_LIMIT} bytes or fewer")));
    }
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(usize::try_from(about.len()).unwrap_or(usize::MAX))
        .map_err(|_| io(std::io::ErrorKind::OutOfMemory.into()))?;
    let mut file = fs::File::open(path).map_err(io)?.take(FILE_LIMIT);
    loop {
        match (&mut file).take(PIECE).read_to_end(&mut bytes).map_err(io)? {
            0 => break,
            read => READ.fetch_add(read as u64, Ordering::Relaxed),
        };
    }
    Ok(bytes)
}

/// Bytes of a file that are read between two statements of progress.
const PIECE: u64 = 1 << 20;

static READ: AtomicU64 = AtomicU64::new(0);

/// Bytes of files that this process has read so far; for progress.
pub fn bytes_read() -> u64 {
    READ.load(Ordering::Relaxed)
}

/// Rows and columns as `usize`, if they are within the limits.
pub(crate) fn size(path: &Path, place: &str, rows: u64, cols: u64) -> Result<(usize, usize)> {
    let side = 1..=SIDE_LIMIT;
    if !side.contains(&rows) || !side.contains(&cols) || rows * cols > SAMPLE_LIMIT {
        return Err(Error::file(
            path,
            place,
            format!("{rows} rows and {cols} columns"),
            format!("1 to {SIDE_LIMIT} of each and at most {SAMPLE_LIMIT} samples"),
        ));
    }
    Ok((rows as usize, cols as usize))
}

/// Refuses a header that claims more bytes of samples than `held` bytes could expand to.
pub(crate) fn plausible(
    path: &Path,
    place: &str,
    claimed: u64,
    held: usize,
    ratio: u64,
) -> Result<()> {
    if claimed > ratio.saturating_mul(held as u64) {
        return Err(Error::file(
            path,
            place,
            format!("a claim of {claimed} bytes of samples in {held} bytes"),
            "no more than the file can hold",
        ));
    }
    Ok(())
}

/// The system's refusal of so many bytes at once, before a decoder that cannot report it asks for them.
pub(crate) fn room(path: &Path, bytes: u64) -> Result<()> {
    let count = usize::try_from(bytes).unwrap_or(usize::MAX);
    let refused = |_| Error::io(path, std::io::ErrorKind::OutOfMemory.into());
    Vec::<u8>::new().try_reserve_exact(count).map_err(refused)
}

/// Memory for `count` zeros, or the system's refusal.
pub(crate) fn zeros<T: Copy + Default>(path: &Path, count: usize) -> Result<Vec<T>> {
    let mut values = Vec::new();
    values
        .try_reserve_exact(count)
        .map_err(|_| Error::io(path, std::io::ErrorKind::OutOfMemory.into()))?;
    values.resize(count, T::default());
    Ok(values)
}

/// A text of a file for messages: its first characters.
pub(crate) fn shortened(text: &str, most: usize) -> String {
    text.chars().filter(|c| !c.is_control()).take(most).collect()
}

/// A decoder's error as the `found` of a message: one line, no full stop.
pub(crate) fn complaint(error: impl std::fmt::Display) -> String {
    let text = error.to_string().replace(|c: char| c.is_control(), " ");
    let words: Vec<_> = text.split_whitespace().collect();
    words.join(" ").trim_end_matches('.').to_owned()
}

/// [`complaint`] for the `image` crate, which reports a truncated file as the reader does.
pub(crate) fn reason(error: image::ImageError) -> String {
    match error {
        image::ImageError::IoError(e) if e.kind() == std::io::ErrorKind::UnexpectedEof => {
            "the end of the file".to_owned()
        }
        other => complaint(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_bytes_overrule_a_name() {
        let all = [Format::Png, Format::Tiff, Format::Hgt];
        let found = |name: &str, bytes: &[u8]| format(Path::new(name), bytes, &all);
        assert_eq!(found("a.PNG", b"\x89PNG\r\n\x1a\n").unwrap(), Format::Png);
        assert_eq!(found("a.hgt", &[0, 115]).unwrap(), Format::Hgt);
        for (name, bytes, said) in [
            ("a.png", &b"II*\0"[..], "a.png: first bytes: found a TIFF, expected a PNG"),
            ("a.png", b"GIF8", "found 47 49 46 38"),
            ("a.hgt", b"PK\x03\x04", "found a ZIP archive"),
            (
                "a.npy",
                b"\x93NUMPY",
                "the extension .npy, expected one of .png .tif .tiff .hgt, or one packed as .gz or .zip",
            ),
            ("a", b"", "no extension"),
            ("a.png", b"", "an empty file"),
        ] {
            let error = found(name, bytes).unwrap_err().to_string();
            assert!(error.contains(said), "{error}");
        }
    }
}

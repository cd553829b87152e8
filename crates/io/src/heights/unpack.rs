//! Height fields in `.gz` and `.zip` files.

use crate::open::{self, FILE_LIMIT, Format};
use flate2::read::MultiGzDecoder;
use ridgelight::{Error, Result};
use std::io::{Cursor, Read};
use std::path::{Path, PathBuf};

/// The name and the bytes of a packed file, `None` where the name is not that of one. Messages name the packed file; the last part
/// of the name sets the format, and an .hgt's position.
///
/// # Errors
/// Broken or huge contents; an archive with no height field, or more than one.
pub(super) fn unpacked(path: &Path, bytes: &[u8]) -> Result<Option<(PathBuf, Vec<u8>)>> {
    let extension = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("gz") => {
            let inner = path.file_stem().unwrap_or_default();
            Ok(Some((
                path.join(inner),
                all(path, MultiGzDecoder::new(bytes), "a whole gzip file")?,
            )))
        }
        Some("zip") => unzipped(path, bytes).map(Some),
        _ => Ok(None),
    }
}

fn unzipped(path: &Path, bytes: &[u8]) -> Result<(PathBuf, Vec<u8>)> {
    let broken = |e: zip::result::ZipError| {
        Error::file(path, "archive", open::complaint(e), "a whole ZIP archive")
    };
    let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).map_err(broken)?;
    // Paths into folders and hidden files of macOS do not count.
    let is_field = |name: &String| {
        let name = Path::new(name);
        let is_hidden = name.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
        !is_hidden && Format::of_name(name).is_some_and(|format| format != Format::Hdr)
    };
    let fields: Vec<String> = archive
        .file_names()
        .filter_map(|name| Some(name.ok()?.into_owned()))
        .filter(is_field)
        .collect();
    let [name] = fields.as_slice() else {
        let found = format!("{} height fields", fields.len());
        return Err(Error::file(path, "archive", found, "one, as N44W072.hgt in N44W072.hgt.zip"));
    };
    let contents = all(path, archive.by_name(name).map_err(broken)?, "a whole ZIP archive")?;
    let inner = Path::new(name).file_name().unwrap_or_default();
    Ok((path.join(inner), contents))
}

/// All that a decoder gives, up to the largest file.
fn all(path: &Path, decoder: impl Read, expected: &str) -> Result<Vec<u8>> {
    let mut contents = Vec::new();
    let read = decoder.take(FILE_LIMIT + 1).read_to_end(&mut contents);
    read.map_err(|e| Error::file(path, "compressed data", open::complaint(e), expected))?;
    if contents.len() as u64 > FILE_LIMIT {
        let found = "more bytes than a field may have";
        return Err(Error::file(path, "compressed data", found, format!("at most {FILE_LIMIT}")));
    }
    Ok(contents)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::heights::parse_field;
    use crate::{HeightOptions, parse_heights};
    use std::io::Write;

    const GRID: &[u8] = b"ncols 2 nrows 1 cellsize 3 5 7";

    fn gz(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    fn zip_of(files: &[(&str, &[u8])]) -> Vec<u8> {
        let mut writer = zip::ZipWriter::new(Cursor::new(Vec::new()));
        for (name, bytes) in files {
            writer.start_file(*name, zip::write::SimpleFileOptions::default()).unwrap();
            writer.write_all(bytes).unwrap();
        }
        writer.finish().unwrap().into_inner()
    }

    fn read(name: &str, bytes: &[u8]) -> Result<ridgelight::scene::HeightField> {
        parse_heights(Path::new(name), bytes, &HeightOptions::default())
    }

    #[test]
    fn packed_fields_are_those_inside() {
        let plain = read("a.asc", GRID).unwrap();
        assert_eq!(read("a.asc.gz", &gz(GRID)).unwrap(), plain);
        assert_eq!(read("a.ASC.GZ", &gz(GRID)).unwrap(), plain);
        let archive = zip_of(&[("readme.txt", b"about"), ("deep/a.asc", GRID)]);
        assert_eq!(read("b.zip", &archive).unwrap(), plain);
        // The tile's name in the archive gives its latitude: cells of 1/2 degree.
        let tile: Vec<u8> = (0..9_u16).flat_map(u16::to_be_bytes).collect();
        let [plain, packed] = [
            read("N44W072.hgt", &tile).unwrap(),
            read("x.zip", &zip_of(&[("N44W072.hgt", &tile)])).unwrap(),
        ];
        assert_eq!(plain.cell_m(), packed.cell_m());
        // Positions: a GeoTIFF's from its tags, a tile's from its name without ".gz".
        let utm = include_bytes!("../../../../tests/files/gdal/utm.tif");
        for (name, bytes, corner) in [
            ("utm.tif", utm.as_slice(), [500_000.0, 5_100_000.0]),
            ("N44W072.hgt", tile.as_slice(), [-72.25, 45.25]),
        ] {
            let of = |name: &str, bytes: &[u8]| {
                parse_field(Path::new(name), bytes, &HeightOptions::default()).unwrap()
            };
            let [plain, packed] = [of(name, bytes), of(&format!("{name}.gz"), &gz(bytes))];
            assert_eq!(packed.field, plain.field, "{name}");
            assert_eq!(packed.georeference, plain.georeference, "{name}");
            assert_eq!(packed.georeference.unwrap().corner, corner, "{name}");
        }
    }

    #[test]
    fn broken_and_ambiguous_packages_are_refused() {
        let whole = gz(GRID);
        for (name, bytes, said) in [
            ("a.asc.gz", whole[..whole.len() - 9].to_vec(), "compressed data"),
            ("a.asc.gz", GRID.to_vec(), "compressed data"),
            ("a.gz", whole, "no extension"),
            ("a.zip", GRID.to_vec(), "archive"),
            ("a.zip", zip_of(&[("a.txt", b"")]), "found 0 height fields"),
            ("a.zip", zip_of(&[("a.asc", GRID), ("b.asc", GRID)]), "found 2 height fields"),
        ] {
            let error = read(name, &bytes).unwrap_err().to_string();
            assert!(error.contains(said), "{name}: {error}");
        }
    }
}

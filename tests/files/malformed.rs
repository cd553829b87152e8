//! Wrong inputs: one sentence each, and no panic.

use crate::formats::*;
use crate::{one_sentence, parse};
use ridgelight::Error;
use ridgelight_io::*;
use std::path::Path;

#[test]
fn malformed_heights_are_one_sentence() {
    let mut count = 0;
    let mut refused = |name: &str, bytes: &[u8], why: &str| {
        match parse(name, bytes) {
            Ok(_) => panic!("{name} is taken although {why}"),
            Err(error) => one_sentence(&error.to_string(), name),
        }
        count += 1;
    };
    let files = height_files();
    for (name, bytes) in &files {
        refused(name, &[], "empty");
        for length in [1, 2, 5, 9, bytes.len() / 3, bytes.len() / 2, bytes.len() - 1] {
            // A cut NPZ loses its directory, a cut ASC may end between digits of its last number.
            let cut = if name.ends_with("asc") { length.min(bytes.len() - 5) } else { length };
            refused(name, &bytes[..cut], &format!("cut to {cut} bytes"));
        }
        for (other, others) in &files {
            let text = |n: &str| n.ends_with("asc") || n.ends_with("hgt");
            if other != name && !text(name) && !text(other) {
                refused(name, others, &format!("it is a {other}"));
            }
        }
    }
    // Wrong sizes: IHDR of a PNG is at 16..24 (the test repairs its CRC, which is checked first).
    let (name, png) = &files[0];
    for (rows, cols) in
        [(0_u32, 4_u32), (3, 0), (4, 4), (70_000, 4), (1 << 31, 1 << 31), (65_536, 65_536)]
    {
        let mut bytes = png.clone();
        bytes[16..20].copy_from_slice(&cols.to_be_bytes());
        bytes[20..24].copy_from_slice(&rows.to_be_bytes());
        let crc = crc32(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&crc.to_be_bytes());
        refused(name, &bytes, &format!("it claims {rows} × {cols}"));
    }
    // ImageLength is tag 257 of the TIFF's directory; dataWindow ends with the EXR's last row.
    let (name, tiff) = &files[2];
    let directory = u32::from_le_bytes(tiff[4..8].try_into().unwrap()) as usize;
    let entry = (0..).map(|i| directory + 2 + 12 * i).find(|e| tiff[*e..e + 2] == [1, 1]).unwrap();
    for rows in [0_u32, 4, 60_000, 70_000, u32::MAX] {
        let mut bytes = tiff.clone();
        bytes[entry + 2..entry + 12].copy_from_slice(
            &[&4_u16.to_le_bytes()[..], &1_u32.to_le_bytes(), &rows.to_le_bytes()].concat(),
        );
        refused(name, &bytes, &format!("it claims {rows} rows"));
    }
    let (name, exr) = &files[1];
    let key = b"dataWindow\0box2i\0";
    let at = exr.windows(key.len()).position(|w| w == key).unwrap() + key.len() + 4 + 12;
    for last_row in [-1_i32, 1, 3, 60_000, 70_000, i32::MAX, i32::MIN] {
        let mut bytes = exr.clone();
        bytes[at..at + 4].copy_from_slice(&last_row.to_le_bytes());
        refused(name, &bytes, &format!("it claims row {last_row} to be its last"));
    }
    let le: Vec<u8> = HEIGHTS.iter().flat_map(|h| h.to_le_bytes()).collect();
    for (descr, shape) in [
        ("<i2", "(3, 5)"),
        ("<i2", "(3, 3)"),
        ("<i2", "(12,)"),
        ("<i2", "()"),
        ("<i2", "(1, 3, 4)"),
        ("<i2", "(0, 4)"),
        ("<i2", "(99999999999, 99999999999)"),
        ("<i2", "(99999999999999999999, 1)"),
        ("<i2", "(-3, 4)"),
        ("<i2", "(3, 4"),
        ("<i2", "[3, 4]"),
        ("|b1", "(3, 8)"),
        ("<f16", "(3, 4)"),
        ("<c8", "(3, 1)"),
        ("|O", "(3, 4)"),
        ("<f1", "(3, 8)"),
    ] {
        refused("a.npy", &npy(descr, false, shape, &le), &format!("{descr} {shape}"));
    }
    for value in [f64::NAN, f64::INFINITY, 1e300] {
        refused("a.npy", &npy("<f8", false, "(1, 1)", &value.to_le_bytes()), "not a height");
    }
    let mut version = npy("<i2", false, "(3, 4)", &le);
    version[6] = 9;
    refused("a.npy", &version, "version 9");
    for shape in ["(0, 0)", "(1, 70000)"] {
        refused(
            "a.npy",
            &npy("|u1", false, shape, &vec![0; if shape == "(0, 0)" { 0 } else { 70_000 }]),
            shape,
        );
    }
    refused("N44W072.hgt", &[0x80, 0, 0x80, 0, 0x80, 0, 0x80, 0], "no data everywhere");
    refused("tile.hgt", &[0; 8], "no latitude");
    refused("a.jpg", &le, "unknown extension");
    refused("a", &le, "no extension");
    refused("a.tif", b"II*\0\x08\0\0\0\xff\xff", "a directory beyond the end");
    refused("a.asc", b"ncols 2 nrows 1 NODATA_value 7 7 7", "no data everywhere");
    refused("a.asc", b"\xff\xfe\0\x01", "no text");
    refused("a.npz", &zip(&[("a.txt", b"hello".to_vec())]), "no arrays");
    refused("a.npz", &zip(&[("elevation.npy", b"hello".to_vec())]), "no array");
    // The checksum of the first member in the archive's directory.
    let mut flipped = height_files().into_iter().find(|f| f.0 == "a.npz").expect("kept").1;
    let at = flipped.windows(4).position(|w| w == b"PK\x01\x02").expect("a directory");
    flipped[at + 16] ^= 1;
    refused("a.npz", &flipped, "hecksum");
    println!("{count} malformed files refused");
}

#[test]
fn paths_that_are_no_files() {
    let folder = tempfile::Builder::new().suffix(".png").tempdir().unwrap();
    let name = folder.path().file_name().unwrap().to_str().unwrap().to_owned();
    let heights = |p: &Path| read_heights(p, &HeightOptions::default()).unwrap_err();
    one_sentence(&heights(folder.path()).to_string(), &name);
    let absent = folder.path().join("absent.png");
    let error = heights(&absent);
    assert!(matches!(error, Error::Io { .. }) && error.to_string().contains("absent.png"));
    assert!(read_environment(&absent, 0.0).is_err());
    assert!(read_planes(&absent).is_err());
    assert!(read_albedo(&absent, 1, 1).is_err());
    assert!(write_text(folder.path(), "x").is_err());
    assert!(write_json(folder.path(), &serde_json::Value::Null).is_err());
    assert!(write_text(&folder.path().join("no/such/folder.txt"), "x").is_err());
    #[cfg(unix)]
    assert!(write_text(Path::new("/dev/null"), "x").is_err());
}

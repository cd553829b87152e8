//! Readers against files built here byte by byte and against real ones; writers by reading back.

mod common;

use common::*;
use exr::prelude::FlatSamples;
use ridgelight::Error;
use ridgelight::files::*;
use ridgelight::scene::HeightField;
use std::path::{Path, PathBuf};
use tiff::encoder::{Compression, DeflateLevel, colortype};
use tiff::tags::Predictor;

fn parse(name: &str, bytes: &[u8]) -> Result<HeightField, Error> {
    parse_heights(Path::new(name), bytes, &HeightOptions::default())
}

/// Asserts that a message is one sentence about a file: its name, no line break, found and
/// expected where the file is to blame.
fn one_sentence(message: &str, name: &str) {
    assert!(message.contains(name), "{message:?} does not name {name}");
    assert!(!message.contains(['\n', '\r']), "{message:?} has several lines");
    assert!(!message.trim_end_matches('.').contains(". "), "{message:?} is several sentences");
    assert!(message.contains(": found ") && message.contains(", expected "), "{message:?}");
    assert!(message.len() < 400, "{message:?} is long");
}

/// A folder of development data beside the clone, if this checkout has one.
fn shared(file: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(file);
    path.exists().then_some(path)
}

/// A file of this project's own assets.
fn asset(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(file)
}

/// Absolute heights; exact for the small integers used here.
fn absolute(field: &HeightField) -> Vec<f64> {
    field.heights_m().iter().map(|h| f64::from(*h) + field.base_m()).collect()
}

fn expected() -> Vec<f64> {
    HEIGHTS.iter().map(|h| f64::from(*h)).collect()
}

#[test]
fn every_format_gives_the_same_heights() {
    for (name, bytes) in height_files() {
        let field = parse(name, &bytes).unwrap();
        if name.ends_with(".hgt") {
            assert_eq!((field.rows(), field.cols()), (3, 3));
            assert_eq!(absolute(&field), expected()[..9]);
        } else {
            assert_eq!((field.rows(), field.cols()), (ROWS, COLS), "{name}");
            assert_eq!(absolute(&field), expected(), "{name}");
        }
        assert!(field.voids().is_none());
        let cell = match name {
            "a.asc" => [30.0, 30.0],
            "a.npz" => [30.0, 20.0],
            // Middle of three rows of 0.02° south of 45°, and of the tile at 44°: radii of the
            // ellipsoid as in the test beside the series, to 0.1 m a degree.
            "a.tif" => [0.01 * 78_888.0, 0.02 * 111_131.0],
            "N44W072.hgt" => [0.5 * 79_527.0, 0.5 * 111_122.0],
            _ => [1.0, 1.0],
        };
        for (got, expected) in field.cell_m().iter().zip(cell) {
            assert!((got / expected - 1.0).abs() < 1e-3, "{name}: {got} for {expected}");
        }
    }
}

#[test]
fn options_overrule_the_file() {
    let options = HeightOptions { cell_m: Some([2.0, 3.0]), z_scale: 0.5, nodata: Some(100.0) };
    for (name, bytes) in height_files() {
        let field = parse_heights(Path::new(name), &bytes, &options).unwrap();
        assert_eq!(field.cell_m(), [2.0, 3.0], "{name}");
        let voids = field.voids().unwrap();
        assert_eq!(voids.iter().filter(|v| **v).count(), 1);
        assert!(voids[8], "{name}");
        assert_eq!(absolute(&field)[5], f64::from(HEIGHTS[5]) / 2.0, "{name}");
    }
    for options in [
        HeightOptions { cell_m: Some([0.0, 1.0]), ..Default::default() },
        HeightOptions { cell_m: Some([f64::NAN, 1.0]), ..Default::default() },
        HeightOptions { z_scale: f64::INFINITY, ..Default::default() },
    ] {
        let (name, bytes) = &height_files()[0];
        let error = parse_heights(Path::new(name), bytes, &options).unwrap_err();
        assert!(matches!(error, Error::Setting { .. }), "{error}");
    }
}

#[test]
fn npy_of_every_type_order_and_endianness() {
    let signed = |size: usize, big: bool| -> Vec<u8> {
        let each = |h: &i16| {
            let le = i64::from(*h).to_le_bytes()[..size].to_vec();
            if big { le.into_iter().rev().collect::<Vec<_>>() } else { le }
        };
        HEIGHTS.iter().flat_map(each).collect()
    };
    for size in [1, 2, 4, 8] {
        for kind in ["i", "u"] {
            for (order, big) in [("<", false), (">", true)] {
                let descr = format!("{order}{kind}{size}");
                let field =
                    parse("a.npy", &npy(&descr, false, "(3, 4)", &signed(size, big))).unwrap();
                assert_eq!(absolute(&field), expected(), "{descr}");
            }
        }
    }
    let f2: Vec<u8> =
        HEIGHTS.iter().flat_map(|h| half::f16::from_f32(f32::from(*h)).to_le_bytes()).collect();
    let f4: Vec<u8> = HEIGHTS.iter().flat_map(|h| f32::from(*h).to_be_bytes()).collect();
    let f8: Vec<u8> = HEIGHTS.iter().flat_map(|h| f64::from(*h).to_le_bytes()).collect();
    for (descr, data) in [("<f2", &f2), (">f4", &f4), ("<f8", &f8)] {
        let field = parse("a.npy", &npy(descr, false, "(3, 4)", data)).unwrap();
        assert_eq!(absolute(&field), expected(), "{descr}");
    }
    // Sign: -1 in one byte.
    assert_eq!(absolute(&parse("a.npy", &npy("|i1", false, "(1, 1)", &[255])).unwrap()), [-1.0]);
    // Fortran: columns first.
    let columns: Vec<u8> = (0..12).flat_map(|i| HEIGHTS[i % 3 * 4 + i / 3].to_le_bytes()).collect();
    let field = parse("a.npy", &npy("<i2", true, "(3, 4)", &columns)).unwrap();
    assert_eq!(absolute(&field), expected());
    // Version 2 has a longer length.
    let mut two = npy("<i2", false, "(1, 1)", &[7, 0]);
    two[6] = 2;
    two.splice(10..10, [0, 0]);
    assert_eq!(absolute(&parse("a.npy", &two).unwrap()), [7.0]);
}

#[test]
fn npz_by_name_or_the_only_plane() {
    let le: Vec<u8> = HEIGHTS.iter().flat_map(|h| h.to_le_bytes()).collect();
    let array = npy("<i2", false, "(3, 4)", &le);
    let number = |v: f64| npy("<f8", false, "()", &v.to_le_bytes());
    let degrees = |y0: f64, y1: f64| {
        zip(&[
            ("whatever.npy", array.clone()),
            ("dx.npy", number(0.001)),
            ("dy.npy", number(0.002)),
            ("xmin.npy", number(-84.0)),
            ("xmax.npy", number(-83.9)),
            ("ymin.npy", number(y0)),
            ("ymax.npy", number(y1)),
        ])
    };
    let field = parse("a.npz", &degrees(36.0, 36.5)).unwrap();
    assert_eq!(absolute(&field), expected());
    // A degree of latitude near 36.25° is 110 967 m.
    assert!((field.cell_m()[1] - 221.93).abs() < 0.1, "{:?}", field.cell_m());
    assert_eq!(parse("a.npz", &degrees(36.5, 36.0)).unwrap().cell_m(), field.cell_m());
    let two = zip(&[("a.npy", array.clone()), ("b.npy", array.clone())]);
    let error = parse("a.npz", &two).unwrap_err().to_string();
    assert!(error.contains("several 2-D arrays"), "{error}");
    assert!(parse("a.npz", &zip(&[("a.npy", number(1.0))])).is_err());
}

#[test]
fn png_depths_and_masks() {
    use png::{BitDepth, ColorType};
    let field = parse(
        "a.png",
        &png(2, 2, ColorType::GrayscaleAlpha, BitDepth::Eight, &[9, 255, 8, 0, 7, 1, 6, 255]),
    )
    .unwrap();
    assert_eq!(field.voids().unwrap(), [false, true, false, false]);
    assert_eq!(absolute(&field)[2], 7.0);
    for (colour, bytes) in [(ColorType::Rgb, 3), (ColorType::Rgba, 4), (ColorType::Indexed, 1)] {
        let error = parse("a.png", &png(1, 1, colour, BitDepth::Eight, &vec![0; bytes]));
        one_sentence(&error.unwrap_err().to_string(), "a.png");
    }
    let error = parse("a.png", &png(8, 1, ColorType::Grayscale, BitDepth::One, &[3]));
    assert!(error.unwrap_err().to_string().contains("1 bits"));
}

#[test]
fn exr_channels_and_sample_types() {
    let f16 = FlatSamples::F16(HEIGHTS.map(|h| half::f16::from_f32(f32::from(h))).to_vec());
    let f32 = FlatSamples::F32(HEIGHTS.map(f32::from).to_vec());
    let u32 = FlatSamples::U32(HEIGHTS.map(|h| h as u32).to_vec());
    let zero = FlatSamples::F32(vec![0.0; 12]);
    for samples in [f16, f32.clone(), u32] {
        for name in ["Y", "Z", "R", "height", "anything"] {
            let field = parse("a.exr", &exr(4, 3, &[(name, samples.clone())])).unwrap();
            assert_eq!(absolute(&field), expected(), "{name}");
        }
    }
    let field = parse("a.exr", &exr(4, 3, &[("B", zero.clone()), ("Y", f32), ("Z", zero.clone())]));
    assert_eq!(absolute(&field.unwrap()), expected());
    let error = parse("a.exr", &exr(4, 3, &[("B", zero.clone()), ("G", zero)])).unwrap_err();
    assert!(error.to_string().contains("the channels B, G"), "{error}");
}

#[test]
fn tiff_sample_types_compressions_and_predictors() {
    fn check(bytes: Vec<u8>) {
        assert_eq!(absolute(&parse("a.tiff", &bytes).unwrap()), expected());
    }
    macro_rules! all {
        ($($colour:ident $kind:ty),*) => { $(
            let samples = HEIGHTS.map(|h| h as $kind);
            for compression in [
                Compression::Uncompressed,
                Compression::Lzw,
                Compression::Deflate(DeflateLevel::Balanced),
                Compression::Packbits,
            ] {
                check(tiff::<colortype::$colour>(4, 3, &samples, compression, Predictor::None, &[]));
            }
        )* };
    }
    all!(Gray8 u8, GrayI8 i8, Gray16 u16, GrayI16 i16, Gray32 u32, GrayI32 i32, Gray32Float f32,
         Gray64 u64, GrayI64 i64, Gray64Float f64);
    let (lzw, none) = (Compression::Lzw, Predictor::Horizontal);
    check(tiff::<colortype::GrayI32>(4, 3, &HEIGHTS.map(i32::from), lzw, none, &[]));
}

#[test]
fn geotiff_places_and_units() {
    let with = |tags: &[(u16, Tag)]| {
        let (none, plain) = (Predictor::None, Compression::Uncompressed);
        tiff::<colortype::Gray32Float>(4, 3, &HEIGHTS.map(f32::from), plain, none, tags)
    };
    let cell = |tags: &[(u16, Tag)]| parse("a.tif", &with(tags)).map(|f| f.cell_m());
    let scale = || (33550, Tag::Doubles(&[30.0, 20.0, 0.0]));
    let tie = || (33922, Tag::Doubles(&[0.0, 0.0, 0.0, 500_000.0, 4_900_000.0, 0.0]));
    assert_eq!(cell(&[]).unwrap(), [1.0, 1.0]);
    assert_eq!(cell(&[scale(), tie()]).unwrap(), [30.0, 20.0]);
    let projected = |unit: u16| [1, 1, 0, 2, 1024, 0, 1, 1, 3076, 0, 1, unit];
    assert_eq!(
        cell(&[scale(), tie(), (34735, Tag::Shorts(&projected(9001)))]).unwrap(),
        [30.0, 20.0]
    );
    let feet = cell(&[scale(), tie(), (34735, Tag::Shorts(&projected(9002)))]).unwrap();
    assert!((feet[0] - 9.144).abs() < 1e-9 && (feet[1] - 6.096).abs() < 1e-9, "{feet:?}");
    let user = [1, 1, 0, 3, 1024, 0, 1, 1, 3076, 0, 1, 32767, 3077, 34736, 1, 0];
    let own = cell(&[scale(), tie(), (34735, Tag::Shorts(&user)), (34736, Tag::Doubles(&[2.0]))]);
    assert_eq!(own.unwrap(), [60.0, 40.0]);
    // Heights in feet.
    let vertical = [1, 1, 0, 2, 1024, 0, 1, 1, 4099, 0, 1, 9002];
    let field = parse("a.tif", &with(&[scale(), tie(), (34735, Tag::Shorts(&vertical))])).unwrap();
    assert!((absolute(&field)[8] - 30.48).abs() < 1e-5);
    // Without keys, small numbers are degrees: the middle of 3 rows of 0.01° from 60.015° is 60°,
    // where a degree of longitude is 55 800 m.
    let small = [
        (33550, Tag::Doubles(&[0.01, 0.01, 0.0])),
        (33922, Tag::Doubles(&[0.0, 0.0, 0.0, 10.0, 60.015, 0.0])),
    ];
    assert!((cell(&small).unwrap()[0] - 558.0).abs() < 0.1);
    let matrix = |shear: f64| {
        let mut m = [0.0; 16];
        (m[0], m[1], m[3], m[5], m[7], m[15]) = (30.0, shear, 500_000.0, -20.0, 4.9e6, 1.0);
        m
    };
    assert_eq!(cell(&[(34264, Tag::Doubles(&matrix(0.0)))]).unwrap(), [30.0, 20.0]);
    for (tags, said) in [
        (vec![(34264, Tag::Doubles(&matrix(1.0)))], "rotated"),
        (vec![(34264, Tag::Doubles(&[1.0, 2.0]))], "2 numbers"),
        (vec![(33550, Tag::Doubles(&[30.0, -20.0, 0.0]))], "north up"),
        (vec![(33550, Tag::Doubles(&[f64::NAN, 1.0, 0.0]))], "positive sizes"),
        (vec![scale(), tie(), (34735, Tag::Shorts(&projected(1)))], "unit 1"),
        (vec![scale(), (34735, Tag::Shorts(&[1, 1, 0, 1, 1024, 0, 1, 2]))], "latitude"),
        (
            vec![scale(), tie(), (34735, Tag::Shorts(&[1, 1, 0, 1, 1024, 0, 1, 2]))],
            "latitude 48999",
        ),
        (vec![scale(), tie(), (34735, Tag::Shorts(&[1, 1, 0, 1, 1024, 0, 1, 3]))], "model type 3"),
        (vec![(42113, Tag::Text("none"))], "tag 42113"),
    ] {
        let error = cell(&tags).unwrap_err().to_string();
        one_sentence(&error, "a.tif");
        assert!(error.contains(said), "{error}");
    }
    // No data: printed in decimal, compared as the f32 it was; and NaN.
    let mut heights = HEIGHTS.map(f32::from);
    (heights[3], heights[7]) = (-f32::MAX, f32::NAN);
    let field = |nodata: &str, heights: &[f32]| {
        let (none, plain) = (Predictor::None, Compression::Uncompressed);
        let tags = [(42113, Tag::Text(nodata))];
        parse("a.tif", &tiff::<colortype::Gray32Float>(4, 3, heights, plain, none, &tags))
    };
    let error = field("-3.40282346639e+38", &heights).unwrap_err().to_string();
    assert!(error.contains("row 1, column 3: found NaN"), "{error}");
    heights[7] = 1.0;
    assert!(field("-3.40282346639e+38", &heights).unwrap().voids().unwrap()[3]);
    heights[3] = f32::NAN;
    assert!(field("nan", &heights).unwrap().voids().unwrap()[3]);
}

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
    // Sizes that lie: IHDR of a PNG is at 16..24 (its CRC is checked first, so mend it).
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
    println!("{count} malformed files refused");
}

/// The PNG checksum (ISO 3309), bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |crc, b| {
        (0..8).fold(
            crc ^ u32::from(*b),
            |c, _| if c & 1 == 1 { c >> 1 ^ 0xedb8_8320 } else { c >> 1 },
        )
    })
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
    assert!(write_text(&folder.path().join("no/such/folder.txt"), "x").is_err());
    #[cfg(unix)]
    assert!(write_text(Path::new("/dev/null"), "x").is_err());
}

/// Names in a folder, to see that nothing temporary stays.
fn listing(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn exr_layers_round_trip() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.exr");
    let (rows, cols) = (37, 23);
    let rgb: Vec<[f32; 3]> =
        (0..rows * cols).map(|i| [i as f32, 0.5 * i as f32, f32::MAX]).collect();
    let scalar: Vec<f32> =
        (0..rows * cols).map(|i| if i == 5 { f32::NAN } else { -(i as f32) }).collect();
    let layers = [
        Layer { name: String::new(), channels: Channels::Rgb(&rgb) },
        Layer { name: "direct.sky".into(), channels: Channels::Rgb(&rgb) },
        Layer { name: "error".into(), channels: Channels::Scalar("Y", &scalar) },
        Layer { name: "horizon".into(), channels: Channels::Scalar("", &scalar) },
    ];
    let metadata = [("device".to_owned(), "Größe".to_owned()), ("empty".to_owned(), String::new())];
    write_exr(&path, rows, cols, &layers, &metadata).unwrap();
    assert_eq!(listing(folder.path()), ["out.exr"]);

    let planes = read_planes(&path).unwrap();
    assert_eq!((planes.rows, planes.cols), (rows, cols));
    let names =
        ["B", "G", "R", "direct.sky.B", "direct.sky.G", "direct.sky.R", "error.Y", "horizon"];
    assert_eq!(planes.names, names);
    for (i, value) in scalar.iter().enumerate() {
        assert_eq!([2, 1, 0].map(|p| planes.planes[p][i]), rgb[i]);
        assert_eq!([5, 4, 3].map(|p| planes.planes[p][i]), rgb[i]);
        assert!([6, 7].iter().all(|&p| planes.planes[p][i].to_bits() == value.to_bits()));
    }
    let meta = exr::meta::MetaData::read_from_file(&path, true).unwrap();
    assert_eq!(meta.headers.len(), 1);
    let attributes = &meta.headers[0].own_attributes.other;
    assert!(attributes.iter().any(|(k, v)| k.eq("device")
        && matches!(v, exr::prelude::AttributeValue::Text(t) if t.bytes() == "Größe".as_bytes())));

    // What cannot be written leaves the old file and nothing else.
    let before = std::fs::read(&path).unwrap();
    let short = [Layer { name: String::new(), channels: Channels::Rgb(&rgb[1..]) }];
    let twice = [layers[0].clone(), layers[0].clone()];
    let nameless = [Layer { name: String::new(), channels: Channels::Scalar("", &scalar) }];
    let reserved = [("channels".to_owned(), "x".to_owned())];
    assert!(write_exr(&path, rows, cols, &short, &[]).is_err());
    assert!(write_exr(&path, rows, cols, &twice, &[]).is_err());
    assert!(write_exr(&path, rows, cols, &nameless, &[]).is_err());
    assert!(write_exr(&path, rows, cols, &[], &[]).is_err());
    assert!(write_exr(&path, rows, cols, &layers, &reserved).is_err());
    assert_eq!(std::fs::read(&path).unwrap(), before);
    assert_eq!(listing(folder.path()), ["out.exr"]);
}

#[test]
fn png_round_trips_to_the_step_of_eight_bits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.png");
    let (rows, cols) = (5, 51);
    let mut rgb: Vec<[f32; 3]> = (0..255).map(|i| [i as f32 / 255.0, 2.0, -1.0]).collect();
    write_png(&path, rows, cols, &rgb, None, Tone { exposure: 0.5 }).unwrap();
    let planes = read_planes(&path).unwrap();
    assert_eq!((planes.names.join(""), planes.rows, planes.cols), ("RGB".into(), rows, cols));
    for (i, texel) in rgb.iter().enumerate() {
        // Half a code is at most 1/510 of encoded range; the curve's slope is at most 2.275 there
        // (at white, 2.4/1.055).
        let got = planes.planes[0][i];
        assert!((got - texel[0] * 0.5).abs() < 2.275 / 510.0 + 1e-6, "{got} for {}", texel[0]);
        assert_eq!((planes.planes[1][i], planes.planes[2][i]), (1.0, 0.0));
    }
    rgb[7] = [f32::NAN; 3];
    let error = write_png(&path, rows, cols, &rgb, None, Tone::default()).unwrap_err();
    assert!(error.to_string().contains("row 0, column 7"), "{error}");
    let transparent: Vec<bool> = (0..255).map(|i| i == 7).collect();
    write_png(&path, rows, cols, &rgb, Some(&transparent), Tone::default()).unwrap();
    let planes = read_planes(&path).unwrap();
    assert_eq!(planes.names.join(""), "RGBA");
    assert!((0..255).all(|i| planes.planes[3][i] == if i == 7 { 0.0 } else { 1.0 }));
    assert!(write_png(&path, 5, 5, &rgb, None, Tone::default()).is_err());
    assert!(write_png(&path, rows, cols, &rgb, None, Tone { exposure: f32::NAN }).is_err());
    assert_eq!(listing(folder.path()), ["out.png"]);
}

#[test]
fn npy_streams_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.npy");
    let values: Vec<f32> = (0..2 * 3 * 5).map(|i| i as f32).collect();
    write_npy_f32(&path, &[2, 3, 5], values.chunks(7)).unwrap();
    let bytes = std::fs::read(&path).unwrap();
    assert_eq!((bytes.len() - 30 * 4) % 64, 0);
    let planes = read_planes(&path).unwrap();
    assert_eq!((planes.rows, planes.cols, planes.names.len()), (3, 5, 2));
    assert_eq!(planes.planes.concat(), values);
    assert!(write_npy_f32(&path, &[2, 3, 5], values[1..].chunks(7)).is_err());
    assert!(write_npy_f32(&path, &[2, 3, 4], values.chunks(7)).is_err());
    assert!(write_npy_f32(&path, &[usize::MAX, 2], values.chunks(7)).is_err());
    let mut writer = NpyWriter::create(&folder.path().join("dropped.npy"), &[30]).unwrap();
    writer.write(&values).unwrap();
    drop(writer);
    assert_eq!(listing(folder.path()), ["out.npy"]);
    assert_eq!(std::fs::read(&path).unwrap(), bytes);
    write_npy_f32(&path, &[4], [&[1.0, f32::NAN, 3.0, 4.0][..]]).unwrap();
    assert!(read_planes(&path).is_err(), "one dimension is no plane");
}

#[test]
fn text_replaces_text_through_a_link() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.json");
    write_text(&path, "{}").unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        let plain = folder.path().join("plain");
        std::fs::write(&plain, "").unwrap();
        let mode = |p: &Path| std::fs::metadata(p).unwrap().permissions().mode();
        assert_eq!(mode(&path), mode(&plain), "as readable as any new file");
        std::fs::remove_file(plain).unwrap();
        let link = folder.path().join("link.json");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write_text(&link, "[1]").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "[1]");
    }
}

fn environment(name: &str, bytes: &[u8]) -> Result<ridgelight::scene::Environment, Error> {
    parse_environment(Path::new(name), bytes, 0.25)
}

#[test]
fn hdr_headers_and_codings() {
    // 128·2^(129-136) = 1.
    let one = [[128, 64, 32, 129]; 8];
    let noise = "GAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\n# a comment\n";
    let picture = environment("a.hdr", &hdr(4, 2, noise, &one)).unwrap();
    assert_eq!((picture.width(), picture.height(), picture.rotation_rad()), (4, 2, 0.25));
    assert!(picture.texels().iter().all(|t| *t == [1.0, 0.5, 0.25]));
    // EXPOSURE and COLORCORR are what the values were multiplied by, line after line.
    let lines = "EXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR=1 0.5 1\n";
    let picture = environment("a.hdr", &hdr(4, 2, lines, &one)).unwrap();
    assert!(picture.texels().iter().all(|t| *t == [0.125, 0.125, 0.03125]));
    // Old runs: one texel, then seven more of it; rows do not share runs.
    let old = hdr(4, 2, "", &[[128, 64, 32, 129], [1, 1, 1, 3], [128, 0, 0, 129], [1, 1, 1, 3]]);
    assert_eq!(environment("a.hdr", &old).unwrap().texels()[7], [1.0, 0.0, 0.0]);
    // New runs, 16 wide: each channel as a run of 10 and 6 values as they are.
    let mut bytes = hdr(16, 8, "", &[]);
    for _ in 0..8 {
        bytes.extend([2, 2, 0, 16]);
        for channel in [128, 64, 32, 129] {
            bytes.extend([128 + 10, channel, 6]);
            bytes.extend([channel; 6]);
        }
    }
    let picture = environment("a.hdr", &bytes).unwrap();
    assert!(picture.texels().iter().all(|t| *t == [1.0, 0.5, 0.25]));
    for cut in 0..bytes.len() {
        let error = environment("a.hdr", &bytes[..cut]).unwrap_err().to_string();
        one_sentence(&error, "a.hdr");
    }
    for (bytes, said) in [
        (hdr(4, 2, "EXPOSURE=0\n", &one), "EXPOSURE"),
        (hdr(4, 2, "EXPOSURE=\n", &one), "EXPOSURE"),
        (hdr(4, 2, "COLORCORR=1\n", &one), "COLORCORR"),
        (hdr(4, 2, "FORMAT=32-bit_rle_xyze\n", &one), "xyze"),
        (hdr(5, 2, "", &one), "row 1"),
        (hdr(3, 2, "", &one), "3 × 2"),
        (hdr(20_000, 10_000, "", &one), "134217728"),
        (hdr(100_000, 1, "", &one), "100000 columns"),
        (hdr(4, 2, "EXPOSURE=1e-300\n", &one), "row 0, column 0"),
        (hdr(4, 2, "", &[[1, 1, 1, 200], one[0]]), "row 0"),
    ] {
        let error = environment("a.hdr", &bytes).unwrap_err().to_string();
        one_sentence(&error, "a.hdr");
        assert!(error.contains(said), "{error}");
    }
}

#[test]
fn exr_environments_of_every_shape() {
    let flat = |cols: usize, rows: usize| {
        let plane = |v: f32| FlatSamples::F32(vec![v; cols * rows]);
        exr(cols, rows, &[("R", plane(3.0)), ("G", plane(2.0)), ("B", plane(1.0))])
    };
    for (cols, rows, width) in [(8, 4, 8), (10, 10, 10), (12, 9, 20), (9, 12, 20)] {
        let picture = environment("a.exr", &flat(cols, rows)).unwrap();
        assert_eq!((picture.width(), picture.height()), (width, width / 2), "{cols} × {rows}");
        assert!(picture.texels().iter().all(|t| *t == [3.0, 2.0, 1.0]));
    }
    assert!(environment("a.exr", &flat(7, 3)).is_err());
    let grey = exr(2, 1, &[("Y", FlatSamples::F32(vec![1.0, 4.0]))]);
    assert_eq!(environment("a.exr", &grey).unwrap().texels(), [[1.0; 3], [4.0; 3]]);
    for bad in [-1.0, f32::NAN, f32::INFINITY] {
        let bytes = exr(2, 1, &[("Y", FlatSamples::F32(vec![1.0, bad]))]);
        let error = environment("a.exr", &bytes).unwrap_err().to_string();
        one_sentence(&error, "a.exr");
        assert!(error.contains("row 0, column 1"), "{error}");
    }
}

#[test]
fn six_files_make_a_cube() {
    let folder = tempfile::tempdir().unwrap();
    let face = |name: &str, code: u8, side: usize| {
        let bytes = hdr(side, side, "", &vec![[code, code, 7, 136]; side * side]);
        std::fs::write(folder.path().join(name), bytes).unwrap();
    };
    for (name, code) in ["px", "nx", "py", "ny", "pz", "nz"].iter().zip(1..) {
        face(&format!("sky_{name}.hdr"), code, 6);
    }
    let any = read_environment(&folder.path().join("sky_ny.hdr"), 0.0).unwrap();
    let pattern = read_environment(&folder.path().join("sky_*.hdr"), 0.0).unwrap();
    assert_eq!(any, pattern);
    assert_eq!((any.width(), any.height()), (40, 20));
    // Straight ahead is +Z (code 5), up +Y (3), down -Y (4), south +X (1), north -X (2).
    let at = |row: usize, col: usize| any.texels()[row * 40 + col][0];
    assert_eq!(
        [at(10, 20), at(0, 7), at(19, 7), at(10, 30), at(10, 10)],
        [5.0, 3.0, 4.0, 1.0, 2.0]
    );
    assert_eq!(at(10, 0), 6.0);
    face("sky_pz.hdr", 9, 7);
    let error = read_environment(&folder.path().join("sky_px.hdr"), 0.0).unwrap_err();
    one_sentence(&error.to_string(), "sky_pz.hdr");
    std::fs::remove_file(folder.path().join("sky_nz.hdr")).unwrap();
    face("sky_pz.hdr", 5, 6);
    let error = read_environment(&folder.path().join("sky_px.hdr"), 0.0).unwrap_err();
    assert!(error.to_string().contains("sky_nz.hdr"), "{error}");
}

#[test]
fn albedo_is_linear_and_fits_the_field() {
    use png::{BitDepth, ColorType};
    use ridgelight::scene::Albedo;
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: Vec<u8>| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let texels = |path: &Path| match read_albedo(path, 1, 2).unwrap() {
        Albedo::Map(map) => map,
        Albedo::Constant(c) => panic!("a map, not {c:?}"),
    };
    // sRGB 0.5 is 0.214 041 in linear light (IEC 61966-2-1); 188/255 is 0.502 886.
    let grey =
        write("g.png", png(2, 1, ColorType::Grayscale, BitDepth::Sixteen, &[0x80, 0, 0xff, 0xff]));
    assert!((texels(&grey)[0][1] - 0.214_046).abs() < 1e-5);
    assert_eq!(texels(&grey)[1], [1.0; 3]);
    let rgb = write("c.png", png(2, 1, ColorType::Rgb, BitDepth::Eight, &[188, 0, 255, 0, 0, 0]));
    assert!((texels(&rgb)[0][0] - 0.502_886).abs() < 1e-5);
    assert_eq!(texels(&rgb)[0][1..], [0.0, 1.0]);
    let palette = write("p.png", png(2, 1, ColorType::Indexed, BitDepth::Eight, &[1, 0]));
    assert_eq!(texels(&palette), [[1.0; 3], [0.0; 3]]);
    let exr = |v: f32| write("a.exr", exr(2, 1, &[("Y", FlatSamples::F32(vec![0.5, v]))]));
    assert_eq!(texels(&exr(1.0)), [[0.5; 3], [1.0; 3]]);
    for bad in [1.01, -0.1, f32::NAN] {
        let error = read_albedo(&exr(bad), 1, 2).unwrap_err().to_string();
        one_sentence(&error, "a.exr");
        assert!(error.contains("row 0, column 1"), "{error}");
    }
    one_sentence(&read_albedo(&grey, 2, 1).unwrap_err().to_string(), "g.png");
}

#[test]
fn the_projects_own_assets() {
    let field = read_heights(&asset("mt_washington_256.png"), &HeightOptions::default()).unwrap();
    assert_eq!((field.rows(), field.cols()), (256, 256));
    assert_eq!(range(&field), (287.0, 1908.0));
    let sky = read_environment(&asset("sky_512x256.hdr"), 0.0).unwrap();
    assert_eq!((sky.width(), sky.height()), (512, 256));
    assert_eq!(peak(&sky).0, 23040.0);
    assert_eq!(peak(&sky).1 % 512, 304);
}

fn range(field: &HeightField) -> (f64, f64) {
    let known = field.voids().map(|v| v.to_vec()).unwrap_or(vec![false; field.heights_m().len()]);
    absolute(field)
        .iter()
        .zip(known)
        .filter(|(_, void)| !void)
        .fold((f64::MAX, f64::MIN), |(lo, hi), (h, _)| (lo.min(*h), hi.max(*h)))
}

/// The largest channel and its texel's index.
fn peak(environment: &ridgelight::scene::Environment) -> (f32, usize) {
    let value = |t: &[f32; 3]| t[0].max(t[1]).max(t[2]);
    let texels = environment.texels();
    let i = (0..texels.len()).max_by(|a, b| value(&texels[*a]).total_cmp(&value(&texels[*b])));
    i.map(|i| (value(&texels[i]), i)).unwrap()
}

#[test]
fn real_files_beside_the_clone() {
    let mut skipped = 0;
    // Name, rows, columns, lowest, highest, voids, cell.
    let heights = [
        ("N44W072.hgt", 1201, 1201, 115.0, 1908.0, 0, [66.0, 92.6]),
        ("mt_rainier_90m.tif", 1201, 1201, 263.0, 4371.0, 9033, [64.0, 92.6]),
        ("jacksboro_fault_dem.npz", 344, 403, 236.0, 1076.0, 0, [74.0, 92.5]),
        ("Moss001_1K_Displacement.png", 1024, 1024, 1392.0, 65535.0, 0, [1.0, 1.0]),
        ("mt_washington_256.png", 256, 256, 287.0, 1908.0, 0, [1.0, 1.0]),
        ("west_bijou_escarpment_snippet.asc", 67, 129, 1690.0, 1807.0, 0, [23.8, 30.9]),
    ];
    for (name, rows, cols, lowest, highest, voids, cell) in heights {
        let Some(path) = shared(&format!("height/{name}")) else {
            skipped += 1;
            continue;
        };
        let field = read_heights(&path, &HeightOptions::default()).unwrap();
        assert_eq!((field.rows(), field.cols()), (rows, cols), "{name}");
        assert_eq!(range(&field), (lowest, highest), "{name}");
        let found = field.voids().map_or(0, |v| v.iter().filter(|v| **v).count());
        assert_eq!(found, voids, "{name}");
        for (got, expected) in field.cell_m().iter().zip(cell) {
            assert!((got / expected - 1.0).abs() < 0.01, "{name}: {got} for {expected}");
        }
    }
    let environments: [(&str, f32, Option<usize>); 4] = [
        ("spiaggia_di_mondello_1k.hdr", 72704.0, Some(615)),
        ("lab.hdr", 49.25, None),
        ("sky_512x256.hdr", 23040.0, Some(304)),
        ("KernerEnvLatLong.exr", 1678.0, None),
    ];
    for (name, expected, col) in environments {
        let Some(path) = shared(&format!("env/{name}")) else {
            skipped += 1;
            continue;
        };
        let environment = read_environment(&path, 0.0).unwrap();
        let (value, texel) = peak(&environment);
        assert!((value / expected - 1.0).abs() < 1e-3, "{name}: {value} for {expected}");
        if let Some(col) = col {
            assert_eq!(texel % environment.width(), col, "{name}");
        }
    }
    println!("{skipped} of 10 real files are not beside this clone");
}

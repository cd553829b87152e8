//! Each format, built here byte by byte, gives the heights and cells that were put in.

use crate::formats::*;
use crate::{absolute, expected, one_sentence, parse};
use exr::prelude::FlatSamples;
use ridgelight::Error;
use ridgelight::scene::HeightField;
use ridgelight_io::*;
use std::path::Path;
use tiff::encoder::{Compression, DeflateLevel, colortype};
use tiff::tags::Predictor;

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
    let options = HeightOptions {
        cell_m: Some([2.0, 3.0]),
        z_scale: 0.5,
        nodata: Some(100.0),
        ..HeightOptions::default()
    };
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
    use colour::*;
    let masked = png(2, 2, GREY_ALPHA, 8, &[], &[9, 255, 8, 0, 7, 1, 6, 255]);
    let field = parse("a.png", &masked).unwrap();
    assert_eq!(field.voids().unwrap(), [false, true, false, false]);
    assert_eq!(absolute(&field)[2], 7.0);
    // The grey that a tRNS chunk makes transparent, at either depth.
    let bytes = png(2, 1, GREY, 8, &[(b"tRNS", &[0, 9])], &[8, 9]);
    assert_eq!(parse("a.png", &bytes).unwrap().voids().unwrap(), [false, true]);
    let bytes = png(2, 1, GREY, 16, &[(b"tRNS", &[1, 9])], &[0, 9, 1, 9]);
    let field = parse("a.png", &bytes).unwrap();
    assert_eq!(field.voids().unwrap(), [false, true]);
    assert_eq!(absolute(&field)[0], 9.0);
    // Chunks beside the pixels change nothing, even broken or long ones.
    let note = [b"Comment\0".to_vec(), vec![b'x'; 1 << 20]].concat();
    let chunks: [(&[u8; 4], &[u8]); 3] =
        [(b"gAMA", &[0, 0, 0, 1]), (b"iCCP", b"p\0\0junk"), (b"tEXt", &note)];
    assert_eq!(
        absolute(&parse("a.png", &png(2, 1, GREY, 8, &chunks, &[8, 9])).unwrap()),
        [8.0, 9.0]
    );
    for (colour, bytes) in [(RGB, 3), (RGBA, 4), (PALETTE, 1)] {
        let error = parse("a.png", &png(1, 1, colour, 8, &[], &vec![0; bytes]));
        one_sentence(&error.unwrap_err().to_string(), "a.png");
    }
    let error = parse("a.png", &png(8, 1, GREY, 1, &[], &[3]));
    assert!(error.unwrap_err().to_string().contains("1 bits"));
}

#[test]
fn exr_channels_and_sample_types() {
    let f16 = FlatSamples::F16(HEIGHTS.map(|h| half::f16::from_f32(f32::from(h))).to_vec());
    let f32 = FlatSamples::F32(HEIGHTS.map(f32::from).to_vec());
    let u32 = FlatSamples::U32(HEIGHTS.map(|h| h as u32).to_vec());
    let zero = FlatSamples::F32(vec![0.0; 12]);
    for texels in [f16, f32.clone(), u32] {
        for name in ["Y", "Z", "R", "height", "anything"] {
            let field = parse("a.exr", &exr(4, 3, &[(name, texels.clone())])).unwrap();
            assert_eq!(absolute(&field), expected(), "{name}");
        }
    }
    let file = |heights: &str, others: &[&str]| {
        let others = others.iter().map(|name| (*name, zero.clone()));
        let all: Vec<_> = others.chain([(heights, f32.clone())]).collect();
        parse("a.exr", &exr(4, 3, &all))
    };
    for (heights, others) in [
        ("Z", &["R", "G", "B"][..]),
        ("Z", &["A", "N.X"]),
        ("height", &["X"]),
        ("elevation", &["R", "G", "B", "A"]),
        ("Y", &["A"]),
        ("R", &["A"]),
    ] {
        assert_eq!(absolute(&file(heights, others).unwrap()), expected(), "{heights}, {others:?}");
    }
    // Colours, vectors, and heights of which there are two.
    for (one, others, said) in [
        ("R", &["G", "B"][..], "the channels B, G, R"),
        ("R", &["A", "B", "G"], "the channels A, B, G, R"),
        ("R", &["G"], "the channels G, R"),
        ("Y", &["BY", "RY"], "the channels BY, RY, Y"),
        ("Z", &["X", "Y"], "the channels X, Y, Z"),
        ("Y", &["Z"], "the channels Y, Z"),
        ("height", &["Z"], "the channels Z, height"),
        ("G", &["B"], "the channels B, G"),
    ] {
        let error = file(one, others).unwrap_err().to_string();
        one_sentence(&error, "a.exr");
        assert!(error.contains(said) && error.contains("one channel"), "{error}");
    }
}

#[test]
fn tiff_sample_types_compressions_and_predictors() {
    fn check(bytes: Vec<u8>) {
        assert_eq!(absolute(&parse("a.tiff", &bytes).unwrap()), expected());
    }
    macro_rules! all {
        ($($colour:ident $kind:ty),*) => { $(
            let texels = HEIGHTS.map(|h| h as $kind);
            for compression in [
                Compression::Uncompressed,
                Compression::Lzw,
                Compression::Deflate(DeflateLevel::Balanced),
                Compression::Packbits,
            ] {
                check(tiff::<colortype::$colour>(4, 3, &texels, compression, Predictor::None, &[]));
            }
        )* };
    }
    all!(Gray8 u8, GrayI8 i8, Gray16 u16, GrayI16 i16, Gray32 u32, GrayI32 i32, Gray32Float f32,
         Gray64 u64, GrayI64 i64, Gray64Float f64);
    let (lzw, none) = (Compression::Lzw, Predictor::Horizontal);
    check(tiff::<colortype::GrayI32>(4, 3, &HEIGHTS.map(i32::from), lzw, none, &[]));
}

/// The place of a tag's entry in the only directory of a little-endian TIFF.
fn entry(bytes: &[u8], tag: u16) -> usize {
    let directory = u32::from_le_bytes(bytes[4..8].try_into().unwrap()) as usize;
    let mut all = (0..).map(|i| directory + 2 + 12 * i);
    all.find(|at| bytes[*at..at + 2] == tag.to_le_bytes()).unwrap()
}

/// Rows a strip, with the default of TIFF 6.0 for one strip of the whole image.
#[test]
fn strips_may_be_taller_than_the_image() {
    for compression in
        [Compression::Uncompressed, Compression::Lzw, Compression::Deflate(DeflateLevel::Fast)]
    {
        let none = Predictor::None;
        let mut bytes = tiff::<colortype::GrayI16>(4, 3, &HEIGHTS, compression, none, &[]);
        let at = entry(&bytes, 278);
        for rows in [4_u32, 70_000, 1 << 31, u32::MAX] {
            let rows = [&4_u16.to_le_bytes()[..], &1_u32.to_le_bytes(), &rows.to_le_bytes()];
            bytes[at + 2..at + 12].copy_from_slice(&rows.concat());
            assert_eq!(absolute(&parse("a.tif", &bytes).unwrap()), expected());
        }
    }
}

/// Heights are the stored values, whichever of the least and the greatest a picture shows as white (tag 262).
#[test]
fn values_are_the_stored_ones_where_white_is_zero() {
    fn check<C>(texels: &[C::Inner], compression: Compression)
    where
        C: colortype::ColorType,
        [C::Inner]: tiff::encoder::TiffValue,
    {
        let mut bytes = tiff::<C>(4, 3, texels, compression, Predictor::None, &[]);
        let at = entry(&bytes, 262);
        assert_eq!(bytes[at + 2..at + 9], [3, 0, 1, 0, 0, 0, 1], "a SHORT, BlackIsZero");
        bytes[at + 8] = 0;
        assert_eq!(absolute(&parse("a.tif", &bytes).unwrap()), expected());
    }
    for compression in [
        Compression::Uncompressed,
        Compression::Lzw,
        Compression::Deflate(DeflateLevel::Fast),
        Compression::Packbits,
    ] {
        check::<colortype::Gray8>(&HEIGHTS.map(|h| h as u8), compression);
        check::<colortype::GrayI16>(&HEIGHTS, compression);
        check::<colortype::Gray32>(&HEIGHTS.map(|h| h as u32), compression);
        check::<colortype::Gray32Float>(&HEIGHTS.map(f32::from), compression);
        check::<colortype::Gray64Float>(&HEIGHTS.map(f64::from), compression);
    }
}

/// The memory for a tile follows from its sides, which only the header states.
#[test]
fn huge_tiles_are_refused() {
    for compression in
        [Compression::Uncompressed, Compression::Lzw, Compression::Deflate(DeflateLevel::Fast)]
    {
        let plain = tiff::<colortype::GrayI16>(4, 3, &HEIGHTS, compression, Predictor::None, &[]);
        // The strip as a tile: offsets 273 to 324, rows a strip 278 to a width 322, byte counts 279 to 325. A
        // directory is in ascending order, so the entries move behind the others.
        let count = usize::from(plain[entry(&plain, 256) - 2]);
        let start = entry(&plain, 256);
        for [width, length] in
            [[65_520_u32, 16_368], [1 << 31, 16], [16, 1 << 31], [u32::MAX; 2], [0, 16]]
        {
            let mut entries: Vec<[u8; 12]> =
                plain[start..start + 12 * count].as_chunks::<12>().0.to_vec();
            let mut rest = Vec::new();
            entries.retain(|e| {
                let tag = u16::from_le_bytes([e[0], e[1]]);
                let moved = match tag {
                    273 => Some(324_u16),
                    279 => Some(325),
                    278 => return false,
                    _ => None,
                };
                if let Some(tag) = moved {
                    let mut own = *e;
                    own[..2].copy_from_slice(&tag.to_le_bytes());
                    rest.push(own);
                }
                moved.is_none()
            });
            for (tag, value) in [(322_u16, width), (323, length)] {
                let words = [
                    &tag.to_le_bytes()[..],
                    &4_u16.to_le_bytes(),
                    &1_u32.to_le_bytes(),
                    &value.to_le_bytes(),
                ];
                rest.push(words.concat().try_into().unwrap());
            }
            entries.extend(rest);
            entries.sort_by_key(|e| u16::from_le_bytes([e[0], e[1]]));
            // A new directory behind the file.
            let mut bytes = plain.clone();
            let at = bytes.len() as u32;
            bytes[4..8].copy_from_slice(&at.to_le_bytes());
            bytes.extend((entries.len() as u16).to_le_bytes());
            bytes.extend(entries.concat());
            bytes.extend([0; 4]);
            let error = parse("a.tif", &bytes).unwrap_err().to_string();
            one_sentence(&error, "a.tif");
            let said = match width {
                0 => "header",
                65_520 => "a claim of",
                _ => "tile size",
            };
            assert!(error.contains(said), "{error}");
        }
    }
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
    // By the code of the projected system alone, New York Long Island in US survey feet; a unit of
    // the file overrules it.
    let feet = [1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 2263];
    let metres = [1, 1, 0, 3, 1024, 0, 1, 1, 3072, 0, 1, 2263, 3076, 0, 1, 9001];
    let [of_code, of_file] = [&feet[..], &metres].map(|keys| {
        let cell = cell(&[scale(), tie(), (34735, Tag::Shorts(keys))]).unwrap();
        cell[0] / 30.0
    });
    assert!((of_code - 1200.0 / 3937.0).abs() < 1e-12 && of_file == 1.0, "{of_code} {of_file}");
    let field = parse("a.tif", &with(&[scale(), tie(), (34735, Tag::Shorts(&vertical))])).unwrap();
    assert!((absolute(&field)[8] - 30.48).abs() < 1e-5);
    // A vertical system has its own unit; without one the unit of the heights is open.
    let folder = tempfile::tempdir().unwrap();
    for (vertical, unit, is_noted) in [
        (None, 1.0, true),
        (Some(32767), 1.0, true),
        (Some(5703), 1.0, false),
        (Some(5773), 1.0, false),
        (Some(6360), 1200.0 / 3937.0, false),
        (Some(8050), 0.3048, false),
    ] {
        let mut keys = vec![1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 2265];
        if let Some(code) = vertical {
            keys[3] = 3;
            keys.extend([4096, 0, 1, code]);
        }
        let path = folder.path().join("a.tif");
        std::fs::write(&path, with(&[scale(), tie(), (34735, Tag::Shorts(&keys))])).unwrap();
        let read = read_field(&path, &HeightOptions::default()).unwrap();
        assert!((absolute(&read.field)[8] - 100.0 * unit).abs() < 1e-4, "{vertical:?}");
        let [notes, warnings] = [read.notes, read.warnings].map(|all| all.join("\n"));
        assert!(notes.contains("cells are in units of 0.3048 m"), "{notes}");
        assert_eq!(warnings.contains("z_scale"), is_noted, "{vertical:?}: {warnings}");
        let of_heights = format!("heights are in units of {unit} m and become metres");
        assert_eq!(notes.contains(&of_heights), unit != 1.0, "{vertical:?}: {notes}");
    }
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
        (vec![(33550, Tag::Doubles(&[30.0, -20.0, 0.0]))], "rows from north to south"),
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

/// Sizes come from the header alone; the files hold nothing else.
/// A plane of a 3-D array is chosen, never assumed; formats with one band have a first and no second.
#[test]
fn a_plane_is_chosen_by_its_number() {
    let values: Vec<u8> = (0..2 * 12).flat_map(|i| (i as f32).to_le_bytes()).collect();
    let cube = npy("<f4", false, "(2, 3, 4)", &values);
    let read = |name: &str, bytes: &[u8], band| {
        parse_heights(Path::new(name), bytes, &HeightOptions { band, ..Default::default() })
    };
    for (band, first) in [(1, 0.0), (2, 12.0)] {
        let field = read("a.npy", &cube, Some(band)).unwrap();
        assert_eq!((field.rows(), field.cols(), absolute(&field)[0]), (3, 4, first));
    }
    let error = read("a.npy", &cube, Some(3)).unwrap_err().to_string();
    assert!(error.contains("found 2 bands, expected a band 3"), "{error}");
    let error = read("a.npy", &cube, None).unwrap_err().to_string();
    assert!(error.contains("3 dimensions") && error.contains("`band`"), "{error}");
    for (name, bytes) in height_files() {
        assert!(read(name, &bytes, Some(1)).is_ok(), "{name}");
        let error = read(name, &bytes, Some(2)).unwrap_err().to_string();
        assert!(error.contains("a band 2"), "{name}: {error}");
    }
}

#[test]
fn sizes_are_known_from_headers() {
    let folder = tempfile::tempdir().unwrap();
    let size = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        height_size(&path)
    };
    for (name, bytes) in height_files() {
        let expected = match name {
            "a.npz" => None,
            "N44W072.hgt" => Some([3, 3]),
            _ => Some([ROWS, COLS]),
        };
        assert_eq!(size(name, &bytes), expected, "{name}");
        // The texels are last, but for TIFF's, whose header stands behind them.
        let cut = match name {
            "a.png" => 24,
            "a.asc" => bytes.len() - 36,
            "a.npy" => bytes.len() - 2 * HEIGHTS.len(),
            "a.exr" => bytes.len() - 30,
            _ => continue,
        };
        assert_eq!(size(name, &bytes[..cut]), expected, "{name}, cut");
        assert_eq!(size(name, &bytes[..8]), None, "{name}, 8 bytes");
    }
    assert_eq!(size("a.xyz", b"ncols 3 nrows 4"), None);
    assert_eq!(size("a.npy", &npy("<f4", false, "(2, 3, 4)", &[])), None);
    assert_eq!(height_size(folder.path()), None);
    assert_eq!(height_size(&folder.path().join("missing.png")), None);
}

/// GDAL's files of one hill, tests/files/gdal/write.sh: 5 rows, 7 columns, cells of 10 and 20 units.
fn gdal(name: &str) -> HeightField {
    let path = format!("{}/tests/files/gdal/{name}.tif", env!("CARGO_MANIFEST_DIR"));
    ridgelight_io::read_heights(Path::new(&path), &HeightOptions::default()).unwrap()
}

fn hill(row: i32, col: i32) -> f64 {
    f64::from(100 - 9 * (col - 3).pow(2) - 7 * (row - 2).pow(2))
}

fn assert_hill(field: &HeightField, height: impl Fn(f64) -> f64) {
    assert_eq!([field.rows(), field.cols()], [5, 7]);
    for (i, found) in field.heights_m().iter().enumerate() {
        let expected = height(hill(i as i32 / 7, i as i32 % 7));
        assert_eq!(field.base_m() + f64::from(*found), expected, "{i}");
    }
}

#[test]
fn gdal_compressions_and_scales_are_read() {
    for name in ["utm", "zstd", "mercator"] {
        assert_hill(&gdal(name), |height| height);
    }
    assert_hill(&gdal("scaled"), |stored| 1000.0 + 0.5 * stored);
    assert_eq!(gdal("zstd").cell_m(), [10.0, 20.0]);
    // Its vertical reference, EPSG:6360, is in US survey feet: heights round to f32.
    let field = gdal("utm_point_feet");
    for (i, found) in field.heights_m().iter().enumerate() {
        let expected = hill(i as i32 / 7, i as i32 % 7) * 1200.0 / 3937.0;
        let height = field.base_m() + f64::from(*found);
        assert!((height - expected).abs() < 1e-5, "{i}: {height} for {expected}");
    }
}

/// At northing y the latitude is atan(sinh(y / a)), and a metre of the grid is cos(latitude) metres on a sphere; the
/// ellipsoid's radii differ from a sphere's by 1/298.
#[test]
fn web_mercator_metres_are_shortened() {
    let latitude = (5_621_471.0_f64 / 6_378_137.0).sinh().atan();
    assert!((latitude.to_degrees() - 45.0).abs() < 1.0);
    let cell = gdal("mercator").cell_m();
    for (found, grid) in cell.into_iter().zip([10.0, 20.0]) {
        let ratio = found / (grid * latitude.cos());
        assert!((ratio - 1.0).abs() < 1.0 / 298.0, "{ratio}");
    }
}

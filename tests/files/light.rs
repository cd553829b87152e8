//! Environments and albedo maps.

use crate::formats::*;
use crate::one_sentence;
use exr::prelude::FlatSamples;
use ridgelight::Error;
use ridgelight_io::*;
use std::path::Path;

fn environment(name: &str, bytes: &[u8]) -> Result<ridgelight::scene::Environment, Error> {
    parse_environment(Path::new(name), bytes, 0.25)
}

/// Bytes with one string replaced by another.
fn with(mut bytes: Vec<u8>, from: &str, to: &str) -> Vec<u8> {
    let at = bytes.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
    bytes.splice(at..at + from.len(), to.bytes());
    bytes
}

#[test]
fn hdr_headers_and_codings() {
    // 128·2^(129-136) = 1.
    let one = [[128, 64, 32, 129]; 8];
    let noise = "GAMMA=1\nPRIMARIES=0 0 0 0 0 0 0 0\n# a comment\n";
    let picture = environment("a.hdr", &hdr(4, 2, noise, &one)).unwrap();
    assert_eq!((picture.width(), picture.height(), picture.rotation_rad()), (4, 2, 0.25));
    assert!(picture.texels().iter().all(|t| *t == [1.0, 0.5, 0.25]));
    // EXPOSURE and COLORCORR, by which the values were multiplied, line after line.
    let lines = "EXPOSURE=2\nEXPOSURE= 4.0\nCOLORCORR=1 0.5 1\n";
    let picture = environment("a.hdr", &hdr(4, 2, lines, &one)).unwrap();
    assert!(picture.texels().iter().all(|t| *t == [0.125, 0.125, 0.03125]));
    // The format's other first line, and the ends of the exponent: 128·2^(1-136), 255·2^(255-136).
    let ends = hdr(4, 2, "", &[one[0], [128, 0, 0, 1], [255, 128, 0, 255], [9, 9, 9, 0]].repeat(2));
    let picture = environment("a.hdr", &with(ends, "RADIANCE", "RGBE")).unwrap();
    let smallest = f32::from_bits(1 << 21);
    let largest = [255.0 * 2_f32.powi(119), 2_f32.powi(126), 0.0];
    assert_eq!(picture.texels()[1..4], [[smallest, 0.0, 0.0], largest, [0.0; 3]]);
    // Old runs: one texel, then seven more of it; rows do not share runs.
    let old = hdr(4, 2, "", &[[128, 64, 32, 129], [1, 1, 1, 3], [128, 0, 0, 129], [1, 1, 1, 3]]);
    assert_eq!(environment("a.hdr", &old).unwrap().texels()[7], [1.0, 0.0, 0.0]);
    // Run markers in a row are the digits of one count, lowest first: 1 + 255 + 256·1 = 512.
    let long = hdr(512, 256, "", &[[128, 64, 32, 129], [1, 1, 1, 255], [1, 1, 1, 1]].repeat(256));
    let picture = environment("a.hdr", &long).unwrap();
    assert!(picture.texels().iter().all(|t| *t == [1.0, 0.5, 0.25]));
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
        (hdr(4, 2, "EXPOSURE=2 3\n", &one), "EXPOSURE"),
        (hdr(4, 2, "COLORCORR=1 2 x\n", &one), "COLORCORR"),
        (hdr(5, 2, "", &one), "image data: found the end of the file"),
        (hdr(3, 2, "", &one), "3 × 2"),
        (hdr(20_000, 10_000, "", &one), "134217728"),
        (hdr(100_000, 1, "", &one), "100000 columns"),
        (hdr(4, 2, "EXPOSURE=1e-300\n", &one), "row 0, column 0"),
        (hdr(4, 2, "", &[[1, 1, 1, 200], one[0]]), "run length"),
        (hdr(4, 2, "", &[one[0], [1, 1, 1, 200]]), "scanline"),
        (hdr(4, 2, "", &[&one[..1], &[[1, 1, 1, 0]; 9]].concat()), "five run lengths"),
        (with(hdr(4, 2, "", &one), "\n\n", "\r\n\r\n"), "no empty line"),
        (with(hdr(4, 2, "", &one), "-Y 2 +X 4", "+Y 2 +X 4"), "Orientation +Y +X"),
        (with(hdr(4, 2, "", &one), "-Y 2 +X 4", "-Y 2 +X -4"), "width"),
        // A row of 257 takes at least a texel and two run markers, 12 bytes.
        (hdr(300, 20_000, "", &[one[0]; 20_000]), "no more than the file can hold"),
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
        let bytes = hdr(side, side, "", &vec![[16 * code, 16 * code, 7, 132]; side * side]);
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
    use colour::*;
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
    let grey = write("g.png", png(2, 1, GREY, 16, &[], &[0x80, 0, 0xff, 0xff]));
    assert!((texels(&grey)[0][1] - 0.214_046).abs() < 1e-5);
    assert_eq!(texels(&grey)[1], [1.0; 3]);
    let rgb = write("c.png", png(2, 1, RGB, 8, &[], &[188, 0, 255, 0, 0, 0]));
    assert!((texels(&rgb)[0][0] - 0.502_886).abs() < 1e-5);
    assert_eq!(texels(&rgb)[0][1..], [0.0, 1.0]);
    let palette = write("p.png", png(2, 1, PALETTE, 8, &[], &[1, 0]));
    assert_eq!(texels(&palette), [[1.0; 3], [0.0; 3]]);
    let bits = write("b.png", png(2, 1, PALETTE, 1, &[], &[0x40]));
    assert_eq!(texels(&bits), [[0.0; 3], [1.0; 3]]);
    let exr = |v: f32| write("a.exr", exr(2, 1, &[("Y", FlatSamples::F32(vec![0.5, v]))]));
    assert_eq!(texels(&exr(1.0)), [[0.5; 3], [1.0; 3]]);
    for bad in [1.01, -0.1, f32::NAN] {
        let error = read_albedo(&exr(bad), 1, 2).unwrap_err().to_string();
        one_sentence(&error, "a.exr");
        assert!(error.contains("row 0, column 1"), "{error}");
    }
    one_sentence(&read_albedo(&grey, 2, 1).unwrap_err().to_string(), "g.png");
}

/// Channels by their names, whatever their order; two planes of an array; the size and the range of each texel.
#[test]
fn specular_maps_have_two_planes() {
    use ridgelight::scene::{PhongSpecular, Specular};
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let channel = |v: [f32; 2]| FlatSamples::F32(v.to_vec());
    let write = |name: &str, scale: f32| {
        let channels =
            [("B", channel([7.0; 2])), ("G", channel([0.25, scale])), ("R", channel([0.0, 1e4]))];
        std::fs::write(path(name), exr(2, 1, &channels)).unwrap();
    };
    write("a.exr", 1.0);
    write_npy_f32(&path("a.npy"), &[2, 1, 2], [&[0.0, 1e4, 0.25, 1.0][..]]).unwrap();
    let phong = |exponent, scale| PhongSpecular { exponent, scale };
    let want = Specular::Map(vec![phong(0.0, 0.25), phong(1e4, 1.0)]);
    for name in ["a.exr", "a.npy"] {
        assert_eq!(read_specular(&path(name), 1, 2).unwrap(), want, "{name}");
    }
    write_npy_f32(&path("three.npy"), &[3, 1, 2], [&[0.0; 6][..]]).unwrap();
    write("b.exr", f32::NAN);
    for (name, size, says) in [
        ("a.npy", [2, 1], "1 × 2, as the heights"),
        ("three.npy", [1, 2], "channels: found 0, 1, 2"),
        ("b.exr", [1, 2], "row 0, column 1: found scale NaN"),
        ("none", [1, 2], "extension: found none"),
    ] {
        let error = read_specular(&path(name), size[0], size[1]).unwrap_err().to_string();
        one_sentence(&error, name);
        assert!(error.contains(says), "{error}");
    }
}

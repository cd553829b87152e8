//! Wrong input files.

use crate::formats::{colour, hdr, npy, png};
use crate::{Folder, refused};

/// Refused as the input of every command that takes a field.
fn refused_by_all(folder: &Folder, files: &[(String, i32, Vec<&str>)]) {
    let commands = ["plan {}", "render {} -o out.exr", "horizon {} -o out.npy --distances far.npy"];
    let owned: Vec<(String, i32, &[&str])> = files
        .iter()
        .flat_map(|(name, status, says)| {
            commands.map(|c| (c.replace("{}", name), *status, says.as_slice()))
        })
        .collect();
    let cases: Vec<_> = owned.iter().map(|(a, s, says)| (a.as_str(), *s, *says)).collect();
    refused(folder, &cases);
}

fn f32s(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

#[test]
fn every_format_empty_cut_short_and_of_another_kind() {
    let folder = Folder::new();
    let mut files = Vec::new();
    for (name, bytes) in crate::formats::height_files() {
        let extension = name.rsplit('.').next().unwrap();
        let mut bad = |kind: &str, bytes: &[u8]| {
            // An .hgt has its coordinates in its name.
            let stem = if extension == "hgt" { "N44W072" } else { "bad" };
            std::fs::create_dir_all(folder.path(kind)).unwrap();
            let name = format!("{kind}/{stem}.{extension}");
            folder.write(&name, bytes);
            files.push(name);
        };
        bad("empty", b"");
        bad("half", &bytes[..bytes.len() / 2]);
        bad("short", &bytes[..bytes.len() - 1]);
        bad("magic", b"GIF89a\x01\x00\x01\x00\x80\x00\x00\xff\xff\xff");
        bad("other", if extension == "png" { b"II*\0\x08\0\0\0" } else { b"\x89PNG\r\n\x1a\n" });
    }
    // The last byte of white space, or of a ZIP's or PNG's trailer, may be missing.
    files.retain(|f| f != "short/bad.asc");
    let files: Vec<_> =
        files.iter().map(|f| (f.clone(), 1, vec![f.as_str(), ": found ", ", expected "])).collect();
    refused_by_all(&folder, &files);
}

#[test]
fn sizes_that_lie_and_heights_that_are_none() {
    let folder = Folder::new();
    let nan = npy("<f4", false, "(2, 3)", &f32s(&[0.0, 1.0, 2.0, 3.0, 4.0, f32::NAN]));
    folder.write("nan.npy", &nan);
    let inf = npy("<f4", false, "(2, 3)", &f32s(&[0.0, f32::NEG_INFINITY, 2.0, 3.0, 4.0, 5.0]));
    folder.write("inf.npy", &inf);
    folder.write("lies.npy", &npy("<f4", false, "(300, 400)", &f32s(&[0.0; 6])));
    folder.write("huge.npy", &npy("<f8", false, "(4294967296, 4294967296)", &f32s(&[0.0; 6])));
    folder.write("cube.npy", &npy("<f4", false, "(1, 2, 3)", &f32s(&[0.0; 6])));
    folder.write("none.npy", &npy("<f4", false, "(0, 3)", &[]));
    folder.write("text.npy", &npy("<U4", false, "(2, 3)", &f32s(&[0.0; 6])));
    folder.write("lies.png", &png(4000, 3, colour::GREY, 8, &[], &[0; 12]));
    folder.write("rgb.png", &png(4, 1, colour::RGB, 8, &[], &[0; 12]));
    folder.write("lies.asc", b"ncols 60000 nrows 60000 cellsize 1 0 0 0");
    folder.write("word.asc", b"ncols 2 nrows 2 cellsize 1 0 0 deep 0");
    folder.write("nan.asc", b"ncols 2 nrows 2 cellsize 1 0 0 nan 0");
    folder.write("more.asc", b"ncols 2 nrows 2 cellsize 1 0 0 0 0 0");
    folder.write("cell.asc", b"ncols 2 nrows 2 cellsize -1 0 0 0 0");
    folder.write("void.asc", b"ncols 2 nrows 2 cellsize 1 nodata_value 0 0 0 0 0");
    folder.write("N44W073.hgt", &[0; 24]);
    let file = |name: &str, status, says: &[&'static str]| {
        let all: Vec<&str> = [&[": found ", ", expected "], says].concat();
        (name.to_owned(), status, all)
    };
    refused_by_all(
        &folder,
        &[
            file("nan.npy", 1, &["nan.npy", "row 1, column 2", "NaN"]),
            file("inf.npy", 1, &["inf.npy", "row 0, column 1", "inf"]),
            file("lies.npy", 1, &["lies.npy", "24 bytes", "480000"]),
            file("huge.npy", 1, &["huge.npy"]),
            file("cube.npy", 1, &["cube.npy", "3 dimensions"]),
            file("none.npy", 1, &["none.npy", "0 rows"]),
            file("text.npy", 1, &["text.npy", "U4"]),
            file("lies.png", 1, &["lies.png"]),
            file("rgb.png", 1, &["rgb.png"]),
            file("lies.asc", 1, &["lies.asc", "header"]),
            file("word.asc", 1, &["word.asc", "row 1, column 0", "deep"]),
            file("nan.asc", 1, &["nan.asc", "row 1, column 0"]),
            file("more.asc", 1, &["more.asc", "after the last row"]),
            file("cell.asc", 1, &["cell.asc", "cellsize"]),
            file("void.asc", 1, &["void.asc", "no-data"]),
            file("N44W073.hgt", 1, &["N44W073.hgt"]),
        ],
    );
}

#[test]
fn what_is_no_file_or_has_no_format() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("folder.png")).unwrap();
    folder.write("a.xyz", b"1 2 3");
    folder.write("plain", b"1 2 3");
    folder.write("a.vrt", b"<VRTDataset/>");
    folder.write("a.img", b"EHFA_HEADER_TAG");
    let missing = |name: &str| (name.to_owned(), 1, vec!["ridgelight: "]);
    refused_by_all(
        &folder,
        &[
            ("folder.png".into(), 1, vec!["folder.png", "a directory"]),
            ("missing.png".into(), 1, vec!["missing.png"]),
            ("no/folder.png".into(), 1, vec!["no/folder.png"]),
            ("a.xyz".into(), 1, vec!["a.xyz", ".xyz", ".npy", "packed as .gz or .zip"]),
            ("plain".into(), 1, vec!["plain", "no extension"]),
            (
                "a.vrt".into(),
                1,
                vec!["the extension .vrt", "`gdal_translate a.vrt out.tif` converts it"],
            ),
            (
                "a.img".into(),
                1,
                vec!["the extension .img", "`gdal_translate a.img out.tif` converts it"],
            ),
            // A file name of two lines still gives one line of error.
            missing("two\nlines.png"),
            missing("two\nlines"),
        ],
    );
    let run = folder.run_without_driver(&["plan", "a.xyz"]);
    assert!(!run.err.contains("gdal_translate"), "{}", run.err);
}

#[test]
fn environments_and_albedos() {
    let folder = Folder::new();
    folder.write("env.hdr", &hdr(8, 4, "", &[[128, 128, 128, 129]; 32]));
    folder.write("cut.hdr", &hdr(8, 4, "", &[[128, 128, 128, 129]; 31]));
    folder.write("oblong.hdr", &hdr(8, 5, "", &[[128, 128, 128, 129]; 40]));
    let mut dark = vec![0.5_f32; 32];
    dark[8 + 3] = -1.0;
    let channel = |v: &[f32]| exr::prelude::FlatSamples::F32(v.to_vec());
    folder.write("dark.exr", &crate::formats::exr(8, 4, &[("Y", channel(&dark))]));
    folder.write("size.png", &png(5, 3, colour::GREY, 8, &[], &[0; 15]));
    let mut shiny = vec![0.5_f32; 12];
    shiny[7] = 1.5;
    folder.write("shiny.exr", &crate::formats::exr(4, 3, &[("Y", channel(&shiny))]));
    folder.write("grey.exr", &crate::formats::exr(4, 3, &[("Y", channel(&shiny))]));
    let channels = [("R", channel(&[9.0; 12])), ("G", channel(&shiny))];
    folder.write("specular.exr", &crate::formats::exr(4, 3, &channels));
    let npy = folder.path("size.npy");
    ridgelight_io::write_npy_f32(&npy, &[2, 1, 2], [&[1.0_f32; 4][..]]).unwrap();
    std::fs::create_dir(folder.path("folder.exr")).unwrap();
    for command in ["plan a.asc", "render a.asc -o out.png"] {
        let cases: Vec<(String, &[&str])> = [
            ("--env missing.hdr", &["missing.hdr"][..]),
            ("--env folder.exr", &["folder.exr", "a directory"]),
            ("--env a.png", &["a.png", "the extension .png"]),
            ("--env cut.hdr", &["cut.hdr", ": found "]),
            ("--env oblong.hdr", &["oblong.hdr", "8 × 5", "width = 2 · height"]),
            ("--env dark.exr", &["dark.exr", "row 1, column 3", "-1"]),
            ("--albedo missing.png", &["missing.png"]),
            ("--albedo size.png", &["size.png", "5 × 3", "4 × 3"]),
            ("--albedo shiny.exr", &["shiny.exr", "row 1, column 3", "1.5"]),
            ("--albedo env.hdr", &["env.hdr", "the extension .hdr"]),
            ("--albedo a.tif", &["a.tif"]),
            ("--specular missing.exr", &["missing.exr"]),
            ("--specular specular.png", &["specular.png", ".png", "exponents above 1"]),
            ("--specular grey.exr", &["grey.exr", "channels: found Y", "R (exponent)"]),
            ("--specular specular.exr", &["specular.exr", "row 1, column 3", "scale 1.5"]),
            ("--specular size.npy", &["size.npy", "2 × 1", "4 × 3"]),
        ]
        .map(|(args, says)| (format!("{command} {args}"), says))
        .into();
        let cases: Vec<_> = cases.iter().map(|(a, says)| (a.as_str(), 1, *says)).collect();
        refused(&folder, &cases);
    }
}

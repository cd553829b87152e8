//! Pairs that cannot be compared.

use super::{run, write};
use crate::formats::{colour, hdr, npy, png};
use crate::{Folder, refused};

const NAN: f32 = f32::NAN;

#[test]
fn files_without_horizons_are_refused() {
    let folder = Folder::new();
    let level = [0.25_f32; 12];
    write(&folder, "a1.npy", &[("", level); 4]);
    // Azimuths of other names are other azimuths.
    write(&folder, "h.exr", &[("azimuth_000.0", level), ("azimuth_090.0", level)]);
    write(&folder, "i.exr", &[("azimuth_000.0", level), ("azimuth_089.0", level)]);
    refused(
        &folder,
        &[
            ("compare h.exr i.exr --horizons", 1, &["h.exr: channels: found azimuth_090.0", "089"]),
            ("compare a1.npy h.exr --horizons", 1, &["a1.npy: number of channels: found 4", "2"]),
        ],
    );
    write(&folder, "rgb.exr", &[("R", level), ("G", level), ("B", level)]);
    write(&folder, "mean.exr", &[("horizon_mean", level)]);
    write(&folder, "far.exr", &[("azimuth_000.0", level), ("azimuth_361", level)]);
    write(&folder, "more.exr", &[("azimuth_000.0", level), ("sky_view", level)]);
    let mut steep = level;
    steep[6] = 1.6;
    write(&folder, "steep.exr", &[("azimuth_000.0", level), ("azimuth_090.0", steep)]);
    write(&folder, "steep.npy", &[("", level), ("", steep)]);
    write(&folder, "level.npy", &[("", level), ("", level)]);
    folder.write("a1.png", &png(4, 3, colour::GREY, 8, &[], &[0; 12]));
    write(&folder, "up.exr", &[("azimuth_000.0", [std::f32::consts::FRAC_PI_2; 12])]);
    assert_eq!(run(&folder, "compare up.exr up.exr --horizons").status, Some(0));
    let named = "expected horizon channels azimuth_000.0";
    let radians = "expected an elevation, -π/2 to π/2 radians";
    refused(
        &folder,
        &[
            ("compare rgb.exr rgb.exr --horizons", 1, &["rgb.exr: channels: found B", named]),
            ("compare mean.exr mean.exr --horizons", 1, &["found horizon_mean", named]),
            ("compare far.exr far.exr --horizons", 1, &["found azimuth_361", named]),
            ("compare h.exr more.exr --horizons", 1, &["more.exr: channels: found sky_view"]),
            (
                "compare h.exr steep.exr --horizons",
                1,
                &["steep.exr: channel azimuth_090.0 at row 1, column 2: found 1.6", radians],
            ),
            ("compare steep.npy level.npy --horizons", 1, &["steep.npy: channel 1 at row 1"]),
            ("compare a1.png a1.png --horizons", 1, &["a1.png: name: found the extension .png"]),
        ],
    );
}

#[test]
fn unlike_files_are_refused() {
    let folder = Folder::new();
    let (one, two) = ([1.0; 12], [2.0; 12]);
    write(&folder, "one.npy", &[("", one)]);
    write(&folder, "two.npy", &[("", two)]);
    write(&folder, "deep.npy", &[("", one), ("", one)]);
    write(&folder, "void.npy", &[("", [NAN; 12])]);
    folder.write("wide.npy", &npy("<f4", false, "(3, 5)", &[0; 60]));
    write(&folder, "rgb.exr", &[("R", one), ("G", one), ("B", one)]);
    write(&folder, "xyz.exr", &[("X", one), ("Y", one), ("Z", one)]);
    folder.write("a.hdr", &hdr(4, 3, "", &[[128, 128, 128, 129]; 11]));
    folder.write("text.npy", b"no array");
    let mut cases: Vec<(String, i32, Vec<&str>)> = [
        ("one.npy wide.npy", 1, &["one.npy: size", "4 × 3", "5 × 3 as in wide.npy"][..]),
        ("one.npy deep.npy", 1, &["one.npy: number of channels: found 1", "2 as in deep.npy"]),
        ("rgb.exr xyz.exr", 1, &["rgb.exr: channels: found B G R", "one of X Y Z as in xyz.exr"]),
        ("one.npy void.npy", 1, &["one.npy: channel 0", "12 mismatched", "as in void.npy"]),
        ("void.npy void.npy --horizons", 1, &["void.npy: horizons", "12 masked"]),
        ("one.npy missing.npy", 1, &["missing.npy"]),
        ("text.npy one.npy", 1, &["text.npy", "first bytes"]),
        ("a.hdr a.hdr", 1, &["a.hdr: image data"]),
        ("a.asc one.npy", 1, &["a.asc", "the extension .asc"]),
        ("old.json new.json", 1, &["old.json: name", "`ridgelight bench --against old.json`"]),
        ("one.npy .", 1, &["a directory"]),
        ("one.npy two.npy --diff d.png", 2, &["--diff: found d.png", ".exr, .tif, .tiff or .npy"]),
        ("one.npy two.npy --diff no/d.exr", 2, &["--diff", "a folder no"]),
        ("one.npy two.npy --diff one.npy", 2, &["--diff: found one.npy", "an input"]),
        ("one.npy two.npy --json d.txt", 2, &["--json: found d.txt", ".json"]),
        ("one.npy two.npy --json two.json --diff ./two.npy", 2, &["--diff", "an input"]),
        ("one.npy two.npy --max-flip 0.1", 2, &["--max-flip: found only 0", "R, G and B, or Y"]),
        ("one.npy two.npy --exposure 2", 2, &["--exposure: found only 0"]),
        ("one.npy two.npy --pixels-per-degree 60", 2, &["--pixels-per-degree: found only 0"]),
        (
            "rgb.exr rgb.exr --pixels-per-degree 0.5",
            2,
            &["--pixels-per-degree: found 0.5", "1 to 1000"],
        ),
        ("rgb.exr rgb.exr --pixels-per-degree nan", 2, &["--pixels-per-degree: found NaN"]),
        ("rgb.exr rgb.exr --exposure 0", 2, &["--exposure: found 0", "above 0"]),
        ("rgb.exr rgb.exr --exposure inf", 2, &["--exposure: found inf"]),
        ("a.png a.png --exposure 2", 2, &["--exposure: found two .png files"]),
        ("one.npy", 2, &["<B>"]),
    ]
    .map(|(args, status, says)| (args.to_owned(), status, says.to_vec()))
    .into();
    for flag in ["--max-rmse", "--max-mean-shift", "--max-p99", "--max-worst", "--max-flip"] {
        for (value, said) in [("-1", "found -1"), ("nan", "found NaN"), ("x", "found x")] {
            cases.push((format!("rgb.exr rgb.exr {flag} {value}"), 2, vec![flag, said]));
        }
        cases.push((format!("rgb.exr rgb.exr {flag} 1 --horizons"), 2, vec![flag, "--horizons"]));
    }
    for flag in ["--max-median-deg", "--max-p999-deg", "--max-worst-deg"] {
        for (value, said) in [("-1", "found -1"), ("nan", "found NaN")] {
            cases.push((format!("one.npy one.npy --horizons {flag} {value}"), 2, vec![flag, said]));
        }
        cases.push((format!("one.npy one.npy {flag} 1"), 2, vec!["--horizons"]));
    }
    let cases: Vec<_> =
        cases.iter().map(|(args, s, says)| (format!("compare {args}"), *s, says)).collect();
    let cases: Vec<_> =
        cases.iter().map(|(a, s, says)| (a.as_str(), *s, says.as_slice())).collect();
    refused(&folder, &cases);
}

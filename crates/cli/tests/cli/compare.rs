//! Comparisons whose figures are derived in comments; each bound is tested from both sides.

mod refused;

use crate::formats::{self, colour, hdr, npy, png};
use crate::{Folder, Run};
use serde_json::{Value, json};

const NAN: f32 = f32::NAN;

pub fn run(folder: &Folder, args: &str) -> Run {
    let run = folder.run_without_driver(&args.split(' ').collect::<Vec<_>>());
    assert_eq!(run.err, "", "{args}");
    run
}

/// Writes channels of 4 × 3, or an array of as many planes.
pub fn write(folder: &Folder, name: &str, channels: &[(&str, [f32; 12])]) {
    if name.ends_with(".npy") {
        let values: Vec<u8> =
            channels.iter().flat_map(|c| c.1).flat_map(|v| v.to_le_bytes()).collect();
        let shape = format!("({}, 3, 4)", channels.len());
        return folder.write(name, &npy("<f4", false, &shape, &values));
    }
    let all: Vec<_> = channels
        .iter()
        .map(|(name, v)| (*name, exr::prelude::FlatSamples::F32(v.to_vec())))
        .collect();
    folder.write(name, &formats::exr(4, 3, &all));
}

/// Figures of a run with --json.
fn figures(folder: &Folder, args: &str) -> Value {
    let run = run(folder, &format!("compare {args} --json figures.json"));
    let json: Value =
        serde_json::from_slice(&std::fs::read(folder.path("figures.json")).unwrap()).unwrap();
    assert_eq!(run.status, Some(i32::from(json["beyond"] == true)), "{args}");
    assert_eq!(run.out.contains("beyond"), json["beyond"] == true, "{args}: {}", run.out);
    json
}

/// Every bound passes at `found` plus a millionth and fails at `found` less a millionth, with the value found in the message;
/// with and without --quiet.
fn bounded(folder: &Folder, files: &str, flag: &str, found: f64, said: &str) {
    let [above, below] = [found * (1.0 + 1e-6), found * (1.0 - 1e-6)];
    let args = format!("compare {files} {flag}");
    let kept = run(folder, &format!("{args} {above}"));
    assert_eq!(kept.status, Some(0), "{args} {above}: {}", kept.out);
    let broken = run(folder, &format!("{args} {below}"));
    assert_eq!(broken.status, Some(1), "{args} {below}: {}", broken.out);
    let last = broken.out.lines().last().unwrap();
    assert!(last.starts_with(&format!("beyond {flag} {below}: ")), "{last}");
    assert!(last.contains(said), "{last} does not say {said:?}");
    let quiet = run(folder, &format!("{args} {below} --quiet"));
    assert_eq!((quiet.status, quiet.out.as_str()), (Some(1), ""), "{args}");
}

fn near(json: &Value, expected: f64) {
    let found = json.as_f64().unwrap();
    assert!((found - expected).abs() <= 1e-6 * expected.abs(), "{found} for {expected}");
}

/// Reference 2 everywhere, void at the last; errors +3 at row 1, column 2 and -1 at the first, 0 at
/// the 9 others of 11. RMSE √(10/11); shift 2/11; |errors| in order 0 (9 times), 1, 3: rank 0.99 · 10 =
/// 9.9 stands at 1 + 0.9 · 2 = 2.8. Relative: half of each.
#[test]
fn channels_have_their_known_errors() {
    let folder = Folder::new();
    let mut b = [2.0; 12];
    b[11] = NAN;
    let mut a = b;
    (a[6], a[0]) = (5.0, 1.0);
    for (name, x, y) in [("npy", "a1.npy", "b1.npy"), ("exr", "a1.exr", "b1.exr")] {
        write(&folder, x, &[("Z", a)]);
        write(&folder, y, &[("Z", b)]);
        let json = figures(&folder, &format!("{x} {y}"));
        let row = &json["rows"][0];
        assert_eq!(row["channel"], if name == "npy" { "0" } else { "Z" });
        near(&row["mean_reference"], 2.0);
        near(&row["rmse"], (10.0_f64 / 11.0).sqrt());
        near(&row["mean_shift"], 2.0 / 11.0);
        near(&row["p99"], 2.8);
        near(&row["worst"], 3.0);
        near(&row["relative_rmse"], (10.0_f64 / 11.0).sqrt() / 2.0);
        near(&row["relative_mean_shift"], 1.0 / 11.0);
        near(&row["relative_p99"], 1.4);
        near(&row["relative_worst"], 1.5);
        for (key, value) in
            [("worst_row", 1), ("worst_col", 2), ("count", 11), ("masked", 1), ("mismatched", 0)]
        {
            assert_eq!(row[key], value, "{key}");
        }
        let files = format!("{x} {y}");
        bounded(&folder, &files, "--max-rmse", (10.0_f64 / 11.0).sqrt() / 2.0, "0.4767");
        bounded(&folder, &files, "--max-mean-shift", 1.0 / 11.0, " has 0.0909");
        bounded(&folder, &files, "--max-p99", 1.4, "of the mean of B");
        bounded(&folder, &files, "--max-worst", 1.5, "1.5 of the mean of B, at row 1, column 2");
        // Too dark counts as too bright does: against each other, -2/11 of a mean of 24/11.
        bounded(&folder, &format!("{y} {x}"), "--max-mean-shift", 1.0 / 12.0, "0.0833");
        let out = run(&folder, &format!("compare {x} {y}")).out;
        for said in ["RMSE 0.953463 (47.673129 % of the mean)", "mean shift 0.181818 (9.090909 %)"]
        {
            assert!(out.contains(said), "{out}");
        }
        for said in
            ["99 % 2.800000 (140.000000 %)", "worst 3.000000 (150.000000 %) at row 1, column 2"]
        {
            assert!(out.contains(said), "{out}");
        }
        assert!(out.ends_with("11 compared, 1 masked, 0 masked in one only\n"), "{out}");
        // A file equals itself within any bound.
        let zero = "--max-rmse 0 --max-mean-shift 0 --max-p99 0 --max-worst 0";
        assert_eq!(run(&folder, &format!("compare {x} {x} {zero}")).status, Some(0));
    }
}

/// sRGB's green against its blue is ꟻLIP 1 by its definition, white against black 0.9674: L* is 100
/// apart, the largest HyAB 203.3; 0.95 + 0.05 (100^0.7/203.3^0.7 - 0.4)/0.6.
#[test]
fn pictures_have_their_known_flip() {
    let folder = Folder::new();
    let (one, none, half) = ([1.0; 12], [0.0; 12], [0.5; 12]);
    write(&folder, "green.exr", &[("R", none), ("G", one), ("B", none)]);
    write(&folder, "blue.exr", &[("R", none), ("G", none), ("B", one)]);
    write(&folder, "white.exr", &[("R", one), ("G", one), ("B", one)]);
    write(&folder, "grey.exr", &[("R", half), ("G", half), ("B", half)]);
    write(&folder, "y1.exr", &[("Y", one)]);
    write(&folder, "y0.exr", &[("Y", none)]);
    folder.write("green.hdr", &hdr(4, 3, "", &[[0, 128, 0, 129]; 12]));
    folder.write("blue.hdr", &hdr(4, 3, "", &[[0, 0, 128, 129]; 12]));
    folder.write("green.png", &png(4, 3, colour::RGB, 8, &[], &[0, 255, 0].repeat(12)));
    folder.write("blue.png", &png(4, 3, colour::RGB, 8, &[], &[0, 0, 255].repeat(12)));
    for files in
        ["green.exr blue.exr", "green.png blue.png", "green.hdr blue.hdr", "green.png blue.hdr"]
    {
        let flip = &figures(&folder, files)["flip"][0];
        near(&flip["mean"], 1.0);
        near(&flip["worst"], 1.0);
        for quartile in flip["weighted_quartiles"].as_array().unwrap() {
            near(quartile, 1.0);
        }
        assert_eq!(
            (&flip["layer"], &flip["count"], &flip["masked"]),
            (&"".into(), &12.into(), &0.into())
        );
        bounded(&folder, files, "--max-flip", 1.0, "FLIP has 1");
    }
    let flip = &figures(&folder, "y1.exr y0.exr")["flip"][0];
    assert!((flip["mean"].as_f64().unwrap() - 0.9674).abs() < 1e-4, "{flip}");
    assert_eq!(run(&folder, "compare grey.exr grey.exr --max-flip 0").status, Some(0));
    // At twice the exposure grey is white, and brighter values clip to white.
    for (args, status) in [
        ("grey.exr white.exr --max-flip 0", 1),
        ("white.exr grey.exr --max-flip 0 --exposure 2", 0),
        ("grey.exr white.exr --max-flip 0 --exposure 1.9", 1),
    ] {
        assert_eq!(run(&folder, &format!("compare {args}")).status, Some(status), "{args}");
    }
    // A .png is shown as it is: code 128 is the same as half its light at twice the exposure.
    let light = ((128.0_f64 / 255.0 + 0.055) / 1.055).powf(2.4) as f32;
    folder.write("code.png", &png(4, 3, colour::GREY, 8, &[], &[128; 12]));
    write(&folder, "light.exr", &[("Y", [light / 2.0; 12])]);
    for files in ["code.png light.exr", "light.exr code.png"] {
        let json = figures(&folder, &format!("{files} --exposure 2 --max-flip 0"));
        assert_eq!((&json["flip"][0]["mean"], &json["exposure"]), (&0.0.into(), &2.0.into()));
        assert_eq!(figures(&folder, &format!("{files} --max-flip 0"))["beyond"], true);
    }
    // A texel is hardly visible at 1000 pixels per degree.
    let mut dot = half;
    dot[5] = 1.0;
    write(&folder, "dot.exr", &[("Y", dot)]);
    write(&folder, "plain.exr", &[("Y", half)]);
    let at = |ppd: &str| {
        figures(&folder, &format!("dot.exr plain.exr{ppd}"))["flip"][0]["worst"].as_f64().unwrap()
    };
    let default = at("");
    let flip = &figures(&folder, "dot.exr plain.exr")["flip"][0];
    let [mean, p99] = ["mean", "p99"].map(|key| flip[key].as_f64().unwrap());
    assert!(mean < 0.9 * p99, "{flip}");
    bounded(&folder, "dot.exr plain.exr", "--max-flip", mean, "FLIP has 0.");
    assert!(at(" --pixels-per-degree 1000") < default && default < at(" --pixels-per-degree 10"));
    assert!((at(" --pixels-per-degree 67.02064") - default).abs() < 1e-6);
}

/// The layer of a sphere light has the name of its metadata; a file of an earlier release has the old one.
#[test]
fn an_old_layer_is_the_new_one() {
    let folder = Folder::new();
    let (one, two) = ([1.0; 12], [2.0; 12]);
    let channels = |layer: &str, of_light| {
        let names = ["R", "G", "B"].map(|c| format!("{layer}.{c}"));
        let all: Vec<_> = names.iter().map(|name| (name.as_str(), of_light)).collect();
        write(&folder, &format!("{layer}.exr"), &[&[("R", one)][..], &all].concat());
    };
    channels("direct.light1", one);
    channels("direct.sphere_light1", two);
    channels("direct.lights", one);
    let of = |files: &str| {
        folder.run_without_driver(&["compare", &format!("{files}.exr"), "direct.sphere_light1.exr"])
    };
    let old = of("direct.light1");
    let warning = "warning: direct.lightN is now direct.sphere_lightN; the old name goes away in the next release\n";
    assert_eq!((old.status, old.err.as_str()), (Some(0), warning));
    assert!(
        !old.out.contains("only in") && old.out.contains("direct.sphere_light1.R: "),
        "{}",
        old.out
    );
    let new = of("direct.sphere_light1");
    assert_eq!((new.status, new.err.as_str()), (Some(0), ""));
    let other = of("direct.lights");
    assert!(
        other.err.is_empty() && other.out.contains("only in direct.lights.exr"),
        "{}",
        other.out
    );
}

/// A layer of one file only is listed and not compared. One that the result lacks fails every bound; an extra one does not. The
/// bound applies to the worst of the others.
#[test]
fn layers_are_compared_by_name() {
    let folder = Folder::new();
    let (one, two) = ([1.0; 12], [2.0; 12]);
    let rgb = |layer: &'static [&'static str; 3], v| layer.iter().map(move |n| (*n, v));
    const MAIN: [&str; 3] = ["R", "G", "B"];
    const SUN: [&str; 3] = ["direct.sun1.R", "direct.sun1.G", "direct.sun1.B"];
    const SKY: [&str; 3] = ["direct.sky.R", "direct.sky.G", "direct.sky.B"];
    let all = |extra: &'static [&'static str; 3], sun: [f32; 12]| -> Vec<_> {
        rgb(&MAIN, one).chain(rgb(&SUN, sun)).chain(rgb(extra, one)).collect()
    };
    write(&folder, "a1.exr", &[all(&SKY, one).as_slice(), &[("sky_view", one)]].concat());
    write(&folder, "b1.exr", &all(&["E.R", "E.G", "E.B"], two));
    // 1 against 2: half of the mean, in three of six channels.
    let json = figures(&folder, "a1.exr b1.exr --max-rmse 0.25");
    assert_eq!(json["only_in_a"].as_array().unwrap().len(), 4);
    assert_eq!(json["only_in_b"], json!(["E.B", "E.G", "E.R"]));
    let names: Vec<_> = json["rows"].as_array().unwrap().iter().map(|r| &r["channel"]).collect();
    assert_eq!(names, ["B", "G", "R", "direct.sun1.B", "direct.sun1.G", "direct.sun1.R"]);
    let excesses = json["excesses"].as_array().unwrap();
    assert_eq!(excesses.len(), 6, "{excesses:?}");
    for (excess, name) in excesses.iter().zip(["E.B", "E.G", "E.R"]) {
        assert_eq!((&excess["bound"], &excess["found"]), (&Value::Null, &Value::Null));
        assert_eq!(excess["of"], name);
    }
    for excess in &excesses[3..] {
        assert_eq!((&excess["bound"], &excess["limit"]), (&"--max-rmse".into(), &0.25.into()));
        assert!(excess["of"].as_str().unwrap().starts_with("direct.sun1."));
        near(&excess["found"], 0.5);
    }
    let layers: Vec<_> = json["flip"].as_array().unwrap().iter().map(|f| &f["layer"]).collect();
    assert_eq!(layers, ["", "direct.sun1"]);
    let out = run(&folder, "compare a1.exr b1.exr").out;
    let only = "not compared, only in a1.exr: direct.sky.B direct.sky.G direct.sky.R sky_view\n\
                not compared, only in b1.exr: E.B E.G E.R\n";
    assert!(out.starts_with(only), "{out}");
    assert!(
        out.contains("\nFLIP: mean 0.000000") && out.contains("\nFLIP of direct.sun1: "),
        "{out}"
    );
    let lost = "beyond any bound: E.B is not in A\nbeyond any bound: E.G is not in A\n";
    assert!(out.contains(lost), "{out}");
    // A missing layer fails without a bound too, where all shared layers agree; an extra one does not.
    write(&folder, "less.exr", &rgb(&MAIN, one).collect::<Vec<_>>());
    write(&folder, "more.exr", &[rgb(&MAIN, one).collect(), vec![("sky_view", one)]].concat());
    let less = run(&folder, "compare less.exr more.exr --max-rmse 1 --quiet");
    assert_eq!((less.status, less.out.as_str()), (Some(1), ""));
    assert_eq!(run(&folder, "compare more.exr less.exr --max-rmse 0").status, Some(0));
}

/// Alpha of 1 everywhere equals no alpha; any other alpha that the result lacks fails.
#[test]
fn an_opaque_alpha_is_none() {
    let folder = Folder::new();
    let (one, mut half) = ([1.0; 12], [1.0; 12]);
    half[7] = 0.5;
    write(&folder, "none.exr", &[("Y", one)]);
    write(&folder, "opaque.exr", &[("Y", one), ("A", one)]);
    write(&folder, "half.exr", &[("Y", one), ("A", half)]);
    assert_eq!(run(&folder, "compare none.exr opaque.exr").status, Some(0));
    let lost = run(&folder, "compare none.exr half.exr");
    assert_eq!(lost.status, Some(1));
    assert!(lost.out.ends_with("beyond any bound: A is not in A\n"), "{}", lost.out);
}

/// A void in both files is masked. A void in one file only is counted and fails, with or without a bound.
#[test]
fn voids_are_masked_and_counted() {
    let folder = Folder::new();
    let grey = |alpha: [u8; 4]| alpha.iter().flat_map(|a| [100, *a]).collect::<Vec<u8>>();
    let write_png = |name: &str, alpha| {
        folder.write(name, &png(4, 1, colour::GREY_ALPHA, 8, &[], &grey(alpha)));
    };
    write_png("full.png", [255; 4]);
    write_png("hole.png", [255, 0, 255, 255]);
    write_png("other.png", [255, 255, 0, 255]);
    folder.write("opaque.png", &png(4, 1, colour::GREY, 8, &[], &[100; 4]));
    let mut holed = [1.0; 12];
    holed[3] = NAN;
    write(&folder, "holed.exr", &[("Y", holed)]);
    write(&folder, "whole.exr", &[("Y", [1.0; 12])]);
    for (files, counts) in [
        ("hole.png hole.png", [3, 1, 0]),
        ("hole.png full.png", [3, 0, 1]),
        ("full.png hole.png", [3, 0, 1]),
        ("hole.png other.png", [2, 0, 2]),
        ("hole.png opaque.png", [3, 0, 1]),
        ("holed.exr holed.exr", [11, 1, 0]),
        ("holed.exr whole.exr", [11, 0, 1]),
    ] {
        let json = figures(&folder, files);
        let row = json["rows"].as_array().unwrap().iter().find(|r| r["channel"] == "Y").unwrap();
        let found = ["count", "masked", "mismatched"].map(|key| row[key].as_i64().unwrap());
        assert_eq!(found, counts, "{files}");
        assert_eq!((&row["rmse"], &json["flip"][0]["mean"]), (&0.0.into(), &0.0.into()), "{files}");
        assert_eq!(json["flip"][0]["count"], counts[0], "{files}");
        assert_eq!(json["beyond"], counts[2] > 0, "{files}");
    }
    let run = run(&folder, "compare holed.exr whole.exr --max-rmse 9 --max-flip 1");
    assert_eq!(run.status, Some(1));
    assert!(run.out.ends_with("beyond any bound: Y has 1 masked in one only\n"), "{}", run.out);
}

/// Files with one map each are compared whatever the names, because other programs use other names. Several maps are paired by name.
#[test]
fn single_maps_are_compared_whatever_their_names() {
    let folder = Folder::new();
    let (level, off) = ([0.25_f32; 12], [0.75_f32; 12]);
    write(&folder, "a.exr", &[("hillshade", level)]);
    write(&folder, "b.exr", &[("band1", off)]);
    let run = folder.run_str("compare a.exr b.exr --json j.json");
    assert_eq!(run.status, Some(0), "{}", run.err);
    let note = "note: the only channel of each file is compared: hillshade with band1";
    assert_eq!(run.err.trim_end(), note);
    let json = crate::needs_vulkan::json(&folder.path("j.json"));
    let row = &json["rows"][0];
    assert_eq!([&row["channel"], &json["only_in_b"]], [&json!("hillshade"), &json!([])]);
    assert_eq!(row["rmse"], json!(0.5));
    // Several planes of an .npy have no names by which to pair them.
    write(&folder, "d.npy", &[("", level); 2]);
    write(&folder, "e.exr", &[("x", level), ("y", level)]);
    let run = folder.run_str("compare d.npy e.exr");
    assert!(run.err.contains("channels: found 0, expected x as in e.exr"), "{}", run.err);
    write(&folder, "c.exr", &[("band1", level), ("band2", off)]);
    let run = folder.run_str("compare a.exr c.exr");
    assert_eq!(run.status, Some(1), "{}", run.out);
    assert!(
        run.err.contains("found hillshade, expected at least one of band1 band2"),
        "{}",
        run.err
    );
}

/// 4 azimuths of 4 × 3: 48 horizons without error, except 1° at azimuth 2, row 1, column 3 and -0.5° at
/// azimuth 0's first. Median 0; rank 0.999 · 47 = 46.953 lies between 0.5° and 1°.
#[test]
fn horizons_are_compared_in_degrees() {
    let folder = Folder::new();
    let level = [0.25_f32; 12];
    let (mut first, mut third) = (level, level);
    first[0] -= 0.5_f32.to_radians();
    third[7] += 1_f32.to_radians();
    write(&folder, "a1.npy", &[("", first), ("", level), ("", third), ("", level)]);
    write(&folder, "b1.npy", &[("", level); 4]);
    let json = figures(&folder, "a1.npy b1.npy --horizons");
    let row = &json["rows"][0];
    // 0.25 and its neighbours are f32: half a step of 2^-26, in degrees 1e-6.
    let close = |key: &str, expected: f64| {
        let found = row[key].as_f64().unwrap();
        assert!((found - expected).abs() < 1e-6, "{key}: {found}");
    };
    close("mean_deg", 1.5 / 48.0);
    close("median_deg", 0.0);
    close("p999_deg", 0.5 + 0.953 * 0.5);
    close("worst_deg", 1.0);
    assert_eq!(row["worst_at"], json!([2, 1, 3]));
    for (flag, found, place) in
        [("--max-p999-deg", 0.9765, ""), ("--max-worst-deg", 1.0, "azimuth 2, row 1, column 3")]
    {
        for (limit, status) in [(found + 1e-5, 0), (found - 1e-5, 1)] {
            let run = run(&folder, &format!("compare a1.npy b1.npy --horizons {flag} {limit}"));
            assert_eq!(run.status, Some(status), "{flag} {limit}: {}", run.out);
            let said = run.out.contains(&format!("beyond {flag} {limit}: horizons has "));
            assert_eq!(said, status == 1, "{}", run.out);
            assert!(run.out.contains(place), "{}", run.out);
        }
    }
    // Three quarters have an error of 2°: so has the median, and the mean is 1.5°.
    let off = level.map(|v| v + 2_f32.to_radians());
    write(&folder, "c1.npy", &[("", off), ("", level), ("", off), ("", off)]);
    for (limit, status) in [("2.00001", 0), ("1.99999", 1)] {
        let args = format!("compare c1.npy b1.npy --horizons --max-median-deg {limit}");
        assert_eq!(run(&folder, &args).status, Some(status), "{limit}");
    }
}

#[test]
fn difference_images_hold_differences_and_flip() {
    let folder = Folder::new();
    let (mut a, b) = ([1.0; 12], [2.0; 12]);
    a[4] = NAN;
    a[5] = f32::INFINITY;
    let mut c = b;
    (c[4], c[5]) = (NAN, f32::INFINITY);
    write(&folder, "a1.exr", &[("R", a), ("G", b), ("B", b), ("sky.Y", a), ("t", b)]);
    write(&folder, "b1.exr", &[("R", c), ("G", b), ("B", b), ("sky.Y", c), ("t", b)]);
    assert_eq!(run(&folder, "compare a1.exr b1.exr --diff d.exr --quiet").status, Some(0));
    let exr = crate::read(&folder.path("d.exr"));
    let plane = |name: &str| &exr.planes[exr.names.iter().position(|n| n == name).unwrap()];
    assert_eq!(
        exr.names,
        [
            "difference.B",
            "difference.G",
            "difference.R",
            "difference.sky.Y",
            "difference.t",
            "flip",
            "flip.sky",
        ]
    );
    assert_eq!(plane("difference.G"), &[0.0; 12]);
    for (i, v) in plane("difference.R").iter().enumerate() {
        assert!(
            if i == 4 { v.is_nan() } else { *v == [-1.0, 0.0][usize::from(i == 5)] },
            "{i}: {v}"
        );
    }
    // Clipped to white in both files, the difference is invisible.
    for name in ["flip", "flip.sky"] {
        assert!(
            plane(name)
                .iter()
                .enumerate()
                .all(|(i, v)| (i == 4) == v.is_nan() && v.max(0.0) == 0.0)
        );
    }
    assert_eq!(
        run(&folder, "compare a1.exr b1.exr --diff e.exr --exposure 0.5 --quiet").status,
        Some(0)
    );
    let shown = crate::read(&folder.path("e.exr"));
    let flip = &shown.planes[shown.names.iter().position(|n| n == "flip").unwrap()];
    assert!(flip[0] > 0.1 && flip[4].is_nan() && flip[5] < flip[0], "{flip:?}");
    let run = run(&folder, "compare a1.exr b1.exr --diff d.npy --quiet");
    assert_eq!(run.status, Some(0));
    let npy = crate::read(&folder.path("d.npy"));
    assert_eq!((npy.planes.len(), npy.planes[2][0], npy.planes[1][0]), (5, -1.0, 0.0));
}

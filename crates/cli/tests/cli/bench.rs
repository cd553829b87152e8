//! `ridgelight bench`: reports and verdicts.

use serde_json::Value;

use crate::formats::hdr;
use crate::{Folder, specular_map};

/// Before the verification.
#[test]
fn gpu_an_unknown_pass_is_reported_first() {
    let folder = Folder::new();
    let run = folder.run(&["bench", "--size", "32", "--passes", "sky_shade,none"]);
    assert_eq!((run.status, run.out.as_str()), (Some(2), ""), "{}", run.err);
    assert!(run.err.contains("--passes: found none, expected"), "{}", run.err);
}

/// The work of the peak rates follows from the memory budget. By default it takes most of a run.
const SMALL: [&str; 2] = ["--memory-budget", "16MiB"];

/// Of later bounces, the second is compared as well.
#[test]
fn gpu_two_bounces_are_verified() {
    let folder = Folder::new();
    let bounces = [
        "bench",
        "--size",
        "32",
        "--albedo",
        "0.5",
        "--runs",
        "1",
        "--passes",
        "light_resolve",
        "--bounces",
    ];
    for (count, expected) in [("1", [1, 0]), ("3", [1, 1])] {
        let run = folder.run(&[&bounces[..], &[count], &SMALL].concat());
        assert_eq!(run.status, Some(0), "{}{}", run.out, run.err);
        let found =
            ["first bounce error", "second bounce error"].map(|of| run.out.matches(of).count());
        assert_eq!(found, expected, "{}", run.out);
    }
}

/// Reports with a billionth of the times make a run SLOWER, with status 1; with a billion times the times FASTER: no load makes up for
/// that.
#[test]
fn gpu_an_earlier_report_gives_verdicts() {
    let folder = Folder::new();
    let base = ["bench", "--size", "32", "--azimuths", "8", "--runs", "10"];
    let base = [&base[..], &["--passes", "sky_shade"], &SMALL].concat();
    let run =
        folder.run(&[&base[..], &["--json", "now.json", "--bencher", "metrics.json"]].concat());
    assert_eq!(run.status, Some(0), "{}", run.err);
    let report: Value =
        serde_json::from_slice(&std::fs::read(folder.path("now.json")).unwrap()).unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(report["argv"][2], "32");
    assert_eq!(report["scene"]["field"], "fractal");
    assert!(report["sweep"]["azimuths"].is_null(), "{}", report["sweep"]);
    assert!(report["peaks"][2]["reads_per_s"].as_f64() > Some(0.0), "{}", report["peaks"]);
    assert!(run.out.contains("Light: --sky 1 (default)."), "{}", run.out);
    let metrics: Value =
        serde_json::from_slice(&std::fs::read(folder.path("metrics.json")).unwrap()).unwrap();
    assert_eq!(metrics.as_object().unwrap().len(), rows.len());
    let twice = [&base[..], &["--against", "now.json,now.json"]].concat();
    let run = folder.run(&twice);
    assert_eq!(run.status, Some(2), "{}{}", run.out, run.err);
    assert!(run.err.contains("--against: found now.json twice"), "{}", run.err);
    for (name, factor, word, status) in [("fast", 1e-9, "SLOWER", 1), ("slow", 1e9, "FASTER", 0)] {
        let mut changed = report.clone();
        for row in changed["rows"].as_array_mut().unwrap() {
            for key in
                ["min_ns", "p10_ns", "median_low_ns", "median_ns", "median_high_ns", "p90_ns"]
            {
                row[key] = (row[key].as_f64().unwrap() * factor).into();
            }
        }
        let file = format!("{name}.json");
        std::fs::write(folder.path(&file), changed.to_string()).unwrap();
        let run =
            folder.run(&[&base[..], &["--against", &file, "--json", "verdicts.json"]].concat());
        assert_eq!(run.status, Some(status), "{}{}", run.out, run.err);
        assert_eq!(run.out.matches(word).count(), rows.len(), "{}", run.out);
        assert_eq!(run.out.matches(" 32x32 ").count(), rows.len(), "{}", run.out);
        assert!(run.out.contains("compared with 1 earlier report of commit "), "{}", run.out);
        let found: Value =
            serde_json::from_slice(&std::fs::read(folder.path("verdicts.json")).unwrap()).unwrap();
        assert_eq!(found["against"]["rows"][0]["verdict"], word);
        let warnings = found["warnings"].to_string();
        assert!(warnings.contains("one earlier report cannot show"), "{warnings}");
        assert!(run.out.contains("one earlier report cannot show"), "{}", run.out);
    }
    // With -q, warnings are all that is printed.
    let run = folder.run(&[&base[..], &["--against", "slow.json", "-q"]].concat());
    assert_eq!((run.status, run.out.as_str()), (Some(0), ""), "{}", run.err);
    assert!(run.err.contains("warning: one earlier report cannot show"), "{}", run.err);
    assert!(run.err.lines().all(|line| line.starts_with("warning: ")), "{}", run.err);
    let other = ["bench", "--size", "48", "--azimuths", "8", "--runs", "1"];
    let run = folder.run(&[&other[..], &SMALL, &["--against", "now.json,slow.json"]].concat());
    assert_eq!(run.status, Some(2), "{}", run.err);
    let expected = "found 32x32 texels with 8 azimuths in now.json, slow.json, expected 48x48 texels with 8 azimuths";
    assert!(run.err.contains(expected), "{}", run.err);
    // Before anything is verified or timed.
    assert_eq!(run.out, "", "{}", run.err);
    let mut gone = report.clone();
    gone["rows"].as_array_mut().unwrap().iter_mut().for_each(|row| row["pass"] = "gone".into());
    std::fs::write(folder.path("gone.json"), gone.to_string()).unwrap();
    let run = folder.run(&[&base[..], &["--against", "gone.json"]].concat());
    assert_eq!(run.status, Some(2), "{}", run.err);
    assert!(run.err.contains("no row of this run in gone.json"), "{}", run.err);
    std::fs::write(folder.path("field.json"), "[]").unwrap();
    let run = folder.run(&[&base[..], &["--against", "field.json"]].concat());
    assert_eq!((run.status, run.out.as_str()), (Some(1), ""), "{}", run.err);
    assert!(
        run.err.contains("field.json") && run.err.contains("a report of bench --json"),
        "{}",
        run.err
    );
}

/// Before a device is opened.
#[test]
fn reports_of_another_scene_and_wrong_lists_are_refused_first() {
    let folder = Folder::new();
    let report = r#"{ "device": "d", "driver": "v", "rows": [],
        "scene": { "field": "fractal", "lights": "0", "surface": "0" } }"#;
    std::fs::write(folder.path("other.json"), report).unwrap();
    let run = folder.run_without_driver(&["bench", "--size", "32", "--against", "other.json"]);
    assert_eq!((run.status, run.out.as_str()), (Some(1), ""), "{}", run.err);
    let expected = "other.json: scene: found another scene, with different lights and surface";
    assert!(run.err.contains(expected), "{}", run.err);
    let words = ["bench", "--sizes", "16", "--azimuth-list", "8,3"];
    let run = folder.run_without_driver(&words);
    assert_eq!((run.status, run.out.as_str()), (Some(2), ""), "{}", run.err);
    assert!(
        run.err.contains("--azimuth-list: found 3, expected a whole number from 4 to 1024"),
        "{}",
        run.err
    );
}

/// The heights of 1024 x 1024 alone take 4 MiB.
#[test]
fn gpu_rows_of_sizes_are_printed_before_a_later_error() {
    let folder = Folder::new();
    let words = "bench --sizes 16,1024 --azimuths 4 --runs 1 --memory-budget 4MiB";
    let run = folder.run_str(words);
    assert_eq!(run.status, Some(1), "{}{}", run.out, run.err);
    assert!(run.err.contains("--memory-budget"), "{}", run.err);
    let rows: Vec<&str> = run.out.lines().filter(|line| line.ends_with(" 1")).collect();
    assert!(rows.len() == 1 && rows[0].trim_start().starts_with("16 "), "{}", run.out);
}

/// A specular map under a sky and an environment is compared with the oracle, each texel by its own exponent.
#[test]
fn gpu_a_specular_map_is_verified() {
    let folder = Folder::new();
    folder.write("specular.npy", &specular_map(32));
    let texels: Vec<[u8; 4]> = (0..32 * 16).map(|i| [128, (i % 90) as u8, 40, 129]).collect();
    folder.write("env.hdr", &hdr(32, 16, "", &texels));
    for light in ["--sky 1", "--env env.hdr"] {
        let run = folder.run_str(&format!(
            "bench --size 32 --azimuths 32 --runs 1 --albedo 0.2 --specular specular.npy {light}"
        ));
        assert_eq!(run.status, Some(0), "{}", run.err);
        let verified = run.out.lines().find(|line| line.starts_with("verified: ")).expect("a line");
        assert!(verified.contains("specular error"), "{verified}");
    }
}

/// Every light of a scene with specular is compared, and so is the diffuse light in the slices that specular needs.
#[test]
fn gpu_specular_of_each_light_is_verified() {
    let folder = Folder::new();
    let lights = "--sky 1 --sun 40,50,2,3 --key 200,50,60,40,5 --sphere-light 16,16,60,8,4";
    let words = format!(
        "bench --size 32 --azimuths 32 --runs 1 --memory-budget 16MiB --albedo 0.5 --specular 20,0.4 {lights}"
    );
    let run = folder.run_str(&words);
    assert_eq!(run.status, Some(0), "{}", run.err);
    let verified = run.out.lines().find(|line| line.starts_with("verified: ")).expect("a line");
    let count = |start: &str| verified.split("; ").filter(|part| part.starts_with(start)).count();
    for (start, expected) in [
        // Of the sky, by the oracle, and of the sun, by its diffuse light.
        ("specular error", 2),
        // By the oracle's horizons, and by the same sweep.
        ("key specular error", 2),
        ("beside specular, sun and key light error", 2),
        ("sphere light specular error", 1),
        ("beside specular, sphere light 1 error", 1),
    ] {
        assert_eq!(count(start), expected, "{start}: {verified}");
    }
}

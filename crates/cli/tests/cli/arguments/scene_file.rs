//! `--scene FILE.json` equals its flags; mistakes are reported by line and key.

use crate::formats::{colour, png};
use crate::{Folder, refused};

const WHOLE: &str = r#"{
  "$schema": "scene.schema.json",
  "field": { "file": "a.asc", "cell_m": [30, 20], "z_scale": 2, "border": "open", "nodata": -9999 },
  "surface": { "albedo": [0.5, 0.25, 0.125] },
  "lights": {
    "sky": 0.5,
    "suns": [
      { "azimuth_deg": 135, "elevation_deg": 30 },
      { "azimuth_deg": -20, "elevation_deg": 5.5, "diameter_deg": 2, "irradiance": [1, 2, 3] }
    ],
    "keys": [{ "azimuth_deg": 180, "elevation_deg": 30, "width_deg": 60, "height_deg": 20, "radiance": 4 }],
    "sphere_lights": [{ "position_m": [10, -5, 1e2], "radius_m": 3, "radiance": 40 }]
  },
  "quality": { "azimuths": 16, "lines": "1/2", "fuse": "aimed", "sun_azimuths": 4 }
}"#;

const FLAGS: &str = "a.asc --cell 30,20 --z-scale 2 --border open --nodata -9999 --albedo 0.5,0.25,0.125 --sky 0.5 \
    --sun 135,30 --sun -20,5.5,2,1,2,3 --key 180,30,60,20,4 --sphere-light 10,-5,1e2,3,40 --azimuths 16 --lines 1/2 \
    --fuse aimed --sun-azimuths 4";

fn planned(folder: &Folder, args: &str) -> String {
    let [out, err] = crate::planned(folder, args);
    assert_eq!(err, "", "{args}");
    out
}

#[test]
fn a_scene_file_is_its_flags() {
    let folder = Folder::new();
    folder.write("scene.json", WHOLE.as_bytes());
    assert_eq!(planned(&folder, "--scene scene.json"), planned(&folder, FLAGS));
    // Flags override the file: one value, all suns, the input.
    assert_eq!(
        planned(&folder, "--scene=scene.json --azimuths 32 --sun 90,45"),
        planned(
            &folder,
            &FLAGS
                .replace("--azimuths 16", "--azimuths 32")
                .replace("--sun 135,30 --sun -20,5.5,2,1,2,3", "--sun 90,45")
        )
    );
    let other = "a.npy --scene scene.json";
    assert_eq!(planned(&folder, other), planned(&folder, &FLAGS.replace("a.asc", "a.npy")));
    // The comparison can fail.
    assert_ne!(planned(&folder, "--scene scene.json"), planned(&folder, "a.asc"));
}

/// Paths are relative to the scene file's folder, whatever the working directory.
#[test]
fn files_are_sought_beside_the_scene_file() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("deep")).unwrap();
    std::fs::copy(folder.path("a.asc"), folder.path("deep/b.asc")).unwrap();
    let albedo = png(4, 3, colour::GREY, 8, &[], &[255; 12]);
    folder.write("deep/white.png", &albedo);
    let text = r#"{"field": {"file": "b.asc"}, "surface": {"albedo": "white.png"}}"#;
    folder.write("deep/scene.json", text.as_bytes());
    assert_eq!(
        planned(&folder, "--scene deep/scene.json"),
        planned(&folder, "deep/b.asc --albedo deep/white.png")
    );
}

/// A camera in a scene file equals its flags.
#[test]
fn gpu_cameras_stand_in_scene_files() {
    let folder = Folder::new();
    let text = r#"{
      "field": { "file": "a.asc" },
      "camera": { "from": { "azimuth_deg": 200, "elevation_deg": 40 }, "look_at_m": [45, 30], "ortho": true,
                  "size": "9x7", "samples": 1, "background": [0.1, 0.2, 0.3] },
      "quality": { "azimuths": 8 }
    }"#;
    folder.write("visible.json", text.as_bytes());
    let render = |out: &str, args: &str| {
        let args: Vec<&str> = ["render", "-o", out].into_iter().chain(args.split(' ')).collect();
        let run = folder.run(&args);
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{args:?}");
    };
    render("a.exr", "--scene visible.json --quiet");
    let flags =
        "--camera 200,40 --look-at 45,30 --ortho --size 9x7 --samples 1 --background 0.1,0.2,0.3";
    render("b.exr", &format!("a.asc {flags} --azimuths 8 --quiet"));
    let read = |name: &str| ridgelight_io::read_planes(&folder.path(name)).unwrap();
    let [a, b] = [read("a.exr"), read("b.exr")];
    assert_eq!((a.cols, a.rows), (9, 7));
    assert_eq!(a, b);
    planned(&folder, "--scene visible.json");
    folder.write("off.json", text.replace("\"ortho\": true", "\"ortho\": 1").as_bytes());
    refused(
        &folder,
        &[("render -o c.exr --scene off.json", 1, &["line 3, camera.ortho", "true or false"])],
    );
}

/// A command ignores keys that it has no flag for, and gives no notes on keys without effect.
#[test]
fn a_command_takes_what_it_knows() {
    let folder = Folder::new();
    folder.write("scene.json", WHOLE.as_bytes());
    // `horizon` has no such flag: a bad value is ignored.
    folder.write("lights.json", WHOLE.replace("\"sky\": 0.5", "\"sky\": -1").as_bytes());
    for name in ["scene.json", "lights.json"] {
        let run = folder.run_without_driver(&["horizon", "--scene", name, "-o", "out.npy"]);
        assert!(run.err.contains("driver"), "{}", run.err);
        assert!(!run.err.contains("changes nothing") && !run.err.contains("sky"), "{}", run.err);
    }
}

#[test]
fn mistakes_are_reported_by_line_and_key() {
    let folder = Folder::new();
    let mut cases: Vec<(String, Vec<String>)> = Vec::new();
    let mut case = |text: String, says: &[&str]| {
        let name = format!("s{}.json", cases.len());
        folder.write(&name, text.as_bytes());
        let says = says.iter().map(|s| (*s).to_owned()).chain([name.clone()]).collect();
        cases.push((format!("plan --scene {name}"), says));
    };
    let with = |from: &str, to: &str| {
        assert!(WHOLE.contains(from), "{from}");
        WHOLE.replacen(from, to, 1)
    };
    case(String::new(), &["line 1", "JSON"]);
    case(with("\"sky\": 0.5,", "\"sky\": 0.5"), &["line 7, column", "JSON"]);
    case("[]".into(), &["line 1", "found []", "an object"]);
    case(with("\"lights\"", "\"light\""), &["line 5, light", "lights, camera, quality"]);
    case(with("\"fuse\"", "\"fuze\""), &["line 14, quality.fuze", "fuse"]);
    case(
        with("\"sky\": 0.5", "\"sky\": \"blue\""),
        &["line 6, lights.sky", "\"blue\"", "3 in a list"],
    );
    case(with("\"sky\": 0.5", "\"sky\": [1, 2]"), &["line 6, lights.sky", "[1, 2]", "3 in a list"]);
    case(with("\"sky\": 0.5", "\"sky\": -1"), &["line 6, lights.sky", "found [-1"]);
    case(
        with("\"elevation_deg\": 5.5", "\"elevation\": 5"),
        &["lights.suns[1].elevation", "elevation_deg"],
    );
    case(with("\"elevation_deg\": 5.5, ", ""), &["line 9, lights.suns[1]", "no elevation_deg"]);
    case(
        with("\"elevation_deg\": 5.5", "\"elevation_deg\": 95"),
        &["line 9, lights.suns[1]", "95"],
    );
    case(
        with("[10, -5, 1e2]", "10"),
        &["line 12, lights.sphere_lights[0].position_m", "3 numbers"],
    );
    case(
        with("\"azimuths\": 16", "\"azimuths\": 3"),
        &["line 14, quality.azimuths", "found 3", "4 to 1024"],
    );
    case(
        with("\"azimuths\": 16", "\"azimuths\": 4.5"),
        &["line 14, quality.azimuths", "found 4.5, expected a whole number"],
    );
    case(
        with("\"lines\": \"1/2\"", "\"lines\": 3"),
        &["line 14, quality.lines", "found 3", "exact"],
    );
    case(with("\"sky\": 0.5", "\"sky\": 1, \"sky\": 0.5"), &["lights.sky", "the same key again"]);
    case(with("\"a.asc\"", "7"), &["line 3, field.file", "a file's name"]);
    case(
        with("\"border\": \"open\"", "\"border\": \"wall\""),
        &["line 3, field.border", "wall", "periodic"],
    );
    for (args, says) in &cases {
        let says: Vec<&str> = says.iter().map(String::as_str).collect();
        refused(&folder, &[(args, 1, &says)]);
    }
    refused(&folder, &[("plan --scene none.json", 1, &["none.json"])]);
}

//! `reference`: path tracing from the command line.

use serde_json::json;

use crate::needs_vulkan::{attributes, done, json, plane, write_field};
use crate::{Folder, read, refused};

#[test]
fn wrong_requests_are_refused() {
    let folder = Folder::new();
    refused(
        &folder,
        &[
            ("reference a.asc -o out.png", 2, &["-o", ".exr"]),
            ("reference a.asc -o out.exr --json out.txt", 2, &["--json", ".json"]),
            ("reference a.asc -o out.exr --spp 0", 2, &["--spp", "1 or more"]),
            ("reference a.asc -o out.exr --spp -1", 2, &["--spp", "whole number"]),
            ("reference a.asc -o out.exr --bounces 65", 2, &["--bounces", "0 to 64"]),
            ("reference a.asc -o out.exr --until-error 0", 2, &["--until-error", "above 0"]),
            ("reference a.asc -o out.exr --until-error nan", 2, &["--until-error", "above 0"]),
            ("reference a.asc -o out.exr --normals round", 2, &["--normals", "smooth, flat"]),
            ("reference a.asc -o out.exr --seed -1", 2, &["--seed", "whole number"]),
            (
                "reference a.asc -o out.exr --sphere-light 1,2,3,4",
                2,
                &["--sphere-light", "RADIANCE"],
            ),
            (
                "reference a.asc -o out.exr --sphere-light 1,2,3,0,1",
                2,
                &["--sphere-light 1: radius"],
            ),
            (
                "reference a.asc -o out.exr --sphere-light 1,2,3,1,-1",
                2,
                &["--sphere-light 1: radiance"],
            ),
            ("reference a.asc -o out.exr --specular 5", 2, &["--specular", "EXPONENT,SCALE"]),
            (
                "reference a.asc -o out.exr --specular 5,0.1",
                2,
                &["--specular scale", "albedo of 1"],
            ),
            ("reference a.asc -o out.exr --specular -1,0", 2, &["--specular exponent"]),
            ("reference a.asc -o out.exr --sun 0,91", 2, &["--sun 1: elevation"]),
            ("reference a.asc -o out.exr --camera 90", 2, &["--camera", "expected south"]),
            ("reference a.asc -o out.exr --camera 0,91", 2, &["--camera: elevation: found 91°"]),
            ("reference a.asc -o out.exr --look-at 1,2", 2, &["--camera"]),
            ("reference a.asc -o out.exr --camera 0,45 --size 0x9", 2, &["--size: found 0 × 9"]),
            ("reference a.asc -o out.exr --camera 0,45 --plinth -1", 2, &["--plinth: found -1"]),
            ("reference a.asc -o out.exr --camera 0,45 --mesh-step 2", 2, &["--mesh-step"]),
            ("reference none.asc -o out.exr", 1, &["none.asc"]),
            ("reference a.asc -o out.exr", 1, &["driver"]),
        ],
    );
}

/// A ridge, so that there is noise.
fn write_ridge(folder: &Folder) {
    write_field(folder, 9, |_, c| 3.0 - (c as f32 - 4.0).abs().min(3.0));
}

#[test]
fn gpu_reference_writes_light_and_its_error() {
    let folder = Folder::new();
    write_ridge(&folder);
    let args =
        "--spp 40 --bounces 1 --seed 7 --albedo 0.5 --specular 9,0.25 --sphere-light 4,4,9,1,2,3,4";
    done(&folder, &format!("reference field.npy -o out.exr --json out.json {args}"));
    let exr = read(&folder.path("out.exr"));
    let names = ["B", "G", "R", "standard_error.B", "standard_error.G", "standard_error.R"];
    assert_eq!(exr.names, names);
    assert!(exr.planes.concat().iter().all(|v| v.is_finite() && *v >= 0.0));
    assert!(plane(&exr, "standard_error.R").iter().any(|v| *v > 0.0));
    // The sphere light replaces the default sky: in its light blue is twice red.
    for (b, r) in plane(&exr, "B").iter().zip(plane(&exr, "R")) {
        assert!((b - 2.0 * r).abs() <= 1e-5 * b, "{b} {r}");
    }
    let (settings, report) = (attributes(&folder.path("out.exr")), json(&folder.path("out.json")));
    for (name, text, value) in [
        ("method", "path tracing", json!("path tracing")),
        // Whole batches of 64, at least two.
        ("spp", "128", json!(128)),
        ("bounces", "1", json!(1)),
        ("seed", "7", json!(7)),
        ("specular", "9,0.25", json!([9, 0.25])),
        ("sphere_light1", "4,4,9,1,2,3,4", json!([4, 4, 9, 1, 2, 3, 4])),
    ] {
        assert_eq!(settings.get(name).map(String::as_str), Some(text), "{name}");
        assert_eq!(report["settings"][name], value, "{name}");
    }
    for name in
        ["device", "commit", "relative_standard_error", "unsampled_standard_error", "device_bytes"]
    {
        assert!(settings.get(name).is_some_and(|v| !v.is_empty()), "{name} in {settings:?}");
    }
    let passes = report["passes"].as_array().unwrap();
    assert!(passes.iter().any(|p| p["pass"] == "path_trace"), "{passes:?}");
    // Without a light the sun and the sky are the default.
    done(&folder, "reference a.asc -o sky.exr --spp 1");
    assert_eq!(attributes(&folder.path("sky.exr"))["sky"], "clear");
}

/// A point sun in the east on level ground, 35 degrees high, and a camera in the west that views the middle texel from the same
/// elevation: that texel mirrors the sun. From straight above all texels are alike. Only specular depends on the camera.
#[test]
fn gpu_reference_views_specular_from_a_camera() {
    const CAMERA: &str = "--camera 270,35,10 --look-at 4,4,2";
    let folder = Folder::new();
    write_field(&folder, 9, |_, _| 2.0);
    let light = |name: &str, flags: &str| {
        let args = format!(
            "reference field.npy -o {name}.exr --spp 1 --sun 90,35,0 --albedo 0.4 --quiet {flags}"
        );
        done(&folder, args.trim_end());
        let path = folder.path(&format!("{name}.exr"));
        (plane(&read(&path), "R").to_vec(), attributes(&path).get("eye_m").cloned())
    };
    let brightest = |light: &[f32]| {
        let texels = light.iter().enumerate();
        texels.max_by(|a, b| a.1.total_cmp(b.1)).map(|(i, v)| (i, *v)).unwrap()
    };
    let (viewed, eye) = light("viewed", &format!("--specular 200,0.5 {CAMERA}"));
    let (above, no_eye) = light("above", "--specular 200,0.5");
    let (dull, dull_eye) = light("dull", CAMERA);
    let (plain, _) = light("plain", "");
    assert_eq!(brightest(&viewed).0, 4 * 9 + 4);
    // cos^200 of the 55 degrees from the sun to the zenith is 0.
    assert!(brightest(&viewed).1 > 2.0 * brightest(&above).1);
    assert_eq!(dull, plain);
    assert_eq!((no_eye, dull_eye), (None, None));
    let eye: Vec<f64> = eye.unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    let (sin, cos) = 35_f64.to_radians().sin_cos();
    for (got, want) in eye.iter().zip([4.0 - 10.0 * cos, 4.0, 2.0 + 10.0 * sin]) {
        assert!((got - want).abs() < 1e-9, "{eye:?}");
    }
    let run = folder.run_str("reference field.npy -o noted.exr --spp 1 --sun 90,35 --camera");
    let said = "note: --camera changes nothing without --specular\n";
    assert!(run.status == Some(0) && run.err.contains(said), "{}", run.err);
    // The camera of a scene file is that of the flags. Such a file gives no notes on keys without effect.
    let scene = r#"{ "camera": { "from": { "azimuth_deg": 270, "elevation_deg": 35, "distance_m": 10 }, "look_at_m": [4, 4, 2] } }"#;
    folder.write("scene.json", scene.as_bytes());
    assert_eq!(light("of_file", "--specular 200,0.5 --scene scene.json").0, viewed);
    let run =
        folder.run_str("reference field.npy -o quiet.exr --spp 1 --sun 90,35 --scene scene.json");
    assert!(run.status == Some(0) && !run.err.contains("changes nothing"), "{}", run.err);
    // The default sun stands before the camera, as in `render`.
    let camera = "--camera 0,30 --size 9x7 --quiet";
    done(&folder, &format!("reference field.npy -o a.exr --spp 1 {camera}"));
    done(&folder, &format!("render field.npy -o b.exr --samples 1 {camera}"));
    done(&folder, "reference field.npy -o c.exr --spp 1 --quiet");
    let sun = |name: &str| attributes(&folder.path(name))["sun1"].clone();
    assert_eq!(sun("a.exr"), sun("b.exr"));
    assert_ne!(sun("a.exr"), sun("c.exr"));
}

/// A valley of two slopes: the paths from its bottom meet ground whose mean normals differ from those of its triangles. The
/// flag changes the bounced light alone, and the file names it.
#[test]
fn gpu_normals_are_smooth_unless_flat_ones_are_asked_for() {
    let folder = Folder::new();
    write_field(&folder, 9, |_, c| 2.0 * (c as f32 - 4.0).abs());
    let light = |name: &str, flags: &str| {
        done(&folder, &format!("reference field.npy -o {name}.exr --sky 1 --spp 128 {flags}"));
        let normals = attributes(&folder.path(&format!("{name}.exr")))["normals"].clone();
        (normals, plane(&read(&folder.path(&format!("{name}.exr"))), "R").to_vec())
    };
    let usual = light("usual", "--bounces 1");
    let [smooth, flat] =
        ["smooth", "flat"].map(|n| light(n, &format!("--bounces 1 --normals {n}")));
    assert_eq!([&usual.0, &smooth.0, &flat.0], ["smooth", "smooth", "flat"]);
    assert_eq!(usual.1, smooth.1);
    assert_ne!(smooth.1, flat.1);
    let [smooth, flat] =
        ["smooth", "flat"].map(|n| light(n, &format!("--bounces 0 --normals {n}")));
    assert_eq!(smooth.1, flat.1);
}

#[test]
fn gpu_reference_stops_at_an_error() {
    let folder = Folder::new();
    write_ridge(&folder);
    done(&folder, "reference field.npy -o out.exr --spp 1000000 --until-error 0.01 --quiet");
    let settings = attributes(&folder.path("out.exr"));
    let [spp, error] = ["spp", "relative_standard_error"].map(|n| settings[n].parse::<f64>());
    let (spp, error) = (spp.unwrap(), error.unwrap());
    assert!((512.0..1e5).contains(&spp) && error < 0.01, "{spp} {error}");
}

/// Under a sky of 1, every path on level ground gives 1: no noise. After 128 paths the bound on unsampled light is √3/128,
/// 1.353 %, above the requested 0.5 %; after 512 paths it is below.
#[test]
fn gpu_unsampled_light_counts_as_error() {
    let folder = Folder::new();
    write_field(&folder, 5, |_, _| 7.0);
    let args = "reference field.npy --cell 1 --sky 1 -o out.exr --until-error 0.005 --spp";
    let of = |spp: &str| folder.run_str(&format!("{args} {spp}"));
    let error = || -> f64 {
        attributes(&folder.path("out.exr"))["relative_standard_error"].parse().unwrap()
    };
    let run = of("128");
    assert_eq!((run.status, run.err.as_str()), (Some(1), ""));
    assert!(run.out.contains("128 paths per texel, error 1.353 %"), "{}", run.out);
    let said =
        "--spp 128 ended the tracing after 128 paths, before --until-error 0.005 was reached\n";
    assert!(run.out.ends_with(said), "{}", run.out);
    assert!((error() - 3_f64.sqrt() / 128.0).abs() < 1e-5, "{}", error());
    let run = of("4096");
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    assert!(run.out.contains("512 paths per texel, error 0.338 %"), "{}", run.out);
    assert_eq!(run.out.lines().count(), 1, "{}", run.out);
    let run = of("64");
    let said = "--spp 64 ended the tracing after 128 paths (whole batches of 64, at least 128), before --until-error 0.005 was reached\n";
    assert!(run.status == Some(1) && run.out.ends_with(said), "{}", run.out);
    let of_spp = of("129").out;
    assert!(of_spp.contains("--spp 129 ended the tracing after 192 paths (whole"), "{of_spp}");
    let quiet = of("128 --quiet");
    assert_eq!((quiet.status, quiet.out.as_str()), (Some(1), ""));
}

#[test]
fn gpu_voids_have_no_light() {
    let folder = Folder::new();
    folder.write("v.asc", b"ncols 4 nrows 3 cellsize 1 nodata_value -9 0 0 0 0 0 5 -9 0 0 0 0 0");
    done(&folder, "reference v.asc -o v.exr --spp 32 --quiet");
    for plane in read(&folder.path("v.exr")).planes {
        for (i, v) in plane.iter().enumerate() {
            assert_eq!(v.is_nan(), i == 6, "texel {i}: {v}");
        }
    }
}

/// `trade` reads the file and reports its standard error.
#[test]
fn gpu_trade_takes_the_reference() {
    let folder = Folder::new();
    write_ridge(&folder);
    done(&folder, "reference field.npy --sky 1 -o ground_truth.exr --spp 4096 --quiet");
    let args = [
        "trade",
        "field.npy",
        "-o",
        "out",
        "--sky",
        "1",
        "--evaluations",
        "1",
        "--reference",
        "ground_truth.exr",
    ];
    let run = folder.run(&args);
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    let report = json(&folder.path("out/trade.json"));
    let expected_light = read(&folder.path("ground_truth.exr"));
    let colours =
        |layer: &str| ["R", "G", "B"].map(|c| plane(&expected_light, &format!("{layer}{c}")));
    let all = |layer: &str| -> Vec<f64> {
        colours(layer).concat().iter().map(|v| f64::from(*v)).collect()
    };
    let (light, noise) = (all(""), all("standard_error."));
    let count = light.len() as f64;
    let stated = (noise.iter().map(|v| v * v).sum::<f64>() / count).sqrt()
        / (light.iter().sum::<f64>() / count);
    let how = report["ground_truth"]["how"].as_str().unwrap();
    let said = format!(
        "its Monte Carlo noise, {:.3} % of the mean by its layer standard_error",
        100.0 * stated
    );
    assert!(how.contains(&said), "{how} does not say {said}");
}

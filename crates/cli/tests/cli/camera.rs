//! `render --camera`: refusals and output.

use crate::needs_vulkan::{attributes, done, json, plane, write_field};
use crate::{Folder, read, refused};

#[test]
fn cameras_out_of_range_are_refused() {
    let folder = Folder::new();
    folder.write("line.asc", b"ncols 4 nrows 1 cellsize 1 0 1 2 3");
    folder.write("one.asc", b"ncols 1 nrows 1 cellsize 1 5");
    // Each triangle has the north-west and the south-east corner of its cell.
    folder.write("holes.asc", b"ncols 2 nrows 2 cellsize 1 nodata_value -9 -9 1 2 3");
    folder.write("triangle.asc", b"ncols 2 nrows 2 cellsize 1 nodata_value -9 1 -9 2 3");
    let cases = [
        ("--camera 90", &["--camera", "expected south"][..]),
        ("--camera 1,2,3,4", &["--camera", "expected south"]),
        ("--camera x,45", &["--camera: found x,45, expected south", "degrees and metres"]),
        ("--camera nan,45", &["--camera: azimuth: found NaN"]),
        ("--camera 0,91", &["--camera: elevation: found 91°", "-90° to 90°"]),
        ("--camera 0,nan", &["--camera: elevation: found NaN"]),
        ("--camera 0,45,0", &["--camera: distance: found 0", "1e-9 to 1e15"]),
        ("--camera 0,45,-5", &["--camera: distance: found -5"]),
        ("--camera 0,45,0 --ortho", &["--camera: height of the picture: found 0"]),
        ("--camera 0,45 --fov 0", &["--fov: found 0°", "0.06° to 171°"]),
        ("--camera 0,45 --fov 180", &["--fov: found 180°"]),
        ("--camera 0,45 --fov nan", &["--fov: found NaN"]),
        ("--camera 0,45 --fov 40 --ortho", &["--fov", "--ortho"]),
        ("--camera 0,45 --look-at 1", &["--look-at", "expected X,Y"]),
        ("--camera 0,45 --look-at 1,nan", &["--look-at: found [1.0, NaN"]),
        ("--camera 0,45 --size 640", &["--size", "expected WIDTHxHEIGHT"]),
        ("--camera 0,45 --size 0x480", &["--size: found 0 × 480", "1 × 1 or more"]),
        ("--camera 0,45 --size 4x-4", &["--size", "expected WIDTHxHEIGHT"]),
        ("--camera 0,45 --samples 3", &["--samples: found 3", "1, 2, 4 or 8"]),
        ("--camera 0,45 --samples 16", &["--samples: found 16"]),
        ("--camera 0,45 --samples two", &["--samples: found two", "1, 2, 4 or 8"]),
        ("--camera 0,45 --mesh-step 0", &["--mesh-step: found 0", "1 to 1024"]),
        ("--camera 0,45 --background -1", &["--background: found [-1.0", "0 or more"]),
        ("--camera 0,45 --plinth -1", &["--plinth: found -1", "0 to 1"]),
        ("--camera 0,45 --plinth nan", &["--plinth: found NaN"]),
        ("--camera 0,45 --layers lights", &["--layers: found layers of the map with --camera"]),
        ("--layers depth", &["--layers: found depth without --camera"]),
        ("--look-at 1,2", &["--camera"]),
        ("--fov 30", &["--camera"]),
        ("--ortho", &["--camera"]),
        ("--size 640x480", &["--camera"]),
        ("--samples 4", &["--camera"]),
        ("--mesh-step 2", &["--camera"]),
        ("--background 1", &["--camera"]),
        ("--plinth 0", &["--camera"]),
    ];
    let all: Vec<(String, &[&str])> = cases
        .iter()
        .map(|(flags, says)| (format!("render a.asc -o out.exr {flags}"), *says))
        .collect();
    let cases: Vec<_> = all.iter().map(|(args, says)| (args.as_str(), 2, *says)).collect();
    refused(&folder, &cases);
    let line = "render line.asc -o out.exr --camera 0,45";
    let layers = "render a.asc -o out.png --camera 0,45 --layers depth";
    refused(
        &folder,
        &[
            (line, 2, &["a field viewed by a camera", "2 × 2 or more"]),
            (layers, 2, &["--layers", ".exr output"]),
            ("plan a.asc --camera 0,45 --samples 3", 2, &["--samples: found 3"]),
            ("plan line.asc --camera 0,45", 2, &["a field viewed by a camera"]),
            (
                "render one.asc -o out.png --camera",
                2,
                &["found 1 × 1 grid points", "2 × 2 or more"],
            ),
            (
                "render holes.asc -o out.png --camera",
                2,
                &["2 × 2 grid points with voids", "a triangle"],
            ),
            ("render triangle.asc -o out.png --camera", 1, &["driver"]),
            ("render a.asc -o out.exr --camera 0,45", 1, &["driver"]),
        ],
    );
}

/// A level field of 16 by 16 under the default sky, 1 and white. From straight above at one pixel per texel, everything inside the
/// edge is white and at one distance, and the file holds the settings used.
#[test]
fn gpu_cameras_write_pictures_and_depth() {
    let folder = Folder::new();
    write_field(&folder, 16, |_, _| 3.0);
    let above = "--camera 180,90,16 --ortho --size 16x16";
    done(
        &folder,
        &format!("render field.npy -o v.exr --sky 1 --json v.json {above} --layers depth"),
    );
    let exr = read(&folder.path("v.exr"));
    assert_eq!(exr.names, ["B", "G", "R", "Z"]);
    let (green, far) = (plane(&exr, "G"), plane(&exr, "Z"));
    let within = |i: &usize| (1..15).contains(&(i % 16)) && (1..15).contains(&(i / 16));
    for i in (0..256).filter(within) {
        assert!((green[i] - 1.0).abs() < 1e-6, "pixel {i}: {}", green[i]);
        // f32: the eye stands twice the half diagonal of 15 by 15 above.
        assert!((far[i] - 15.0 * 2_f32.sqrt()).abs() < 1e-4, "pixel {i}: {}", far[i]);
    }
    let found = attributes(&folder.path("v.exr"));
    let is = |name: &str, value: &str| assert_eq!(found[name], value, "{name}");
    is("lens", "orthographic 16");
    is("picture_size", "16x16");
    is("samples", "4");
    is("look_at", "7.5,7.5,3");
    let passes = json(&folder.path("v.json"))["passes"].clone();
    let names: Vec<_> = passes.as_array().unwrap().iter().map(|p| p["pass"].clone()).collect();
    assert!(
        names.ends_with(&["terrain_draw".into(), "sky_draw".into(), "depth_resolve".into()]),
        "{names:?}"
    );

    // From the side: surface and background, a .png of the requested size, and the height error of a reduced mesh.
    let aside = "--camera 200,20 --size 40x30 --background 0.2 --mesh-step 4 --quiet";
    done(&folder, &format!("render field.npy -o v.png --json v.json --sky 0.5 {aside}"));
    let png = read(&folder.path("v.png"));
    assert_eq!((png.rows, png.cols), (30, 40));
    assert_eq!(json(&folder.path("v.json"))["settings"]["mesh_error_m"], 0);
}

/// A position far from the field is probably in the coordinates of the file. Positions are metres from the field's south-west corner.
#[test]
fn gpu_places_far_from_the_field_get_a_warning() {
    let folder = Folder::new();
    write_field(&folder, 5, |row, col| (row * col) as f32);
    let small = "--azimuths 4 --size 16x9 --samples 1 -o c.png";
    for (words, warns) in [
        ("--camera 180,20 --look-at 300000,4910000", true),
        ("--camera 180,20 --look-at 2,7", false),
        ("--camera south --sphere-light 300000,2,1,1,5", true),
        ("--camera south --sphere-light -2,2,100,1,5", false),
    ] {
        let run = folder.run_str(&format!("render field.npy {words} {small} -q"));
        assert_eq!(run.status, Some(0), "{words}: {}", run.err);
        assert_eq!(run.err.contains("from its south-west corner"), warns, "{words}: {}", run.err);
    }
}

/// Without numbers the camera is that of 180,30, named south, and the picture has 2048 x 1152 pixels.
#[test]
fn gpu_a_camera_without_numbers_stands_in_the_south() {
    let folder = Folder::new();
    // Without symmetry: each direction has a picture of its own.
    write_field(&folder, 16, |row, col| (row * col % 5) as f32 + col as f32 / 4.0);
    let drawn = |camera: &str| {
        done(&folder, &format!("render field.npy {camera} -o v.png --quiet"));
        image::open(folder.path("v.png")).unwrap().to_rgb8()
    };
    assert_eq!(drawn("--camera --samples 1").dimensions(), (2048, 1152));
    let small = |camera: &str| drawn(&format!("--size 64x36 {camera}"));
    for same in ["180,30", "south"] {
        assert!(small("--camera") == small(&format!("--camera {same}")), "{same}");
    }
    for other in ["north", "180,31"] {
        assert!(small("--camera") != small(&format!("--camera {other}")), "{other}");
    }
}

/// A .png has a plinth by default, an .exr only on request, with the depths of the picture without it.
#[test]
fn gpu_plinths_are_in_pictures_of_codes() {
    let folder = Folder::new();
    write_field(&folder, 16, |row, col| (row * col % 5) as f32);
    let drawn = |output: &str, more: &str| {
        let shape = "--size 40x30 --background 0.2 --quiet --sky 1";
        done(&folder, &format!("render field.npy -o {output} --json v.json {shape} {more}"));
        let passes = json(&folder.path("v.json"))["passes"].clone();
        passes.as_array().unwrap().iter().any(|pass| pass["pass"] == "plinth_draw")
    };
    let camera = "--camera 200,20,30";
    assert!(drawn("v.png", camera));
    assert!(!drawn("none.png", &format!("{camera} --plinth 0")));
    assert!(!drawn("below.png", "--camera 200,-20,30"));
    let layers = &format!("{camera} --layers depth");
    assert!(!drawn("default.exr", layers));
    assert!(!drawn("none.exr", &format!("{layers} --plinth 0")));
    assert!(drawn("plinth.exr", &format!("{layers} --plinth 0.1")));
    let [default, none, plinth] =
        ["default", "none", "plinth"].map(|name| read(&folder.path(&format!("{name}.exr"))));
    assert!(plane(&default, "Z") == plane(&none, "Z") && plane(&none, "Z") == plane(&plinth, "Z"));
    assert!(plane(&default, "G") == plane(&none, "G") && plane(&none, "G") != plane(&plinth, "G"));
    let base = attributes(&folder.path("plinth.exr"))["plinth_base_m"].parse::<f64>().unwrap();
    // A tenth of 15 m.
    assert!((base + 1.5).abs() < 1e-6, "{base}");
}

/// Sample counts that the device lacks are refused before rendering; the message lists those it has.
#[test]
fn gpu_samples_are_the_devices() {
    let folder = Folder::new();
    let flags = "render a.asc -o out.exr --camera 0,45 --size 8x8 --quiet --samples";
    for samples in ["1", "2", "4", "8"] {
        let args: Vec<&str> = flags.split(' ').chain([samples]).collect();
        let run = folder.run(&args);
        let is_refused = run.status == Some(2)
            && run.err.starts_with(&format!("ridgelight: --samples: found {samples}, expected 1"));
        // Vulkan requires these of every device.
        let must = ["1", "4"].contains(&samples);
        assert!(run.status == Some(0) || (is_refused && !must), "{samples}: {}", run.err);
    }
}

/// An eye inside the ground has a warning. Not one above it, one beside the field, a view from below, or rays from far away. The
/// eye is 20 m from the point at height 50, 5 degrees higher.
#[test]
fn eyes_below_the_ground_have_a_warning() {
    let folder = Folder::new();
    write_field(&folder, 16, |_, _| 100.0);
    let below = 100.0 - 50.0 - 20.0 * 5_f64.to_radians().sin();
    let warning = format!("warning: --camera: the eye is {below:.2} m below the ground");
    for (camera, warns) in [
        ("--camera 0,5,20 --look-at 75,75,50", true),
        ("--camera 0,5,20 --look-at 75,75,100", false),
        ("--camera 0,5,5000 --look-at 75,75,50", false),
        ("--camera 0,-5,20 --look-at 75,75,50", false),
        ("--camera 0,5,20 --look-at 75,75,50 --ortho", false),
    ] {
        let words = format!("plan field.npy --cell 10 {camera}");
        let run = folder.run_without_driver(&words.split(' ').collect::<Vec<_>>());
        assert_eq!(run.status, Some(0), "{camera}: {}", run.err);
        assert_eq!(run.err.contains(&warning), warns, "{camera}: {}", run.err);
    }
}

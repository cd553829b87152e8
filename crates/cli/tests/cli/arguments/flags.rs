//! Arguments out of their range, of the wrong kind, or in combinations that cannot be.

use crate::formats::{HEIGHTS, colour, hdr, png};
use crate::{Folder, refused};

/// `flag value`, for each command given.
fn each(commands: &[&str], folder: &Folder, flags: &[(&str, i32, &[&str])]) {
    let all: Vec<(String, i32, &[&str])> = commands
        .iter()
        .flat_map(|c| flags.iter().map(move |(f, s, says)| (format!("{c} {f}"), *s, *says)))
        .collect();
    let cases: Vec<_> = all.iter().map(|(a, s, says)| (a.as_str(), *s, *says)).collect();
    refused(folder, &cases);
}

const PLAN: &str = "plan a.asc";
const RENDER: &str = "render a.asc -o out.exr";
const HORIZON: &str = "horizon a.asc -o out.npy";

#[test]
fn quality() {
    let folder = Folder::new();
    each(
        &[PLAN, RENDER, HORIZON],
        &folder,
        &[
            ("--azimuths 3", 2, &["--azimuths: found 3", "4 to 1024"]),
            ("--azimuths 1025", 2, &["--azimuths: found 1025", "4 to 1024"]),
            ("--azimuths -1", 2, &["--azimuths: found -1, expected a whole number from 4 to 1024"]),
            ("--azimuths x", 2, &["--azimuths: found x, expected a whole number"]),
            ("--azimuths 4.5", 2, &["--azimuths: found 4.5, expected a whole number"]),
            ("--azimuths 99999999999", 2, &["--azimuths: found 99999999999", "4 to 1024"]),
            ("--azimuths", 2, &["--azimuths"]),
            ("--azimuths 8 --azimuths 8", 2, &["--azimuths"]),
            ("--sun-azimuths 0", 2, &["--sun-azimuths: found 0", "1 to 256"]),
            ("--sun-azimuths 257", 2, &["--sun-azimuths: found 257"]),
            ("--table-elevations 7", 2, &["--table-elevations: found 7", "8 to 4096"]),
            ("--table-elevations 4097", 2, &["--table-elevations: found 4097"]),
            ("--method pyramid --level-step 17", 2, &["--level-step: found 17", "1 to 16"]),
            ("--method pyramid --level-offset 5", 2, &["--level-offset: found 5", "0 to 4"]),
            ("--levels mips", 2, &["mips", "stack"]),
            ("--sh-order 1", 2, &["--sh-order: found 1", "2 to 6"]),
            ("--sh-order 7", 2, &["--sh-order: found 7"]),
            ("--wedge-side 3", 2, &["--wedge-side: found 3", "4 to 256"]),
            ("--subsample 3", 2, &["'3'", "--subsample", "1, 2, 4"]),
            ("--subsample -5", 2, &["'-5'", "--subsample", "1, 2, 4"]),
            ("--bounces 65", 2, &["--bounces: found 65", "0 to 64"]),
            ("--bounces -1", 2, &["--bounces: found -1, expected a whole number"]),
            ("--bounce-engine magic", 2, &["--bounce-engine", "magic", "brute-force"]),
            ("--bounce-azimuths 3", 2, &["--bounce-azimuths: found 3", "4 to 1024"]),
            ("--bounce-level-step 17", 2, &["--bounce-level-step: found 17", "1 to 16"]),
            ("--bounce-level-offset 5", 2, &["--bounce-level-offset: found 5", "0 to 4"]),
            ("--bounce-cutoff 2", 2, &["--bounce-cutoff: found 2", "0 to 1"]),
            ("--bounce-cutoff nan", 2, &["--bounce-cutoff: found NaN"]),
            ("--bounce-cutoff 1%", 2, &["--bounce-cutoff: found 1%, expected a share from 0 to 1"]),
            ("--method magic", 2, &["--method", "magic", "sweep"]),
            ("--lines 3", 2, &["--lines", "'3'", "exact"]),
            ("--fuse x", 2, &["--fuse"]),
            ("--precision f64", 2, &["--precision", "f32"]),
            ("--hull x", 2, &["--hull"]),
            ("--nosuch", 2, &["--nosuch"]),
        ],
    );
    let distances = "horizon a.asc -o h.npy --distances d.npy --method pyramid";
    let words = ["--distances", "--method pyramid", "sweep or brute-force"];
    refused(&folder, &[(distances, 2, &words)]);
}

#[test]
fn surface() {
    let folder = Folder::new();
    each(
        &[PLAN, RENDER, HORIZON],
        &folder,
        &[
            ("--cell 0", 2, &["--cell: found 0", "1e-12 to 1e12"]),
            ("--cell -1", 2, &["--cell: found -1"]),
            ("--cell nan", 2, &["--cell: found NaN"]),
            ("--cell inf", 2, &["--cell: found inf"]),
            ("--cell 1,0", 2, &["--cell: found 1.0 × 0.0"]),
            ("--cell 1,2,3", 2, &["--cell: found 1,2,3, expected X or X,Y in metres"]),
            ("--cell x", 2, &["--cell: found x, expected X or X,Y"]),
            ("--cell 1,", 2, &["--cell: found 1,, expected X or X,Y"]),
            ("--z-scale nan", 2, &["--z-scale: found NaN"]),
            ("--z-scale inf", 2, &["--z-scale: found inf"]),
            ("--z-scale=-inf", 2, &["--z-scale: found -inf"]),
            ("--z-scale 0", 2, &["--z-scale: found 0"]),
            ("--z-scale x", 2, &["--z-scale: found x, expected a finite number"]),
            ("--z-scale 1e300", 1, &["a.asc", "height at row 0, column 1"]),
            ("--border wall", 2, &["--border", "wall", "periodic"]),
            ("--nodata x", 2, &["--nodata: found x, expected a height, or nan"]),
        ],
    );
    each(
        &[PLAN, RENDER],
        &folder,
        &[
            ("--albedo 2", 2, &["--albedo: found [2.0, 2.0, 2.0]", "0 to 1"]),
            ("--albedo -1", 2, &["--albedo: found [-1.0"]),
            ("--albedo nan", 2, &["--albedo: found [NaN"]),
            ("--albedo 0,0,1.5", 2, &["--albedo: found [0.0, 0.0, 1.5]"]),
            ("--albedo grey", 1, &["grey"]),
        ],
    );
    refused(&folder, &[("horizon a.asc -o out.npy --albedo 0.5", 2, &["--albedo", "unexpected"])]);
    // Everything void: a field of one height with that height as no data.
    folder.write("level.asc", b"ncols 2 nrows 2 cellsize 1 7 7 7 7");
    refused(&folder, &[("plan level.asc --nodata 7", 1, &["level.asc", "no-data"])]);
}

#[test]
fn lights() {
    let folder = Folder::new();
    folder.write("env.hdr", &hdr(8, 4, "", &[[128, 128, 128, 129]; 32]));
    each(
        &[PLAN, RENDER],
        &folder,
        &[
            ("--sky -1", 2, &["--sky: found [-1.0", "0 to 1e36"]),
            ("--sky nan", 2, &["--sky: found [NaN"]),
            ("--sky inf", 2, &["--sky: found [inf"]),
            ("--sky 1e39", 2, &["--sky: found [inf"]),
            ("--sky 1,2", 2, &["--sky: found 1,2, expected clear, or", "one number or R,G,B"]),
            ("--sky 1,2,3,4", 2, &["--sky: found 1,2,3,4", "one number or R,G,B"]),
            ("--sky blue", 2, &["--sky: found blue, expected clear, or a radiance"]),
            ("--sky 0", 2, &["found all of radiance 0"]),
            ("--sun 90", 2, &["--sun", "expected AZ,EL"]),
            ("--sun 1,2,3,4,5", 2, &["--sun", "expected AZ,EL"]),
            ("--sun 1,2,3,4,5,6,7", 2, &["--sun", "expected AZ,EL"]),
            ("--sun x,y", 2, &["--sun: found x,y, expected AZ,EL"]),
            ("--sun 0,-91", 2, &["--sun 1: elevation: found -91°", "expected -90° to 90°"]),
            ("--sun 0,91", 2, &["--sun 1: elevation: found 91°"]),
            ("--sun 0,nan", 2, &["--sun 1: elevation: found NaN", "--sun AZ,EL: compass azimuth"]),
            ("--sun 0,-5 --sun 0,95", 2, &["--sun 2: elevation: found 95°"]),
            ("--sun nan,45", 2, &["--sun 1: azimuth: found NaN"]),
            ("--sun inf,45", 2, &["--sun 1: azimuth: found -inf"]),
            ("--sun 0,45,-1", 2, &["--sun 1: angular diameter: found -1°"]),
            ("--sun 0,45,91", 2, &["--sun 1: angular diameter: found 91°"]),
            ("--sun 0,45,1,-1", 2, &["--sun 1: irradiance"]),
            ("--sun 0,45,1,1,nan,1", 2, &["--sun 1: irradiance"]),
            ("--sun 0,45 --sun 0,91", 2, &["--sun 2: elevation: found 91°"]),
            (
                "--sun 0,45,0 --lines exact",
                2,
                &["--lines exact with --sun", "--method brute-force"],
            ),
            ("--key 90,45,10,10", 2, &["--key", "expected AZ,EL,WIDTH,HEIGHT,RADIANCE"]),
            ("--key 1,2,3,4,5,6", 2, &["--key", "expected AZ,EL,WIDTH,HEIGHT,RADIANCE"]),
            ("--key 1,2,3,x,5", 2, &["--key: found 1,2,3,x,5", "RADIANCE is one number or R,G,B"]),
            ("--key nan,45,10,10,1", 2, &["--key 1: azimuth: found NaN"]),
            ("--key 90,45,0,10,1", 2, &["--key 1: width: found 0°", "up to 360°"]),
            ("--key 90,45,361,10,1", 2, &["--key 1: width: found 361°"]),
            ("--key 90,45,10,0,1", 2, &["--key 1: elevations: found 45° to 45°", "-90° to 90°"]),
            ("--key 90,80,10,40,1", 2, &["--key 1: elevations: found 60° to 100°"]),
            ("--key 90,45,360,90,1,-1,1", 2, &["--key 1: radiance: found [1.0, -1.0, 1.0]"]),
            ("--key 90,45,9,9,1 --key 90,45,-9,9,1", 2, &["--key 2: width: found -9°"]),
            ("--key 90,45,9,9,0", 2, &["found all of radiance 0"]),
            (
                "--key 90,45,9,9,1 --lines exact",
                2,
                &["--lines exact with --key", "--method brute-force"],
            ),
            ("--sphere-light 1,2,3,0,5", 2, &["--sphere-light 1: radius: found 0"]),
            (
                "--sphere-light 1,2,3,1,5 --sphere-light 1,2,3,1,-1",
                2,
                &["--sphere-light 2: radiance"],
            ),
            (
                "--sphere-light -1,2,3,4,5 --sphere-light 0",
                2,
                &["--sphere-light", "X,Y,Z,RADIUS,RADIANCE"],
            ),
            ("--sphere-light 1,2,x,4,5", 2, &["--sphere-light: found 1,2,x,4,5", "X,Y,Z,RADIUS"]),
            (
                "--sphere-light 1,2,3,4,5 --light-cutoff 2",
                2,
                &["--light-cutoff: found 2", "0 to 1"],
            ),
            ("--sphere-light 1,2,3,4,5 --light-cutoff nan", 2, &["--light-cutoff: found NaN"]),
            ("--env env.hdr --env-rotate nan", 2, &["--env-rotate: found nan"]),
            (
                "--env env.hdr --env-rotate x",
                2,
                &["--env-rotate: found x, expected an angle within"],
            ),
            ("--env-rotate 90", 2, &["--env"]),
        ],
    );
}

#[test]
fn everywhere() {
    let folder = Folder::new();
    each(
        &[PLAN, RENDER, HORIZON],
        &folder,
        &[
            ("--memory-budget 0", 1, &["needs ", "0 bytes of --memory-budget"]),
            ("--memory-budget 0.25KiB", 1, &["needs ", "256 bytes of --memory-budget"]),
            ("--memory-budget 5XB", 2, &["--memory-budget", "XB", "MiB"]),
            ("--memory-budget -1", 2, &["--memory-budget: found -1, expected a size"]),
            (
                "--memory-budget lots",
                2,
                &["--memory-budget: found lots, expected a size, as 512MiB"],
            ),
            ("--memory-budget 1.2.3MiB", 2, &["--memory-budget: found 1.2.3MiB"]),
            ("--device nosuch", 1, &["driver"]),
            ("--json out.txt", 2, &["--json: found out.txt", ".json"]),
            ("--json no/out.json", 2, &["--json", "a folder no"]),
            ("--json a.json/out.json", 2, &["--json", "a folder a.json"]),
        ],
    );
}

#[test]
fn specular() {
    let folder = Folder::new();
    each(
        &[PLAN, RENDER],
        &folder,
        &[
            ("--specular 10", 2, &["--specular", "EXPONENT,SCALE"]),
            ("--specular -1,0.5 --albedo 0.5", 2, &["--specular exponent: found -1"]),
            ("--specular 10,0.5", 2, &["--specular scale", "albedo of 1"]),
            (
                "--specular 10,0.5 --albedo 0.5 --sphere-light 1,2,3,1,5 --light-basis sh",
                2,
                &["--specular: found", "under a sphere light", "exact"],
            ),
            (
                "--specular 10,0.5 --albedo 0.5 --bounces 1 --bounce-engine sweep",
                2,
                &["--bounce-engine", "found sweep, expected pyramid"],
            ),
            (
                "--specular 10,0.5 --albedo 0.5 --bounces 1 --bounce-engine pyramid --receiver cosine",
                2,
                &["--receiver", "specular: found cosine, expected plane"],
            ),
            (
                "--specular 10,0.5 --albedo 0.5 --bounces 1 --bounce-engine pyramid --subsample 2",
                2,
                &["--subsample", "found 2"],
            ),
            ("--bounces 1 --bounce-specular half", 2, &["--bounce-specular", "vector-f16"]),
            (
                "--specular 10,0.5 --albedo 0.5 --bounces 1 --bounce-specular scalar --camera 180,30",
                2,
                &["--bounce-specular", "found scalar", "vector-f16", "without a camera"],
            ),
        ],
    );
    let both = "--specular 10,0.5 --albedo 0.5";
    refused(
        &folder,
        &[
            (
                &format!("trade a.asc -o out {both} --bounces 1"),
                2,
                &["--bounces: found 1", "--reference with as many bounces"],
            ),
            (&format!("bench a.asc {both} --bounces 1"), 2, &["--specular with bench --bounces"]),
            (&format!("bench --sizes 64 {both}"), 2, &["--specular with bench --sizes"]),
            ("horizon a.asc -o out.npy --specular 10,0.5", 2, &["--specular"]),
        ],
    );
}

#[test]
fn unknown_and_missing() {
    let folder = Folder::new();
    refused(
        &folder,
        &[
            ("nosuch a.asc", 2, &["nosuch"]),
            ("render", 2, &["<INPUT>", "--output"]),
            ("render a.asc", 2, &["--output"]),
        ],
    );
}

#[test]
fn view() {
    let folder = Folder::new();
    folder.write("script", b"key m\n# what follows is none\njump\n");
    refused(
        &folder,
        &[
            ("view a.asc --exposure 0", 2, &["--exposure: found 0"]),
            ("view a.asc --size 0x5", 2, &["--size", "1 to 16384"]),
            ("view a.asc --size 640", 2, &["--size", "WxH"]),
            ("view a.asc --azimuths 3", 2, &["--azimuths"]),
            ("view none.asc", 1, &["none.asc"]),
            ("view a.asc --script script", 1, &["script: line 3: found jump"]),
            ("view a.asc --json a.asc", 2, &["--json"]),
        ],
    );
}

#[test]
fn outputs() {
    let folder = Folder::new();
    for name in ["folder.exr", "folder.png", "folder.npy", "folder.json"] {
        std::fs::create_dir(folder.path(name)).unwrap();
    }
    let field: Vec<u8> = HEIGHTS.iter().map(|h| *h as u8).collect();
    folder.write("map.png", &png(4, 3, colour::GREY, 8, &[], &field));
    // What stood at the destination before stays.
    for old in ["old.exr", "old.png", "old.npy"] {
        folder.write(old, b"what was here before");
    }
    refused(
        &folder,
        &[
            ("render a.asc -o out.jpg", 2, &["-o: found out.jpg", ".exr, .tif, .tiff or .png"]),
            ("render a.asc -o out", 2, &["-o: found out"]),
            ("render a.asc -o out.npy", 2, &["-o: found out.npy"]),
            (
                "horizon a.asc -o out.jpg",
                2,
                &["-o: found out.jpg", ".npy, .tif, .tiff, .exr or .png"],
            ),
            ("render a.asc -o no/out.exr", 2, &["-o", "a folder no"]),
            ("render a.asc -o folder.exr", 2, &["-o: found the directory folder.exr"]),
            ("render a.asc -o folder.png", 2, &["-o: found the directory folder.png"]),
            ("horizon a.asc -o folder.npy", 2, &["-o: found the directory folder.npy"]),
            ("horizon a.asc -o folder.exr", 2, &["-o: found the directory folder.exr"]),
            ("render a.asc -o out.png --json folder.json", 2, &["--json", "folder.json"]),
            ("horizon a.asc -o out.npy --json folder.json", 2, &["--json", "folder.json"]),
            ("plan a.asc --json folder.json", 2, &["--json", "folder.json"]),
            ("devices --json folder.json", 2, &["--json", "folder.json"]),
            ("devices --json d.txt", 2, &["--json", "d.txt"]),
            ("horizon a.asc -o out.npy --distances far.exr", 2, &["--distances", ".npy"]),
            ("horizon a.asc -o out.npy --distances no/far.npy", 2, &["--distances", "a folder no"]),
            ("horizon a.asc -o out.npy --distances out.npy", 2, &["--distances", "which is -o"]),
            ("horizon a.asc -o out.npy --distances ./out.npy", 2, &["--distances", "which is -o"]),
            (
                "horizon a.asc -o out.npy --distances far.npy --fuse nearest",
                2,
                &["--distances", "--fuse nearest", "aimed"],
            ),
            ("horizon a.asc -o old.npy --distances far.npy --fuse slopes", 2, &["--distances"]),
            ("horizon a.asc -o out.npy --lines exact", 2, &["--lines exact", "--json"]),
            // Brute force has even azimuths: nothing to say beside them.
            ("horizon a.asc -o out.npy --lines exact --method brute-force", 1, &["driver"]),
            ("render a.png -o a.png", 2, &["-o: found a.png", "an input"]),
            ("render a.png -o ./a.png", 2, &["-o", "an input"]),
            ("render a.asc -o map.png --albedo map.png", 2, &["-o: found map.png", "an input"]),
            ("horizon a.npy -o a.npy", 2, &["-o: found a.npy", "an input"]),
            ("render a.asc -o out.png --layers lights", 2, &["--layers", ".png"]),
            ("render a.asc -o out.exr --layers moon", 2, &["--layers", "moon", "sky-view"]),
            ("render a.asc -o out.png --exposure 0", 2, &["--exposure: found 0"]),
            ("render a.asc -o out.png --exposure -1", 2, &["--exposure: found -1"]),
            ("render a.asc -o out.png --exposure nan", 2, &["--exposure: found NaN"]),
            ("render a.asc -o out.exr --exposure 2", 2, &["--exposure", ".exr"]),
            ("render missing.asc -o old.exr", 1, &["missing.asc"]),
            ("render a.asc -o old.png --memory-budget 1", 1, &["--memory-budget"]),
            ("render a.asc -o old.exr", 1, &["driver"]),
        ],
    );
    #[cfg(target_os = "linux")]
    refused(
        &folder,
        &[
            // No file can be made in /proc, not even by root.
            ("render a.asc -o /proc/out.exr", 1, &["/proc/out.exr"]),
            ("horizon a.asc -o /proc/out.npy", 1, &["/proc/out.npy"]),
            ("horizon a.asc -o out.npy --distances /proc/out.npy", 1, &["/proc/out.npy"]),
            ("render a.asc -o out.exr --json /proc/out.json", 1, &["/proc/out.json"]),
            ("compare a.npy a.npy --diff /proc/out.npy", 1, &["/proc/out.npy"]),
            ("plan a.asc --json /proc/out.json", 1, &["/proc/out.json"]),
        ],
    );
}

#[test]
fn sizes_that_no_machine_holds_are_refused() {
    let folder = Folder::new();
    for args in [["bench", "--size", "1000000"], ["bench", "--sizes", "256,0"]] {
        let run = folder.run_without_driver(&args);
        assert_eq!(run.status, Some(2), "{args:?}: {}", run.err);
        assert!(run.err.contains("1 to 32768"), "{args:?}: {}", run.err);
    }
    let whole = "expected a whole number from 1 to 32768";
    refused(
        &folder,
        &[
            ("bench --size -5", 2, &["--size: found -5", whole]),
            ("bench --sizes 256,x", 2, &["--sizes: found x", whole]),
            ("bench --runs 5%", 2, &["--runs: found 5%, expected a whole number"]),
            ("tune --size -5", 2, &["--size: found -5, expected a whole number from 1 to 16384"]),
            ("tune --azimuths=", 2, &["--azimuths: found an empty value", "4 to 1024"]),
        ],
    );
}

/// A camera's azimuth may be negative; other unknown flags and commands without a camera get no such tip.
#[test]
fn a_negative_camera_has_a_tip() {
    let folder = Folder::new();
    let tip = "tip: a value that begins with - needs =: --camera=-10,40";
    for (args, has_tip) in [
        ("render a.asc -o o.png --camera -10,40", true),
        ("render a.asc -o o.png --bogus --camera -10,40", false),
        ("bench --camera -10,40", false),
    ] {
        let run = folder.run_without_driver(&args.split(' ').collect::<Vec<_>>());
        assert_eq!(run.status, Some(2), "{args}");
        assert_eq!(run.err.contains(tip), has_tip, "{args}: {}", run.err);
    }
    let run = folder.run_without_driver(&["info", "a.asc", "--json"]);
    assert!(run.status == Some(0) && run.out.starts_with('{'), "{}", run.out);
}

/// Flags of gdaldem get our flag as a tip, where the command has it.
#[test]
fn flags_of_gdaldem_have_tips() {
    let folder = Folder::new();
    let sun = "tip: write the sun as --sun AZ,EL; gdaldem's -az 315 -alt 45 are --sun 315,45";
    refused(
        &folder,
        &[
            ("hillshade a.asc -o o.tif --az 315", 2, &["'--az'", sun]),
            ("hillshade a.asc -o o.tif --azimuth 315", 2, &[sun]),
            ("hillshade a.asc -o o.tif -az 315 -alt 45", 2, &["'-a'", sun]),
            ("shadow a.asc -o o.tif --alt 45", 2, &[sun]),
            ("render a.asc -o o.tif --altitude=45", 2, &[sun]),
            ("hillshade a.asc -o o.tif -z 2", 2, &["tip: gdaldem's -z is --z-scale"]),
            ("hillshade a.asc -o o.tif -s 111120", 2, &["tip: leave out gdaldem's -s"]),
            (
                "info --json dem.tif",
                2,
                &["<INPUT>", "tip: --json takes a file name: write `info dem.tif --json`"],
            ),
        ],
    );
    for (args, word) in [("svf a.asc -o o.tif --az 3", "--sun"), ("info --json i.json", "tip:")] {
        let run = folder.run_without_driver(&args.split(' ').collect::<Vec<_>>());
        assert_eq!(run.status, Some(2), "{args}");
        assert!(!run.err.contains(word), "{args}: {}", run.err);
    }
}

//! Settings chosen for an error or a time.

use ridgelight::scene::{Albedo, Border, Lights, Scene, Surface};
use ridgelight_cpu::indirect;
use ridgelight_cpu::indirect::Fineness;
use ridgelight_cpu::light::{self, Receiver, Site};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_io::HeightOptions;

use crate::needs_vulkan::{attributes, plane, write_field};
use crate::{Folder, read, refused, succeeded};

/// A share above 1 is likely meant as a percentage.
#[test]
fn an_error_above_the_mean_gets_a_warning() {
    let folder = Folder::new();
    for (error, is_warned) in [("5", true), ("1", false), ("0.01", false)] {
        let words = ["render", "a.asc", "-o", "out.exr", "--max-error", error];
        let run = folder.run_without_driver(&words);
        let said = run.err.contains(&format!("warning: --max-error {error} is 500 %"));
        assert_eq!(said, is_warned, "{error}: {}", run.err);
    }
}

#[test]
fn wrong_goals_are_refused() {
    let folder = Folder::new();
    folder.write("void.asc", b"ncols 2 nrows 1 cellsize 1 nodata_value -9 -9 -9");
    refused(
        &folder,
        &[
            ("render a.asc -o out.exr --max-error 0", 2, &["--max-error: found 0", "above 0"]),
            ("render a.asc -o out.exr --max-error -1", 2, &["--max-error: found -1"]),
            ("render a.asc -o out.exr --max-error nan", 2, &["--max-error: found NaN"]),
            ("render a.asc -o out.exr --max-error some", 2, &["--max-error: found some"]),
            (
                "render a.asc -o out.exr --max-error 1%",
                2,
                &["--max-error: found 1%, expected a number above 0, without %: 0.01 is 1 %"],
            ),
            ("render a.asc -o out.exr --time-budget 0", 2, &["--time-budget: found 0"]),
            ("render a.asc -o out.exr --time-budget inf", 2, &["--time-budget: found inf"]),
            (
                "render a.asc -o out.exr --max-error 1 --time-budget 1",
                2,
                &["--max-error", "cannot be used with", "--time-budget"],
            ),
            (
                "render a.asc -o out.exr --max-error 1 --azimuths 64",
                2,
                &["--max-error", "cannot be used with", "--azimuths"],
            ),
            (
                "render a.asc -o out.exr --time-budget 1 --fuse aimed",
                2,
                &["--time-budget", "cannot be used with", "--fuse"],
            ),
            (
                "render a.asc -o out.exr --max-error 1 --method brute-force",
                2,
                &["--max-error", "cannot be used with", "--method"],
            ),
            (
                "render a.asc -o out.exr --max-error 1 --bounces 2 --bounce-azimuths 8",
                2,
                &["--max-error", "cannot be used with", "--bounce-azimuths"],
            ),
            (
                "render a.asc -o out.exr --max-error 1 --bounces 2 --specular 5,0.1 --albedo 0.5 --sh-order 3",
                2,
                &["--max-error", "cannot be used with", "--sh-order"],
            ),
            ("render a.asc -o out.exr --max-error 1 --bounces 65", 2, &["--bounces", "0 to 64"]),
            ("render a.asc -o out.exr --max-error 1 --seed -1", 2, &["--seed", "whole number"]),
            ("render a.asc -o out.exr --max-error 1 --sky 0", 2, &["--sky", "radiance 0"]),
            ("render void.asc -o out.exr --max-error 1", 1, &["void.asc", "no-data"]),
            ("plan a.asc --max-error 1", 2, &["--max-error"]),
            ("render a.asc -o out.exr --max-error 1", 1, &["driver"]),
        ],
    );
}

/// The second run takes the choice of the first; another goal, or a file that cannot be read, takes none.
#[test]
fn gpu_a_choice_is_kept() {
    let folder = Folder::new();
    write_field(&folder, SIDE / 2, peaks);
    let args = "render field.npy -o out.exr --sky 1 --json out.json --max-error 0.05";
    let kept = || {
        let files = std::fs::read_dir(folder.path("cache/ridgelight/choices"));
        files.map_or(Vec::new(), |all| all.map(|file| file.unwrap().path()).collect())
    };
    let note = "that of an earlier run";
    let uncached = succeeded(&folder, &format!("{args} --no-cache"));
    assert!(!uncached.notes.contains(note) && kept().is_empty(), "{}", uncached.notes);
    let first = succeeded(&folder, args);
    assert!(!first.notes.contains(note) && kept().len() == 1, "{}", first.notes);
    let untimed = || {
        let mut all = settings(&folder);
        all.as_object_mut().unwrap().remove("gpu_ms");
        all
    };
    let (chosen, lit) = (untimed(), std::fs::read(folder.path("out.exr")).unwrap());
    let second = succeeded(&folder, args);
    assert!(second.notes.contains(note), "{}", second.notes);
    let remembered = " settings tried in an earlier run, which made this choice";
    assert!(second.out.contains(remembered) && !first.out.contains(remembered), "{}", second.out);
    assert_eq!(
        without_time(&second.out.replace(remembered, " settings tried")),
        without_time(&first.out)
    );
    assert_eq!(untimed(), chosen);
    assert!(std::fs::read(folder.path("out.exr")).unwrap() == lit, "another picture");
    let other = succeeded(&folder, &args.replace("0.05", "0.04"));
    assert!(!other.notes.contains(note) && kept().len() == 2, "{}", other.notes);
    kept().iter().for_each(|file| std::fs::write(file, "{\"settings\": 3}").unwrap());
    let third = succeeded(&folder, args);
    assert!(!third.notes.contains(note), "{}", third.notes);
    assert!(succeeded(&folder, args).notes.contains(note));
    let idle = folder.run_str("render field.npy -o out.exr --sky 1 --no-cache");
    assert!(idle.err.contains("--no-cache changes nothing"), "{}", idle.err);
}

/// What is printed but the line with the frame's time.
fn without_time(out: &str) -> String {
    out.lines().filter(|line| !line.contains("GPU time")).collect::<Vec<_>>().join("\n")
}

/// Texels per side. Half of that holds one of the two peaks, enough for tests that do not compare light.
const SIDE: usize = 24;

fn peaks(row: usize, col: usize) -> f32 {
    let peak = |y: f32, x: f32, h: f32| (h - (row as f32 - y).hypot(col as f32 - x)).max(0.0);
    peak(7.0, 8.0, 7.0).max(peak(16.0, 15.0, 5.5))
}

fn settings(folder: &Folder) -> serde_json::Value {
    let text = std::fs::read(folder.path("out.json")).unwrap();
    serde_json::from_slice::<serde_json::Value>(&text).unwrap()["settings"].clone()
}

fn number(settings: &serde_json::Value, name: &str) -> f64 {
    settings[name].as_f64().unwrap_or_else(|| panic!("{name} in {settings}"))
}

/// The stated error holds at every third texel against the oracle. Probes cover the whole small field; the library's tests
/// cover choices by few probes.
#[test]
fn gpu_a_max_error_holds() {
    let folder = Folder::new();
    write_field(&folder, SIDE, peaks);
    let most = 0.01;
    let args = "render field.npy -o out.exr --sky 1 --json out.json --max-error 0.01";
    let run = succeeded(&folder, args);
    for said in [
        "expected error",
        "one standard deviation",
        "measured",
        "95 % confidence",
        "probes",
        "--azimuths",
    ] {
        assert!(run.out.contains(said), "{said}: {}", run.out);
    }
    let settings = settings(&folder);
    let [stated, at_most] = ["error_measured", "error_at_most"].map(|name| number(&settings, name));
    assert!(0.0 < stated && stated <= at_most && at_most <= most, "{stated} {at_most}");
    assert!(number(&settings, "error_expected") > 0.0);
    assert!((64.0..=1000.0).contains(&number(&settings, "error_probes")));
    // The picture's header states the same but times, and lists the trials that missed.
    let header = attributes(&folder.path("out.exr"));
    assert!(
        !header["tried"].contains(" ms") && settings["tried"].as_str().unwrap().contains(" ms")
    );
    for (name, value) in settings.as_object().unwrap().iter().filter(|one| one.0 != "gpu_ms") {
        match value.as_f64() {
            // serde_json reads the nearest number or the one beside it.
            Some(number) => {
                let other: f64 = header[name].parse().unwrap();
                assert!((other - number).abs() <= f64::EPSILON * number.abs(), "{name}: {other}");
            }
            None => assert!(header.contains_key(name), "{name}"),
        }
    }
    let tried = settings["tried"].as_str().unwrap();
    assert_eq!(tried.contains("missed"), run.out.contains("chose slower settings"), "{}", run.out);
    let exr = read(&folder.path("out.exr"));
    let field = ridgelight_io::read_heights(
        &folder.path("field.npy"),
        &HeightOptions { cell_m: Some([1.0; 2]), ..HeightOptions::default() },
    )
    .unwrap();
    let oracle = Oracle::new(&field, Border::Plane);
    let (mut squares, mut sum, mut count) = (0.0, 0.0, 0.0_f64);
    for i in (0..SIDE * SIDE).step_by(3) {
        let expected_light = light::sky_of(&oracle, i / SIDE, i % SIDE, 360);
        squares += (f64::from(exr.planes[0][i]) - expected_light).powi(2);
        sum += expected_light;
        count += 1.0;
    }
    let off = (squares / count).sqrt() / (sum / count);
    assert!(off <= most && off > 0.3 * stated, "{off} of {stated}");
}

/// The same with two bounces of albedo 0.7, against the f64 quadrature, which shares nothing with the path tracing that judges.
/// The picture's error is within the goal, up to the quadrature's own error. Without indirect light it is not.
#[test]
fn gpu_a_max_error_holds_with_bounces() {
    let folder = Folder::new();
    write_field(&folder, SIDE, peaks);
    let args = "render field.npy --sky 1 -o out.exr --json out.json --albedo 0.7 --bounces 2 --max-error 0.02";
    let run = succeeded(&folder, args);
    for said in ["--bounces 2", "--bounce-azimuths", "paths each", "at most"] {
        assert!(run.out.contains(said), "{said}: {}", run.out);
    }
    let settings = settings(&folder);
    let [stated, at_most] = ["error_measured", "error_at_most"].map(|name| number(&settings, name));
    assert!(stated <= at_most && at_most <= 0.02, "{stated} {at_most}");
    // Batches of 64, from 8 to 256, as many as stated.
    let paths = number(&settings, "error_paths");
    assert!((512.0..=16384.0).contains(&paths) && paths % 64.0 == 0.0, "{paths}");
    assert!(run.out.contains(&format!("{paths} paths each")), "{paths}: {}", run.out);
    let exr = read(&folder.path("out.exr"));
    let field = ridgelight_io::read_heights(
        &folder.path("field.npy"),
        &HeightOptions { cell_m: Some([1.0; 2]), ..HeightOptions::default() },
    )
    .unwrap();
    let surface = Surface { albedo: Albedo::Constant([0.7; 3]), ..Surface::default() };
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let scene = Scene { field, surface, lights };
    let fineness = Fineness { azimuths: 32, divisions: 1, strips: 1 };
    let expected_light = indirect::ground_truth(&scene, 2, fineness).unwrap();
    let root = |of: &dyn Fn(usize) -> f64| {
        ((0..SIDE * SIDE).map(|i| of(i).powi(2)).sum::<f64>() / (SIDE * SIDE) as f64).sqrt()
    };
    let mean = expected_light.radiance[2].iter().map(|t| t[0]).sum::<f64>() / (SIDE * SIDE) as f64;
    let off =
        |b: usize| root(&|i| f64::from(exr.planes[0][i]) - expected_light.radiance[b][i][0]) / mean;
    let own = root(&|i| expected_light.error[2][i][0]) / mean;
    assert!(own < 0.25 * 0.02, "the quadrature may be {own} off");
    assert!(off(2) <= at_most + own, "{} of {at_most}, {own}", off(2));
    // Without bounces the goal is missed.
    assert!(off(0) > 0.02, "{}", off(0));
}

/// Whether the RMSE of out.exr relative to the mean, against path tracing with these arguments of `render`, is at most `at_most`.
fn is_within(folder: &Folder, args: &str, at_most: f64) -> bool {
    let args = args.replace("render", "reference");
    succeeded(folder, &format!("{args} --spp 16384 -o traced.exr"));
    let path = folder.path("traced.exr");
    let noise: f64 = attributes(&path)["relative_standard_error"].parse().unwrap();
    let (traced, found) = (read(&path), read(&folder.path("out.exr")));
    let traced = plane(&traced, "R");
    let count = traced.len() as f64;
    let mean = traced.iter().map(|light| f64::from(*light)).sum::<f64>() / count;
    let pairs = traced.iter().zip(plane(&found, "R"));
    let squares = pairs.map(|(traced, found)| f64::from(traced - found).powi(2));
    let off = (squares.sum::<f64>() / count).sqrt() / mean;
    // The mean square of errors e with normal noise n of N texels expects e² + n², with a variance of (2 n⁴ + 4 e² n²) / N: the noise
    // also multiplies the errors. At four standard deviations.
    let [e, n] = [at_most, noise].map(|v| v.powi(2));
    let most = e + n + 4.0 * ((2.0 * n * n + 4.0 * e * n) / count).sqrt();
    assert!(noise < 0.01, "{noise}");
    off.powi(2) <= most
}

/// With specular bounces the choice includes engines and SH orders; the error is that of all light, against path tracing. Light between
/// lobes is the largest part of what no bounces would lose.
#[test]
fn gpu_a_max_error_holds_with_specular_bounces() {
    let folder = Folder::new();
    write_field(&folder, SIDE, peaks);
    let scene = "render field.npy --sky 1 --albedo 0.2 --specular 5,0.7 --bounces 2";
    let run = succeeded(&folder, &format!("{scene} -o out.exr --json out.json --max-error 0.02"));
    for said in ["--bounce-engine", "--sh-order", "--subsample 1", "paths each"] {
        assert!(run.out.contains(said), "{said}: {}", run.out);
    }
    let settings = settings(&folder);
    let [stated, at_most] = ["error_measured", "error_at_most"].map(|name| number(&settings, name));
    assert!(stated <= at_most && at_most <= 0.02, "{stated} {at_most}");
    assert!(is_within(&folder, scene, at_most), "{at_most}");
    succeeded(
        &folder,
        &format!("{scene} --quiet -o out.exr").replace("--bounces 2", "--bounces 0"),
    );
    assert!(!is_within(&folder, scene, 0.02));
}

/// The same with specular, against lobes over the oracle's horizons and against path tracing, which shares nothing with them. Its diffuse
/// light alone would miss the goal.
#[test]
fn gpu_a_max_error_holds_with_specular() {
    let folder = Folder::new();
    write_field(&folder, SIDE, peaks);
    let args =
        "render field.npy --sky 1 --albedo 0.5 --specular 20,0.4 --json out.json --max-error 0.01";
    succeeded(&folder, &format!("{args} -o out.exr"));
    let lit = settings(&folder);
    let [stated, at_most] = ["error_measured", "error_at_most"].map(|name| number(&lit, name));
    assert!(0.0 < stated && stated <= at_most && at_most <= 0.01, "{stated} {at_most}");
    let exr = read(&folder.path("out.exr"));
    let field = ridgelight_io::read_heights(
        &folder.path("field.npy"),
        &HeightOptions { cell_m: Some([1.0; 2]), ..HeightOptions::default() },
    )
    .unwrap();
    let oracle = Oracle::new(&field, Border::Plane);
    let light = |i: usize| {
        let place = [i / SIDE, i % SIDE];
        let normal = light::normal(&field, Border::Plane, place[0], place[1]);
        let receivers = [Receiver::diffuse(normal), Receiver::specular_from_above(normal, 20.0)];
        let of = Site::of(&oracle, place, &receivers).sky(360);
        [0.5 * of[0], 0.4 * of[1]]
    };
    let all: Vec<[f64; 2]> = (0..SIDE * SIDE).map(light).collect();
    let mean = all.iter().map(|[diffuse, lobe]| diffuse + lobe).sum::<f64>() / all.len() as f64;
    let off = |lobes: f64| {
        let squares = all.iter().zip(&exr.planes[0]);
        let squares = squares.map(|([d, l], found)| (f64::from(*found) - d - lobes * l).powi(2));
        (squares.sum::<f64>() / all.len() as f64).sqrt() / mean
    };
    // Rounding of f32 pictures, and of the oracle's 720 azimuths against 360.
    assert!((off(1.0) - stated).abs() < 0.1 * stated + 1e-4, "{} of {stated}", off(1.0));
    assert!(off(0.0) > 0.3, "{}", off(0.0));
    let traced = args.replace("--json out.json --max-error 0.01", "--bounces 0");
    assert!(is_within(&folder, &traced, at_most), "{at_most}");

    // From a camera the probes have its view: from above, the highlight would be elsewhere.
    let sun = "--sun 135,30,4,3 --camera 315,30 --size 64x36 -o camera.exr";
    succeeded(&folder, &args.replace("--sky 1", sun));
    let at_most = number(&settings(&folder), "error_at_most");
    assert!(at_most <= 0.01, "{at_most}");
}

#[test]
fn gpu_goals_out_of_reach_are_refused_and_a_budget_is_kept() {
    let folder = Folder::new();
    write_field(&folder, SIDE / 2, peaks);
    let before = folder.contents();
    for (goal, says) in [
        ("--max-error 1e-9", ["--max-error 0.000000001: needs", "an oracle", "half of its rays"]),
        ("--time-budget 1e-6", ["--time-budget 0.000001: needs", "ms a frame", "--azimuths"]),
    ] {
        let args = format!("render field.npy -o out.exr {goal}");
        let run = folder.run_str(&args);
        assert_eq!(run.status, Some(1), "{}", run.err);
        assert!(says.iter().all(|s| run.err.contains(s)), "{}", run.err);
        assert!(folder.contents() == before);
    }
    let args = "render field.npy -o out.exr --json out.json --quiet --time-budget 1e9";
    let run = folder.run_str(args);
    assert_eq!((run.status, run.out.as_str(), run.err.as_str()), (Some(0), "", ""));
    let settings = settings(&folder);
    assert_eq!(number(&settings, "time_budget_ms"), 1e9);
    // Eleven days are enough for the finest settings, on any machine.
    assert!(number(&settings, "azimuths") >= 256.0, "{settings}");
    assert!(number(&settings, "error_at_most") < 0.01, "{settings}");
    // Without --quiet the time that decided is printed beside the goal; the choice is that of the cache.
    let run = folder.run_str(&args.replace("--quiet ", ""));
    let said = run.out.lines().find(|line| line.starts_with("a frame takes ")).expect("a time");
    let ms = said.split(' ').nth(3).and_then(|ms| ms.parse::<f64>().ok()).expect("a number");
    assert!(0.0 < ms && ms <= 1e9, "{said}");
    assert!(said.contains("the goal is at most 1000000000 ms"), "{said}");
}

/// One texel, and one beside a void: all texels are probes.
#[test]
fn gpu_tiny_fields_have_goals_too() {
    let folder = Folder::new();
    folder.write("one.asc", b"ncols 1 nrows 1 cellsize 1 5");
    folder.write("two.asc", b"ncols 3 nrows 1 cellsize 1 nodata_value -9 0 -9 3");
    for (input, probes) in [("one.asc", 1.0), ("two.asc", 2.0)] {
        for goal in ["--max-error 0.01 --seed 3", "--max-error 0.01 --sun 90,30"] {
            let args = format!("render {input} -o out.exr --json out.json {goal}");
            succeeded(&folder, &args);
            let settings = settings(&folder);
            let [measured, at_most] =
                ["error_measured", "error_at_most"].map(|name| number(&settings, name));
            assert!(measured <= at_most && at_most <= 0.01, "{args}: {measured} {at_most}");
            assert_eq!(number(&settings, "error_probes"), probes, "{args}");
            assert_eq!(number(&settings, "seed"), if goal.contains("seed") { 3.0 } else { 0.0 });
        }
    }
}

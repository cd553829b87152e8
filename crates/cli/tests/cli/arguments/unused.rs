//! Flags that change nothing are noted and are no error.

use crate::formats::{hdr, npy};
use crate::needs_vulkan::write_field;
use crate::{Folder, Run};

/// Plans `field` with `flags`, without a driver.
fn plan(folder: &Folder, field: &str, flags: &str) -> Run {
    // The default light has a sun and an environment.
    let is_lit = ["--sun ", "--key", "--env", "--sky"].iter().any(|light| flags.contains(light));
    let sky = if is_lit { "" } else { "--sky 1" };
    let args = format!("plan {field} {sky} {flags}");
    let run = folder.run_without_driver(&args.split_whitespace().collect::<Vec<_>>());
    assert_eq!(run.status, Some(0), "{args}: {}", run.err);
    assert!(run.out.contains("border"), "{args}: {}", run.out);
    run
}

/// A level field with a spike, so that there is an occluder.
fn folder() -> Folder {
    let folder = Folder::new();
    write_field(&folder, 9, |r, c| if (r, c) == (4, 4) { 3.0 } else { 0.0 });
    folder.write("env.hdr", &hdr(8, 4, "", &[[128, 128, 128, 129]; 32]));
    folder
}

#[test]
fn flags_that_change_nothing_are_noted() {
    let folder = folder();
    for (flags, says) in [
        (
            "--method brute-force --hull occluder-list",
            &["--hull occluder-list changes nothing with --method brute-force"][..],
        ),
        (
            "--method brute-force --lines exact",
            &["--lines exact changes nothing with --method brute-force"],
        ),
        (
            "--fuse own --method brute-force --precision packed",
            &[
                "--fuse own changes nothing with --method brute-force",
                "--precision packed changes nothing with --method brute-force",
            ],
        ),
        ("--lines exact --fuse aimed", &["--fuse aimed changes nothing with --lines exact"]),
        ("--precision f16", &["--precision f16 changes nothing with --fuse aimed-around"]),
        ("--table-elevations 64", &["--table-elevations 64 changes nothing without an env"]),
        ("--basis sh", &["--basis sh changes nothing without an environment"]),
        ("--env env.hdr --sh-order 3", &["--sh-order 3 changes nothing without --basis sh"]),
        (
            "--env env.hdr --subsample 2",
            &[
                "--subsample 2 changes nothing without --basis sh or --bounces: tables light each texel",
            ],
        ),
        (
            "--env env.hdr --basis sh --wedge-side 16",
            &["--wedge-side 16 changes nothing without --wedges table"],
        ),
        (
            "--subsample 4 --basis sh --sky 1",
            &["--subsample 4 changes nothing without an env", "--basis sh changes"],
        ),
        (
            "--env env.hdr --basis sh --table-elevations 64",
            &["--table-elevations 64 changes nothing with --basis sh"],
        ),
        ("--sun-azimuths 4", &["--sun-azimuths 4 changes nothing without a sun wider"]),
        ("--sun 90,30,0 --sun-azimuths 4 --sky 1", &["--sun-azimuths 4 changes nothing without"]),
        ("--sun 90,30 --azimuths 16", &["--azimuths 16 changes nothing without a sky"]),
        ("--light-cutoff 0.1", &["--light-cutoff 0.1 changes nothing without a sphere light"]),
        (
            "--sphere-light 4,4,9,1,5 --albedo 0.5 --specular 9,0.5 --light-cutoff 0.1",
            &["--light-cutoff 0.1 changes nothing with --specular"],
        ),
        // Lines 2 apart do not divide 9 cells.
        ("--border periodic --lines 2", &["--lines 2 changes nothing with --border periodic"]),
    ] {
        let run = plan(&folder, "field.npy", flags);
        let lines: Vec<_> = run.err.lines().collect();
        assert_eq!(lines.len(), says.len(), "{flags}: {}", run.err);
        for said in says {
            let line = format!("note: {said}");
            assert!(lines.iter().any(|l| l.starts_with(&line)), "{flags}: {}", run.err);
        }
        let quiet = format!("plan field.npy {flags} --quiet");
        let run = folder.run_without_driver(&quiet.split(' ').collect::<Vec<_>>());
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""), "{quiet}");
    }
    // A level field has no occluder.
    let level: Vec<u8> = [0_f32; 9].iter().flat_map(|v| v.to_le_bytes()).collect();
    folder.write("level.npy", &npy("<f4", false, "(3, 3)", &level));
    let run = plan(&folder, "level.npy", "--hull shared");
    assert_eq!(
        run.err,
        "note: --hull shared changes nothing where nothing rises above anything else\n"
    );
}

/// On steep ground with specular, the default number of azimuths is larger and is printed. `--azimuths` and `--basis sh` keep 32.
#[test]
fn azimuths_for_narrow_lobes_on_steep_ground_are_printed() {
    let folder = Folder::new();
    write_field(&folder, 9, |r, _| if r % 4 < 2 { 4.0 * r as f32 } else { 0.0 });
    let azimuths = |flags: &str| {
        let run = plan(&folder, "field.npy", &format!("--albedo 0.5 {flags}"));
        let (_, after) = run.out.split_once("azimuths ").expect("a number of azimuths");
        let count = after.split(|c: char| !c.is_ascii_digit()).next().map(str::to_owned);
        assert_eq!(run.err, "");
        (count.unwrap_or_default(), run.out.contains("\nAzimuths: --azimuths 128, because "))
    };
    assert_eq!(azimuths("--specular 100,0.4"), ("128".into(), true));
    for flags in ["", "--specular 100,0.4 --azimuths 32", "--specular 100,0.4 --basis sh"] {
        assert_eq!(azimuths(flags), ("32".into(), false), "{flags}");
    }
}

/// The layer `horizon`, and a bake's horizons, keep 32 azimuths beside specular with more.
#[test]
fn gpu_azimuths_of_specular_change_no_horizon() {
    let folder = Folder::new();
    write_field(&folder, 9, |r, _| if r % 4 < 2 { 4.0 * r as f32 } else { 0.0 });
    let horizons = |flags: &str| {
        let args =
            format!("render field.npy --sky 1 --albedo 0.5 --layers horizon{flags} -o horizon.exr");
        let run = folder.run_str(&args);
        assert_eq!(run.status, Some(0), "{}", run.err);
        let image = exr::prelude::read_first_flat_layer_from_file(folder.path("horizon.exr"));
        let channels = image.unwrap().layer_data.channel_data.list;
        let horizon = channels.iter().find(|channel| channel.name.to_string() == "horizon_mean");
        horizon.expect("a layer").sample_data.values_as_f32().collect::<Vec<f32>>()
    };
    let all = ["", " --specular 100,0.4", " --azimuths 128"].map(horizons);
    assert_eq!(all[0], all[1]);
    assert_ne!(all[0], all[2]);
    let args = "bake field.npy --what horizon,scatter --sky 1 --albedo 0.5 --specular 100,0.4 --bounces 1 --directions 4 -o out";
    let run = folder.run_str(args);
    assert_eq!(run.status, Some(0), "{}", run.err);
    let manifest = std::fs::read_to_string(folder.path("out/manifest.json")).unwrap();
    for stated in ["\"azimuths\": 32", "\"direct_azimuths\": 128"] {
        assert!(manifest.contains(stated), "{manifest}");
    }
}

#[test]
fn other_flags_are_not_noted() {
    let folder = folder();
    for flags in [
        "",
        "--method brute-force",
        "--lines exact",
        "--method brute-force --azimuths 8",
        "--lines 2 --fuse slopes --precision f16 --hull shared --azimuths 8",
        "--precision packed --hull occluder-list",
        "--precision f32 --lines 1 --fuse aimed-around --hull auto --method sweep",
        "--sun 90,30 --sun-azimuths 4",
        "--key 90,45,360,90,1 --sun-azimuths 4",
        "--env env.hdr --table-elevations 64 --azimuths 8",
        "--sun 90,30 --env env.hdr --table-elevations 64 --azimuths 8 --sun-azimuths 4",
        "--border periodic --lines 1/2",
        "--env env.hdr --basis sh --sh-order 3 --wedges nlp --receiver cosine --window hann",
        "--env env.hdr --basis sh --subsample 4 --method brute-force",
        "--env env.hdr --basis sh --wedges table --wedge-side 8",
        "--env env.hdr --basis table --table-elevations 64",
    ] {
        assert_eq!(plan(&folder, "field.npy", flags).err, "", "{flags}");
    }
}

#[test]
fn gpu_results_are_those_without_the_flag() {
    let folder = folder();
    let mut all = Vec::new();
    for flags in ["", " --table-elevations 64"] {
        let args = format!("horizon field.npy -o h.npy --azimuths 8{flags}");
        let run = folder.run_str(&args);
        let said = "note: --table-elevations 64 changes nothing without an environment\n";
        let said = if flags.is_empty() { "" } else { said };
        assert_eq!((run.status, run.err.as_str()), (Some(0), said));
        all.push(std::fs::read(folder.path("h.npy")).unwrap());
    }
    assert!(all[0] == all[1]);
    let args = "render field.npy -o s.exr --seed 3";
    let run = folder.run_str(args);
    let said = "note: --seed 3 changes nothing without --max-error or --time-budget\n";
    assert_eq!((run.status, run.err.as_str()), (Some(0), said));
    // The horizon layer needs azimuths all around; a sun alone does not.
    for (flags, notes) in [("", 1), (" --layers horizon", 0), (" --layers sky-view", 0)] {
        let args = format!("render field.npy -o s.exr --sun 90,30 --azimuths 8{flags}");
        let run = folder.run_str(&args);
        assert_eq!((run.status, run.err.lines().count()), (Some(0), notes), "{args}: {}", run.err);
    }
    for (flags, reason) in
        [("a.asc --size 8", "with an INPUT"), ("--size 8 --sizes 4", "with --sizes")]
    {
        // A small budget: little work for the peak rates.
        let args = format!("bench {flags} --runs 1 --memory-budget 16MiB");
        let run = folder.run_str(&args);
        let said = format!("note: --size 8 changes nothing {reason}\n");
        assert_eq!((run.status, run.err), (Some(0), said), "{args}");
    }
}

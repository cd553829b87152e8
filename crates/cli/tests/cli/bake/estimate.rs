//! The time that `bake` expects, and maps that cost what they cost `render`.

use serde_json::Value;

use super::light::{load, write};
use crate::needs_vulkan::{done, json, plane};
use crate::{Folder, read, succeeded};

const KINDS: &str = "horizon,sky-view,ellipse,scatter,light-field,brdf,brdf-factors,btf";

/// Probes of curved ground are a stage of that kind alone, as long for each field.
#[test]
fn gpu_probes_of_curved_ground_are_counted_once() {
    let folder = Folder::new();
    write(&folder, "field.npy", [6, 5], |r, c| ((r * 5 + c * 3) % 7) as f32 * 0.01);
    let words =
        "--what visible-points,curved-ellipse --directions 32 --border periodic --curvature 1e-6";
    let run = folder.run_str(&format!("bake field.npy -o out {words} --format npy --json t.json"));
    assert_eq!(run.status, Some(0), "{}", run.err);
    let report = json(&folder.path("t.json"));
    let stages = report["estimate"]["stages"].as_array().unwrap();
    let found: Vec<_> = stages
        .iter()
        .map(|stage| (stage["stage"].as_str().unwrap(), stage["work"].as_f64().unwrap()))
        .collect();
    let rays = 30.0 * 32.0;
    let probes = ("curved-ellipse: probes of the base surface", 1.0);
    for stage in [("visible-points", rays), ("curved-ellipse", rays), probes] {
        assert!(found.contains(&stage), "{stage:?} of {found:?}");
    }
    assert_eq!(found.len(), 4, "{found:?}");
}

/// Every stage's work is counted before the bake. No value of a time is checked: times are finite, and 0 where nothing ran.
#[test]
fn gpu_an_estimate_comes_first() {
    let folder = Folder::new();
    write(&folder, "field.npy", [6, 5], |r, c| ((r * 5 + c * 3) % 7) as f32 * 0.5);
    let words =
        "--border periodic --azimuths 8 --directions 32 --paths 32 --bounces 2 --angles 3x8";
    let run = succeeded(
        &folder,
        &format!("bake field.npy -o out --what {KINDS} {words} --format npy --json t.json"),
    );
    let note = run.notes.lines().find_map(|line| line.strip_prefix("note: estimate: about "));
    assert!(note.is_some_and(|note| note.ends_with(" MB on disk")), "{}", run.notes);
    let report = json(&folder.path("t.json"));
    let estimate = &report["estimate"];
    let number = |value: &Value| {
        let number = value.as_f64().unwrap_or_else(|| panic!("{value}"));
        assert!(number.is_finite() && number >= 0.0);
        number
    };
    assert!(number(&estimate["seconds"]) > 0.0);
    assert!(number(&report["settings"]["seconds"]) > 0.0);
    // The bound covers the files, of which --format npy packs none.
    let on_disk: u64 = std::fs::read_dir(folder.path("out")).unwrap().map(size).sum();
    let most = number(&estimate["bytes_at_most"]) as u64;
    assert!((on_disk..2 * on_disk + (1 << 17)).contains(&most), "{most} for {on_disk}");

    let stages = estimate["stages"].as_array().unwrap();
    let named: Vec<&str> = stages.iter().map(|stage| stage["stage"].as_str().unwrap()).collect();
    let work = |name: &str| {
        let own = stages.iter().find(|stage| stage["stage"] == name);
        number(&own.unwrap_or_else(|| panic!("{name} in {named:?}"))["work"])
    };
    // 30 texels, each in 8 triangles 8 times finer along both sides: 2 · 8² of them a texel.
    let (texels, triangles, angles, pairs) = (30.0, 30.0 * 128.0, 24.0, 64.0);
    let used = number(&report["settings"]["paths_used"]);
    let traced = number(&report["maps"][5]["scattered"]["paths"]);
    let steps = texels * traced * 2.0;
    let all = [
        ("horizons", texels * 8.0),
        ("sky-view", texels * 8.0),
        ("ellipse", texels * 32.0),
        ("scatter: direct light", texels * 8.0),
        ("scatter: visible points", texels * 32.0),
        ("scatter: scattered light", texels * used * 2.0),
        ("light-field: direct light", texels * 8.0),
        ("light-field: visible points", texels * 32.0),
        ("light-field: scattered light", steps),
        ("light-field: triangle visibility", triangles * angles),
        ("light-field: views", triangles * angles),
        // The table and its pairs, which have two ends.
        ("brdf: triangle visibility", triangles * (angles + 2.0 * pairs)),
        ("brdf: visible points", 2.0 * texels * 32.0),
        ("brdf: lights", angles * (triangles * angles + steps)),
        ("brdf: pairs between the angles", pairs * (triangles + steps)),
        ("brdf-factors: shorter form", angles * angles * 8.0),
        ("btf: triangle visibility", triangles * angles),
        ("btf: visible points", texels * 32.0),
        ("btf: lights", angles * (triangles * angles + steps)),
    ];
    for (name, expected) in all {
        assert_eq!(work(name), expected, "{name}");
    }
    assert_eq!(named.len(), all.len() + 1, "{named:?}");
    for stage in stages {
        let trial = &stage["trial"];
        let [all, part] = [stage, trial].map(|of| number(&of["work"]));
        assert!(0.0 < part && part <= all, "{stage}");
        let [whole, share] = [&stage["estimated_s"], &trial["seconds"]].map(number);
        assert!((whole - share * all / part).abs() <= 1e-9 * whole, "{stage}");
        assert!(number(&stage["seconds"]) > 0.0 && share > 0.0, "{stage}");
    }
    // The trial traced a sixteenth of 32 directions, at least 4, and a quarter of 8 azimuths, at least 4.
    let trial = |name: &str| {
        let own = stages.iter().find(|stage| stage["stage"] == name).unwrap();
        number(&own["trial"]["work"])
    };
    assert_eq!(["horizons", "ellipse"].map(trial), [texels * 4.0, texels * 4.0]);
    // The manifest has no times: two bakes write the same files.
    assert!(json(&folder.path("out/manifest.json"))["estimate"].is_null());
}

fn size(entry: std::io::Result<std::fs::DirEntry>) -> u64 {
    entry.unwrap().metadata().unwrap().len()
}

/// The passes of a sky view are those of `render` under a sky, so its values are the same bit for bit. (An environment has its
/// own azimuths.)
#[test]
fn gpu_a_sky_view_is_that_of_render() {
    let folder = Folder::new();
    write(&folder, "field.npy", [20, 33], |r, c| ((r * r + 3 * c) % 11) as f32 * 0.4);
    for words in ["", " --border open --azimuths 24", " --method brute-force --border periodic"] {
        done(&folder, &format!("render field.npy --sky 1 -o r.exr --layers sky-view{words}"));
        let baked = format!("bake field.npy -o out --what sky-view --format npy{words}");
        done(&folder, &format!("{baked} --json b.json"));
        let rendered = read(&folder.path("r.exr"));
        let (_, baked) = load(&folder.path("out/sky_view.npy"));
        assert!(plane(&rendered, "sky_view") == baked, "{words}");
        assert!(baked.iter().any(|v| *v < 0.9), "nothing is hidden");
        let report = json(&folder.path("b.json"));
        let passes = report["passes"].as_array().unwrap().iter();
        let passes: Vec<&str> = passes.map(|pass| pass["pass"].as_str().unwrap()).collect();
        let reads = |pass: &&&str| pass.starts_with("sweep_fuse");
        assert_eq!(passes.iter().find(reads), None, "{passes:?}");
    }
}

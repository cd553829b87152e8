//! Old names are accepted with one warning and give the same plan and the same bytes.

use crate::{Folder, planned};

fn warning(old: &str, new: &str) -> String {
    format!("warning: {old} is now {new}; the old name goes away in the next release\n")
}

const CASES: [(&str, &str, &str, &str); 11] = [
    ("--hull list", "--hull occluder-list", "--hull list", "--hull occluder-list"),
    (
        "--receiver lobe",
        "--receiver cosine",
        "--sphere-light 1,2,30,4,5 --light-basis sh --receiver lobe",
        "--sphere-light 1,2,30,4,5 --light-basis sh --receiver cosine",
    ),
    (
        "--bounce-gloss",
        "--bounce-specular",
        "--albedo 0.5 --specular 10,0.5 --bounces 1 --bounce-engine pyramid --bounce-gloss scalar",
        "--albedo 0.5 --specular 10,0.5 --bounces 1 --bounce-engine pyramid --bounce-specular scalar",
    ),
    ("--phong", "--specular", "--albedo 0.5 --phong 10,0.5", "--albedo 0.5 --specular 10,0.5"),
    ("--phong", "--specular", "--albedo 0.5 --phong=10,0.5", "--albedo 0.5 --specular=10,0.5"),
    ("--light", "--sphere-light", "--light 1,2,30,4,5", "--sphere-light 1,2,30,4,5"),
    (
        "--light",
        "--sphere-light",
        "--light 1,2,30,4,5 --light=1,2,40,4,5",
        "--sphere-light 1,2,30,4,5 --sphere-light 1,2,40,4,5",
    ),
    ("--method brute", "--method brute-force", "--method brute", "--method brute-force"),
    ("--method brute", "--method brute-force", "--method=brute", "--method=brute-force"),
    (
        "--bounce-engine brute",
        "--bounce-engine brute-force",
        "--albedo 0.5 --bounces 1 --bounce-engine brute",
        "--albedo 0.5 --bounces 1 --bounce-engine brute-force",
    ),
    (
        "--bounce-engine brute",
        "--bounce-engine brute-force",
        "--albedo 0.5 --bounces 1 --bounce-engine=brute",
        "--albedo 0.5 --bounces 1 --bounce-engine=brute-force",
    ),
];

#[test]
fn old_flags_and_values_warn_once() {
    let folder = Folder::new();
    for (old, new, with_old, with_new) in CASES {
        let [plan, warned] = planned(&folder, &format!("a.asc {with_old}"));
        let [expected, silent] = planned(&folder, &format!("a.asc {with_new}"));
        assert_eq!(warned, warning(old, new), "{with_old}");
        assert_eq!((plan, silent.as_str()), (expected, ""), "{with_old}");
        // The next release refuses the old name, so scripts with --quiet get the warning, too.
        let [_, quiet] = planned(&folder, &format!("a.asc {with_old} --quiet"));
        assert_eq!(quiet, warned, "{with_old}");
    }
    // A command without the new flag refuses the old one by the name that was written.
    let run = folder.run_without_driver(&["horizon", "a.asc", "-o", "h.npy", "--phong", "9,0.5"]);
    assert!(run.status == Some(2) && run.err.contains("--phong"), "{}", run.err);
    // A value that looks like an old one stays.
    let run = folder.run_without_driver(&["plan", "brute"]);
    assert!(run.status == Some(1) && run.err.contains("brute"), "{}", run.err);
    assert!(!run.err.contains("brute-force"), "{}", run.err);
}

#[test]
fn old_keys_of_scene_files_warn_once() {
    let folder = Folder::new();
    let sphere = r#"[{ "position_m": [1, 2, 30], "radius_m": 4, "radiance": 5 }]"#;
    let specular = r#"{ "exponent": 10, "scale": 0.5 }"#;
    let text = |sphere_lights: &str, key: &str, stored: &str, method: &str| {
        format!(
            r#"{{ "field": {{ "file": "a.asc" }}, "surface": {{ "albedo": 0.5, "{key}": {specular} }},
                "lights": {{ "sky": 1, "{sphere_lights}": [] }}, "quality": {{ "method": "{method}", "{stored}": "scalar" }} }}"#
        )
    };
    folder.write("old.json", text("balls", "phong", "bounce_gloss", "brute").as_bytes());
    folder.write(
        "new.json",
        text("sphere_lights", "specular", "bounce_specular", "brute-force").as_bytes(),
    );
    let [plan, warned] = planned(&folder, "--scene old.json");
    let [expected, silent] = planned(&folder, "--scene new.json");
    assert_eq!((&plan, silent.as_str()), (&expected, ""));
    let mut lines: Vec<&str> = warned.split_inclusive('\n').collect();
    lines.sort_unstable();
    assert_eq!(
        lines,
        [
            warning("--bounce-gloss", "--bounce-specular"),
            warning("--method brute", "--method brute-force"),
            warning("lights.balls", "lights.sphere_lights"),
            warning("surface.phong", "surface.specular"),
        ]
    );
    for (name, key) in [("b.json", "balls"), ("s.json", "sphere_lights")] {
        let text =
            format!(r#"{{ "field": {{ "file": "a.asc" }}, "lights": {{ "{key}": {sphere} }} }}"#);
        folder.write(name, text.as_bytes());
    }
    let [old, _] = planned(&folder, "--scene b.json");
    assert_eq!(old, planned(&folder, "--scene s.json")[0]);
    // An old flag overrides the file's key, as the new one does.
    let with = |flag: &str| format!("--scene s.json {flag} 1,2,30,4,5 {flag} 2,2,30,4,5");
    let [overridden, warned] = planned(&folder, &with("--light"));
    assert_eq!(warned, warning("--light", "--sphere-light"));
    assert_ne!(overridden, old);
    assert_eq!(overridden, planned(&folder, &with("--sphere-light"))[0]);
}

#[test]
fn gpu_old_names_give_the_same_bytes() {
    let folder = Folder::new();
    let render = |name: &str, words: &str| {
        let args = format!("render a.asc -o {name} --azimuths 8 --quiet {words}");
        let run = folder.run_str(&args);
        assert_eq!(run.status, Some(0), "{args}: {}", run.err);
        crate::read(&folder.path(name))
    };
    assert_eq!(
        render("old.exr", "--method brute --light 1,2,30,4,5"),
        render("new.exr", "--method brute-force --sphere-light 1,2,30,4,5")
    );
}

/// `--samples` was the number of timed runs; `render --samples` stays.
#[test]
fn gpu_bench_samples_is_runs() {
    let folder = Folder::new();
    // A small budget: little work for the peak rates.
    let run = folder.run_str("bench --size 32 --samples 1 --azimuths 4 --memory-budget 16MiB");
    assert_eq!((run.status, run.err), (Some(0), warning("--samples", "--runs")));
    let run = folder.run_without_driver(&["bench", "--size", "32", "--runs", "0"]);
    assert!(run.status == Some(2) && run.err.contains("--runs: found 0"), "{}", run.err);
    let camera = ["render", "a.asc", "-o", "out.exr", "--camera", "0,45", "--samples", "3"];
    let run = folder.run_without_driver(&camera);
    assert!(run.status == Some(2) && run.err.contains("--samples: found 3"), "{}", run.err);
    assert!(!run.err.contains("warning"), "{}", run.err);
}

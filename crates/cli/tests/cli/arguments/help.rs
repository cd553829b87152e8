//! Texts of `-h`, `--help` and `--version`.

use crate::Folder;

/// Every flag with a range, a unit or a default gives it.
#[test]
fn help_gives_units_and_defaults() {
    let words = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let folder = Folder::new();
    let shared: &[(&str, &[&str])] = &[
        ("--cell", &["metres", "Default the file's"]),
        ("--z-scale", &["Default 1"]),
        ("--border", &["[default: plane]"]),
        ("--nodata", &["Default the file's"]),
        ("--method", &["[default: auto]", "pyramid"]),
        ("--level-step", &["1 to 16", "[default: 4]"]),
        ("--level-offset", &["0 to 4", "[default: 2]"]),
        ("--levels", &["[default: stack]"]),
        ("--azimuths", &["4 to 1024", "[default: 32]"]),
        ("--sun-azimuths", &["1 to 256", "[default: 8]"]),
        ("--light-cutoff", &["0 to 1", "faster", "default 1/65536"]),
        ("--light-basis", &["[default: exact]", "--sh-order"]),
        ("--lines", &["Cells", "[default: 1]"]),
        ("--fuse", &["[default: aimed-around]"]),
        ("--precision", &["[default: f32]"]),
        ("--hull", &["[default: auto]"]),
        ("--table-elevations", &["8 to 4096", "[default: 256]"]),
        ("--basis", &["[default: auto]"]),
        ("--sh-order", &["2 to 6", "[default: 4]"]),
        ("--wedges", &["[default: slices]"]),
        ("--receiver", &["[default: plane]"]),
        ("--window", &["[default: none]"]),
        ("--subsample", &["texel", "[default: 1]"]),
        ("--wedge-side", &["4 to 256", "[default: 64]"]),
        ("--bounces", &["0 to 64", "[default: 0]"]),
        ("--bounce-engine", &["[default: auto]"]),
        ("--bounce-azimuths", &["4 to 1024", "[default: 16]"]),
        ("--bounce-cutoff", &["0 to 1", "default 1/65536"]),
        ("--bounce-level-step", &["1 to 16", "[default: 4]"]),
        ("--bounce-level-offset", &["0 to 4", "[default: 2]"]),
        ("--bounce-specular", &["vector-f16", "[default: vector]"]),
        ("--device", &["Default the first GPU"]),
        ("--memory-budget", &["512MiB", "default half"]),
    ];
    let lit: &[(&str, &[&str])] = &[
        ("--sphere-light", &["X,Y,Z,RADIUS,RADIANCE", "metres"]),
        ("--sky", &["uniform sky of radiance 1"]),
        ("--env-rotate", &["clockwise", "degrees", "[default: 0]"]),
        ("--sun", &["degrees", "default 0.53", "default 1"]),
        ("--albedo", &["0 to 1", "Default 1"]),
        ("--specular", &["0 to 10000", "0 to 1", ".npy", "mirror direction"]),
    ];
    let render: &[(&str, &[&str])] = &[
        ("--exposure", &["99th percentile", "0.8"]),
        ("--tint", &["none, elevation, slope or land", "Default land"]),
        ("--layers", &["lights", "sky-view", "horizon"]),
        ("--max-error", &["0.01 is 1 %", "95 % confidence", "refused"]),
        ("--time-budget", &["<MS>", "GPU time"]),
        ("--seed", &["0 by default"]),
    ];
    let horizon: &[(&str, &[&str])] = &[("--distances", &["metres"])];
    let bake: &[(&str, &[&str])] = &[
        ("--angles", &["2..64 x 4..256", "[default: 8x16, with btf 3x8]"]),
        ("--paths", &["1 to 4096", "[default: 256]"]),
        ("--seed", &["[default: 0]"]),
        ("--what", &["the list below"]),
        ("--format", &["values in f32", "exr, png, npy, ktx2"]),
        ("--encoding", &["KIND=ENCODING", "default the first"]),
        ("--plan", &["memory", "runs nothing"]),
    ];
    let plan: &[(&str, &[&str])] = &[("--format", &["[default: text]"])];
    let compare: &[(&str, &[&str])] = &[
        ("--max-rmse", &["relative to the mean of B", "0.01 is 1 %"]),
        ("--max-mean-shift", &["relative to the mean of B"]),
        ("--max-p99", &["relative to the mean of B"]),
        ("--max-worst", &["relative to the mean of B"]),
        ("--max-flip", &["0 (same look) to 1"]),
        ("--max-median-deg", &["degrees"]),
        ("--max-p999-deg", &["degrees"]),
        ("--max-worst-deg", &["degrees"]),
        ("--horizons", &["radians", "degrees"]),
        ("--exposure", &["[default: 1]"]),
        ("--pixels-per-degree", &["1 to 1000", "Default 67.02"]),
        ("--diff", &["difference.CHANNEL", "flip", "A - B"]),
    ];
    let trade: &[(&str, &[&str])] = &[
        ("--budget", &["Seconds", "[default: 120]"]),
        ("--evaluations", &["the same work on every machine"]),
        ("--bounces", &["0 to 64", "only with --reference", "[default: 0]"]),
        ("--max-error", &["0.01 is 1 %"]),
        ("--time-budget", &["<MS>"]),
        ("--reference", &["Default: brute force"]),
        ("--device", &["Default the first GPU"]),
    ];
    let hillshade: &[(&str, &[&str])] = &[
        ("--sun", &["compass azimuth, elevation (degrees)", "[default: 315,45]"]),
        ("--z-scale", &["Default 1"]),
    ];
    let shadow: &[(&str, &[&str])] =
        &[("--sun", &["compass azimuth, elevation, diameter (degrees)", "[default: 315,45]"])];
    let openness: &[(&str, &[&str])] =
        &[("--border", &["[default: open]"]), ("--negative", &["the negated heights"])];
    let reference: &[(&str, &[&str])] = &[
        ("--spp", &["batches of 64", "at least 128", "[default: 1024]"]),
        ("--bounces", &["0 to 64", "[default: 0]"]),
        ("--until-error", &["0.01 is 1 %", "512 paths"]),
        ("--camera", &["View --specular from a camera", "one pixel per texel"]),
        ("--plinth", &["[default: 0.04]"]),
        ("--seed", &["[default: 0]"]),
        ("--device", &["Default the first GPU"]),
    ];
    for (command, tables) in [
        ("reference", &[lit, reference][..]),
        ("trade", &[lit, trade]),
        ("render", &[shared, lit, render]),
        ("horizon", &[shared, horizon]),
        ("svf", &[shared]),
        ("hillshade", &[hillshade]),
        ("shadow", &[shadow]),
        ("openness", &[openness]),
        ("bake", &[shared, lit, bake]),
        ("plan", &[shared, lit, plan]),
        ("compare", &[compare]),
        ("devices", &[]),
    ] {
        let help = folder.run_without_driver(&[command, "--help"]);
        assert_eq!((help.status, help.err.as_str()), (Some(0), ""), "{command}");
        // Each flag's own paragraph: from its line to the next flag's.
        let flags: Vec<&str> = help.out.split("\n      --").skip(1).collect();
        for (flag, says) in tables.iter().copied().flatten() {
            let own = flags
                .iter()
                .find(|f| f.split([' ', '\n']).next() == flag.strip_prefix("--"))
                .unwrap_or_else(|| panic!("{command} --help has no {flag}"));
            for said in *says {
                // Maps of light are scattered by default, some pictures have a bounce.
                let said = match (command, *flag, *said) {
                    ("render", "--bounces", "[default: 0]") => "[default: 0, or 1 in a .png]",
                    ("bake", "--bounces", "[default: 0]") => "[default: 3]",
                    _ => *said,
                };
                assert!(words(own).contains(said), "{command} {flag} does not say {said:?}: {own}");
            }
        }
        let has_albedo = help.out.contains("--albedo");
        assert_eq!(
            has_albedo,
            ["render", "plan", "trade", "reference", "bake"].contains(&command),
            "{command} --albedo"
        );
    }
    for args in [&["--help"][..], &["--version"]] {
        let run = folder.run_without_driver(args);
        assert!(run.status == Some(0) && run.err.is_empty() && !run.out.is_empty(), "{args:?}");
    }
    let commit = match env!("RIDGELIGHT_COMMIT") {
        "unknown" => String::new(),
        commit => format!(" ({commit})"),
    };
    let version = format!("ridgelight {}{commit}\n", env!("CARGO_PKG_VERSION"));
    assert_eq!(folder.run_without_driver(&["--version"]).out, version);
    // Every kind is listed with the ways to pack it.
    let help = folder.run_without_driver(&["bake", "--help"]).out;
    for said in ["visible-sky:", "unorm16-sin", "snorm16-xyz", "--method auto is sweep here"] {
        // A line may end anywhere in a sentence.
        assert!(words(&help).contains(said), "{said} in\n{help}");
    }
}

/// Lines of `-h` at 100 columns: one screen.
#[test]
fn short_help_fits_one_screen() {
    let folder = Folder::new();
    for command in [
        "render",
        "horizon",
        "hillshade",
        "shadow",
        "ao",
        "svf",
        "openness",
        "plan",
        "bench",
        "compare",
        "devices",
        "info",
        "trade",
        "reference",
        "bake",
        "view",
        "",
    ] {
        let words: Vec<&str> =
            [command, "-h"].into_iter().filter(|word| !word.is_empty()).collect();
        let mut command_line = folder.command(&words);
        command_line.env("COLUMNS", "100");
        let help = crate::ran(command_line);
        assert_eq!((help.status, help.err.as_str()), (Some(0), ""), "{command}");
        let most = if command == "render" { 42 } else { 45 };
        let (count, text) = (help.out.lines().count(), &help.out);
        assert!(count <= most, "{command} -h has {count} lines, at most {most}:\n{text}");
        let widest = text.lines().map(|line| line.chars().count()).max();
        assert!(widest <= Some(100), "{command} -h: {widest:?} columns:\n{text}");
        if command == "render" {
            assert!(text.lines().last().is_some_and(|line| line.contains("--help")), "{text}");
            // One line each.
            assert!(!text.contains("\n          "), "{text}");
        }
    }
}

/// The last line of `-h` promises examples where `--help` has some.
#[test]
fn short_help_promises_what_the_long_help_has() {
    let folder = Folder::new();
    for (command, has_examples) in [("bench", false), ("render", true), ("hillshade", true)] {
        let [short, long] =
            ["-h", "--help"].map(|flag| folder.run_without_driver(&[command, flag]).out);
        assert_eq!(long.contains("\n  ridgelight "), has_examples, "{long}");
        assert_eq!(short.contains("all flags and examples"), has_examples, "{short}");
    }
    // What --against reads.
    let help = folder.run_without_driver(&["bench", "-h"]).out;
    assert!(help.contains("--json <FILE>"), "{help}");
}

/// Headings of `--help` in their order; expert settings come last.
#[test]
fn help_is_grouped() {
    let folder = Folder::new();
    let help = folder.run_without_driver(&["render", "--help"]).out;
    let headings: Vec<&str> = help
        .lines()
        .filter(|line| line.ends_with(':') && !line.starts_with([' ', '#']))
        .map(|line| line.trim_end_matches(':'))
        .collect();
    let groups = [
        "Input", "Lights", "Surface", "Quality", "Camera", "Output", "Device", "Expert", "Examples",
    ];
    assert_eq!(headings, groups);
}

/// The first lines of `svf --help` name RVT's map, so that nobody takes one for the other.
#[test]
fn help_of_svf_begins_with_the_map_of_rvt() {
    let folder = Folder::new();
    let start = |command: &str| {
        let help = folder.run_without_driver(&[command, "--help"]).out;
        let text = help.split("Usage:").next().unwrap_or_default().to_owned();
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let svf = start("svf");
    for said in ["RVT", "`ridgelight bake --what visible-sky`", "`ao` writes the same map"] {
        assert!(svf.contains(said), "{said}: {svf}");
    }
    assert!(start("ao").contains("`svf` writes the same map"), "{}", start("ao"));
}

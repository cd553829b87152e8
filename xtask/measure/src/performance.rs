//! What docs/measured/performance.md shows: reports of `ridgelight bench`, one after the other, and a plot.
//! `cargo xtask performance`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Duration;

use ridgelight_io as files;
use serde_json::{Value, json};

use crate::common::Outcome;
use crate::common::args::Args;
use crate::common::plot::{self, Curve, Panel, Style, curve};

/// The average over a minute below which a machine is quiet, and how often it is asked, 10 s apart.
const QUIET: f64 = 0.3;
const WAITS: usize = 60;

/// Name and arguments of each report. Commas are between flags, semicolons in lists.
pub fn reports() -> Vec<(String, String)> {
    let one = [
        ("frame", "--size 1024,--azimuths 64,--fuse aimed-around"),
        (
            "environment",
            "--size 1024,--azimuths 64,--fuse aimed-around,--env assets/sky_512x256.hdr",
        ),
        ("forms", "--size 1024,--azimuths 64,--forms,--passes FORMS"),
        ("sizes", "--sizes 256;512;1024;2048;4096,--fuse aimed-around,--azimuth-list 64"),
        ("azimuths", "--sizes 1024,--fuse aimed-around,--azimuth-list 8;16;32;64;128;256"),
    ];
    let bounces = |count: u32| {
        let words =
            "--size 512,--azimuths 64,--fuse aimed-around,--subsample 2,--bounce-azimuths 32";
        let words = format!("{words},--bounces {count},--passes light_resolve");
        (format!("bounces{count}"), words)
    };
    let one = one.map(|(name, words)| (name.to_owned(), words.to_owned()));
    one.into_iter().chain((0..=4).map(bounces)).collect()
}

/// The forms that are compared with a scalar sweep.
pub const FORMS: [&str; 6] = [
    "horizon_sweep lines 1",
    "sky_shade aimed-nearest",
    "sky_shade aimed-around",
    "surface_sweep exact",
    "pyramid_march stack",
    "horizon_march brute",
];

/// Runs all with the program, and writes the reports as one file; or only draws the plot of such a file again.
pub fn run(mut args: Args) -> Outcome {
    let (output, json_path) = (args.needed("-o")?, args.needed("--json")?);
    if args.has("--redraw") {
        args.end()?;
        let all: Value = serde_json::from_slice(&std::fs::read(&json_path)?)?;
        return Ok(plot::write(Some(&output), &panels(&all))?);
    }
    let program = args.folder().ok_or("expected the program")?;
    args.end()?;
    let scratch = PathBuf::from("out");
    std::fs::create_dir_all(&scratch)?;
    let mut all = json!({ "cpu": cpu(), "load": quiet_load()? });
    for (name, words) in reports() {
        let report = reported(&program, &words, &scratch.join("performance.json"))?;
        for key in ["device", "driver", "commit"] {
            all[key] = report[key].clone();
        }
        all["ended"] = report["time"].clone();
        println!("{name}: bench {words}");
        all["reports"][name] = json!({ "rows": report["rows"], "peaks": report["peaks"] });
    }
    plot::write(Some(&output), &panels(&all))?;
    files::write_json(&json_path, &all)?;
    Ok(())
}

/// The report of one `bench`.
fn reported(
    program: &Path,
    words: &str,
    json: &Path,
) -> std::result::Result<Value, Box<dyn std::error::Error>> {
    let mut command = Command::new(program);
    // Untuned: what `ridgelight tune` has kept stays out.
    command.env("XDG_CACHE_HOME", std::fs::canonicalize("out")?.join("cache"));
    command.arg("bench").arg("--quiet").arg("--json").arg(json);
    for flag in words.split(',') {
        let (flag, value) = flag.split_once(' ').unwrap_or((flag, ""));
        let value = value.replace(';', ",").replace("FORMS", &FORMS.join(","));
        command.arg(flag).args(Some(value).filter(|value| !value.is_empty()));
    }
    if !command.status()?.success() {
        return Err(format!("bench {words} failed").into());
    }
    Ok(serde_json::from_slice(&std::fs::read(json)?)?)
}

/// The processor's name, as times of a software driver depend on it.
fn cpu() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find(|line| line.starts_with("model name"));
    let name = name.and_then(|line| line.split_once(": ")).map_or("unknown", |(_, name)| name);
    let cores = std::thread::available_parallelism().map_or(0, usize::from);
    format!("{cores} cores of {name}")
}

/// The load of the machine, once it is quiet: the build before it has raised it.
fn quiet_load() -> std::result::Result<String, String> {
    for _ in 0..WAITS {
        let text = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
        let load: Vec<&str> = text.split(' ').take(3).collect();
        // Where the system does not state it, it is not known.
        let now = load.first().and_then(|now| now.parse().ok()).unwrap_or(0.0_f64);
        if now < QUIET {
            return Ok(load.join(" "));
        }
        std::thread::sleep(Duration::from_secs(10));
    }
    Err(format!("the load stays above {QUIET} for 10 minutes: measure on a quiet machine"))
}

/// Time against the field's side, the azimuths and the bounces.
fn panels(all: &Value) -> Vec<Panel> {
    let rows = |name: &str| all["reports"][name]["rows"].as_array().cloned().unwrap_or_default();
    let ms = |row: &Value| row["median_ns"].as_f64().unwrap_or(f64::NAN) * 1e-6;
    let along = |name: &str, key: &str| -> Vec<Curve> {
        let rows = rows(name);
        let points = rows.iter().map(|row| [row[key].as_f64().unwrap_or(0.0), ms(row)]).collect();
        vec![curve("a frame under a uniform sky", 0, Style::Dotted, points)]
    };
    let of_bounces = (0..=4).filter_map(|count| {
        let rows = rows(&format!("bounces{count}"));
        let total = rows.iter().find(|r| r["pass"] == "total" && r["mode"] == "overlapped")?;
        Some([f64::from(count), ms(total)])
    });
    let of_bounces: Vec<[f64; 2]> = of_bounces.collect();
    let most = of_bounces.iter().fold(0.0_f64, |most, [_, ms]| most.max(*ms));
    let name = "a frame, bounces at every 2nd texel";
    let bounces = vec![curve(name, 1, Style::Dotted, of_bounces)];
    vec![
        Panel::new("64 azimuths", ["side of the field, texels", "ms"], along("sizes", "cols")),
        Panel::new("1024 × 1024 texels", ["azimuths", "ms"], along("azimuths", "azimuths")),
        Panel {
            title: "512 × 512 texels, 64 azimuths".into(),
            x: "bounces",
            y: "ms",
            curves: bounces,
            linear: Some([5.0, round_above(most)]),
        },
    ]
}

/// The next of 1, 2 and 5 times a power of ten.
fn round_above(most: f64) -> f64 {
    let decade = 10_f64.powf(most.max(1e-3).log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|m| m * decade).into_iter().find(|end| *end >= most).unwrap_or(most)
}

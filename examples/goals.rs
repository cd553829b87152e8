//! How often `render --max-error` holds with bounces.
//!
//! `cargo run --release --example goals -- RIDGELIGHT [FOLDER]`
//!
//! Runs the command line as its users do: each field (the middle 64² of the bundled mountain; with FOLDER those of its
//! `height/` too) under each light, three bounces of albedo 0.8, each error asked for. The truth are two pictures of
//! `reference` by paths of other seeds: what the square of a difference gains by their chance is not in the product of
//! the differences from one and from the other.

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use ridgelight::scene::HeightField;
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

#[path = "shared/middle.rs"]
mod middle;

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const SIDE: usize = 64;
const PATHS: &str = "4096";
const ERRORS: [f64; 4] = [0.02, 0.01, 0.005, 0.003];
const LIT: [&str; 4] = ["--albedo", "0.8", "--bounces", "3"];

fn fields(folder: Option<&Path>) -> Result<Vec<(&'static str, HeightField)>> {
    let of = |path: &Path, cell: [f64; 2], z_scale: f64| {
        let options = HeightOptions { cell_m: Some(cell), z_scale, nodata: Some(-32768.0) };
        middle::middle(&files::read_heights(path, &options)?, SIDE)
    };
    let mountain = Path::new("assets/mt_washington_256.png");
    let mut all = vec![("Mt Washington", of(mountain, [66.0, 92.6], 1.0)?)];
    if let Some(folder) = folder {
        let rainier = folder.join("height/mt_rainier_90m.tif");
        all.push(("Mt Rainier", of(&rainier, [64.0, 92.6], 1.0)?));
        let moss = folder.join("height/Moss001_1K_Displacement.png");
        all.push(("moss", of(&moss, [1.0; 2], 80.0 / 65535.0)?));
    }
    Ok(all)
}

const LIGHTS: [(&str, &[&str]); 2] = [
    ("sky", &["--env", "assets/sky_512x256.hdr"]),
    ("sky and sun", &["--sky", "1", "--sun", "143,23,0.53,8"]),
];

/// The settings that matter most, of a picture's metadata.
const TOLD: [&str; 7] =
    ["lines", "fuse", "azimuths", "bounces", "bounce_engine", "bounce_azimuths", "subsample"];

/// Why the command does not do what it was asked on a field under its lights, if it does not: an exit status of 1.
fn run(program: &Path, command: &str, of: (&Path, &[&str], &[&str])) -> Result<Option<String>> {
    let (field, lights, more) = of;
    let mut call = Command::new(program);
    call.arg(command).arg(field).args(LIT).args(lights).args(more).arg("--quiet");
    let output = call.output()?;
    let told = String::from_utf8_lossy(&output.stderr).trim().replace('\n', " ");
    match output.status.code() {
        Some(0) => Ok(None),
        Some(1) => Ok(Some(told)),
        _ => Err(format!("{call:?}: {told}").into()),
    }
}

/// R, G and B, one after the other.
fn light(path: &Path) -> Result<Vec<f64>> {
    let read = files::read_planes(path)?;
    let mut all = Vec::new();
    for channel in ["R", "G", "B"] {
        let at = read.names.iter().position(|n| n == channel).ok_or("a picture without colours")?;
        all.extend(read.planes[at].iter().map(|v| f64::from(*v)));
    }
    Ok(all)
}

/// RMSE over the mean, and its standard error: of the mean of products, one a sample.
fn error(drawn: &[f64], truth: &[Vec<f64>; 2]) -> [f64; 2] {
    let [a, b] = truth;
    let samples = (drawn.len() / 3) as f64;
    let product = |i: usize| -> f64 {
        let of = |i: usize| (drawn[i] - a[i]) * (drawn[i] - b[i]);
        (0..3).map(|c| of(i + c * drawn.len() / 3)).sum::<f64>() / 3.0
    };
    let products: Vec<f64> = (0..drawn.len() / 3).map(product).collect();
    let mean = products.iter().sum::<f64>() / samples;
    let spread = products.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / samples;
    let light = (a.iter().sum::<f64>() + b.iter().sum::<f64>()) / (6.0 * samples);
    let rmse = mean.max(0.0).sqrt();
    // What a square is off its root is by twice the root, if that is more than chance.
    let chance = (spread / samples).sqrt();
    [rmse / light, chance / (2.0 * rmse.max(chance.sqrt())) / light]
}

fn rows(program: &Path, work: &Path, folder: Option<&Path>) -> Result<()> {
    println!(
        "`render --max-error` with three bounces of albedo 0.8, the middle {SIDE}² of each field; true: beside two pictures of \
         {PATHS} light paths a sample, RMSE over the mean, %, give or take their chance\n"
    );
    println!("| field | light | asked % | chosen | measured % | at most % | true % | holds |");
    println!("|---|---|---|---|---|---|---|---|");
    let (mut held, mut chosen, mut asked) = (0, 0, 0);
    for (name, field) in fields(folder)? {
        let path = work.join("field.npy");
        files::write_npy_heights(&path, &field)?;
        let [x, y] = field.cell_m();
        let cell = format!("{x},{y}");
        for (light_name, lights) in LIGHTS {
            let of = |command: &str, more: &[&str], out: &Path| {
                let out = out.to_string_lossy();
                let all = [&["--cell", cell.as_str(), "-o", &*out], more].concat();
                run(program, command, (&path, lights, &all))
            };
            let mut truth = [Vec::new(), Vec::new()];
            for (truth, seed) in truth.iter_mut().zip(["71", "72"]) {
                let out = work.join("truth.exr");
                if let Some(why) = of("reference", &["--spp", PATHS, "--seed", seed], &out)? {
                    return Err(why.into());
                }
                *truth = light(&out)?;
            }
            for most in ERRORS {
                asked += 1;
                let out = work.join("drawn.exr");
                let head = format!("| {name} | {light_name} | {} |", 100.0 * most);
                if let Some(why) = of("render", &["--max-error", &most.to_string()], &out)? {
                    println!("{head} refused: {why} | | | | |");
                    continue;
                }
                chosen += 1;
                let [off, chance] = error(&light(&out)?, &truth);
                held += usize::from(off <= most);
                let told = files::read_metadata(&out)?;
                let of = |key: &str| {
                    let found = told.iter().find(|(name, _)| name == key);
                    found.map_or("", |(_, value)| value.as_str())
                };
                let percent = |key: &str| of(key).parse().map(|v: f64| format!("{:.3}", 100.0 * v));
                println!(
                    "{head} {} | {} | {} | {:.3} ± {:.3} | {} |",
                    TOLD.map(|key| format!("{key} {}", of(key))).join(", "),
                    percent("error_measured")?,
                    percent("error_at_most")?,
                    100.0 * off,
                    100.0 * chance,
                    if off <= most { "yes" } else { "no" }
                );
            }
        }
    }
    println!("\n{held} of {chosen} chosen hold, {} of {asked} refused", asked - chosen);
    Ok(())
}

fn main() -> ExitCode {
    let args: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let Some(program) = args.first() else {
        eprintln!("goals: expected the path of ridgelight");
        return ExitCode::from(2);
    };
    let work = std::env::temp_dir().join(format!("ridgelight-goals-{}", std::process::id()));
    let done = std::fs::create_dir(&work)
        .map_err(Into::into)
        .and_then(|()| rows(program, &work, args.get(1).map(PathBuf::as_path)));
    std::fs::remove_dir_all(&work).ok();
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("goals: {error}");
            ExitCode::FAILURE
        }
    }
}

//! How often `render --max-error` meets its goal with bounces.
//!
//! Runs the command line as its users do: each field (the middle 64² of the bundled mountain; with FOLDER those of its
//! `height/` too) under each light, three bounces of albedo 0.8, each error. The ground truth are two pictures of
//! `reference` by paths of other seeds: the product of the differences from one and from the other does not contain
//! their noise, which the square of a difference does.

use std::path::{Path, PathBuf};
use std::process::Command;

use ridgelight_io as files;

use crate::common::args::Args;
use crate::common::{Outcome, head, inputs};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const SIDE: usize = 64;
const PATHS: &str = "4096";
const ERRORS: [f64; 4] = [0.02, 0.01, 0.005, 0.003];
const LIT: [&str; 4] = ["--albedo", "0.8", "--bounces", "3"];

const LIGHTS: [(&str, &[&str]); 2] = [
    ("sky", &["--env", "assets/sky_512x256.hdr"]),
    ("sky and sun", &["--sky", "1", "--sun", "143,23,0.53,8"]),
];

/// The settings that matter most, of a picture's metadata.
const STATED: [&str; 7] =
    ["lines", "fuse", "azimuths", "bounces", "bounce_engine", "bounce_azimuths", "subsample"];

/// Why the command refuses a field under its lights, if it does: an exit status of 1.
fn refusal(program: &Path, command: &str, of: (&Path, &[&str], &[&str])) -> Result<Option<String>> {
    let (field, lights, more) = of;
    let mut call = Command::new(program);
    call.arg(command).arg(field).args(LIT).args(lights).args(more).arg("--quiet");
    let output = call.output()?;
    let reason = String::from_utf8_lossy(&output.stderr).trim().replace('\n', " ");
    match output.status.code() {
        Some(0) => Ok(None),
        Some(1) => Ok(Some(reason)),
        _ => Err(format!("{call:?}: {reason}").into()),
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

/// Relative RMSE and its standard error: of the mean of products, one a grid point.
fn error(drawn: &[f64], truth: &[Vec<f64>; 2]) -> [f64; 2] {
    let [a, b] = truth;
    let count = (drawn.len() / 3) as f64;
    let product = |i: usize| -> f64 {
        let of = |i: usize| (drawn[i] - a[i]) * (drawn[i] - b[i]);
        (0..3).map(|c| of(i + c * drawn.len() / 3)).sum::<f64>() / 3.0
    };
    let products: Vec<f64> = (0..drawn.len() / 3).map(product).collect();
    let mean = products.iter().sum::<f64>() / count;
    let spread = products.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / count;
    let light = (a.iter().sum::<f64>() + b.iter().sum::<f64>()) / (6.0 * count);
    let rmse = mean.max(0.0).sqrt();
    // The error of a square is that of its root times twice the root, where that is more than noise.
    let noise = (spread / count).sqrt();
    [rmse / light, noise / (2.0 * rmse.max(noise.sqrt())) / light]
}

fn rows(program: &Path, work: &Path, folder: Option<&Path>) -> Result<()> {
    println!(
        "`render --max-error` with three bounces of albedo 0.8, the middle {SIDE}² of each field; true: beside two pictures of \
         {PATHS} paths per grid point, relative RMSE, %, ± its standard error\n"
    );
    head("| field | light | asked % | chosen | measured % | at most % | true % | holds |");
    let mut fields = vec![("Mt Washington", inputs::mountain(1.0)?)];
    if let Some(folder) = folder {
        fields.push(("Mt Rainier", inputs::field_of(folder, inputs::RAINIER)?));
        fields.push(("moss", inputs::field_of(folder, inputs::MOSS)?));
    }
    let (mut held, mut chosen, mut asked) = (0, 0, 0);
    for (name, field) in fields {
        let field = inputs::middle(&field, SIDE)?;
        let path = work.join("field.npy");
        files::write_npy_heights(&path, &field)?;
        let [x, y] = field.cell_m();
        let cell = format!("{x},{y}");
        for (light_name, lights) in LIGHTS {
            let of = |command: &str, more: &[&str], out: &Path| {
                let out = out.to_string_lossy();
                let all = [&["--cell", cell.as_str(), "-o", &*out], more].concat();
                refusal(program, command, (&path, lights, &all))
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
                let [rmse, noise] = error(&light(&out)?, &truth);
                held += usize::from(rmse <= most);
                let stated = files::read_metadata(&out)?;
                let of = |key: &str| {
                    let found = stated.iter().find(|(name, _)| name == key);
                    found.map_or("", |(_, value)| value.as_str())
                };
                let percent = |key: &str| of(key).parse().map(|v: f64| format!("{:.3}", 100.0 * v));
                println!(
                    "{head} {} | {} | {} | {:.3} ± {:.3} | {} |",
                    STATED.map(|key| format!("{key} {}", of(key))).join(", "),
                    percent("error_measured")?,
                    percent("error_at_most")?,
                    100.0 * rmse,
                    100.0 * noise,
                    if rmse <= most { "yes" } else { "no" }
                );
            }
        }
    }
    println!("\n{held} of {chosen} chosen hold, {} of {asked} refused", asked - chosen);
    Ok(())
}

pub fn run(mut args: Args) -> Outcome {
    let program = PathBuf::from(args.word().ok_or("expected the path of ridgelight")?);
    let folder = args.word().map(PathBuf::from);
    args.end()?;
    let work = std::env::temp_dir().join(format!("ridgelight-goals-{}", std::process::id()));
    std::fs::create_dir(&work)?;
    let done = rows(&program, &work, folder.as_deref());
    std::fs::remove_dir_all(&work).ok();
    done
}

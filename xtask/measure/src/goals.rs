//! How often `render --max-error` meets its goal with bounces.
//!
//! Runs the command line as its users do: each field (the middle 64² of the bundled mountain; with
//! FOLDER those of its `height/` too) under each light, three bounces of albedo 0.8, each error. The
//! ground truths are two pictures of `reference` by paths of other seeds. The product of the
//! differences to one and to the other does not contain their noise; the square of a difference does.

use std::path::Path;
use std::process::Command;

use ridgelight_io as files;

use crate::common::args::Args;
use crate::common::{Outcome, head, inputs};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const SIDE: usize = 64;
const PATHS: &str = "4096";
const ERRORS: [f64; 4] = [0.02, 0.01, 0.005, 0.003];

const LIGHTS: [(&str, &[&str]); 2] = [
    ("sky", &["--env", "assets/sky_512x256.hdr"]),
    ("sky and sun", &["--sky", "1", "--sun", "143,23,0.53,8"]),
];

/// The settings that matter most, of a picture's metadata.
const STATED: [&str; 8] = [
    "method",
    "lines",
    "fuse",
    "azimuths",
    "bounces",
    "bounce_engine",
    "bounce_azimuths",
    "subsample",
];

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

/// Relative RMSE and its standard error: of the mean of products, one per grid point.
fn error(drawn: &[f64], [a, b]: &[Vec<f64>; 2]) -> [f64; 2] {
    let points = drawn.len() / 3;
    let product = |i: usize| -> f64 {
        let of = |i: usize| (drawn[i] - a[i]) * (drawn[i] - b[i]);
        (0..3).map(|c| of(i + c * points)).sum::<f64>() / 3.0
    };
    let (products, count): (Vec<f64>, _) = ((0..points).map(product).collect(), points as f64);
    let mean = products.iter().sum::<f64>() / count;
    let spread = products.iter().map(|p| (p - mean).powi(2)).sum::<f64>() / count;
    let light = (a.iter().sum::<f64>() + b.iter().sum::<f64>()) / (6.0 * count);
    let rmse = mean.max(0.0).sqrt();
    // The error of a square is that of its root times twice the root, where that is more than noise.
    let noise = (spread / count).sqrt();
    [rmse / light, noise / (2.0 * rmse.max(noise.sqrt())) / light]
}

/// Chosen settings that hold, all that were chosen, and all requests.
type Counts = [usize; 3];

/// The rows of a field under one light. `run` fails on an exit status above 1, and returns why the
/// command refuses on 1.
fn rows(
    name: &str,
    run: impl Fn(&str, &[&str], &Path) -> Result<Option<String>>,
    work: &Path,
    counts: &mut Counts,
) -> Result<()> {
    let (picture, mut pair) = (work.join("picture.exr"), [Vec::new(), Vec::new()]);
    for (light_of, seed) in pair.iter_mut().zip(["71", "72"]) {
        if let Some(why) = run("reference", &["--spp", PATHS, "--seed", seed], &picture)? {
            return Err(why.into());
        }
        *light_of = light(&picture)?;
    }
    for most in ERRORS {
        counts[2] += 1;
        let head = format!("| {name} | {} |", 100.0 * most);
        if let Some(why) =
            run("render", &["--no-cache", "--max-error", &most.to_string()], &picture)?
        {
            println!("{head} refused: {why} | | | | |");
            continue;
        }
        let [rmse, noise] = error(&light(&picture)?, &pair);
        counts[1] += 1;
        counts[0] += usize::from(rmse <= most);
        let stated = files::read_metadata(&picture)?;
        let of = |key: &str| {
            let found = stated.iter().find(|(name, _)| name == key);
            found.map_or("", |(_, value)| value.as_str())
        };
        let of_picture = STATED.map(|key| (key, of(key)));
        let settings = of_picture.iter().filter(|(_, value)| !value.is_empty());
        let settings: Vec<_> = settings.map(|(key, value)| format!("{key} {value}")).collect();
        let percent = |key: &str| of(key).parse().map(|v: f64| format!("{:.3}", 100.0 * v));
        println!(
            "{head} {} | {} | {} | {:.3} ± {:.3} | {} |",
            settings.join(", "),
            percent("error_measured")?,
            percent("error_at_most")?,
            100.0 * rmse,
            100.0 * noise,
            if rmse <= most { "yes" } else { "no" }
        );
    }
    Ok(())
}

fn all_rows(program: &str, work: &Path, folder: Option<&Path>) -> Result<()> {
    println!(
        "`render --max-error` with three bounces of albedo 0.8, the middle {SIDE}² of each field; true: against two pictures of \
         {PATHS} paths per grid point, relative RMSE, %, ± its standard error\n"
    );
    head("| field | light | requested % | chosen | measured % | at most % | true % | holds |");
    let mut fields = vec![("Mt Washington", inputs::mountain(1.0)?)];
    if let Some(folder) = folder {
        fields.push(("Mt Rainier", inputs::field_of(folder, inputs::RAINIER)?));
        fields.push(("moss", inputs::field_of(folder, inputs::MOSS)?));
    }
    let mut counts = [0; 3];
    for (name, field) in fields {
        let (field, path) = (inputs::middle(&field, SIDE)?, work.join("field.npy"));
        files::write_npy_heights(&path, &field)?;
        let cell = field.cell_m().map(|side| side.to_string()).join(",");
        for (light, lights) in LIGHTS {
            let run = |command: &str, more: &[&str], out: &Path| -> Result<Option<String>> {
                let mut call = Command::new(program);
                call.arg(command).arg(&path).args(["--albedo", "0.8", "--bounces", "3", "--quiet"]);
                call.args(lights).args(["--cell", &cell]).args(more).arg("-o").arg(out);
                let output = call.output()?;
                let reason = String::from_utf8_lossy(&output.stderr).trim().replace('\n', " ");
                match output.status.code() {
                    Some(0) => Ok(None),
                    Some(1) => Ok(Some(reason)),
                    _ => Err(format!("{call:?}: {reason}").into()),
                }
            };
            rows(&format!("{name} | {light}"), run, work, &mut counts)?;
        }
    }
    let [held, chosen, requested] = counts;
    println!("\n{held} of {chosen} chosen hold, {} of {requested} refused", requested - chosen);
    Ok(())
}

pub fn run(mut args: Args) -> Outcome {
    let program = args.word().ok_or("expected the path of ridgelight")?;
    let folder = args.folder();
    args.end()?;
    let work = std::env::temp_dir().join(format!("ridgelight-goals-{}", std::process::id()));
    std::fs::create_dir(&work)?;
    let done = all_rows(&program, &work, folder.as_deref());
    std::fs::remove_dir_all(&work).ok();
    done
}

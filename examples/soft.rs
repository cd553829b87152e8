//! Soft horizons and harmonics beside sharp horizons and tables: errors, memory, times.
//!
//! `cargo run --release --example soft -- converge FIELD [--cell X,Y] [--env FILE] [--side N] [-o FILE.svg]`
//! errors of pyramids by levels an octave and by azimuths, under tables and harmonics, and the floors that
//! sharp horizons leave (Nowrouzezahrai & Snyder 2009, figure 10); of sub-sampling, too.
//!
//! `… -- sizes [--largest N] [--samples K]` memory and time of each stage, by size, engine, sub-sampling and
//! wedges (its table 1).
//!
//! `… -- wedges FIELD [--cell X,Y] [--side N]` the series of what is seen by slices, by Legendre coefficients
//! and by a table of wedges, from the oracle's horizons.
//!
//! `… -- rivals FOLDER [--side N] [--samples K] [-o FILE.svg]` three real scenes of FOLDER's `height/` and
//! `env/`: the cheapest of each engine and basis within an error, and whether `auto` is it.
//!
//! FIELD and scenes are the middle N² (128, 192) samples.

#[path = "soft/converge.rs"]
mod converge;
#[path = "shared/middle.rs"]
mod middle;
#[path = "soft/plot.rs"]
mod plot;
#[path = "soft/rivals.rs"]
mod rivals;
#[path = "soft/sizes.rs"]
mod sizes;
#[path = "soft/wedges.rs"]
mod wedges;

use std::path::{Path, PathBuf};

use middle::middle;
use ridgelight::gpu::{Headless, HeadlessOptions, Pixels, Timing};
use ridgelight::plan::{self, Picture, Plan};
use ridgelight::scene::{Environment, HeightField, Lights, Method, Quality, Scene, Surface};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_trade::error::ImageError;

struct Request {
    what: String,
    path: PathBuf,
    env: PathBuf,
    cell_m: Option<[f64; 2]>,
    side: usize,
    largest: usize,
    samples: usize,
    output: Option<PathBuf>,
}

fn asked() -> Result<Request> {
    let mut asked = Request {
        what: String::new(),
        path: PathBuf::new(),
        env: "assets/sky_512x256.hdr".into(),
        cell_m: None,
        side: 0,
        largest: 1024,
        samples: 11,
        output: None,
    };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut text = || args.next().ok_or_else(|| Error::setting(&arg, "nothing", "a value"));
        let whole =
            |text: String| text.parse().map_err(|_| Error::setting(&arg, text, "a whole number"));
        match arg.as_str() {
            "--env" => asked.env = text()?.into(),
            "--cell" => {
                let text = text()?;
                let parts: Vec<f64> = text.split(',').filter_map(|p| p.parse().ok()).collect();
                let [x, y] = parts[..] else { return Err(Error::setting("--cell", text, "X,Y")) };
                asked.cell_m = Some([x, y]);
            }
            "--side" => asked.side = whole(text()?)?,
            "--largest" => asked.largest = whole(text()?)?,
            "--samples" => asked.samples = whole(text()?)?,
            "-o" => asked.output = Some(text()?.into()),
            _ if asked.what.is_empty() => asked.what = arg,
            _ => asked.path = arg.into(),
        }
    }
    Ok(asked)
}

fn under(field: HeightField, environment: Environment) -> Scene {
    let lights = Lights { environment: Some(environment), ..Lights::default() };
    Scene { field, surface: Surface::default(), lights }
}

/// A plan's first output after so many draws, the first of which compiles, and the times of the others.
fn drawn(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
    draws: usize,
) -> Result<(Vec<f32>, Plan, Vec<Vec<Timing>>)> {
    let plan = plan::picture(scene, quality, &gpu.report().limits, Picture::default())?;
    let kept = plan.clone();
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let (pixels, times) = gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        let times = (1..draws).map(|_| gpu.draw(frame)).collect::<Result<Vec<_>>>()?;
        Ok((gpu.pixels(frame, 0)?, times))
    })?;
    Ok((colours(&pixels), kept, times))
}

fn colours(pixels: &Pixels) -> Vec<f32> {
    pixels.values.chunks_exact(pixels.channels).flat_map(|t| t[..3].to_vec()).collect()
}

/// Every crossing in 256 azimuths, by tables of 1024 elevations.
fn truth(gpu: &mut Headless, scene: &Scene) -> Result<Vec<f32>> {
    let quality = Quality {
        method: Method::BruteForce,
        azimuths: 256,
        table_elevations: 1024,
        ..Quality::default()
    };
    Ok(drawn(gpu, scene, &quality, 1)?.0)
}

/// Relative RMSE, %.
fn off(found: &[f32], truth: &[f32]) -> Result<f64> {
    Ok(100.0 * ImageError::of(found, truth, 3)?.relative_rmse)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn write(output: Option<&Path>, svg: &str) -> Result<()> {
    let Some(path) = output else { return Ok(()) };
    std::fs::write(path, svg).map_err(|source| Error::Io { path: path.to_owned(), source })
}

fn run() -> Result<()> {
    let asked = asked()?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!("{}", gpu.report().name);
    let field = || {
        let options = files::HeightOptions { cell_m: asked.cell_m, ..Default::default() };
        files::read_heights(&asked.path, &options)
    };
    match asked.what.as_str() {
        "wedges" => {
            wedges::run(&middle(&field()?, if asked.side > 0 { asked.side } else { 128 })?);
            Ok(())
        }
        "converge" => {
            let field = field()?;
            let side = if asked.side > 0 { asked.side } else { 128 };
            let environment = files::read_environment(&asked.env, 0.0)?;
            let scene = under(middle(&field, side)?, environment);
            write(asked.output.as_deref(), &converge::run(&mut gpu, &scene)?)
        }
        "sizes" => sizes::run(&mut gpu, asked.largest, asked.samples),
        "rivals" => {
            let side = if asked.side > 0 { asked.side } else { 192 };
            let svg = rivals::run(&mut gpu, &asked.path, side, asked.samples)?;
            write(asked.output.as_deref(), &svg)
        }
        other => Err(Error::setting("what", other, "converge, sizes, wedges or rivals")),
    }
}

fn main() -> std::process::ExitCode {
    match run() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            std::process::ExitCode::FAILURE
        }
    }
}

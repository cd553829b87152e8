//! How far each engine of bounces is from the truth, and what it costs.
//!
//! `cargo run --release --example bounce -- [FOLDER] [--side N] [--spp N] [--rim N] [-o FILE.svg]`
//!
//! First spherical pits, their rim N (30) cells from the middle, beside their closed form: RMSE over the radiance, at
//! samples up to half of the rim's distance. Then the middle N² (64) samples of real fields under environments, for
//! two albedos, one and three bounces, beside N (8192) light paths a sample: what is bounced alone, and the whole; and
//! three bounces of albedo 0.8 under each field's first environment by azimuths, as FILE.svg draws them.
//! FOLDER has `height/` and `env/`; without it, the bundled mountain and sky. Milliseconds are those of the passes
//! for bounces, sweeps included.
//!
//! `… -- table [--side N] [--samples K]` the paper's table 1 (Nowrouzezahrai & Snyder 2009): a frame of N² (512)
//! samples, 2× sub-sampled, with one, two and three bounces over one without; and what sub-sampling takes off.

#[path = "bounce/nodes.rs"]
mod nodes;
#[path = "soft/plot.rs"]
mod plot;
#[path = "bounce/real.rs"]
mod real;
#[path = "bounce/table.rs"]
mod table;

use std::path::PathBuf;

use ridgelight::gpu::{Headless, HeadlessOptions, Pixels};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, HeightField, Lights, Quality, Scene, Surface,
};
use ridgelight::{Error, Result};

const ENGINES: [BounceEngine; 3] =
    [BounceEngine::Brute, BounceEngine::Sweep, BounceEngine::Pyramid];

struct Asked {
    is_table: bool,
    folder: Option<PathBuf>,
    side: Option<usize>,
    samples: usize,
    paths: u32,
    rim: u32,
    output: Option<PathBuf>,
}

fn asked() -> Result<Asked> {
    let mut asked = Asked {
        is_table: false,
        folder: None,
        side: None,
        samples: 11,
        paths: 8192,
        rim: 30,
        output: None,
    };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut whole = || {
            let text = args.next().unwrap_or_default();
            let number: Option<u32> = text.parse().ok().filter(|n| *n > 1);
            number.ok_or_else(|| Error::setting(&arg, text, "a whole number, 2 or more"))
        };
        match arg.as_str() {
            "table" => asked.is_table = true,
            "--side" => asked.side = Some(whole()? as usize),
            "--samples" => asked.samples = whole()? as usize,
            "--spp" => asked.paths = whole()?,
            "--rim" => asked.rim = whole()?,
            "-o" => asked.output = args.next().map(PathBuf::from),
            _ => asked.folder = Some(arg.into()),
        }
    }
    Ok(asked)
}

/// Linear RGB of all samples.
type Colours = Vec<[f64; 3]>;

struct Drawn {
    whole: Colours,
    /// All bounces.
    bounced: Colours,
    ms: f64,
}

fn colours(pixels: &Pixels) -> Colours {
    let channel = |t: &[f32], c: usize| f64::from(t[c.min(t.len() - 1)]);
    pixels.values.chunks_exact(pixels.channels).map(|t| [0, 1, 2].map(|c| channel(t, c))).collect()
}

/// Drawn twice: the first draw warms up.
fn drawn(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<Drawn> {
    let wanted = Picture { light_layers: true, ..Picture::default() };
    let plan = plan::picture(scene, quality, &gpu.report().limits, wanted)?;
    let layers: Vec<String> = plan.outputs().map(|(_, r)| r.name.clone()).collect();
    let first =
        plan.passes.iter().rposition(|p| p.part.starts_with("env") || p.part.starts_with("sky"));
    let first = first.map_or(0, |i| i + 1);
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        let times = gpu.draw(frame)?;
        let ms = times[first..].iter().map(|t| t.ns).sum::<f64>() / 1e6;
        let whole = colours(&gpu.pixels(frame, 0)?);
        let mut bounced = vec![[0.0; 3]; whole.len()];
        for (i, _) in layers.iter().enumerate().filter(|(_, name)| name.starts_with("indirect.")) {
            for (sum, more) in bounced.iter_mut().zip(colours(&gpu.pixels(frame, i)?)) {
                *sum = [0, 1, 2].map(|c| sum[c] + more[c]);
            }
        }
        Ok(Drawn { whole, bounced, ms })
    })
}

/// As many azimuths of direct light as of bounces.
fn quality(bounces: Bounces) -> Quality {
    Quality { azimuths: bounces.azimuths, bounces, ..Quality::default() }
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (squares, count) = values.fold((0.0, 0.0), |(s, n), v| (s + v * v, n + 1.0));
    f64::sqrt(squares / f64::max(count, 1.0))
}

fn mean(all: &Colours) -> f64 {
    all.as_flattened().iter().sum::<f64>() / (3 * all.len()) as f64
}

/// RMSE over the mean of the truth, %.
fn off(found: &Colours, truth: &Colours) -> f64 {
    let pairs = found.as_flattened().iter().zip(truth.as_flattened());
    100.0 * rms(pairs.map(|(a, b)| a - b)) / mean(truth)
}

/// The spherical pit of half-angle `alpha`, its rim so many cells from the middle of a field that ends two beyond.
fn pit(rim: f64, alpha: f64) -> Result<HeightField> {
    let (sphere, middle) = (rim / alpha.sin(), rim.ceil() + 1.0);
    let side = 2 * middle as usize + 1;
    let height = |i: usize| {
        let away = ((i / side) as f64 - middle).hypot((i % side) as f64 - middle).min(rim);
        -(sphere * sphere - away * away).sqrt()
    };
    let heights: Vec<f64> = (0..side * side).map(height).collect();
    HeightField::new(side, side, &heights, [1.0; 2], None)
}

/// All points of the pit see the sky with s = (1 + cos α)/2 and the pit, equally bright, with 1 - s.
fn pit_radiance(alpha: f64, albedo: f64, bounces: u32) -> f64 {
    let share = 0.5 * (1.0 + alpha.cos());
    let again = albedo * (1.0 - share);
    albedo * share * (1.0 - again.powi(bounces as i32 + 1)) / (1.0 - again)
}

fn pits(gpu: &mut Headless, rim: u32) -> Result<()> {
    println!(
        "Spherical pits under a sky of 1, rim {rim} cells away: RMSE over the closed form, %\n"
    );
    println!("| half-angle | albedo | bounces | azimuths | brute | sweep | pyramid |");
    println!("|---|---|---|---|---|---|---|");
    let rim = f64::from(rim) + 0.5;
    for (alpha, albedo) in [(0.8, 0.5_f32), (1.2, 0.9)] {
        let field = pit(rim, alpha)?;
        let side = field.cols();
        let surface =
            Surface { albedo: Albedo::Constant([albedo; 3]), border: Border::Plane, phong: None };
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let scene = Scene { field, surface, lights };
        for (count, azimuths) in [(0, 64), (1, 64), (4, 64), (4, 256)] {
            let expected = pit_radiance(alpha, albedo.into(), count);
            let mut cells = Vec::new();
            for engine in ENGINES {
                let bounces =
                    Bounces { count, engine, azimuths, cutoff: 0.0, ..Bounces::default() };
                let whole = drawn(gpu, &scene, &quality(bounces))?.whole;
                let middle = (side / 2) as f64;
                let inner = whole.iter().enumerate().filter(|(i, _)| {
                    let [r, c] = [i / side, i % side].map(|n| n as f64 - middle);
                    r.hypot(c) <= 0.5 * rim
                });
                let error = rms(inner.map(|(_, v)| v[0] - expected)) / expected;
                cells.push(format!("{:.3}", 100.0 * error));
            }
            println!("| {alpha} | {albedo} | {count} | {azimuths} | {} |", cells.join(" | "));
        }
    }
    println!();
    Ok(())
}

/// The middle of a field, at most `side`² samples.
fn middle(field: &HeightField, side: usize) -> Result<HeightField> {
    let [rows, cols] = [field.rows(), field.cols()].map(|n| n.min(side));
    let first = [(field.rows() - rows) / 2, (field.cols() - cols) / 2];
    let at = |i: usize| (first[0] + i / cols) * field.cols() + first[1] + i % cols;
    let heights: Vec<f64> = (0..rows * cols).map(|i| f64::from(field.heights_m()[at(i)])).collect();
    HeightField::new(rows, cols, &heights, field.cell_m(), None)
}

fn run() -> Result<()> {
    let asked = asked()?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!("{}, {}\n", gpu.report().name, gpu.report().driver);
    if asked.is_table {
        table::run(&mut gpu, asked.side.unwrap_or(512), asked.samples)?;
        return nodes::run(&mut gpu);
    }
    pits(&mut gpu, asked.rim)?;
    let side = asked.side.unwrap_or(64);
    let svg = real::run(&mut gpu, asked.folder.as_deref(), side, asked.paths)?;
    let Some(path) = asked.output else { return Ok(()) };
    std::fs::write(&path, svg).map_err(|source| Error::Io { path, source })
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

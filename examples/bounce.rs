//! How far each engine of bounces is from the truth, and what it costs.
//!
//! `cargo run --release --example bounce -- [FOLDER] [--side N] [--spp N] [--rim N] [-o FILE.svg]`
//!
//! First spherical pits, their rim N (30) cells from the middle, beside their closed form: RMSE over the radiance, at
//! samples up to half of the rim's distance, with what f64 leaves on the same field, and of a rim without a staircase. Then the middle N² (64) samples of real fields under environments, for
//! two albedos, one and three bounces, beside N (8192) light paths a sample: what is bounced alone, and the whole; and
//! three bounces of albedo 0.8 under each field's first environment by azimuths, as FILE.svg draws them.
//! FOLDER has `height/` and `env/`; without it, the bundled mountain and sky. Milliseconds are those of the passes
//! for bounces, sweeps included.
//!
//! `… -- table [--side N] [--samples K]` the paper's table 1 (Nowrouzezahrai & Snyder 2009): a frame of N² (512)
//! samples, 2× sub-sampled, with one, two and three bounces over one without; and what sub-sampling takes off.

#[path = "shared/middle.rs"]
mod middle;
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
    Albedo, Border, BounceEngine, Bounces, HeightField, Lights, Method, Quality, Scene, Surface,
};
use ridgelight::{Error, Result};
use ridgelight_cpu::bounce_march::bounce_march;
use ridgelight_cpu::light::sky_of;
use ridgelight_cpu::oracle::Oracle;

const ENGINES: [BounceEngine; 3] =
    [BounceEngine::BruteForce, BounceEngine::Sweep, BounceEngine::Pyramid];

struct Request {
    is_table: bool,
    folder: Option<PathBuf>,
    side: Option<usize>,
    samples: usize,
    paths: u32,
    rim: u32,
    output: Option<PathBuf>,
}

fn asked() -> Result<Request> {
    let mut asked = Request {
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

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// The median of what draws take, after one that warms up: of five, of one where it takes half a second.
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
        let mut draw = || -> Result<f64> {
            Ok(gpu.draw(frame)?[first..].iter().map(|t| t.ns).sum::<f64>() / 1e6)
        };
        let draws = if draw()? < 500.0 { 5 } else { 1 };
        let ms = median((0..draws).map(|_| draw()).collect::<Result<_>>()?);
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

/// The spherical pit of half-angle `alpha`, its rim so many cells from the middle of a field that ends two beyond. Where
/// `is_cone` samples of the plain beside the pit's stand on the cone from its lowest point through its rim, so that the
/// middle sees no staircase.
fn pit(rim: f64, alpha: f64, is_cone: bool) -> Result<HeightField> {
    let (sphere, middle) = (rim / alpha.sin(), rim.ceil() + 1.0);
    let side = 2 * middle as usize + 1;
    let away = |r: f64, c: f64| (r - middle).hypot(c - middle);
    let height = |i: usize| {
        let (r, c) = ((i / side) as f64, (i % side) as f64);
        let mut around = (0..9).map(|k| (r + f64::from(k / 3) - 1.0, c + f64::from(k % 3) - 1.0));
        let is_beside = is_cone && around.any(|(r, c)| away(r, c) <= rim);
        match away(r, c) - rim {
            ..=0.0 => -(sphere * sphere - away(r, c).powi(2)).sqrt(),
            beyond if is_beside => beyond * (0.5 * alpha).tan() - sphere * alpha.cos(),
            _ => -sphere * alpha.cos(),
        }
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

/// What a sky of 1 and so many bounces and fewer give by quadrature in f64 on the field itself, in 32 azimuths: how far
/// that is from the closed form is the field's.
fn quadrature(field: &HeightField, albedo: f64, bounces: u32) -> Vec<Vec<f64>> {
    const AZIMUTHS: u32 = 32;
    let oracle = Oracle::new(field, Border::Plane);
    let places = || (0..field.rows() * field.cols()).map(|i| (i / field.cols(), i % field.cols()));
    let sky = places().map(|(r, c)| [albedo * sky_of(&oracle, r, c, AZIMUTHS as usize); 3]);
    let mut layer: Colours = sky.collect();
    let mut all = vec![layer.iter().map(|l| l[0]).collect::<Vec<f64>>()];
    for _ in 0..bounces {
        let thrown = places().map(|(r, c)| bounce_march(&oracle, &layer, AZIMUTHS, r, c));
        layer = thrown.map(|l| l.map(|l| albedo * l)).collect();
        let before = all.last().expect("direct light");
        all.push(before.iter().zip(&layer).map(|(sum, l)| sum + l[0]).collect());
    }
    all
}

fn pits(gpu: &mut Headless, rim: u32) -> Result<()> {
    println!(
        "Spherical pits under a sky of 1, rim {rim} cells away, as it falls on the grid and on a cone that hides its \
         staircase from the middle: RMSE over the closed form, %; f64: of quadrature on the field, which is the field's own\n"
    );
    println!(
        "| half-angle | albedo | rim | bounces | azimuths | f64 | brute, brute's sky | brute | sweep | pyramid |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let rim = f64::from(rim) + 0.5;
    for (alpha, albedo, is_cone) in
        [(0.8, 0.5_f32, false), (0.8, 0.5, true), (1.2, 0.9, false), (1.2, 0.9, true)]
    {
        let field = pit(rim, alpha, is_cone)?;
        let side = field.cols();
        let truth = quadrature(&field, albedo.into(), 4);
        let surface = Surface {
            albedo: Albedo::Constant([albedo; 3]),
            border: Border::Plane,
            specular: None,
        };
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let scene = Scene { field, surface, lights };
        for (count, azimuths) in [(0, 64), (1, 64), (4, 64), (4, 256)] {
            let expected = pit_radiance(alpha, albedo.into(), count);
            let middle = (side / 2) as f64;
            let inner = |i: &usize| {
                let [r, c] = [i / side, i % side].map(|n| n as f64 - middle);
                r.hypot(c) <= 0.5 * rim
            };
            let error = |light: &dyn Fn(usize) -> f64| {
                let inner = (0..side * side).filter(inner);
                format!("{:.3}", 100.0 * rms(inner.map(|i| light(i) - expected)) / expected)
            };
            let mut cells = vec![error(&|i| truth[count as usize][i])];
            let ways = [(Method::BruteForce, BounceEngine::BruteForce)];
            for (method, engine) in ways.into_iter().chain(ENGINES.map(|e| (Method::Auto, e))) {
                let bounces =
                    Bounces { count, engine, azimuths, cutoff: 0.0, ..Bounces::default() };
                let quality = Quality { method, ..quality(bounces) };
                let whole = drawn(gpu, &scene, &quality)?.whole;
                cells.push(error(&|i| whole[i][0]));
            }
            let rim = if is_cone { "cone" } else { "grid" };
            println!(
                "| {alpha} | {albedo} | {rim} | {count} | {azimuths} | {} |",
                cells.join(" | ")
            );
        }
    }
    println!();
    Ok(())
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

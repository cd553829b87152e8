//! How far each engine of bounces is from the truth, and what it costs.
//!
//! `cargo run --release --example bounce -- [FOLDER] [--side N] [--spp N] [--rim N]`
//!
//! First spherical pits, their rim N (30) cells from the middle, beside their closed form: RMSE over the radiance, at
//! samples up to half of the rim's distance. Then the middle N² (64) samples of real fields under environments, for
//! two albedos, one and three bounces, beside N (1024) light paths a sample: what is bounced alone, and the whole.
//! FOLDER has `height/` and `env/`; without it, the bundled mountain and sky. Milliseconds are those of the passes
//! for bounces, sweeps included.

use std::path::{Path, PathBuf};

use ridgelight::files::{HeightOptions, read_environment, read_heights};
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture, REFERENCE_BATCH};
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, Environment, HeightField, Lights, Quality, Scene,
    Surface,
};
use ridgelight::{Error, Result};

const ENGINES: [BounceEngine; 3] =
    [BounceEngine::Brute, BounceEngine::Sweep, BounceEngine::Pyramid];

struct Asked {
    folder: Option<PathBuf>,
    side: usize,
    paths: u32,
    rim: u32,
}

fn asked() -> Result<Asked> {
    let mut asked = Asked { folder: None, side: 64, paths: 1024, rim: 30 };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut whole = || {
            let text = args.next().unwrap_or_default();
            let number: Option<u32> = text.parse().ok().filter(|n| *n > 1);
            number.ok_or_else(|| Error::setting(&arg, text, "a whole number, 2 or more"))
        };
        match arg.as_str() {
            "--side" => asked.side = whole()? as usize,
            "--spp" => asked.paths = whole()?,
            "--rim" => asked.rim = whole()?,
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

fn colours(pixels: &ridgelight::gpu::Pixels) -> Colours {
    let channel = |t: &[f32], c: usize| f64::from(t[c.min(t.len() - 1)]);
    pixels.values.chunks_exact(pixels.channels).map(|t| [0, 1, 2].map(|c| channel(t, c))).collect()
}

/// Drawn twice: the first draw warms up.
fn drawn(gpu: &mut Headless, scene: &Scene, bounces: Bounces) -> Result<Drawn> {
    let quality = Quality { azimuths: bounces.azimuths, bounces, ..Quality::default() };
    let wanted = Picture { light_layers: true, ..Picture::default() };
    let plan = plan::picture(scene, &quality, &gpu.report().limits, wanted)?;
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

/// Light paths' mean radiance, and its standard error.
fn traced(gpu: &mut Headless, scene: &Scene, bounces: u32, paths: u32) -> Result<[Colours; 2]> {
    let plan = plan::reference(scene, bounces, 1, &gpu.report().limits)?;
    let contents = plan::reference_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let passes = plan.passes.iter().enumerate();
    let bands: Vec<usize> = passes.filter(|(_, p)| p.name() == "path_trace").map(|b| b.0).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        for _ in 1..paths.div_ceil(REFERENCE_BATCH).max(2) {
            gpu.draw_passes(frame, &bands)?;
        }
        Ok([colours(&gpu.pixels(frame, 0)?), colours(&gpu.pixels(frame, 1)?)])
    })
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

fn less(a: &Colours, b: &Colours) -> Colours {
    a.iter().zip(b).map(|(a, b)| [0, 1, 2].map(|c| a[c] - b[c])).collect()
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
                let whole = drawn(gpu, &scene, bounces)?.whole;
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

type Named<T> = Vec<(&'static str, T)>;

fn inputs(folder: Option<&Path>, side: usize) -> Result<(Named<HeightField>, Named<Environment>)> {
    let plain = HeightOptions::default();
    let washington = HeightOptions { cell_m: Some([66.0, 92.6]), ..plain };
    let Some(folder) = folder else {
        let mountain = read_heights(Path::new("assets/mt_washington_256.png"), &washington)?;
        let sky = read_environment(Path::new("assets/sky_512x256.hdr"), 0.0)?;
        return Ok((vec![("Mt Washington", middle(&mountain, side)?)], vec![("sky", sky)]));
    };
    let rainier = HeightOptions { cell_m: Some([64.0, 92.6]), nodata: Some(-32768.0), ..plain };
    // 80 cells from black to white.
    let moss = HeightOptions { z_scale: 80.0 / 65535.0, cell_m: Some([1.0; 2]), ..plain };
    let fields = [
        ("Mt Washington", "mt_washington_256.png", washington),
        ("White Mountains", "N44W072.hgt", plain),
        ("Mt Rainier", "mt_rainier_90m.tif", rainier),
        ("moss", "Moss001_1K_Displacement.png", moss),
    ];
    let fields = fields.into_iter().map(|(name, file, options)| {
        let field = read_heights(&folder.join("height").join(file), &options)?;
        Ok((name, middle(&field, side)?))
    });
    let environments = [("sky", "sky_512x256.hdr"), ("room", "lab.hdr")];
    let environments = environments
        .into_iter()
        .map(|(name, file)| Ok((name, read_environment(&folder.join("env").join(file), 0.0)?)));
    Ok((fields.collect::<Result<_>>()?, environments.collect::<Result<_>>()?))
}

fn real(gpu: &mut Headless, asked: &Asked) -> Result<()> {
    let (fields, environments) = inputs(asked.folder.as_deref(), asked.side)?;
    let (side, paths) = (asked.side, asked.paths);
    println!(
        "The middle {side}² samples, {paths} paths: RMSE over the mean, %; noise: the paths' own, at most, as those without bounces begin alike\n"
    );
    println!(
        "| field | light | albedo | bounces | engine | bounced | noise | whole | noise | ms | over brute's |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for ((name, field), (light, environment)) in
        fields.iter().flat_map(|f| environments.iter().map(move |e| (f, e)))
    {
        for albedo in [0.3_f32, 0.8] {
            let lights = Lights { environment: Some(environment.clone()), ..Lights::default() };
            let albedo_of = Albedo::Constant([albedo; 3]);
            let surface = Surface { albedo: albedo_of, ..Surface::default() };
            let scene = Scene { field: field.clone(), surface, lights };
            let [direct, direct_error] = traced(gpu, &scene, 0, paths)?;
            for count in [1, 3] {
                let [whole, whole_error] = traced(gpu, &scene, count, paths)?;
                let bounced = less(&whole, &direct);
                let both = whole_error.as_flattened().iter().zip(direct_error.as_flattened());
                let noise = 100.0 * rms(both.map(|(a, b)| a.hypot(*b))) / mean(&bounced);
                let whole_noise =
                    100.0 * rms(whole_error.as_flattened().iter().copied()) / mean(&whole);
                let mut slowest = None;
                for engine in ENGINES {
                    let bounces =
                        Bounces { count, engine, azimuths: 64, cutoff: 0.0, ..Bounces::default() };
                    let got = drawn(gpu, &scene, bounces)?;
                    let over = got.ms / *slowest.get_or_insert(got.ms);
                    println!(
                        "| {name} | {light} | {albedo} | {count} | {} | {:.2} | {noise:.2} | {:.3} | {whole_noise:.3} | {:.1} | {over:.3} |",
                        engine.name(),
                        off(&got.bounced, &bounced),
                        off(&got.whole, &whole),
                        got.ms,
                    );
                }
            }
        }
    }
    Ok(())
}

fn run() -> Result<()> {
    let asked = asked()?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!("{}, {}\n", gpu.report().name, gpu.report().driver);
    pits(&mut gpu, asked.rim)?;
    real(&mut gpu, &asked)
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

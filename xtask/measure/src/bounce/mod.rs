//! Errors of each engine of bounces, and their times.
//!
//! First spherical pits, their rim N (30) cells from the middle, beside their closed form: RMSE relative to the
//! radiance, at grid points up to half of the rim's distance, with what f64 leaves on the same field, and of a rim
//! without a staircase. Then the middle N² (64) grid points of real fields under environments, for two albedos, one
//! and three bounces, beside N (8192) paths per grid point: the indirect light, and all light; and three bounces of
//! albedo 0.8 under each field's first environment by azimuths, as FILE.svg shows them. FOLDER has `height/` and
//! `env/`; without it, the bundled mountain and sky. Milliseconds are those of the passes for bounces, sweeps included.

mod real;
pub mod table;

use std::path::PathBuf;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::Picture;
use ridgelight::scene::{
    Border, BounceEngine, Bounces, HeightField, Lights, Method, Quality, Scene,
};
use ridgelight_cpu::bounce_march::bounce_march;
use ridgelight_cpu::light::sky_of;
use ridgelight_cpu::oracle::Oracle;

use crate::common::args::Args;
use crate::common::frames::{Colours, add, colours, device, open, rms, total, with_picture};
use crate::common::{Outcome, head, inputs, median, plot};

const ENGINES: [BounceEngine; 3] =
    [BounceEngine::BruteForce, BounceEngine::Sweep, BounceEngine::Pyramid];

struct Drawn {
    whole: Colours,
    /// All bounces.
    bounced: Colours,
    ms: f64,
}

/// The median time of draws after the first: of five, of one where it takes half a second.
fn drawn(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<Drawn> {
    let wanted = Picture { light_layers: true, ..Picture::default() };
    with_picture(gpu, scene, quality, wanted, |gpu, frame| {
        let plan = frame.plan();
        let layers: Vec<String> = plan.outputs().map(|(_, r)| r.name.clone()).collect();
        let is_direct = |part: &str| part.starts_with("env") || part.starts_with("sky");
        let first = plan.passes.iter().rposition(|p| is_direct(&p.part)).map_or(0, |i| i + 1);
        let mut draw = || -> Result<f64> { Ok(total(&gpu.draw(frame)?[first..])) };
        let draws = if draw()? < 500.0 { 5 } else { 1 };
        let ms = median((0..draws).map(|_| draw()).collect::<Result<_>>()?);
        let whole = colours(&gpu.pixels(frame, 0)?);
        let mut bounced = vec![[0.0; 3]; whole.len()];
        for (i, _) in layers.iter().enumerate().filter(|(_, name)| name.starts_with("indirect.")) {
            add(&mut bounced, 1.0, &colours(&gpu.pixels(frame, i)?));
        }
        Ok(Drawn { whole, bounced, ms })
    })
}

/// As many azimuths of direct light as of bounces.
fn quality(bounces: Bounces) -> Quality {
    Quality { azimuths: bounces.azimuths, bounces, ..Quality::default() }
}

/// The spherical pit of half-angle `alpha`, its rim so many cells from the middle of a field that ends two beyond. Where
/// `is_cone` grid points of the plain beside the pit's stand on the cone from its lowest point through its rim, so that
/// the middle sees no staircase.
fn pit(rim: f64, alpha: f64, is_cone: bool) -> Result<HeightField> {
    let (sphere, middle) = (rim / alpha.sin(), rim.ceil() + 1.0);
    let side = 2 * middle as usize + 1;
    let away = |r: f64, c: f64| (r - middle).hypot(c - middle);
    inputs::field(side, side, |row, col| {
        let (r, c) = (row as f64, col as f64);
        let mut around = (0..9).map(|k| (r + f64::from(k / 3) - 1.0, c + f64::from(k % 3) - 1.0));
        let is_beside = is_cone && around.any(|(r, c)| away(r, c) <= rim);
        match away(r, c) - rim {
            ..=0.0 => -(sphere * sphere - away(r, c).powi(2)).sqrt(),
            beyond if is_beside => beyond * (0.5 * alpha).tan() - sphere * alpha.cos(),
            _ => -sphere * alpha.cos(),
        }
    })
}

/// All points of the pit see the sky with s = (1 + cos α)/2 and the pit, equally bright, with 1 - s.
fn pit_radiance(alpha: f64, albedo: f64, bounces: u32) -> f64 {
    let share = 0.5 * (1.0 + alpha.cos());
    let again = albedo * (1.0 - share);
    albedo * share * (1.0 - again.powi(bounces as i32 + 1)) / (1.0 - again)
}

/// Radiance under a sky of 1 with so many bounces and fewer by quadrature in f64 on the field itself, in 32 azimuths:
/// its difference to the closed form is the field's.
fn quadrature(field: &HeightField, albedo: f64, bounces: u32) -> Vec<Vec<f64>> {
    const AZIMUTHS: u32 = 32;
    let oracle = Oracle::new(field, Border::Plane);
    let places = || (0..field.rows() * field.cols()).map(|i| (i / field.cols(), i % field.cols()));
    let sky = places().map(|(r, c)| [albedo * sky_of(&oracle, r, c, AZIMUTHS as usize); 3]);
    let mut layer: Colours = sky.collect();
    let mut all = vec![layer.iter().map(|l| l[0]).collect::<Vec<f64>>()];
    for _ in 0..bounces {
        let indirect = places().map(|(r, c)| bounce_march(&oracle, &layer, AZIMUTHS, r, c));
        layer = indirect.map(|l| l.map(|l| albedo * l)).collect();
        let before = all.last().expect("direct light");
        all.push(before.iter().zip(&layer).map(|(sum, l)| sum + l[0]).collect());
    }
    all
}

fn pits(gpu: &mut Headless, rim: u32) -> Result<()> {
    println!(
        "Spherical pits under a sky of 1, rim {rim} cells away, as it falls on the grid and on a cone that hides its \
         staircase from the middle: RMSE relative to the closed form, %; f64: of quadrature on the field, which is the field's own\n"
    );
    head(
        "| half-angle | albedo | rim | bounces | azimuths | f64 | brute, brute's sky | brute | sweep | pyramid |",
    );
    let rim = f64::from(rim) + 0.5;
    for (alpha, albedo, is_cone) in
        [(0.8, 0.5_f32, false), (0.8, 0.5, true), (1.2, 0.9, false), (1.2, 0.9, true)]
    {
        let field = pit(rim, alpha, is_cone)?;
        let side = field.cols();
        let truth = quadrature(&field, albedo.into(), 4);
        let surface = inputs::matte([albedo; 3], Border::Plane);
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

pub fn run(mut args: Args) -> Outcome {
    let (side, paths) = (args.number("--side", 64)?, args.number("--spp", 8192)?);
    let (rim, output) = (args.number("--rim", 30)?, args.path("-o")?);
    let folder = args.word().map(PathBuf::from);
    args.end()?;
    let mut gpu = open()?;
    println!("{}\n", device(&gpu));
    pits(&mut gpu, rim)?;
    let panels = real::run(&mut gpu, folder.as_deref(), side, paths)?;
    plot::write(output.as_deref(), &panels)
}

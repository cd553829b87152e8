//! What balls of light cost and how near they are to the truth: lamps over a fractal field, by their number and
//! their radius.
//!
//! `cargo run --release --example lights -- [SIDE]`: grid points a side of the field (512).
//!
//! `… -- cones [-o SHEET.png]`: spherical harmonics beside the exact form, on the scene of cones of the thesis on local
//! lights: its figures 6.1 and 6.2 with errors, details to a PNG; its tables 6.1 to 6.4 as ratios.

#[path = "lights/cones.rs"]
mod cones;

use std::path::Path;
use std::time::{Duration, Instant};

use ridgelight::gpu::{Frame, Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::fractal;
use ridgelight::scene::{HeightField, Lights, Quality, Scene, SphereLight, Surface};
use ridgelight::{Error, Result};
use ridgelight_cpu::lit::Lit;

const COUNTS: [usize; 3] = [1, 8, 64];
/// In cells of 1 m.
const RADII_M: [f64; 2] = [0.25, 4.0];
/// Of the lamps' middles over the ground.
const ABOVE_M: f64 = 12.0;
/// Draws after one to warm up, unless they take longer together.
const DRAWS: usize = 5;
const LONGEST: Duration = Duration::from_secs(20);
/// Samples held against the oracle.
const PLACES: usize = 60;

/// Lamps on a lattice, alike far from each other.
fn lamps(field: &HeightField, count: usize, radius_m: f64) -> Vec<SphereLight> {
    let (across, side) = ((count as f64).sqrt().ceil() as usize, field.cols());
    let lamp = |i: usize| {
        let place = |k: usize| ((2 * k + 1) * side / (2 * across)).min(side - 1);
        let (col, up) = (place(i % across), place(i / across));
        let row = side - 1 - up;
        let ground = field.base_m() + f64::from(field.heights_m()[row * side + col]);
        let position_m = [col as f64, up as f64, ground + ABOVE_M];
        SphereLight { position_m, radius_m, radiance: [1.0; 3] }
    };
    (0..count).map(lamp).collect()
}

/// RMSE over the mean of the truth.
fn error(scene: &Scene, values: &[f32]) -> f64 {
    let lit = Lit::of(scene);
    let (mut squares, mut sum) = (0.0, 0.0);
    for k in 1..=PLACES {
        // Multiples of the golden ratio's share of the field: no two near each other.
        let i = ((k as f64 * 0.618_033_988_749_895).fract() * values.len() as f64) as usize;
        let truth = lit.at(i / scene.field.cols(), i % scene.field.cols())[0];
        squares += (f64::from(values[i]) - truth).powi(2);
        sum += truth;
    }
    (squares / PLACES as f64).sqrt() * PLACES as f64 / sum
}

/// Milliseconds of a frame, by the device's timestamps, once it has been drawn.
fn typical_ms(gpu: &mut Headless, frame: &mut Frame) -> Result<f64> {
    gpu.draw(frame)?;
    let begun = Instant::now();
    let mut times: Vec<f64> = Vec::new();
    while times.is_empty() || (times.len() < DRAWS && begun.elapsed() < LONGEST) {
        times.push(gpu.draw(frame)?.iter().map(|t| t.ns).sum::<f64>() / 1e6);
    }
    times.sort_by(f64::total_cmp);
    Ok(times[times.len() / 2])
}

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let report = gpu.report().clone();
    let device = format!("{}, {}", report.name, report.driver);
    match args.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["cones"] => {
            println!("{device}");
            cones::run(&mut gpu, None)
        }
        ["cones", "-o", path] => {
            println!("{device}");
            cones::run(&mut gpu, Some(Path::new(path)))
        }
        [] => lamps_of(&mut gpu, &device, 512),
        [text] => {
            let side = text.parse();
            let wrong = |_| Error::setting("SIDE", text, "a whole number, 1 or more, or cones");
            lamps_of(&mut gpu, &device, side.map_err(wrong)?)
        }
        _ => Err(Error::setting("arguments", args.join(" "), "SIDE, or cones -o SHEET.png")),
    }
}

/// By number and radius.
fn lamps_of(gpu: &mut Headless, device: &str, side: usize) -> Result<()> {
    let field = fractal(side, 1)?;
    println!("{device}: {side}², {ABOVE_M} m above a fractal in cells of 1 m");
    println!();
    println!("| lights | radius m | frame ms | ms a light | RMSE % |");
    println!("|---|---|---|---|---|");
    for (radius_m, count) in RADII_M.into_iter().flat_map(|r| COUNTS.map(|c| (r, c))) {
        let spheres = lamps(&field, count, radius_m);
        let lights = Lights { sphere_lights: spheres, ..Lights::default() };
        let scene = Scene { field: field.clone(), surface: Surface::default(), lights };
        let limits = gpu.report().limits;
        let plan = plan::picture(&scene, &Quality::default(), &limits, Picture::default())?;
        let (ms, values) = gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
            let ms = typical_ms(gpu, frame)?;
            Ok((ms, gpu.pixels(frame, 0)?.values))
        })?;
        let off = 100.0 * error(&scene, &values);
        println!("| {count} | {radius_m} | {ms:.1} | {:.1} | {off:.3} |", ms / count as f64);
    }
    Ok(())
}

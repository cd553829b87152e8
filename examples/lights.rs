//! What balls of light cost and how near they are to the truth: lamps over a fractal field, by their number and
//! their radius.
//!
//! `cargo run --release --example lights -- [SIDE]`: samples a side of the field (512).

use std::time::{Duration, Instant};

use ridgelight::cpu::lit::Lit;
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::measure::fractal::fractal;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{HeightField, Lights, Quality, Scene, SphereLight, Surface};
use ridgelight::{Error, Result};

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

fn main() -> Result<()> {
    let side = match std::env::args().nth(1) {
        Some(text) => {
            text.parse().map_err(|_| Error::setting("SIDE", &text, "a whole number, 1 or more"))?
        }
        None => 512,
    };
    let field = fractal(side, 1)?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let report = gpu.report().clone();
    println!(
        "{}, {}: {side}², {ABOVE_M} m above a fractal in cells of 1 m",
        report.name, report.driver
    );
    println!();
    println!("| lights | radius m | frame ms | ms a light | RMSE % |");
    println!("|---|---|---|---|---|");
    for (radius_m, count) in RADII_M.into_iter().flat_map(|r| COUNTS.map(|c| (r, c))) {
        let spheres = lamps(&field, count, radius_m);
        let lights = Lights { spheres, ..Lights::default() };
        let scene = Scene { field: field.clone(), surface: Surface::default(), lights };
        let plan = plan::picture(&scene, &Quality::default(), &report.limits, Picture::default())?;
        let (mut times, values) =
            gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
                gpu.draw(frame)?;
                let begun = Instant::now();
                let mut times: Vec<f64> = Vec::new();
                while times.is_empty() || (times.len() < DRAWS && begun.elapsed() < LONGEST) {
                    times.push(gpu.draw(frame)?.iter().map(|t| t.ns).sum::<f64>() / 1e6);
                }
                Ok((times, gpu.pixels(frame, 0)?.values))
            })?;
        times.sort_by(f64::total_cmp);
        let ms = times[times.len() / 2];
        let off = 100.0 * error(&scene, &values);
        println!("| {count} | {radius_m} | {ms:.1} | {:.1} | {off:.3} |", ms / count as f64);
    }
    Ok(())
}

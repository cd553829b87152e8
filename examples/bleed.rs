//! Draws docs/pictures/bleed.png: a white floor within a red wall under a low sun and a dim sky, without
//! bounces, as Ridgelight lights it, and by light paths, side by side; and prints how far off each is.
//!
//! `cargo run --release --example bleed -- -o PICTURE.png`

#[path = "shared/traced.rs"]
mod traced;

use std::path::Path;

use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::Tone;
use ridgelight::scene::{
    Albedo, BounceEngine, Bounces, Fuse, HeightField, Lights, Quality, Scene, Sun, Surface,
};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_trade::error::ImageError;
use traced::traced;

/// Samples a side, a metre apart.
const SIDE: usize = 160;
/// The wall's height and the breadth of its flanks, m.
const TOP: f64 = 30.0;
const FLANK: f64 = 3.0;
/// White columns between pictures.
const GAP: usize = 4;
const BOUNCES: u32 = 3;
/// Of 64 light paths each.
const BATCHES: u32 = 16;

/// How far a sample is inside the foot of the wall, m: half a ring, open to the west.
fn within_wall(row: usize, col: usize) -> f64 {
    let (radius, half_width) = (56.0, 8.0);
    let middle = (SIDE / 2) as f64;
    let (x, y) = (col as f64 - 0.75 * middle, row as f64 - middle);
    let from_ring = if x > 0.0 { x.hypot(y) - radius } else { x.hypot(y.abs() - radius) };
    half_width - from_ring.abs()
}

fn scene() -> Result<Scene> {
    let depths: Vec<f64> = (0..SIDE * SIDE).map(|i| within_wall(i / SIDE, i % SIDE)).collect();
    let heights: Vec<f64> = depths.iter().map(|d| TOP * (d / FLANK).clamp(0.0, 1.0)).collect();
    // A cell farther out: the normals of samples at the foot lean as the flank does.
    let colour = |depth: &f64| if *depth > -1.5 { [0.8, 0.06, 0.04] } else { [0.8; 3] };
    let sun = Sun {
        azimuth_rad: 170_f64.to_radians(),
        elevation_rad: 20_f64.to_radians(),
        diameter_rad: 0.53_f64.to_radians(),
        irradiance: [3.0; 3],
    };
    let lights = Lights { sky: Some([0.1; 3]), suns: vec![sun], ..Lights::default() };
    let albedo = Albedo::Map(depths.iter().map(colour).collect());
    let field = HeightField::new(SIDE, SIDE, &heights, [1.0; 2], None)?;
    Ok(Scene { field, surface: Surface { albedo, ..Surface::default() }, lights })
}

/// The picture that the device draws, and its time, ms.
fn drawn(gpu: &mut Headless, scene: &Scene, count: u32) -> Result<(Vec<f32>, f64)> {
    let engine = BounceEngine::Sweep;
    let bounces = Bounces { count, engine, azimuths: 64, ..Bounces::default() };
    let quality = Quality { fuse: Fuse::AimedAround, bounces, ..Quality::default() };
    let plan = plan::picture(scene, &quality, &gpu.report().limits, Picture::default())?;
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        let ns: f64 = gpu.draw(frame)?.iter().map(|t| t.ns).sum();
        Ok((gpu.pixels(frame, 0)?.values, ns / 1e6))
    })
}

fn colours(values: &[f32]) -> Vec<[f32; 3]> {
    values.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect()
}

fn run(out: &Path) -> Result<()> {
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let scene = scene()?;
    let (off, off_ms) = drawn(&mut gpu, &scene, 0)?;
    let (ours, ours_ms) = drawn(&mut gpu, &scene, BOUNCES)?;
    let [truth, noise] = traced(&mut gpu, &scene, BOUNCES, BATCHES)?.map(|v| colours(&v));
    let pictures = [colours(&off), colours(&ours), truth];
    let [_, _, truth] = &pictures;
    println!(
        "{}: a red wall on a white floor, {SIDE}² samples, {BOUNCES} bounces, {} paths; RMSE over the mean, %\n",
        gpu.report().name,
        64 * BATCHES
    );
    println!("| picture | whole | ms |\n|---|---|---|");
    for (name, picture, ms) in
        [("without bounces", &pictures[0], off_ms), ("ours", &pictures[1], ours_ms)]
    {
        let error = ImageError::of(picture.as_flattened(), truth.as_flattened(), 3)?.relative_rmse;
        println!("| {name} | {:.2} | {ms:.1} |", 100.0 * error);
    }
    let zero = vec![0.0; 3 * truth.len()];
    let of = |a: &[f32]| ImageError::of(a, &zero, 3).map(|e| e.rmse);
    let mean = truth.as_flattened().iter().map(|v| f64::from(*v)).sum::<f64>() / zero.len() as f64;
    println!("\nthe paths' own standard error: {:.2} %", 100.0 * of(noise.as_flattened())? / mean);

    let mut picture = Vec::new();
    for row in 0..SIDE {
        for (i, panel) in pictures.iter().enumerate() {
            if i > 0 {
                picture.extend([[1.0; 3]; GAP]);
            }
            picture.extend_from_slice(&panel[row * SIDE..(row + 1) * SIDE]);
        }
    }
    let width = 3 * SIDE + 2 * GAP;
    files::write_png(out, SIDE, width, &picture, None, Tone { exposure: 1.4 }, &[])
}

fn main() -> std::process::ExitCode {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let done = match args.as_slice() {
        [flag, out] if flag == "-o" => run(Path::new(out)),
        _ => Err(Error::setting("-o", args.join(" "), "-o and a picture's name, .png")),
    };
    match done {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            std::process::ExitCode::FAILURE
        }
    }
}

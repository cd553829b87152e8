//! docs/pictures/bleed.png: a white floor within a red wall under a low sun and a dim sky, without bounces, as
//! Ridgelight lights it, and path-traced; and the errors.

use ridgelight::Result;
use ridgelight::plan::REFERENCE_BATCH;
use ridgelight::scene::{
    Albedo, BounceEngine, Bounces, Fuse, Lights, Quality, Scene, Sun, Surface,
};

use crate::common::args::Args;
use crate::common::frames::{drawn, error, mean, open, rms, to_f32, traced};
use crate::common::{Outcome, inputs, panels};

/// Grid points a side, a metre apart.
const SIDE: usize = 160;
/// The wall's height and the breadth of its flanks, m.
const TOP: f64 = 30.0;
const FLANK: f64 = 3.0;
const BOUNCES: u32 = 3;
const BATCHES: u32 = 16;

/// How far a grid point is inside the foot of the wall, m: half a ring, open to the west.
fn within_wall(row: usize, col: usize) -> f64 {
    let (radius, half_width) = (56.0, 8.0);
    let middle = (SIDE / 2) as f64;
    let (x, y) = (col as f64 - 0.75 * middle, row as f64 - middle);
    let from_ring = if x > 0.0 { x.hypot(y) - radius } else { x.hypot(y.abs() - radius) };
    half_width - from_ring.abs()
}

fn scene() -> Result<Scene> {
    // A cell farther out: the normals at the foot lean as the flank does.
    let colour = |i: usize| match within_wall(i / SIDE, i % SIDE) > -1.5 {
        true => [0.8, 0.06, 0.04],
        false => [0.8; 3],
    };
    let albedo = Albedo::Map((0..SIDE * SIDE).map(colour).collect());
    let sun = Sun {
        azimuth_rad: 170_f64.to_radians(),
        elevation_rad: 20_f64.to_radians(),
        diameter_rad: 0.53_f64.to_radians(),
        irradiance: [3.0; 3],
    };
    let height = |row, col| TOP * (within_wall(row, col) / FLANK).clamp(0.0, 1.0);
    Ok(Scene {
        field: inputs::field(SIDE, SIDE, height)?,
        surface: Surface { albedo, ..Surface::default() },
        lights: Lights { sky: Some([0.1; 3]), suns: vec![sun], ..Lights::default() },
    })
}

pub fn run(mut args: Args) -> Outcome {
    let output = args.needed("-o")?;
    args.end()?;
    let (mut gpu, scene) = (open()?, scene()?);
    let quality = |count| {
        let bounces =
            Bounces { count, engine: BounceEngine::Sweep, azimuths: 64, ..Bounces::default() };
        Quality { fuse: Fuse::AimedAround, bounces, ..Quality::default() }
    };
    let direct = drawn(&mut gpu, &scene, &quality(0), 1)?;
    let ours = drawn(&mut gpu, &scene, &quality(BOUNCES), 1)?;
    let [truth, noise] = traced(&mut gpu, &scene, BOUNCES, BATCHES)?;
    println!(
        "{}: a red wall on a white floor, {SIDE}² grid points, {BOUNCES} bounces, {} paths; relative RMSE, %\n",
        gpu.report().name,
        REFERENCE_BATCH * BATCHES
    );
    println!("| picture | whole | ms |\n|---|---|---|");
    for (name, picture) in [("without bounces", &direct), ("ours", &ours)] {
        println!("| {name} | {:.2} | {:.1} |", error(&picture.light, &truth)?, picture.ms());
    }
    let noise = 100.0 * rms(noise.as_flattened().iter().copied()) / mean(&truth);
    println!("\nstandard error of the path-traced picture: {noise:.2} %");
    let row = [&direct.light, &ours.light, &truth].map(|light| to_f32(light)).to_vec();
    Ok(panels::write(&output, &[row], SIDE, 1, 1.4)?)
}

//! Light scattered over visible points (Heidrich et al. 2000) beside the path-traced reference: three bounces on grooves,
//! N² (32) grid points that repeat, and on the moss of FOLDER, by directions and paths. The picture: direct light,
//! all light by most directions and paths, and path-traced, of each.

pub mod brdf;
pub mod geometry;
mod strip;

use std::path::{Path, PathBuf};

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, REFERENCE_BATCH};
use ridgelight::scene::{
    Albedo, Border, Directions, Lights, Scatter, Scene, Sun, Surface, VisiblePoints,
};

use crate::common::args::Args;
use crate::common::frames::{
    Colours, add, colours, device, error, mean, minus, open, rms, slices, to_f32, total, traced,
    visible,
};
use crate::common::{Outcome, head, inputs, panels};

const BOUNCES: u32 = 3;
const DIRECTIONS: [usize; 3] = [64, 256, 1024];
const PATHS: [u32; 4] = [40, 100, 400, 1600];

/// A sun in the west-south-west over a dim sky.
fn lights() -> Lights {
    let sun = Sun {
        azimuth_rad: 200_f64.to_radians(),
        elevation_rad: 50_f64.to_radians(),
        diameter_rad: 0.53_f64.to_radians(),
        irradiance: [3.0; 3],
    };
    Lights { sky: Some([0.1; 3]), suns: vec![sun], ..Lights::default() }
}

fn scenes(folder: Option<&Path>, side: usize) -> Result<Vec<(&'static str, Scene)>> {
    // 16 columns from ridge to ridge, walls at right angles: those that look west red, the others white.
    let field = inputs::field(side, side, |_, col| (col % 16).abs_diff(8) as f64)?;
    let colour = |i: usize| if i % side % 16 > 8 { [0.8, 0.1, 0.1] } else { [0.8; 3] };
    let albedo = Albedo::Map((0..side * side).map(colour).collect());
    let surface = Surface { albedo, border: Border::Periodic, specular: None };
    let mut all = vec![("grooves", Scene { field, surface, lights: lights() })];
    if let Some(folder) = folder {
        let field = inputs::middle(&inputs::field_of(folder, inputs::MOSS)?, 2 * side)?;
        let albedo = Albedo::Constant([0.55, 0.7, 0.25]);
        let surface = Surface { albedo, ..Surface::default() };
        all.push(("moss", Scene { field, surface, lights: lights() }));
    }
    Ok(all)
}

/// Scattered light, and its milliseconds.
fn scattered(
    gpu: &mut Headless,
    scene: &Scene,
    points: &VisiblePoints,
    direct: &[[f32; 3]],
    paths: u32,
) -> Result<(Colours, f64)> {
    let scatter = Scatter { bounces: BOUNCES, paths, ..Scatter::default() };
    let plan = plan::scatter(scene, points.directions(), &scatter, &gpu.report().limits)?;
    let contents = plan::scatter_inputs(&plan, scene, points, direct)?;
    gpu.with_frame(plan, &slices(&contents), |gpu, frame| {
        gpu.draw(frame)?;
        let ms = total(&gpu.draw(frame)?);
        Ok((colours(&gpu.pixels(frame, 0)?), ms))
    })
}

/// Direct light, with scattered light, and path-traced.
fn one(gpu: &mut Headless, name: &str, scene: &Scene, batches: u32) -> Result<[Colours; 3]> {
    let [direct, _] = traced(gpu, scene, 0, batches)?;
    let [all, noise] = traced(gpu, scene, BOUNCES, batches)?;
    let truth = minus(&all, &direct);
    println!(
        "{name}, {} × {}, {BOUNCES} bounces; scattered light is {:.1} % of all; {} paths per grid point, standard error {:.2} % of it\n",
        scene.field.cols(),
        scene.field.rows(),
        100.0 * mean(&truth) / mean(&all),
        batches * REFERENCE_BATCH,
        100.0 * rms(noise.as_flattened().iter().copied()) / mean(&truth),
    );
    head("| directions | MB | ms to find | paths | RMSE, % of scattered | of all | ms |");
    let mut lit = direct.clone();
    for count in DIRECTIONS {
        let directions = Directions::fibonacci(count, -1.0, 0)?;
        let (points, found_ms) = visible(gpu, (&scene.field, scene.surface.border), &directions)?;
        let mb = 4.0 * points.words().len() as f64 / 1e6;
        for paths in PATHS {
            let (light, ms) = scattered(gpu, scene, &points, &to_f32(&direct), paths)?;
            let rmse = error(&light, &truth)?;
            println!(
                "| {count} | {mb:.1} | {found_ms:.1} | {paths} | {rmse:.2} | {:.2} | {ms:.2} |",
                rmse * mean(&truth) / mean(&all)
            );
            lit.clone_from(&direct);
            add(&mut lit, 1.0, &light);
        }
    }
    println!();
    Ok([direct, lit, all])
}

pub fn run(mut args: Args) -> Outcome {
    let (side, paths) = (args.number("--side", 32)?, args.number("--spp", 2048_u32)?);
    let output = args.path("-o")?;
    let folder = args.word().map(PathBuf::from);
    args.end()?;
    let mut gpu = open()?;
    println!("{}\n", device(&gpu));
    let mut rows = Vec::new();
    for (name, scene) in scenes(folder.as_deref(), side)? {
        let light = one(&mut gpu, name, &scene, paths.div_ceil(REFERENCE_BATCH))?;
        rows.push((light, scene.field.cols()));
    }
    let Some(path) = output else { return Ok(()) };
    // Of one size: the grooves repeat.
    let most = rows.iter().map(|row| row.1).max().unwrap_or(side);
    let panel = |light: &Colours, own: usize| {
        let texels = to_f32(light);
        (0..most * most).map(|i| texels[i / most % own * own + i % most % own]).collect()
    };
    let rows: Vec<Vec<panels::Panel>> = rows
        .iter()
        .map(|(lights, own)| lights.iter().map(|light| panel(light, *own)).collect())
        .collect();
    Ok(panels::write(&path, &rows, most, 3, 1.2)?)
}

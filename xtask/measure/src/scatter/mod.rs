//! Light scattered over visible points (Heidrich et al. 2000) against the path-traced reference: three
//! bounces on grooves, N² (32) grid points that repeat, and on the moss of FOLDER, by directions and
//! paths. The picture of each: direct light, all light by most directions and paths, and path-traced.

pub mod brdf;
pub mod geometry;

use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::REFERENCE_BATCH;
use ridgelight::scene::{Albedo, Border, Directions, Lights, Scatter, Scene, Surface};

use crate::common::args::Args;
use crate::common::frames::{Colours, add, device, error, mean, minus, rms_of, to_f32, traced};
use crate::common::plot::{self, Texels};
use crate::common::{Outcome, head, inputs};

const BOUNCES: u32 = 3;
const DIRECTIONS: [usize; 3] = [64, 256, 1024];
const PATHS: [u32; 4] = [40, 100, 400, 1600];

fn scenes(folder: Option<&Path>, side: usize) -> Result<Vec<(&'static str, Scene)>> {
    // A sun in the west-south-west over a dim sky.
    let suns = vec![inputs::sun(200.0, 50.0, [3.0; 3])];
    let lights = Lights { sky: Some([0.1; 3]), suns, ..Lights::default() };
    // 16 columns from ridge to ridge, walls at right angles: those that face west red, the others white.
    let field = inputs::field(side, side, |_, col| (col % 16).abs_diff(8) as f64)?;
    let colour = |i: usize| if i % side % 16 > 8 { [0.8, 0.1, 0.1] } else { [0.8; 3] };
    let albedo = Albedo::Map((0..side * side).map(colour).collect());
    let surface = Surface { albedo, border: Border::Periodic, specular: None };
    let mut all = vec![("grooves", Scene { field, surface, lights: lights.clone() })];
    if let Some(folder) = folder {
        let field = inputs::middle(&inputs::field_of(folder, inputs::MOSS)?, 2 * side)?;
        let mut scene = inputs::lit_by(field, lights);
        scene.surface.albedo = Albedo::Constant([0.55, 0.7, 0.25]);
        all.push(("moss", scene));
    }
    Ok(all)
}

/// Direct light, with scattered light, and path-traced.
fn one(gpu: &mut Headless, name: &str, scene: &Scene, batches: u32) -> Result<[Colours; 3]> {
    let [direct, _] = traced(gpu, scene, 0, batches)?;
    let [all, deviation] = traced(gpu, scene, BOUNCES, batches)?;
    let reference = minus(&all, &direct);
    println!(
        "{name}, {} × {}, {BOUNCES} bounces; scattered light is {:.1} % of all; {} paths per grid point, standard error {:.2} % of it\n",
        scene.field.cols(),
        scene.field.rows(),
        100.0 * mean(&reference) / mean(&all),
        batches * REFERENCE_BATCH,
        100.0 * rms_of(&deviation) / mean(&reference),
    );
    head("| directions | paths | RMSE, % of scattered | of all |");
    let (limits, ground) = (gpu.report().limits, (&scene.field, scene.surface.border));
    let mut lit = direct.clone();
    for count in DIRECTIONS {
        let directions = Directions::fibonacci(count, -1.0, 0)?;
        let points = gpu.visible_points(ground, &directions, &limits)?;
        for paths in PATHS {
            let scatter = Scatter { bounces: BOUNCES, paths, ..Scatter::default() };
            let light = gpu.scattered(scene, &points, &to_f32(&direct), &scatter, &limits)?;
            let light = light.iter().map(|t| t.map(f64::from)).collect();
            let rmse = error(&light, &reference)?;
            let of_all = rmse * mean(&reference) / mean(&all);
            println!("| {count} | {paths} | {rmse:.2} | {of_all:.2} |");
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
    let folder = args.folder();
    let mut gpu = args.open()?;
    println!("{}\n", device(&gpu));
    let mut rows = Vec::new();
    for (name, scene) in scenes(folder.as_deref(), side)? {
        let light = one(&mut gpu, name, &scene, paths.div_ceil(REFERENCE_BATCH))?;
        rows.push((light, scene.field.cols()));
    }
    let Some(path) = output else { return Ok(()) };
    // The grooves repeat up to the size of the largest.
    let most = rows.iter().map(|row| row.1).max().unwrap_or(side);
    let texels = |light: &Colours, own: usize| -> Texels {
        let texels = to_f32(light);
        (0..most * most).map(|i| texels[i / most % own * own + i % most % own]).collect()
    };
    let row = |(lights, own): &([Colours; 3], usize)| {
        lights.iter().map(|light| texels(light, *own)).collect()
    };
    let rows: Vec<Vec<Texels>> = rows.iter().map(row).collect();
    Ok(plot::png(&path, &rows, most, 3, 1.2)?)
}

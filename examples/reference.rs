//! How fast `ridgelight reference` follows light paths.
use std::path::{Path, PathBuf};
use std::time::Instant;

use ridgelight::files::{self, HeightOptions};
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::measure::fractal::fractal;
use ridgelight::plan::{self, REFERENCE_BATCH};
use ridgelight::scene::{Albedo, Environment, HeightField, Lights, Scene, Surface};
use ridgelight::{Error, Result};

fn crop(field: &HeightField, side: usize) -> Result<HeightField> {
    let (rows, cols) = (field.rows(), field.cols());
    let side = side.min(rows).min(cols);
    let [top, left] = [rows, cols].map(|n| (n - side) / 2);
    let at = |i: usize| (top + i / side) * cols + left + i % side;
    let heights: Vec<f64> =
        (0..side * side).map(|i| f64::from(field.heights_m()[at(i)]) + field.base_m()).collect();
    HeightField::new(side, side, &heights, field.cell_m(), None)
}

fn run(
    gpu: &mut Headless,
    scene: &Scene,
    bounces: u32,
    seed: u32,
    batches: u32,
) -> Result<(Vec<f32>, Vec<f32>, f64)> {
    let plan = plan::reference(scene, bounces, seed, &gpu.report().limits)?;
    let contents = plan::reference_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let last: Vec<usize> =
        (0..plan.passes.len()).filter(|p| plan.passes[*p].name() == "path_trace").collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        gpu.draw(frame)?;
        let cpu = || {
            let stat = std::fs::read_to_string("/proc/self/stat").unwrap();
            let f: Vec<&str> = stat.split_whitespace().collect();
            (f[13].parse::<f64>().unwrap() + f[14].parse::<f64>().unwrap()) / 100.0
        };
        let start = Instant::now();
        let cpu0 = cpu();
        for _ in 1..batches {
            gpu.draw_passes(frame, &last)?;
        }
        let _ = start.elapsed().as_secs_f64();
        // Two cores' worth.
        let s = (cpu() - cpu0) / 2.0;
        Ok((gpu.pixels(frame, 0)?.values, gpu.pixels(frame, 1)?.values, s / f64::from(batches - 1)))
    })
}

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let get = |n: &str, d: &str| {
        args.iter().position(|a| a == n).and_then(|i| args.get(i + 1)).cloned().unwrap_or(d.into())
    };
    let hgt = get("--field", "/work/shared/data/height/N44W072.hgt");
    let env = get("--env", "/work/shared/data/env/spiaggia_di_mondello_1k.hdr");
    let only = get("--only", "");
    let paths: u32 = get("--paths", "128").parse().unwrap();
    let field = crop(&files::read_heights(Path::new(&hgt), &HeightOptions::default())?, 512)?;
    let environment = files::read_environment(&PathBuf::from(env), 0.0)?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let sky = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let lit = Lights { environment: Some(environment), ..Lights::default() };
    let surface = Surface { albedo: Albedo::Constant([0.7; 3]), ..Surface::default() };
    let scene = |field: &HeightField, lights: &Lights| Scene {
        field: field.clone(),
        surface: surface.clone(),
        lights: lights.clone(),
    };
    let fr = fractal(256, 5)?;
    let rows = [
        ("fractal sky 0", scene(&fr, &sky), 0),
        ("fractal sky 1", scene(&fr, &sky), 1),
        ("hgt sky 0", scene(&field, &sky), 0),
        ("hgt sky 1", scene(&field, &sky), 1),
        ("hgt env 0", scene(&field, &lit), 0),
        ("hgt env 1", scene(&field, &lit), 1),
    ];
    for (name, scene, bounces) in rows {
        if !name.contains(&only) {
            continue;
        }
        let batches = paths / REFERENCE_BATCH;
        let n = scene.field.rows() * scene.field.cols();
        let (light, error, s) = run(&mut gpu, &scene, bounces, 1, batches)?;
        let mean = light.chunks_exact(4).map(|t| f64::from(t[0] + t[1] + t[2])).sum::<f64>()
            / (3 * n) as f64;
        let se = (error
            .chunks_exact(4)
            .map(|t| t[..3].iter().map(|v| f64::from(*v).powi(2)).sum::<f64>())
            .sum::<f64>()
            / (3 * n) as f64)
            .sqrt();
        let rate = n as f64 * f64::from(REFERENCE_BATCH) / s / 1e6;
        let rays = error.chunks_exact(4).map(|t| f64::from(t[3])).sum::<f64>()
            / (n as f64 * f64::from(batches * REFERENCE_BATCH));
        let to = s * f64::from(batches) * (se / mean / 0.01).powi(2);
        println!(
            "{name:14} {rate:8.2} Msamples/s {:8.2} Mrays/s ({rays:.2}), mean {mean:.5} se {:.4}% at {paths}, to 1% {to:.3} s",
            rate * rays,
            100.0 * se / mean
        );
    }
    let _ = Error::setting("", "", "");
    let _: Option<Environment> = None;
    Ok(())
}

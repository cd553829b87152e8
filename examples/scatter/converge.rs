//! Scattered light beside light paths, by directions and paths; and pictures.

use ridgelight::Result;
use ridgelight::gpu::Headless;
use ridgelight::plan::REFERENCE_BATCH;
use ridgelight::scene::Tone;
use ridgelight::scene::{Albedo, Border, Directions, HeightField, Scatter, Scene, Surface};
use ridgelight_cpu::bounce_march::bounce_march;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::scatter_gather::{GridPoints, expected};
use ridgelight_io as files;

use crate::seen::points;
use crate::table::bumps;
use crate::traced::traced;
use crate::{Colours, Request, colours, grooves, lights, mean, moss, rms, scattered};

const BOUNCES: u32 = 3;
/// Of what samples see by their own normals.
const AZIMUTHS: u32 = 64;
const DIRECTIONS: [usize; 3] = [64, 256, 1024];
/// And how many seeds each is the mean of: few where paths are many.
const PATHS: [(u32, u32); 4] = [(40, 16), (100, 16), (400, 8), (1600, 4)];
/// White columns between pictures, and pixels a sample.
const GAP: usize = 4;
const SCALE: usize = 3;

/// The middle of a field, at most `side`² samples.
fn middle(field: &HeightField, side: usize) -> Result<HeightField> {
    let [rows, cols] = [field.rows(), field.cols()].map(|n| n.min(side));
    let first = [(field.rows() - rows) / 2, (field.cols() - cols) / 2];
    let at = |i: usize| (first[0] + i / cols) * field.cols() + first[1] + i % cols;
    let heights: Vec<f64> = (0..rows * cols).map(|i| f64::from(field.heights_m()[at(i)])).collect();
    HeightField::new(rows, cols, &heights, field.cell_m(), None)
}

fn scenes(asked: &Request) -> Result<Vec<(&'static str, Scene)>> {
    let on = |field| {
        let surface = Surface { albedo: Albedo::Constant([0.8, 0.7, 0.6]), ..Surface::default() };
        Scene { field, surface, lights: lights() }
    };
    let mut all =
        vec![("grooves", grooves(asked.side, asked.side, 16)?), ("bumps", on(bumps(asked.side)?))];
    all[1].1.surface.border = Border::Periodic;
    if let Some(folder) = &asked.folder {
        let moss = moss::read(folder)?;
        let mut scene = on(middle(&moss, 2 * asked.side)?);
        scene.surface.albedo = Albedo::Constant([0.55, 0.7, 0.25]);
        all.push(("moss", scene));
    }
    Ok(all)
}

pub fn run(gpu: &mut Headless, asked: &Request) -> Result<()> {
    let mut rows: Vec<[Colours; 3]> = Vec::new();
    for (name, scene) in scenes(asked)? {
        rows.push(one(gpu, asked, name, &scene)?);
    }
    let Some(path) = &asked.output else { return Ok(()) };
    // Pictures of one side; grooves and moss, the figures that the paper has.
    let last = rows.last().expect("some");
    let side = (last[0].len() as f64).sqrt() as usize;
    let mut picture = Vec::new();
    for (panels, own) in [(&rows[0], asked.side), (last, side)] {
        for row in (0..side * SCALE).map(|row| row / SCALE % own) {
            for (i, panel) in panels.iter().enumerate() {
                if i > 0 {
                    picture.extend([[1.0; 3]; GAP]);
                }
                let cols = (0..side * SCALE).map(|col| col / SCALE % own);
                picture.extend(cols.map(|col| panel[row * own + col]));
            }
        }
    }
    let width = 3 * side * SCALE + 2 * GAP;
    files::write_png(path, 2 * side * SCALE, width, &picture, None, Tone { exposure: 1.2 }, &[])
}

/// Scattered light by all that each sample sees along azimuths, in f64, with normals and light of samples.
fn by_own_normals(scene: &Scene, direct: &Colours) -> Colours {
    let oracle = Oracle::new(&scene.field, scene.surface.border);
    let samples = GridPoints::of(scene);
    let cols = scene.field.cols();
    let direct: Vec<[f64; 3]> = direct.iter().map(|v| v.map(f64::from)).collect();
    let (mut leaving, mut sums) = (direct.clone(), Vec::new());
    for _ in 0..BOUNCES {
        let of = |at: usize| {
            let arrives = bounce_march(&oracle, &leaving, AZIMUTHS, at / cols, at % cols);
            let albedo = samples.albedo(at);
            [0, 1, 2].map(|c| albedo[c] * arrives[c])
        };
        sums = (0..direct.len()).map(of).collect();
        leaving = direct
            .iter()
            .zip(&sums)
            .map(|(a, b): (_, &[f64; 3])| [0, 1, 2].map(|c| a[c] + b[c]))
            .collect();
    }
    sums.iter().map(|v| v.map(|v| v as f32)).collect()
}

/// Direct light, with scattered light, and light paths.
fn one(gpu: &mut Headless, asked: &Request, name: &str, scene: &Scene) -> Result<[Colours; 3]> {
    let (field, border) = (&scene.field, scene.surface.border);
    let batches = asked.paths.div_ceil(REFERENCE_BATCH);
    let [direct, _] = traced(gpu, scene, 0, batches)?.map(|v| colours(&v));
    let [all, error] = traced(gpu, scene, BOUNCES, batches)?.map(|v| colours(&v));
    let truth: Colours =
        all.iter().zip(&direct).map(|(a, b)| [0, 1, 2].map(|c| a[c] - b[c])).collect();
    let (level, whole) = (mean(&truth), mean(&all));
    println!(
        "{name}, {} × {}, {BOUNCES} bounces; scattered light is {:.1} % of all; {} light paths, standard error {:.2} % of it\n",
        field.cols(),
        field.rows(),
        100.0 * level / whole,
        batches * REFERENCE_BATCH,
        100.0 * rms(error.as_flattened().iter().map(|v| f64::from(*v))) / level,
    );
    println!("| directions | MB | ms to find | paths | RMSE, % of scattered | of all | ms |");
    println!("|---|---|---|---|---|---|---|");
    let off = |found: &Colours| {
        let pairs = found.as_flattened().iter().zip(truth.as_flattened());
        rms(pairs.map(|(a, b)| f64::from(a - b)))
    };
    let (mut best, mut mean, mut last) = (truth.clone(), truth.clone(), 0.0);
    for count in DIRECTIONS {
        let directions = Directions::fibonacci(count, -1.0, 0)?;
        let (points, found_ms) = points(gpu, field, border, &directions)?;
        let head =
            format!("| {count} | {:.1} | {found_ms:.1} |", 4.0 * points.words().len() as f64 / 1e6);
        for (paths, seeds) in PATHS {
            let (mut squares, mut times) = (0.0, Vec::new());
            for seed in 0..seeds {
                let scatter = Scatter { bounces: BOUNCES, paths, seed, ..Scatter::default() };
                let (light, ms) = scattered(gpu, scene, &points, &direct, &scatter)?;
                squares += off(&light).powi(2) / f64::from(seeds);
                times.push(ms);
                best = light;
            }
            times.sort_by(f64::total_cmp);
            let rmse = squares.sqrt();
            println!(
                "{head} {paths} | {:.2} | {:.2} | {:.2} |",
                100.0 * rmse / level,
                100.0 * rmse / whole,
                times[times.len() / 2]
            );
        }
        let of: Vec<_> = direct.iter().map(|v| v.map(f64::from)).collect();
        mean = expected(scene, &points, &of, BOUNCES).iter().map(|v| v.map(|v| v as f32)).collect();
        last = off(&mean);
        println!("{head} all | {:.2} | {:.2} | |", 100.0 * last / level, 100.0 * last / whole);
    }
    println!("\nRms of 4 to 16 seeds; `all` paths: what the device's tend to, by the processor.");
    let field_light = by_own_normals(scene, &direct);
    let apart = rms(field_light
        .as_flattened()
        .iter()
        .zip(mean.as_flattened())
        .map(|(a, b)| f64::from(a - b)));
    println!(
        "Of the last {:.2} % what directions and nearest samples do is {:.2} %: beside the field's own stretches in \
         {AZIMUTHS} azimuths, samples' normals and light linear between them as here. Those are {:.2} % off light paths, \
         whose surface is flat triangles.\n",
        100.0 * last / level,
        100.0 * apart / level,
        100.0 * off(&field_light) / level,
    );
    let lit = direct.iter().zip(&best).map(|(a, b)| [0, 1, 2].map(|c| a[c] + b[c])).collect();
    Ok([direct, lit, all])
}

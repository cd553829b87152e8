//! Measures how far horizons and light are from the truth, and what they cost: the tables of README.
//!
//! `cargo run --release --example accuracy -- FIELD [--cell X,Y] [--env FILE] [--samples N]`
//!
//! Horizons: 64 azimuths at N random samples against the f64 oracle on the triangulated surface.
//! Sky: the light of a uniform sky at N / 8 samples against the oracle in 360 azimuths. Environment:
//! at N / 20 samples against the quadrature of all its pixels.

use std::path::PathBuf;

use ridgelight::cpu::{light, oracle::Oracle};
use ridgelight::files::{self, HeightOptions};
use ridgelight::gpu::{Headless, HeadlessOptions, Timing};
use ridgelight::measure::error::{HorizonError, ImageError};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Border, Environment, Fuse, HeightField, Lights, Lines, Method, Quality, Scene, Surface,
};
use ridgelight::{Error, Result};

struct Asked {
    field: HeightField,
    environment: Option<Environment>,
    samples: usize,
}

fn asked() -> Result<Asked> {
    let mut options = HeightOptions::default();
    let (mut path, mut env, mut samples) = (None, None, 4000);
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut value = || args.next().ok_or_else(|| Error::setting(&arg, "nothing", "a value"));
        match arg.as_str() {
            "--cell" => {
                let text = value()?;
                let parts: Vec<f64> = text.split(',').filter_map(|p| p.parse().ok()).collect();
                let [x, y] = parts.as_slice() else {
                    return Err(Error::setting("--cell", text, "X,Y"));
                };
                options.cell_m = Some([*x, *y]);
            }
            "--env" => env = Some(PathBuf::from(value()?)),
            "--samples" => {
                let text = value()?;
                samples = text
                    .parse()
                    .map_err(|_| Error::setting("--samples", text, "a whole number"))?;
            }
            _ => path = Some(PathBuf::from(arg)),
        }
    }
    let path = path.ok_or_else(|| Error::setting("FIELD", "nothing", "a height field"))?;
    let environment = env.map(|e| files::read_environment(&e, 0.0)).transpose()?;
    Ok(Asked {
        field: files::read_heights(&path, &options)?,
        environment,
        samples: samples.max(40),
    })
}

fn pick(field: &HeightField, count: usize) -> Vec<[usize; 2]> {
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut next = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        ((state >> 11) as usize) % below
    };
    (0..count).map(|_| [next(field.rows()), next(field.cols())]).collect()
}

fn ms(times: &[Timing], name: &str) -> f64 {
    times.iter().filter(|t| t.label.starts_with(name)).map(|t| t.ns).sum::<f64>() / 1e6
}

/// Draws twice (the first compiles) and returns the plan's first output and the second's times.
fn picture(
    gpu: &mut Headless,
    scene: &Scene,
    quality: &Quality,
) -> Result<(Vec<f32>, usize, Vec<Timing>)> {
    let plan = plan::picture(scene, quality, &gpu.report().limits, Picture::default())?;
    let env: Option<Vec<f32>> = scene
        .lights
        .environment
        .as_ref()
        .map(|e| e.texels().iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect());
    let mut contents = vec![scene.field.heights_m()];
    contents.extend(env.as_deref());
    let mut frame = gpu.frame(plan, &contents)?;
    gpu.draw(&mut frame)?;
    let times = gpu.draw(&mut frame)?;
    let pixels = gpu.pixels(&frame, 0)?;
    gpu.end(frame);
    Ok((pixels.values, pixels.channels, times))
}

/// Elevations at the picked samples, [azimuth][pick].
fn horizons(
    gpu: &mut Headless,
    field: &HeightField,
    quality: &Quality,
    picks: &[[usize; 2]],
) -> Result<Vec<f32>> {
    let plane = field.rows() * field.cols();
    let mut found = vec![0.0; picks.len() * quality.azimuths as usize];
    for first in (0..quality.azimuths).step_by(16) {
        let count = 16.min(quality.azimuths - first);
        let limits = gpu.report().limits;
        let plan = plan::horizons(field, Border::Plane, quality, &limits, (first, count), false)?;
        let order = plan.layer_azimuths.clone();
        let mut frame = gpu.frame(plan, &[field.heights_m()])?;
        gpu.draw(&mut frame)?;
        let angles = gpu.pixels(&frame, 0)?.values;
        gpu.end(frame);
        for (layer, k) in order.iter().enumerate() {
            for (i, [r, c]) in picks.iter().enumerate() {
                found[*k as usize * picks.len() + i] = angles[layer * plane + r * field.cols() + c];
            }
        }
    }
    Ok(found)
}

fn main() -> Result<()> {
    let Asked { field, environment, samples } = asked()?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let oracle = Oracle::new(&field, Border::Plane);
    let picks = pick(&field, samples);
    let lit = &picks[..samples / 8];
    let sky_truth: Vec<f64> =
        lit.iter().map(|[r, c]| light::sky_of(&oracle, *r, *c, 360)).collect();
    let scene =
        |lights: Lights| Scene { field: field.clone(), surface: Surface::default(), lights };
    let sky = scene(Lights { sky: Some([1.0; 3]), ..Lights::default() });
    let megasamples = (field.rows() * field.cols()) as f64 / 1e6;
    println!("{} × {} samples, 64 azimuths, {}\n", field.cols(), field.rows(), gpu.report().name);
    println!(
        "| lines | fuse | mean ° | median ° | 99 % ° | 99.9 % ° | worst ° (row, column) | sky RMSE % | sweep ms | shade ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let mut rows = Vec::new();
    for lines in
        [Lines::FourCells, Lines::TwoCells, Lines::Cell, Lines::HalfCell, Lines::QuarterCell]
    {
        for fuse in [Fuse::Nearest, Fuse::Slopes, Fuse::Own, Fuse::AimedNearest, Fuse::Aimed] {
            rows.push((Method::Sweep, lines, fuse));
        }
    }
    rows.push((Method::Sweep, Lines::Exact, Fuse::AimedNearest));
    if samples * field.cols().max(field.rows()) < 8_000_000 {
        rows.push((Method::Brute, Lines::Cell, Fuse::AimedNearest));
    }
    for (method, lines, fuse) in rows {
        let quality = Quality { method, lines, fuse, ..Quality::default() };
        let found = horizons(&mut gpu, &field, &quality, &picks)?;
        let azimuths = plan::circle_rad(&quality, field.cell_m());
        let truth: Vec<f32> = azimuths
            .iter()
            .flat_map(|phi| picks.iter().map(|[r, c]| oracle.elevation_rad(*r, *c, *phi) as f32))
            .collect();
        let e = HorizonError::of(&found, &truth, 1, samples)?;
        let (values, channels, times) = picture(&mut gpu, &sky, &quality)?;
        let ours: Vec<f64> =
            lit.iter().map(|[r, c]| f64::from(values[(r * field.cols() + c) * channels])).collect();
        let light = ImageError::of(&ours, &sky_truth, lit.len())?;
        let [row, col] = picks[e.worst_at[2]];
        let names = match (method, lines) {
            (Method::Brute, _) => "brute | ".to_owned(),
            (_, Lines::Exact) => "exact | ".to_owned(),
            _ => format!("{} | {}", lines.name(), fuse.name()),
        };
        let sweeps =
            ms(&times, "horizon_sweep") + ms(&times, "surface_sweep") + ms(&times, "horizon_march");
        println!(
            "| {names} | {:.5} | {:.5} | {:.4} | {:.4} | {:.4} ({row}, {col}) | {:.4} | {:.2} | {:.2} |",
            e.mean,
            e.median,
            e.p99,
            e.p999,
            e.worst,
            100.0 * light.relative_rmse,
            sweeps / 64.0 / megasamples,
            ms(&times, "sky_shade") / 64.0 / megasamples
        );
    }
    println!(
        "\nms an azimuth and megasample. Exact horizons are in the azimuths of grid vectors near the even ones."
    );
    let Some(environment) = environment else { return Ok(()) };
    let lit = &picks[..samples / 20];
    let truth: Vec<[f64; 3]> =
        lit.iter().map(|[r, c]| light::environment_of(&oracle, *r, *c, &environment)).collect();
    let scene = scene(Lights { environment: Some(environment), ..Lights::default() });
    println!(
        "\n| azimuths | environment RMSE % | mean shift % | tables ms | sweep ms | shade ms | frame ms |"
    );
    println!("|---|---|---|---|---|---|---|");
    for azimuths in [16, 32, 64, 128, 256] {
        let quality = Quality { azimuths, table_elevations: 512, ..Quality::default() };
        let (values, channels, times) = picture(&mut gpu, &scene, &quality)?;
        let at = |[r, c]: &[usize; 2], channel: usize| {
            f64::from(values[(r * field.cols() + c) * channels + channel])
        };
        let ours: Vec<f64> = lit.iter().flat_map(|p| [0, 1, 2].map(|k| at(p, k))).collect();
        let wanted: Vec<f64> = truth.iter().flatten().copied().collect();
        let e = ImageError::of(&ours, &wanted, 3)?;
        println!(
            "| {azimuths} | {:.3} | {:+.3} | {:.1} | {:.1} | {:.1} | {:.1} |",
            100.0 * e.relative_rmse,
            100.0 * e.relative_mean_shift,
            ms(&times, "env_"),
            ms(&times, "horizon_sweep"),
            ms(&times, "sky_shade"),
            times.iter().map(|t| t.ns).sum::<f64>() / 1e6
        );
    }
    Ok(())
}

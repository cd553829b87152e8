//! Light scattered by precomputed visibility (Heidrich et al. 2000): what it costs, and how far it is from light paths.
//!
//! `cargo run --release --example scatter -- [converge|table|all|brdf] [FOLDER] [--side N] [--spp N] [-o PICTURE.png]`
//!
//! `converge` (part of `all`, the default): three bounces on grooves and on bumps, N² (32) samples that repeat, and on the
//! moss of FOLDER's `height/` where there is one, by directions and paths, beside N (2048) light paths a sample with and
//! without bounces; PICTURE.png has direct light, scattered light and light paths of the first and the last of them.
//! `table`: the paper's table 1 by size. `brdf`: what of a field is seen from afar, see `scatter/brdf.rs`, and the paper's figure 9
//! as brdf.png beside PICTURE.png.

#[path = "scatter/bent.rs"]
mod bent;
#[path = "scatter/brdf.rs"]
mod brdf;
#[path = "scatter/converge.rs"]
mod converge;
#[path = "scatter/geometry.rs"]
mod geometry;
#[path = "scatter/moss.rs"]
mod moss;
#[path = "shared/seen.rs"]
mod seen;
#[path = "scatter/table.rs"]
mod table;
#[path = "shared/traced.rs"]
mod traced;

use std::path::PathBuf;

use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan;
use ridgelight::scene::{
    Albedo, Border, HeightField, Lights, Scatter, Scene, Sun, Surface, VisiblePoints,
};
use ridgelight::{Error, Result};

/// Linear RGB of all samples.
type Colours = Vec<[f32; 3]>;

struct Request {
    part: String,
    folder: Option<PathBuf>,
    side: usize,
    paths: u32,
    output: Option<PathBuf>,
}

fn asked() -> Result<Request> {
    let mut asked =
        Request { part: "all".into(), folder: None, side: 32, paths: 2048, output: None };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut whole = || {
            let text = args.next().unwrap_or_default();
            let number: Option<u32> = text.parse().ok().filter(|n| *n > 1);
            number.ok_or_else(|| Error::setting(&arg, text, "a whole number, 2 or more"))
        };
        match arg.as_str() {
            "converge" | "table" | "brdf" | "all" => asked.part = arg,
            "--side" => asked.side = (whole()? as usize).min(256),
            "--spp" => asked.paths = whole()?,
            "-o" => asked.output = args.next().map(PathBuf::from),
            _ => asked.folder = Some(arg.into()),
        }
    }
    Ok(asked)
}

fn colours(values: &[f32]) -> Colours {
    values.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect()
}

/// Scattered light, and the milliseconds of it.
fn scattered(
    gpu: &mut Headless,
    scene: &Scene,
    points: &VisiblePoints,
    direct: &[[f32; 3]],
    scatter: &Scatter,
) -> Result<(Colours, f64)> {
    let plan = plan::scatter(scene, points.directions(), scatter, &gpu.report().limits)?;
    let contents = plan::scatter_inputs(&plan, scene, points, direct)?;
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.with_frame(plan, &contents, |gpu, frame| {
        let ms = seen::timed(gpu, frame)?;
        Ok((colours(&gpu.pixels(frame, 0)?.values), ms))
    })
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (squares, count) = values.fold((0.0, 0.0), |(s, n), v| (s + v * v, n + 1.0));
    f64::sqrt(squares / f64::max(count, 1.0))
}

fn mean(all: &Colours) -> f64 {
    all.as_flattened().iter().map(|v| f64::from(*v)).sum::<f64>() / (3 * all.len()) as f64
}

/// Triangular grooves, `columns` from ridge to ridge, walls at right angles: those that look west red, the others white.
fn grooves(rows: usize, cols: usize, columns: usize) -> Result<Scene> {
    let half = columns / 2;
    let heights: Vec<f64> =
        (0..rows * cols).map(|i| (i % cols % columns).abs_diff(half) as f64).collect();
    let colour = |i: usize| if i % cols % columns > half { [0.8, 0.1, 0.1] } else { [0.8; 3] };
    let albedo = Albedo::Map((0..rows * cols).map(colour).collect());
    let field = HeightField::new(rows, cols, &heights, [1.0; 2], None)?;
    let surface = Surface { albedo, border: Border::Periodic, specular: None };
    Ok(Scene { field, surface, lights: lights() })
}

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

fn run() -> Result<()> {
    let asked = asked()?;
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    println!("{}, {}\n", gpu.report().name, gpu.report().driver);
    let wanted = |part: &str| asked.part == part || asked.part == "all";
    if wanted("converge") {
        converge::run(&mut gpu, &asked)?;
    }
    if wanted("table") {
        table::run(&mut gpu)?;
    }
    if asked.part == "brdf" {
        brdf::run(&mut gpu, &asked)?;
    }
    Ok(())
}

fn main() -> std::process::ExitCode {
    match run() {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error}");
            std::process::ExitCode::FAILURE
        }
    }
}

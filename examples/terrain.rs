//! Draws the picture of docs/getting-started.md: the bundled mountain before a camera, under the bundled sky and a sun, with one
//! bounce; and writes how long each pass took.
//!
//! `cargo run --release --example terrain -- -o PICTURE.png --json FIGURES.json`
//!
//! The ground is coloured by its height: forest, what grows above the tree line at 1400 m, and rock. Heights are as they
//! are.

use std::path::Path;

use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture, View, ViewOptions};
use ridgelight::scene::Tone;
use ridgelight::scene::{
    Albedo, BounceEngine, Bounces, Camera, HeightField, Lens, Lights, Quality, Scene, Sun, Surface,
};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

const SIZE: [u32; 2] = [1200, 500];
const EXPOSURE: f32 = 0.95;
/// Compass azimuth and elevation: from the left.
const SUN: [f64; 2] = [185.0, 11.0];
/// Degrees counter-clockwise: its bright half, and its own sun behind clouds, before the camera.
const SKY_TURNED: f64 = -110.0;
/// Frames after the first, which compiles; times are their medians.
const FRAMES: usize = 9;

/// The value after a flag.
fn flag<'a>(args: &'a [String], name: &str) -> Result<&'a str> {
    let at = args.iter().position(|a| a == name);
    let value = at.and_then(|at| args.get(at + 1));
    value.map(String::as_str).ok_or_else(|| Error::setting(name, "nothing", "a value"))
}

/// What grows at which height, and rock above it.
fn albedo(field: &HeightField) -> Vec<[f32; 3]> {
    let mix = |a: [f32; 3], b: [f32; 3], t: f32| [0, 1, 2].map(|k| a[k] + t * (b[k] - a[k]));
    let smooth = |low: f64, high: f64, v: f64| {
        let t = ((v - low) / (high - low)).clamp(0.0, 1.0);
        (t * t * (3.0 - 2.0 * t)) as f32
    };
    let (forest, heath, rock) = ([0.045, 0.062, 0.030], [0.15, 0.135, 0.08], [0.21, 0.20, 0.185]);
    let colour = |height: f64| {
        let grown = mix(forest, heath, smooth(1000.0, 1400.0, height));
        mix(grown, rock, smooth(1350.0, 1750.0, height))
    };
    field.heights_m().iter().map(|h| colour(field.base_m() + f64::from(*h))).collect()
}

fn scene() -> Result<Scene> {
    let options = HeightOptions { cell_m: Some([66.0, 92.6]), ..Default::default() };
    let field = files::read_heights(Path::new("assets/mt_washington_256.png"), &options)?;
    let sun = Sun {
        azimuth_rad: (90.0 - SUN[0]).to_radians(),
        elevation_rad: SUN[1].to_radians(),
        diameter_rad: 0.53_f64.to_radians(),
        irradiance: [26.0, 19.0, 12.0],
    };
    let map = albedo(&field);
    Ok(Scene {
        field,
        surface: Surface { albedo: Albedo::Map(map), ..Surface::default() },
        lights: Lights {
            environment: Some(files::read_environment(
                Path::new("assets/sky_512x256.hdr"),
                SKY_TURNED.to_radians(),
            )?),
            suns: vec![sun],
            ..Lights::default()
        },
    })
}

/// From the east, above the ravines.
fn camera() -> Camera {
    Camera {
        target_m: [8200.0, 12400.0, 1150.0],
        azimuth_rad: (90.0_f64 - 80.0).to_radians(),
        elevation_rad: 12_f64.to_radians(),
        distance_m: 11500.0,
        lens: Lens::Perspective { fov_rad: 25_f64.to_radians() },
    }
}

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let scene = scene()?;
    let quality = Quality {
        azimuths: 64,
        sun_azimuths: 8,
        bounces: Bounces { count: 1, engine: BounceEngine::Sweep, ..Bounces::default() },
        ..Quality::default()
    };
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let limits = gpu.report().limits;
    let plan = plan::picture(&scene, &quality, &limits, Picture::default())?;
    let options = ViewOptions { size: SIZE, samples: 4, ..ViewOptions::default() };
    let view = View::new(&scene, &plan, &camera(), &options, &limits)?;
    let contents = plan::picture_inputs(&scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let (seen, lit, drawn) = gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        let mut seen = gpu.look(frame, &view, None)?;
        let (mut lit, mut drawn) = (Vec::new(), Vec::new());
        for _ in 0..FRAMES {
            let ms = |times: &[ridgelight::gpu::Timing]| times.iter().map(|t| t.ns * 1e-6).sum();
            lit.push(ms(&gpu.draw(frame)?));
            seen = gpu.look(frame, &view, None)?;
            drawn.push(ms(&seen.timings));
        }
        Ok((seen, lit, drawn))
    })?;
    let median = |mut all: Vec<f64>| {
        all.sort_by(f64::total_cmp);
        all[all.len() / 2]
    };
    let [cols, rows] = SIZE.map(|n| n as usize);
    let tone = Tone {
        exposure: std::env::var("EXP").ok().and_then(|v| v.parse().ok()).unwrap_or(EXPOSURE),
    };
    files::write_png(Path::new(flag(&args, "-o")?), rows, cols, &seen.radiance, None, tone, &[])?;
    let report = gpu.report();
    let figures = serde_json::json!({
        "device": report.name, "driver": report.driver, "cols": cols, "rows": rows,
        "field_cols": scene.field.cols(), "field_rows": scene.field.rows(),
        "samples": options.samples, "azimuths": quality.azimuths, "bounces": quality.bounces.count,
        "lit_ms": median(lit), "drawn_ms": median(drawn),
    });
    println!("{figures}");
    files::write_json(Path::new(flag(&args, "--json")?), &figures)
}

//! Draws README's picture: a scene without shadows, as Ridgelight lights it, and its reference, side
//! by side; and writes how long the two took and how far from the reference they are.
//!
//! `cargo run --release --example picture -- FIELD --cell X,Y --env FILE --sun AZ,EL,ANGLE,IRRADIANCE
//! --azimuths M --exposure FACTOR -o PICTURE.png --json FIGURES.json` (as in `ridgelight render`)
//!
//! Without shadows: every sample sees all that is above the horizontal and its own plane, in f64, from
//! the CPU twins. The reference: brute force over every crossing in 360 azimuths, 64 across the sun.

use std::path::Path;

use glam::DVec3;
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan::{self, Picture, azimuths};
use ridgelight::scene::Tone;
use ridgelight::scene::{Border, Lights, Method, Quality, Scene, Sun, Surface};
use ridgelight::{Error, Result};
use ridgelight_cpu::{env_tables, env_wedges, light};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;
use ridgelight_trade::error::ImageError;

const TRUE_AZIMUTHS: u32 = 360;
const TRUE_SUN_AZIMUTHS: u32 = 64;
/// White columns between two pictures.
const GAP: usize = 4;

/// The value after a flag.
fn flag<'a>(args: &'a [String], name: &str) -> Result<&'a str> {
    let at = args.iter().position(|a| a == name);
    let value = at.and_then(|at| args.get(at + 1));
    value.map(String::as_str).ok_or_else(|| Error::setting(name, "nothing", "a value"))
}

fn numbers<const N: usize>(args: &[String], name: &str) -> Result<[f64; N]> {
    let text = flag(args, name)?;
    let all: Vec<f64> = text.split(',').filter_map(|p| p.parse().ok()).collect();
    let wrong = |_| Error::setting(name, text, format!("{N} numbers, parted by commas"));
    all.try_into().map_err(wrong)
}

fn scene(args: &[String]) -> Result<Scene> {
    let path = args.first().ok_or_else(|| Error::setting("FIELD", "nothing", "a height field"))?;
    let options = HeightOptions { cell_m: Some(numbers(args, "--cell")?), ..Default::default() };
    let [azimuth, elevation, diameter, irradiance] = numbers(args, "--sun")?;
    let sun = Sun {
        azimuth_rad: (90.0 - azimuth).to_radians(),
        elevation_rad: elevation.to_radians(),
        diameter_rad: diameter.to_radians(),
        irradiance: [irradiance as f32; 3],
    };
    Ok(Scene {
        field: files::read_heights(Path::new(path), &options)?,
        surface: Surface::default(),
        lights: Lights {
            sky: None,
            environment: Some(files::read_environment(Path::new(flag(args, "--env")?), 0.0)?),
            suns: vec![sun],
            ..Lights::default()
        },
    })
}

/// Everything above the horizontal and the sample's own plane arrives.
fn unshadowed(scene: &Scene, quality: &Quality) -> Vec<[f32; 3]> {
    let Scene { field, lights, .. } = scene;
    let environment = lights.environment.as_ref().expect("the scene has one");
    let circle = azimuths::even(quality.azimuths, field.cell_m());
    let rows = env_wedges::env_wedges(environment, Border::Plane, &circle);
    let nodes = quality.table_elevations as usize;
    let tables = env_tables::env_tables(&rows, (environment.height(), circle.len()), nodes, 0.0);
    let sample = |row: usize, col: usize| {
        let normal = light::normal(field, Border::Plane, row, col);
        let mut sum = DVec3::ZERO;
        for (k, azimuth) in circle.iter().enumerate() {
            // The own plane's slope towards the azimuth (TW10 eq. 4).
            let (cos, sin) = (f64::from(azimuth.cos_phi), f64::from(azimuth.sin_phi));
            let lowest = -(normal.x * cos + normal.y * sin) / normal.z;
            sum += tables.light(k, lowest.max(0.0), normal);
        }
        for sun in &lights.suns {
            let (sin, cos) = sun.elevation_rad.sin_cos();
            let (y, x) = sun.azimuth_rad.sin_cos();
            let facing = normal.dot(DVec3::new(x * cos, y * cos, sin)).max(0.0);
            let colour = DVec3::from(sun.irradiance.map(f64::from));
            sum += colour * facing / std::f64::consts::PI;
        }
        sum.to_array().map(|v| v as f32)
    };
    let (rows, cols) = (field.rows(), field.cols());
    (0..rows * cols).map(|i| sample(i / cols, i % cols)).collect()
}

/// The light of a scene and the device's milliseconds.
fn lit(gpu: &mut Headless, scene: &Scene, quality: &Quality) -> Result<(Vec<[f32; 3]>, f64)> {
    let limits = gpu.report().limits;
    let plan = plan::picture(scene, quality, &limits, Picture::default())?;
    let environment = scene.lights.environment.as_ref().expect("the scene has one");
    let texels: Vec<f32> =
        environment.texels().iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    let contents = [scene.field.heights_m(), &texels];
    let (times, pixels) = gpu.with_frame(plan, &contents, |gpu, frame| {
        // The first frame compiles and warms caches: little beside brute force, which is drawn once.
        if quality.method != Method::BruteForce {
            gpu.draw(frame)?;
        }
        Ok((gpu.draw(frame)?, gpu.pixels(frame, 0)?))
    })?;
    let light = pixels.values.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect();
    Ok((light, times.iter().map(|t| t.ns).sum::<f64>() * 1e-6))
}

/// Root mean square of the difference, relative to the mean of the reference.
fn error(light: &[[f32; 3]], reference: &[[f32; 3]]) -> Result<f64> {
    let flat = |all: &[[f32; 3]]| all.iter().flatten().map(|v| f64::from(*v)).collect::<Vec<_>>();
    Ok(ImageError::of(&flat(light), &flat(reference), 3)?.relative_rmse)
}

fn main() -> Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let scene = scene(&args)?;
    let [azimuths] = numbers(&args, "--azimuths")?;
    let [exposure] = numbers(&args, "--exposure")?;
    let quality = Quality { azimuths: azimuths as u32, ..Quality::default() };
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let (ours, ours_ms) = lit(&mut gpu, &scene, &quality)?;
    let brute = Quality {
        method: Method::BruteForce,
        azimuths: TRUE_AZIMUTHS,
        sun_azimuths: TRUE_SUN_AZIMUTHS,
        ..quality
    };
    let (reference, reference_ms) = lit(&mut gpu, &scene, &brute)?;
    let off = unshadowed(&scene, &quality);

    let (rows, cols) = (scene.field.rows(), scene.field.cols());
    // White at this exposure.
    let gap = [[1.0 / exposure as f32; 3]; GAP];
    let mut joined = Vec::new();
    for row in 0..rows {
        let line = row * cols..(row + 1) * cols;
        joined.extend_from_slice(&off[line.clone()]);
        joined.extend(gap);
        joined.extend_from_slice(&ours[line.clone()]);
        joined.extend(gap);
        joined.extend_from_slice(&reference[line]);
    }
    let tone = Tone { exposure: exposure as f32 };
    let width = 3 * cols + 2 * GAP;
    files::write_png(Path::new(flag(&args, "-o")?), rows, width, &joined, None, tone, &[])?;
    let report = gpu.report();
    let figures = serde_json::json!({
        "device": report.name, "driver": report.driver, "field": args[0], "rows": rows, "cols": cols,
        "azimuths": quality.azimuths, "reference_azimuths": TRUE_AZIMUTHS,
        "ours_ms": ours_ms, "reference_ms": reference_ms,
        "off_error": error(&off, &reference)?, "ours_error": error(&ours, &reference)?,
    });
    files::write_json(Path::new(flag(&args, "--json")?), &figures)
}

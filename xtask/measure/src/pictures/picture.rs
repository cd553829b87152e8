//! README's picture: the bundled mountain without shadows, as Ridgelight lights it, and its reference,
//! with times and errors.
//!
//! Without shadows: every grid point sees all that is above the horizontal and its own plane, in f64.
//! The reference: brute force over every crossing in 360 azimuths, 64 across the sun.

use std::f64::consts::PI;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::plan::azimuths;
use ridgelight::scene::{Border, Method, Quality, Scene, Sun};
use ridgelight_cpu::{env_tables, env_wedges, light};
use ridgelight_io as files;

use crate::common::args::Args;
use crate::common::frames::{Colours, drawn, error, open, to_f32};
use crate::common::{Outcome, inputs, panels};

const AZIMUTHS: u32 = 64;
const TRUE_AZIMUTHS: u32 = 360;
const TRUE_SUN_AZIMUTHS: u32 = 64;
const EXPOSURE: f32 = 0.2;

/// Everything above the horizontal and the grid point's own plane arrives.
fn unshadowed(scene: &Scene, quality: &Quality) -> Colours {
    let Scene { field, lights, .. } = scene;
    let environment = lights.environment.as_ref().expect("the scene has one");
    let circle = azimuths::even(quality.azimuths, field.cell_m());
    let rows = env_wedges::env_wedges(environment, Border::Plane, &circle);
    let nodes = quality.table_elevations as usize;
    let tables = env_tables::env_tables(&rows, (environment.height(), circle.len()), nodes, 0.0);
    let of = |i: usize| {
        let normal = light::normal(field, Border::Plane, i / field.cols(), i % field.cols());
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
            sum += DVec3::from(sun.irradiance.map(f64::from)) * facing / PI;
        }
        sum.to_array()
    };
    (0..field.rows() * field.cols()).map(of).collect()
}

pub fn run(mut args: Args) -> Outcome {
    let (output, json) = (args.needed("-o")?, args.needed("--json")?);
    args.end()?;
    let mut scene = inputs::under(inputs::mountain(1.0)?, inputs::sky(0.0)?);
    scene.lights.suns = vec![Sun {
        azimuth_rad: (90.0_f64 - 300.0).to_radians(),
        elevation_rad: 10_f64.to_radians(),
        diameter_rad: 0.53_f64.to_radians(),
        irradiance: [15.0; 3],
    }];
    let quality = Quality { azimuths: AZIMUTHS, ..Quality::default() };
    let brute = Quality {
        method: Method::BruteForce,
        azimuths: TRUE_AZIMUTHS,
        sun_azimuths: TRUE_SUN_AZIMUTHS,
        ..quality
    };
    let mut gpu = open()?;
    let ours = drawn(&mut gpu, &scene, &quality, 1)?;
    // Compiling is little beside brute force.
    let reference = drawn(&mut gpu, &scene, &brute, 0)?;
    let off = unshadowed(&scene, &quality);
    let row = [&off, &ours.light, &reference.light].map(|light| to_f32(light)).to_vec();
    panels::write(&output, &[row], scene.field.cols(), 1, EXPOSURE)?;
    let share = |light: &Colours| -> Result<f64> { Ok(error(light, &reference.light)? / 100.0) };
    let report = gpu.report();
    let figures = serde_json::json!({
        "device": report.name, "driver": report.driver, "field": inputs::MOUNTAIN,
        "rows": scene.field.rows(), "cols": scene.field.cols(),
        "azimuths": AZIMUTHS, "reference_azimuths": TRUE_AZIMUTHS,
        "ours_ms": ours.ms(), "reference_ms": reference.ms(),
        "off_error": share(&off)?, "ours_error": share(&ours.light)?,
    });
    Ok(files::write_json(&json, &figures)?)
}

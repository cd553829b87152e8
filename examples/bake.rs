//! Bakes maps of the bundled mountain from Rust: exact horizons from the device, maps of them on the CPU, and a
//! texture encoding with its stated error.
//!
//! `cargo run --release --example bake -- SKY_VIEW.npy`

use std::f64::consts::TAU;
use std::path::Path;

use ridgelight::Result;
use ridgelight::gpu::{Headless, HeadlessOptions};
use ridgelight::plan;
use ridgelight::scene::{Border, HeightField, Method, Quality};
use ridgelight_bake::{BentNormal, HorizonMap, HorizonSums, Ray, SHARE, SkyView, normals};
use ridgelight_io::{HeightOptions, read_heights, write_npy_f32};

/// Evenly around the circle, the first towards the east.
pub const AZIMUTHS: u32 = 64;

/// Elevations in radians, a plane for each of [`AZIMUTHS`] even azimuths, exact in each.
pub fn horizons(gpu: &mut Headless, field: &HeightField) -> Result<Vec<Vec<f32>>> {
    let quality = Quality { azimuths: AZIMUTHS, method: Method::BruteForce, ..Quality::default() };
    let limits = gpu.report().limits;
    let plan = plan::horizons(field, Border::Plane, &quality, &limits, (0, AZIMUTHS), false)?;
    let values = gpu.with_frame(plan, &[field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        Ok(gpu.pixels(frame, 0)?.values)
    })?;
    Ok(values.chunks_exact(field.rows() * field.cols()).map(<[f32]>::to_vec).collect())
}

/// A map's planes, one a channel.
pub fn baked(
    field: &HeightField,
    horizons: &[Vec<f32>],
    map: Box<dyn HorizonMap>,
) -> Result<Vec<Vec<f32>>> {
    let normals = normals(field, Border::Plane);
    let width_rad = TAU / horizons.len() as f64;
    let mut sums = HorizonSums::new(map, field.rows() * field.cols());
    for (k, elevations) in horizons.iter().enumerate() {
        sums.add(Ray { azimuth_rad: width_rad * k as f64, width_rad }, elevations, &normals)?;
    }
    sums.end(&normals)
}

fn main() -> Result<()> {
    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let options = HeightOptions { cell_m: Some([66.0, 92.6]), ..HeightOptions::default() };
    let field = read_heights(Path::new("assets/mt_washington_256.png"), &options)?;
    let horizons = horizons(&mut gpu, &field)?;
    let sky_view = &baked(&field, &horizons, Box::new(SkyView))?[0];
    let bent_normal = baked(&field, &horizons, Box::new(BentNormal))?;
    let mean = sky_view.iter().sum::<f32>() / sky_view.len() as f32;
    println!("sky view: {mean:.3} in the mean; bent normal: {} channels", bent_normal.len());
    for encoding in &SHARE {
        let value = f64::from(sky_view[0]);
        println!("{}: {value:.6} becomes {:.6}", encoding.name, encoding.packed(&[value])[0]);
    }
    let Some(path) = std::env::args().nth(1) else { return Ok(()) };
    write_npy_f32(Path::new(&path), &[field.rows(), field.cols()], [sky_view.as_slice()])
}

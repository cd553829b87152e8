//! Results stored as floats in `tests/goldens/`: a change fails, and every driver gives the same within its roundings.
//!
//! A failure writes the found and the expected values and their difference as EXR, and prints where. To accept new
//! results: `RIDGELIGHT_BLESS=1 cargo nextest run --test gpu goldens` on lavapipe, and look at the changes.

use std::path::{Path, PathBuf};

use ridgelight::gpu::Pixels;
use ridgelight::plan::{self, Picture, Plan};
use ridgelight::scene::{
    Albedo, Border, Environment, Fuse, HeightField, Lines, Quality, Scene, Sun,
};
use ridgelight_cpu::tolerance::{
    ShadeError, device_angle, device_fused_slope, device_resolved, two_devices,
};
use ridgelight_testing as golden;

use crate::{Device, field, random, under_sky};

const ROWS: usize = 33;
const COLS: usize = 48;
const CELL_M: [f64; 2] = [20.0, 30.0];

/// Two hills, a pit and rubble, by arithmetic that every processor rounds alike.
fn hills() -> HeightField {
    let mut next = random(20);
    let rubble: Vec<f64> = (0..ROWS * COLS).map(|_| 4.0 * next()).collect();
    field(ROWS, COLS, CELL_M, |r, c| {
        let hill = |row: f64, col: f64, height: f64, width: f64| {
            let (y, x) = (r as f64 - row, c as f64 - col);
            height / (1.0 + (x * x + y * y) / width)
        };
        hill(9.0, 12.0, 70.0, 30.0) + hill(22.0, 33.0, 50.0, 12.0) - hill(15.0, 25.0, 30.0, 8.0)
            + rubble[r * COLS + c]
    })
}

fn kept(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/goldens").join(file)
}

/// Compares an output with its stored file, or writes the file where blessing is requested.
fn check(device: &Device, file: &str, pixels: &Pixels, tolerance: f64) {
    if std::env::var_os("RIDGELIGHT_BLESS").is_some_and(|v| v == "1") {
        let name = &device.report().name;
        assert!(name.contains("llvmpipe"), "RIDGELIGHT_BLESS: found {name}, expected llvmpipe");
    }
    let got = golden::planes(pixels, [ROWS, COLS]).expect("an image of the field");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("goldens");
    match golden::hold(&got, &kept(file), tolerance, &folder) {
        Ok(ratio) => println!("{file}: error/tolerance {ratio:.3} of {tolerance:e}"),
        Err(wrong) => panic!("{wrong}"),
    }
}

/// The errors of a picture's horizons in `count` azimuths of a plan.
fn shade_error(scene: &Scene, plan: &Plan, count: usize) -> ShadeError {
    let heights = || scene.field.heights_m().iter().map(|h| f64::from(*h));
    let (low, high) = (heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max));
    let step_m = plan.azimuths.iter().map(|a| f64::from(a.step_m)).fold(f64::MAX, f64::min);
    let slope_error = device_fused_slope(low.abs().max(high.abs()), step_m);
    ShadeError::new(slope_error, high - low, CELL_M[0].min(CELL_M[1]), count)
}

fn sun_weights(plan: &Plan) -> f64 {
    plan.azimuths.iter().map(|a| f64::from(a.weight)).sum()
}

fn draw(
    device: &mut Device,
    scene: &Scene,
    quality: &Quality,
    inputs: &[&[f32]],
) -> (Plan, Pixels) {
    let plan = plan::picture(scene, quality, &device.limits(), Picture::default()).expect("a plan");
    let pixels = device.draw(plan.clone(), inputs).remove(0);
    (plan, pixels)
}

#[test]
fn goldens_of_sky_and_sun() {
    let mut device = Device::new();
    let mut scene = under_sky(hills(), Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    scene.lights.suns = vec![Sun {
        azimuth_rad: 2.2,
        elevation_rad: 0.35,
        diameter_rad: 0.2,
        irradiance: [3.0; 3],
    }];
    let quality = Quality { azimuths: 16, ..Quality::default() };
    let (plan, pixels) = draw(&mut device, &scene, &quality, &[scene.field.heights_m()]);
    let sky = 0.5 * shade_error(&scene, &plan, 16).sky();
    let sun = 0.5 * 3.0 * shade_error(&scene, &plan, 8).sun(sun_weights(&plan));
    // At most the whole sky, and the sun from straight above.
    let brightest = 0.5 * (1.0 + 3.0 / std::f64::consts::PI);
    let tolerance = two_devices(sky + sun + device_resolved(brightest, 2));
    check(&device, "sky_and_sun.exr", &pixels, tolerance);
}

#[test]
fn goldens_of_an_environment() {
    let mut device = Device::new();
    let mut scene = under_sky(hills(), Border::Periodic);
    let mut next = random(21);
    let texels: Vec<[f32; 3]> = (0..24 * 12)
        .map(|i| if i == 76 { [2.0, 1.5, 1.0] } else { [next() as f32, next() as f32, 0.5] })
        .collect();
    scene.lights.sky = None;
    let environment = Environment::new(24, 12, texels, 0.4).expect("an environment");
    let input: Vec<f32> =
        environment.texels().iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    scene.lights.environment = Some(environment);
    let quality =
        Quality { azimuths: 16, table_elevations: 64, fuse: Fuse::Aimed, ..Quality::default() };
    let inputs = [scene.field.heights_m(), input.as_slice()];
    let (plan, pixels) = draw(&mut device, &scene, &quality, &inputs);
    let error = shade_error(&scene, &plan, 16).whole_environment(2.0, [24.0, 12.0, 64.0]);
    let tolerance = two_devices(error + device_resolved(2.0, 1));
    check(&device, "environment.exr", &pixels, tolerance);
}

#[test]
fn goldens_of_horizons() {
    let mut device = Device::new();
    let field = hills();
    let quality =
        Quality { azimuths: 5, lines: Lines::HalfCell, fuse: Fuse::Own, ..Quality::default() };
    let plan = plan::horizons(&field, Border::Open, &quality, &device.limits(), (0, 5), false)
        .expect("a plan");
    let scene = under_sky(field, Border::Open);
    let largest = scene.field.heights_m().iter().fold(0.0_f64, |m, h| m.max(f64::from(h.abs())));
    let step_m = plan.azimuths.iter().map(|a| f64::from(a.step_m)).fold(f64::MAX, f64::min);
    let pixels = device.draw(plan, &[scene.field.heights_m()]).remove(0);
    let tolerance = two_devices(device_angle(0.0, device_fused_slope(largest, step_m)));
    check(&device, "horizons.npy", &pixels, tolerance);
}

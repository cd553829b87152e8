//! A field of one's own, lit on whatever Vulkan device there is: what the documentation begins with.

use ridgelight::gpu::{Headless, HeadlessOptions, Pixels};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{HeightField, Lights, Quality, Scene, Sun, Surface};

/// Light of 128 × 128 texels, 30 m apart, row by row from the north.
pub fn light() -> ridgelight::Result<Pixels> {
    let wave = |i: usize| (0.1 * (i % 128) as f64).sin() * (0.07 * (i / 128) as f64).cos();
    let heights_m: Vec<f64> = (0..128 * 128).map(|i| 1200.0 + 150.0 * wave(i)).collect();
    let field = HeightField::new(128, 128, &heights_m, [30.0, 30.0], None)?;
    let sun = Sun {
        azimuth_rad: 135_f64.to_radians(), // from the north-west
        elevation_rad: 12_f64.to_radians(),
        diameter_rad: 0.53_f64.to_radians(),
        irradiance: [2.0; 3],
    };
    let lights = Lights { sky: Some([0.3; 3]), suns: vec![sun], ..Lights::default() };
    let scene = Scene { field, surface: Surface::default(), lights };

    let mut gpu = Headless::new(&HeadlessOptions::default())?;
    let limits = gpu.report().limits;
    let plan =
        plan::picture(&scene, &Quality::for_scene(&scene, None), &limits, Picture::default())?;
    gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?; // the texture is frame.outputs()[0]
        gpu.pixels(frame, 0)
    })
}

fn main() -> ridgelight::Result<()> {
    let light = light()?;
    println!("{}: {} texels, the first {}", light.name, light.values.len(), light.values[0]);
    Ok(())
}

//! Specular maps under sky and environment.

use std::f64::consts::LN_2;

use ridgelight::gpu::Pixels;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Basis, Border, Environment, Lights, PhongSpecular, Quality, Scene, Specular, Surface,
};

use crate::cpu_reference::{noisy_environment, rough};
use crate::{Device, random};

const EXPONENTS: [f32; 6] = [0.0, 2.5, 11.0, 40.0, 93.0, 300.0];

fn scene(specular: Specular, environment: Option<Environment>, border: Border) -> Scene {
    let sky = environment.is_none().then_some([1.0; 3]);
    Scene {
        field: rough(37, 29, 61),
        surface: Surface { border, albedo: Albedo::Constant([0.0; 3]), specular: Some(specular) },
        lights: Lights { sky, environment, ..Lights::default() },
    }
}

fn lit(gpu: &mut Device, scene: &Scene, quality: &Quality) -> Pixels {
    let plan = plan::picture(scene, quality, &gpu.limits(), Picture::default()).expect("a plan");
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.draw(plan, &contents).remove(0)
}

/// Each texel of a map reflects as a surface of its own exponent does.
///
/// Between two swept levels, at most h = ln 2 apart in ln(n + 1), the hidden share is interpolated linearly. A straight edge √2 u
/// standard deviations from the peak hides erfc(u) / 2 of the lobe. The second derivative of that by ln(n + 1) is
/// e^-u² u (1 - 2 u²) / (4 √π), at most 0.082, so the error is at most 0.082 h² / 8. Both pictures also interpolate tables, each with an
/// error of 1/128 of the lobe ([`super::direct`]). Under an environment, neighbouring levels reflect different light: the bound is then
/// relative to the texel's largest reflection at any exponent.
#[test]
fn texels_of_a_map_reflect_as_their_exponent_does() {
    let mut gpu = Device::new();
    let mut next = random(62);
    for (environment, border) in [
        (None, Border::Plane),
        (None, Border::Open),
        (Some(noisy_environment(63)), Border::Plane),
        (Some(noisy_environment(64)), Border::Periodic),
    ] {
        let quality = Quality { azimuths: 16, ..Quality::default() };
        let field = scene(Specular::Map(Vec::new()), None, border).field;
        let texels = field.heights_m().len();
        let places: Vec<usize> = (0..texels).map(|_| (6.0 * next()) as usize % 6).collect();
        let scales: Vec<f32> = (0..texels).map(|i| (i % 4) as f32 * 0.25).collect();
        let phong = |i: usize| PhongSpecular { exponent: EXPONENTS[places[i]], scale: scales[i] };
        let map = Specular::Map((0..texels).map(phong).collect());
        let of_map = lit(&mut gpu, &scene(map.clone(), environment.clone(), border), &quality);
        let alone: Vec<Pixels> = EXPONENTS
            .iter()
            .map(|exponent| {
                let phong = PhongSpecular { exponent: *exponent, scale: 1.0 };
                let of = scene(Specular::Constant(phong), environment.clone(), border);
                lit(&mut gpu, &of, &quality)
            })
            .collect();
        let sh = Quality { basis: Basis::Sh, ..quality };
        let by_series = lit(&mut gpu, &scene(map, environment.clone(), border), &sh);
        let (mut worst, mut squares, mut of_series, mut sum) = (0.0_f64, 0.0, 0.0, 0.0);
        for i in 0..texels {
            for c in 0..of_map.channels.min(3) {
                let value = |pixels: &Pixels| {
                    f64::from(pixels.values[i * pixels.channels + c.min(pixels.channels - 1)])
                };
                let scale = f64::from(scales[i]);
                let want = scale * value(&alone[places[i]]);
                let off = (value(&of_map) - want).abs();
                let largest = alone.iter().map(value).fold(1.0, f64::max);
                let bound = scale * largest * (0.082 * LN_2 * LN_2 / 8.0 + 2.0 / 128.0);
                assert!(off <= bound, "{border:?} texel {i}: {off:e} of {bound:e}, {want}");
                worst = worst.max(off);
                squares += off * off;
                of_series += (value(&by_series) - want).powi(2);
                sum += want;
            }
        }
        let count = (texels * of_map.channels.min(3)) as f64;
        let [rms, series] = [squares, of_series].map(|s| (s / count).sqrt() / (sum / count));
        println!("{border:?}: worst {worst:.1e}, RMS {rms:.2e}, of series {series:.2e}");
        assert!(rms < 0.1 * series, "{border:?}: {rms} beside {series}");
    }
}

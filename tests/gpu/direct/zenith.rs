//! Lights at the zenith whose angles the caller rounds to f32: f32's π/2, `asin(1.0)`, is above π/2.

use std::f32;
use std::f64::consts::{FRAC_PI_2, TAU};

use ridgelight::gpu::Pixels;
use ridgelight::plan;
use ridgelight::scene::{
    Albedo, Border, KeyLight, Lights, Method, PhongSpecular, Quality, Scene, Specular, Sun,
    Surface, fractal,
};

use crate::Device;

/// A right angle and a full turn.
const EXACT: [f64; 2] = [FRAC_PI_2, TAU];

fn rounded() -> [f64; 2] {
    [f32::consts::FRAC_PI_2, f32::consts::TAU].map(f64::from)
}

/// A point, a narrow disc and the widest.
fn suns(right: f64) -> [Sun; 3] {
    [0.0, 0.01, right].map(|diameter_rad| Sun {
        azimuth_rad: 0.4,
        elevation_rad: right,
        diameter_rad,
        irradiance: [1.0; 3],
    })
}

/// The whole sphere, and one low enough for shadow heights.
fn keys([right, turn]: [f64; 2]) -> [KeyLight; 2] {
    [(turn, -right), (1.0, 1.54)].map(|(width_rad, low)| KeyLight {
        azimuth_rad: 0.4,
        width_rad,
        elevations_rad: [low, right],
        radiance: [1.0; 3],
    })
}

fn bits(outputs: &[Pixels]) -> Vec<u32> {
    outputs.iter().flat_map(|o| &o.values).map(|v| v.to_bits()).collect()
}

/// Radiance and the layer of each light, by each method, have the bits of π/2 and 2π. Specular takes suns only.
#[test]
fn f32_right_angles_light_like_exact_ones() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let phong = Specular::Constant(PhongSpecular { exponent: 20.0, scale: 0.3 });
    for is_specular in [false, true] {
        let scene = |angles: [f64; 2]| {
            let specular = is_specular.then(|| phong.clone());
            let keys = if is_specular { Vec::new() } else { keys(angles).to_vec() };
            let lights = Lights { suns: suns(angles[0]).to_vec(), keys, ..Lights::default() };
            let albedo = Albedo::Constant([0.7; 3]);
            let surface = Surface { border: Border::Open, albedo, specular };
            Scene { field: fractal(40, 3).expect("a field"), surface, lights }
        };
        for method in [Method::Auto, Method::Sweep, Method::Pyramid, Method::BruteForce] {
            let quality = Quality { method, ..Quality::default() };
            let of_rounded = gpu.light_layers(&scene(rounded()), &quality, &limits);
            let of_exact = gpu.light_layers(&scene(EXACT), &quality, &limits);
            assert!(of_rounded.iter().flat_map(|o| &o.values).all(|v| v.is_finite()));
            assert_eq!(bits(&of_rounded), bits(&of_exact), "{method:?} {is_specular}");
        }
    }
}

#[test]
fn f32_right_angles_cast_the_shadow_heights_of_exact_ones() {
    let mut gpu = Device::new();
    let limits = gpu.limits();
    let field = fractal(70, 3).expect("a field");
    for (of_rounded, of_exact) in suns(rounded()[0]).into_iter().zip(suns(EXACT[0])) {
        let mut heights = |sun: &Sun| {
            let plan = plan::shadow_heights(&field, sun, None, 1, &limits).expect("a plan");
            gpu.draw(plan, &[field.heights_m()])
        };
        let found = heights(&of_rounded);
        assert!(found.iter().flat_map(|o| &o.values).all(|v| v.is_finite()), "{of_rounded:?}");
        assert_eq!(bits(&found), bits(&heights(&of_exact)), "{of_rounded:?}");
    }
}

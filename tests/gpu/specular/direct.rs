//! Direct Phong specular in pictures: against closed forms and the path-traced reference.

use std::f64::consts::{FRAC_PI_2, PI};
use std::path::Path;

use ridgelight::basis::zonal::phong;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Basis, Border, HeightField, Lights, Method, PhongSpecular, Quality, Scene, Specular,
    Sun,
};
use ridgelight_cpu::basis::cap;
use ridgelight_cpu::indirect::{Fineness, light};
use ridgelight_cpu::tolerance::{ShadeError, device_march_slope, device_sun_specular};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

use crate::reference::quadrature::traced;
use crate::{Device, field, random, under_sky};

/// Phong specular without a diffuse part.
fn shiny(field: HeightField, exponent: f32, scale: f32) -> Scene {
    let mut scene = under_sky(field, Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.0; 3]);
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent, scale }));
    scene
}

fn sh(sh_order: u32) -> Quality {
    Quality { basis: Basis::Sh, sh_order, ..Quality::default() }
}

/// Level ground sees the upper hemisphere, a cap about the zenith, and reflects the zenith to the zenith: of a sky of
/// radiance 1 it reflects the sum over bands of lobe times cap. In the picture and in a layer, scaled.
#[test]
fn level_ground_reflects_its_hemisphere() {
    let mut gpu = Device::new();
    let order = 4;
    for exponent in [0.0, 5.0, 20.0, 1e4] {
        let scene = shiny(field(3, 5, [1.0, 2.0], |_, _| 4.0), exponent, 0.25);
        let wanted = Picture { light_layers: true, ..Picture::default() };
        let plan = plan::picture(&scene, &sh(order), &gpu.limits(), wanted).expect("a plan");
        let all = gpu.draw(plan, &[scene.field.heights_m()]);
        let own = all.iter().find(|p| p.name == "direct.specular").expect("a layer");
        let n = order as usize;
        let bands = phong(n, exponent.into()).into_iter().zip(cap(n, FRAC_PI_2));
        let want = 0.25 * bands.map(|(l, c)| l * c).sum::<f64>();
        for pixels in [&all[0], own] {
            let off = (f64::from(pixels.values[7 * pixels.channels]) - want).abs();
            assert!(off <= 1e-6 * want, "{exponent}: {off:e} of {want}");
        }
    }
}

/// A point sun at the zenith, or `off` beside it, on level ground: E · scale · (n + 1) / 2π · cosⁿ off, for exponents
/// from 0 to 1e4. Directions of f32 err by 3e-7, the power with their angle: n · off · 3e-7, and second order beside
/// it; the exponential by a few ulp.
#[test]
fn the_narrowest_and_the_widest_lobe_keep_their_digits() {
    let mut gpu = Device::new();
    for (off, exponent) in [(0.0, 1e4), (0.004, 1e4), (0.2, 30.0), (0.7, 1.0), (0.5, 0.0)] {
        let mut scene = shiny(field(3, 3, [1.0, 1.0], |_, _| 2.0), exponent, 0.6);
        let sun = Sun {
            azimuth_rad: 1.0,
            elevation_rad: FRAC_PI_2 - off,
            diameter_rad: 0.0,
            irradiance: [3.0; 3],
        };
        scene.lights = Lights { suns: vec![sun], ..Lights::default() };
        let found = f64::from(gpu.picture(&scene, &Quality::default()).values[4]);
        let n = f64::from(exponent);
        let want = 3.0 * f64::from(0.6_f32) * (n + 1.0) / (2.0 * PI) * off.cos().powf(n);
        let bound = want * (4e-6 + n * (off + 1e-3) * 3e-7);
        assert!((found - want).abs() < bound, "{exponent} {off}: {found} for {want} ± {bound}");
    }
}

/// Suns in a lobe match the quadrature: a point to f32's rounding; a disc by the lobe's change over it, √(n/e) of its
/// peak a radian and its radius at most, where the horizon or the own plane cuts it, and n a²/4 otherwise.
#[test]
fn suns_in_a_lobe_are_the_quadratures() {
    let mut gpu = Device::new();
    let mut next = random(9);
    let noise: Vec<f64> = (0..48).map(|_| next()).collect();
    for (diameter_rad, exponent) in [(0.0, 1.0), (0.0, 300.0), (0.1, 20.0), (0.0093, 1000.0)] {
        let n = f64::from(exponent);
        let relief = 1.2 / n.sqrt();
        let rough = field(6, 8, [1.0, 1.5], |r, c| relief * noise[r * 8 + c]);
        let error = ShadeError::new(device_march_slope(relief, 1.0), relief, 1.0, 32);
        let sun = |azimuth_rad, elevation_rad, irradiance| Sun {
            azimuth_rad,
            elevation_rad,
            diameter_rad,
            irradiance,
        };
        let mut scene = shiny(rough, exponent, 0.5);
        // Two, which add up.
        let suns = vec![sun(2.0, 0.3, [2.0, 0.0, 0.0]), sun(-0.4, 1.5, [0.0, 1.0, 3.0])];
        scene.lights = Lights { suns, ..Lights::default() };
        let quality =
            Quality { method: Method::BruteForce, sun_azimuths: 32, ..Quality::default() };
        let picture = gpu.picture(&scene, &quality);
        let fineness = Fineness { azimuths: 8, divisions: 1, strips: 256 };
        let ground_truth = light(&scene, 0, fineness).expect("a ground truth").remove(0);
        let (peak, radius) = ((n + 1.0) / (2.0 * PI), 0.5 * diameter_rad);
        let mut lit = 0;
        for (i, want) in ground_truth.iter().enumerate() {
            for (c, want) in want.iter().enumerate() {
                let got = f64::from(picture.values[i * picture.channels + c]);
                let irradiance: f64 =
                    scene.lights.suns.iter().map(|s| f64::from(s.irradiance[c])).sum();
                // For a sun with a cosine of a tenth or less: ten times f32's share.
                let rounded = device_sun_specular(n, error.normal(), 0.1);
                let uneven = peak * (n / std::f64::consts::E).sqrt() * 2.0 * radius;
                let of_sum = 10.0 * PI * error.sun(if radius > 0.0 { PI } else { 1.0 }) * peak;
                let bound = 0.5 * irradiance * (rounded + uneven + of_sum);
                let off = (got - want).abs();
                assert!(off <= bound, "{diameter_rad} {n}: texel {i}: {off:e} of {bound:e}");
                lit += usize::from(*want > bound);
            }
        }
        println!(
            "{diameter_rad} {n}: {lit} of {} are above the noise of dark",
            3 * ground_truth.len()
        );
        assert!(lit >= 10, "cannot fail");
    }
}

/// Bundled terrain, its middle, under its sky of radiance 1 from the zenith to horizontal, by the lobe of exponent 5:
/// the higher the order, the smaller the error against the path-traced reference, by more than its Monte Carlo noise.
/// Light without specular has a large error.
#[test]
fn higher_orders_are_nearer_to_the_path_traced_reference() {
    const BATCHES: usize = 4;
    const SIDE: usize = 16;
    let mut gpu = Device::new();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mt_washington_256.png");
    let options = HeightOptions { cell_m: Some([66.0, 92.6]), ..HeightOptions::default() };
    let whole = files::read_heights(&path, &options).expect("the bundled field");
    let height = |r: usize, c: usize| f64::from(whole.heights_m()[(r + 120) * 256 + c + 120]);
    let scene = shiny(field(SIDE, SIDE, whole.cell_m(), height), 5.0, 1.0);
    let [ground_truth, standard] = traced(&mut gpu, &scene, 0, 1, BATCHES);
    let count = ground_truth.len() as f64;
    let noise = standard.iter().map(|e| e[0] * e[0]).sum::<f64>() / count;
    // The mean of squares d² less the noise's σ², and its own standard error from 4 d²σ² + 2 σ⁴.
    let squares = |gpu: &mut Device, order: u32| {
        let got = gpu.picture(&scene, &sh(order)).values;
        let (mut sum, mut spread) = (0.0, 0.0);
        for ((got, want), error) in got.iter().zip(&ground_truth).zip(&standard) {
            let (off2, noise2) = ((f64::from(*got) - want[0]).powi(2), error[0] * error[0]);
            sum += off2;
            spread += 4.0 * off2 * noise2 + 2.0 * noise2 * noise2;
        }
        [sum / count - noise, spread.sqrt() / count]
    };
    let mean = ground_truth.iter().map(|t| t[0]).sum::<f64>() / count;
    let all = [2, 4].map(|order| squares(&mut gpu, order));
    for (order, [square, error]) in [2, 4].iter().zip(all) {
        let rmse = square.max(0.0).sqrt();
        println!("order {order}: RMSE {:.4} of the mean, squares ± {error:.1e}", rmse / mean);
    }
    let [[coarse, a], [fine, b]] = all;
    assert!(fine + 3.0 * a.hypot(b) < coarse, "{all:?}");
    assert!(coarse < 0.25 * mean * mean, "half of the light is missed");
}

//! Key lights on the device: closed forms, real terrain and path tracing against the oracle.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use ridgelight::scene::fractal;
use ridgelight::scene::{
    Albedo, Border, HeightField, KeyLight, Lights, Method, Quality, Scene, Surface,
};
use ridgelight_cpu::indirect::{Fineness, ground_truth as expected_light};
use ridgelight_cpu::light::key_of;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::tolerance::{ShadeError, device_march_slope};

use crate::reference::quadrature::traced;
use crate::scenes::Agreement;
use crate::{Device, bundled, field, random, under_sky};

const METHODS: [Method; 3] = [Method::Sweep, Method::Pyramid, Method::BruteForce];

fn key(azimuth: f64, width: f64, [low, high]: [f64; 2]) -> KeyLight {
    KeyLight {
        azimuth_rad: azimuth.to_radians(),
        width_rad: width.to_radians(),
        elevations_rad: [low.to_radians(), high.to_radians()],
        radiance: [1.0; 3],
    }
}

fn under_key(field: HeightField, border: Border, key: KeyLight) -> Scene {
    let lights = Lights { keys: vec![key], ..Lights::default() };
    Scene { field, surface: Surface { border, ..Surface::default() }, lights }
}

/// width (sin²high - sin²low) / 2 over π on level ground, by any number of slices, border and method.
#[test]
fn a_key_over_level_ground_has_its_closed_form() {
    let mut gpu = Device::new();
    let keys = [(0.0, 360.0, [0.0, 90.0]), (77.0, 20.0, [10.0, 30.0]), (-9.0, 130.0, [-40.0, 5.0])];
    for (i, (azimuth, width, elevations)) in keys.into_iter().enumerate() {
        for (j, border) in [Border::Plane, Border::Open, Border::Periodic].into_iter().enumerate() {
            let key = key(azimuth, width, elevations);
            let scene = under_key(field(9, 12, [1.0, 2.0], |_, _| 7.0), border, key);
            let sun_azimuths = [1, 3, 16][(i + j) % 3];
            let quality = Quality { method: METHODS[j], sun_azimuths, ..Quality::default() };
            let expected = key.level_irradiance() / PI;
            let error = ShadeError::new(0.0, 0.0, 1.0, key.slices(sun_azimuths) as usize);
            for v in gpu.picture(&scene, &quality).values {
                let off = (f64::from(v) - expected).abs();
                assert!(off <= error.sun(key.width_rad), "{key:?} {border:?}: {v} {expected}");
            }
        }
    }
}

/// A key light over the whole upper hemisphere, in the sky's own azimuths, is the sky, within the errors of both.
#[test]
fn a_key_of_the_whole_sky_is_the_sky() {
    let mut gpu = Device::new();
    let rough = fractal(64, 4).expect("a field");
    let heights = || rough.heights_m().iter().map(|h| f64::from(*h));
    let (low, high) = (heights().fold(f64::MAX, f64::min), heights().fold(f64::MIN, f64::max));
    // The setting 4 gives 16 slices, whose middles are multiples of 22.5°.
    let key = key(180.0 - 11.25, 360.0, [0.0, 90.0]);
    for method in METHODS {
        let quality = Quality { method, azimuths: 16, sun_azimuths: 4, ..Quality::default() };
        let of_key = gpu.picture(&under_key(rough.clone(), Border::Plane, key), &quality);
        let of_sky = gpu.picture(&under_sky(rough.clone(), Border::Plane), &quality);
        // Azimuths are equal but for roundings of 2e-16 rad: so are horizons.
        let error = ShadeError::new(0.0, high - low, rough.cell_m()[0], 16);
        let tolerance = error.sky() + error.sun(TAU);
        for (i, (a, b)) in of_key.values.iter().zip(&of_sky.values).enumerate() {
            assert!(f64::from((a - b).abs()) <= tolerance, "{method:?} texel {i}: {a} {b}");
        }
        assert!(of_sky.values.iter().any(|v| *v < 0.9), "something is hidden");
    }
}

/// A wall of height h along the columns hides, from level ground d away, elevations up to atan(h cos δ / d), δ from
/// its normal. The light of the rest, by the midpoint rule over 20,000 parts, compared with at least 64 slices: for an
/// integrand f with |f''| ≤ 1.1 over ±28° and at most two kinks of 0.3, the error is less than (w/64)² (1.1 w / 24 + 2
/// · 0.3 / 8) / 2π.
#[test]
fn a_wall_cuts_a_key_in_elevation() {
    let mut gpu = Device::new();
    let wall = field(31, 41, [1.0, 1.0], |_, c| if c == 20 { 4.0 } else { 0.0 });
    for elevations in [[0.0, 90.0], [15.0, 40.0], [30.0, 35.0]] {
        let key = key(10.0, 36.0, elevations);
        let [low, high] = key.elevations_rad;
        let expected = |distance: f64| {
            let part = key.width_rad / 20_000.0;
            let light = |i: i32| {
                let delta = key.azimuth_rad - key.width_rad / 2.0 + part * (f64::from(i) + 0.5);
                let horizon = (4.0 * delta.cos() / distance).atan().max(low);
                (high.sin().powi(2) - horizon.sin().powi(2)).max(0.0) * part / 2.0
            };
            (0..20_000).map(light).sum::<f64>() / PI
        };
        let scene = under_key(wall.clone(), Border::Plane, key);
        // 64 slices for a width of 25°; other widths in proportion.
        let slices = key.slices(64) as usize;
        let rule = (key.width_rad / 64.0).powi(2) * (1.1 * key.width_rad / 24.0 + 0.075) / TAU;
        let error =
            ShadeError::new(device_march_slope(4.0, 1.0), 4.0, 1.0, slices).sun(key.width_rad);
        for method in [Method::Sweep, Method::BruteForce] {
            let quality = Quality { method, sun_azimuths: 64, ..Quality::default() };
            let picture = gpu.picture(&scene, &quality);
            // Rays from the middle row reach the wall, up to 18 · tan 28° rows away. Next to it the ground's normal
            // leans.
            for c in (2..=18).chain(22..41) {
                let got = f64::from(picture.values[15 * 41 + c]);
                let want =
                    if c < 20 { expected(20.0 - c as f64) } else { key.level_irradiance() / PI };
                assert!((got - want).abs() <= rule + error, "{method:?} column {c}: {got} {want}");
            }
        }
    }
}

/// Bundled terrain under a low key light. Brute force, in the oracle's own azimuths, errs by a march's slopes and by
/// cosines taken over wedges, a share δ²/24 of the light on the normal's horizontal part. Sweeps err by their
/// horizons, 0.3° in the mean by default (see `horizon/terrain.rs`), over the light's width, where a direction adds 1
/// at most.
#[test]
fn a_key_over_bundled_terrain_is_the_oracles() {
    let mut gpu = Device::new();
    let field = bundled();
    let key = key(215.0, 50.0, [4.0, 16.0]);
    let oracle = Oracle::new(&field, Border::Plane);
    let heights = || field.heights_m().iter().map(|h| f64::from(*h));
    let relief = heights().fold(f64::MIN, f64::max) - heights().fold(f64::MAX, f64::min);
    let slices = key.slices(Quality::default().sun_azimuths) as usize;
    let mut next = random(7);
    let picks: Vec<usize> = (0..400).map(|_| (next() * 65_536.0) as usize).collect();
    let expected_light: Vec<f64> =
        picks.iter().map(|i| key_of(&oracle, i / 256, i % 256, &key, slices)[0]).collect();
    let scene = under_key(field.clone(), Border::Plane, key);
    let off = |gpu: &mut Device, method: Method| -> Vec<f64> {
        let picture = gpu.picture(&scene, &Quality { method, ..Quality::default() });
        let at = |(i, want): (&usize, &f64)| (f64::from(picture.values[*i]) - want).abs();
        picks.iter().zip(&expected_light).map(at).collect()
    };
    let wedge = key.width_rad / slices as f64;
    let error = ShadeError::new(device_march_slope(relief, 66.0), relief, 66.0, slices);
    let bound = error.sun(key.width_rad) + key.width_rad / PI * wedge * wedge / 24.0 * FRAC_PI_2;
    let worst = off(&mut gpu, Method::BruteForce).into_iter().fold(0.0, f64::max);
    let swept = off(&mut gpu, Method::Sweep);
    let mean = swept.iter().sum::<f64>() / swept.len() as f64;
    let light = expected_light.iter().sum::<f64>() / expected_light.len() as f64;
    println!("brute worst {worst:.2e} of {bound:.2e}; sweep mean {mean:.2e}; light {light:.2e}");
    assert!(worst <= bound, "{worst} {bound}");
    assert!(mean <= key.width_rad / PI * 0.3_f64.to_radians(), "{mean}");
    // Both comparisons can fail: the same light from elsewhere has a large error.
    let turned = KeyLight { azimuth_rad: key.azimuth_rad + 0.3, ..key };
    let far = picks
        .iter()
        .zip(&expected_light)
        .map(|(i, want)| (key_of(&oracle, i / 256, i % 256, &turned, slices)[0] - want).abs());
    assert!(far.sum::<f64>() / picks.len() as f64 > key.width_rad / PI * 0.3_f64.to_radians());
}

/// Path tracing against the quadrature: patches from below horizontal, at the zenith and all around, with two bounces;
/// a channel without light stays black.
#[test]
fn paths_to_keys_agree_with_the_quadrature() {
    const BATCHES: usize = 64;
    let mut device = Device::new();
    let mountains = fractal(10, 3).expect("a field");
    let steep =
        field(10, 10, [1.0, 1.5], |r, c| 3.0 * f64::from(mountains.heights_m()[r * 10 + c]));
    let colour = |key: KeyLight, radiance| KeyLight { radiance, ..key };
    for border in [Border::Plane, Border::Open, Border::Periodic] {
        // A channel each.
        let keys = vec![
            colour(key(200.0, 70.0, [-20.0, 30.0]), [3.0, 0.0, 0.0]),
            colour(key(20.0, 300.0, [70.0, 90.0]), [0.0, 2.0, 0.0]),
            colour(key(0.0, 360.0, [-90.0, 90.0]), [0.0, 0.0, 1.0]),
        ];
        let mut scene = under_sky(steep.clone(), border);
        scene.surface.albedo = Albedo::Constant([0.7; 3]);
        scene.lights = Lights { keys, ..Lights::default() };
        let fineness = Fineness { azimuths: 24, divisions: 1, strips: 48 };
        let expected_light = expected_light(&scene, 2, fineness).expect("a ground truth");
        for b in [0, 2] {
            let [light, error] = &traced(&mut device, &scene, b as u32, 1, BATCHES);
            let paths = (BATCHES as u32 * ridgelight::plan::REFERENCE_BATCH) as f64;
            let against = |b: usize| {
                let right = [&expected_light.radiance[b][..], &expected_light.error[b]];
                Agreement::of([light, error], right, paths, 1e-5)
            };
            let of = against(b);
            println!("{border:?}, {b} bounces: rms {:.3}, worst {:.2}", of.rms, of.worst);
            assert!(of.holds(), "{border:?}, {b} bounces: {of:?}");
            assert!(b != 0 || !against(2).holds(), "passes without bounces");
        }
    }
}

//! Direct Phong specular of key lights in pictures: against closed forms, and against the oracle's horizons.

use std::f64::consts::TAU;

use glam::DVec3;
use ridgelight::basis::quadrature::integral;
use ridgelight::plan::azimuths::across_key;
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{
    Albedo, Border, HeightField, KeyLight, Lights, Method, PhongSpecular, Quality, Scene, Specular,
    Surface, normal,
};
use ridgelight_cpu::key_specular::key_specular;
use ridgelight_cpu::mirror_map::mirrored;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::specular_tables::phong_error;
use ridgelight_cpu::tolerance::{EPSILON, ShadeError, device_march_slope};

use crate::{Device, field, random};

const SCALE: f32 = 0.5;

fn key(azimuth_rad: f64, width_rad: f64, elevations_rad: [f64; 2]) -> KeyLight {
    KeyLight { azimuth_rad, width_rad, elevations_rad, radiance: [2.0; 3] }
}

/// Phong specular without a diffuse part.
fn shiny(field: HeightField, border: Border, key: KeyLight, exponent: f32) -> Scene {
    let specular = Some(Specular::Constant(PhongSpecular { exponent, scale: SCALE }));
    let surface = Surface { border, albedo: Albedo::Constant([0.0; 3]), specular };
    Scene { field, surface, lights: Lights { keys: vec![key], ..Lights::default() } }
}

/// Exit radiance of each grid point, by marches, which find all crossings.
fn drawn(gpu: &mut Device, scene: &Scene, sun_azimuths: u32, eye_m: Option<[f64; 3]>) -> Vec<f64> {
    let quality = Quality { method: Method::BruteForce, sun_azimuths, ..Quality::default() };
    let wanted = Picture { eye_m, ..Picture::default() };
    let plan = plan::picture(scene, &quality, &gpu.limits(), wanted).expect("a plan");
    let lit = gpu.draw(plan, &[scene.field.heights_m()]).remove(0);
    lit.values.iter().step_by(lit.channels).map(|v| f64::from(*v)).collect()
}

/// The mirror direction of the view at a grid point, and the normal.
fn mirror_at(
    field: &HeightField,
    border: Border,
    [row, col]: [usize; 2],
    eye_m: Option<[f64; 3]>,
) -> [DVec3; 2] {
    let normal = normal(field, border, row, col);
    let [x, y] = field.cell_m();
    let height = f64::from(field.heights_m()[row * field.cols() + col]) + field.base_m();
    let at = DVec3::new(col as f64 * x, (field.rows() - 1 - row) as f64 * y, height);
    let view = eye_m.map_or(DVec3::Z, |eye| (DVec3::from_array(eye) - at).normalize());
    [mirrored(normal, view), normal]
}

/// Specular of scale 1 under a key light of radiance 1 at a grid point. The lobe is integrated over equal parts of the patch, each
/// above the oracle's horizon in its middle and above the grid point's own plane, by Gauss' rule over elevations.
fn by_oracle(
    oracle: &Oracle,
    place: [usize; 2],
    key: &KeyLight,
    (n, eye_m): (f64, Option<[f64; 3]>),
    parts: u32,
) -> f64 {
    let [mirror, normal] = mirror_at(oracle.field(), oracle.border(), place, eye_m);
    let width = key.width_rad / f64::from(parts);
    let mut sum = 0.0;
    for k in 0..parts {
        let phi = key.azimuth_rad - key.width_rad / 2.0 + width * (f64::from(k) + 0.5);
        let (sin, cos) = phi.sin_cos();
        let across = mirror.x * sin - mirror.y * cos;
        // The lobe has no light in this azimuth.
        if (1.0 - across * across).max(0.0).powf(0.5 * n) < 1e-9 {
            continue;
        }
        let plane = (-(normal.x * cos + normal.y * sin)).atan2(normal.z);
        let horizon = oracle.elevation_rad(place[0], place[1], phi).max(plane);
        let (low, high) = (key.elevations_rad[0].max(horizon), key.elevations_rad[1]);
        if low >= high {
            continue;
        }
        let at = |w: f64| {
            let e = DVec3::new(w.cos() * cos, w.cos() * sin, w.sin());
            e.dot(mirror).max(0.0).powf(n) * w.cos()
        };
        // Each panel has 32 points.
        let panels = ((high - low) * (n + 1.0).sqrt() / 4.0).ceil();
        let panel = (high - low) / panels;
        for i in 0..panels as u32 {
            let first = low + panel * f64::from(i);
            sum += width * integral(first, first + panel, at);
        }
    }
    (n + 1.0) / TAU * sum
}

/// Level ground mirrors the zenith to the zenith. A patch that covers a share of the circle gives that share of sin^(n + 1) between
/// its elevations, for any number of slices.
#[test]
fn level_ground_has_its_closed_form() {
    let mut gpu = Device::new();
    let keys = [
        key(0.0, TAU, [0.3, 1.5]),
        key(1.0, 0.5, [1.1, 1.12]),
        key(-2.0, 2.0, [-0.5, std::f64::consts::FRAC_PI_2]),
    ];
    let borders = [Border::Plane, Border::Open, Border::Periodic];
    let mut checked = 0;
    for (i, (key, border)) in keys.into_iter().zip(borders).enumerate() {
        for (j, exponent) in [1.0_f32, 20.0, 100.0, 1000.0].into_iter().enumerate() {
            let n = f64::from(exponent);
            let level = field(5, 9, [1.0, 2.0], |_, _| 7.0);
            let scene = shiny(level, border, key, exponent);
            let sun_azimuths = [1, 8, 30][(i + j) % 3];
            let lowest = if border == Border::Open { -1e9 } else { 0.0 };
            let [low, high] = key.elevations_rad.map(|w| w.max(f64::atan(lowest)).sin());
            // A lobe about the zenith ends at horizontal.
            let share = high.powf(n + 1.0) - low.max(0.0).powf(n + 1.0);
            let want = 2.0 * f64::from(SCALE) * key.width_rad / TAU * share;
            let of = |azimuth| key_specular(n, azimuth, (DVec3::Z, lowest), [20.0 * EPSILON, 0.0]);
            let slices = across_key(&key, key.slices(sun_azimuths).max(8), [1.0, 2.0]);
            // A narrow lobe has more slices, but the sum of their tolerances is the same.
            let off: f64 = slices.iter().map(|azimuth| of(azimuth)[1]).sum();
            let tolerance = 2.0 * f64::from(SCALE) * off + 300.0 * EPSILON * want;
            for found in drawn(&mut gpu, &scene, sun_azimuths, None) {
                let error = (found - want).abs();
                assert!(error <= tolerance, "{key:?} {n}: {found} for {want} ± {tolerance}");
            }
            checked += usize::from(want > 10.0 * tolerance);
        }
    }
    // The other cases reflect nearly nothing.
    assert!(checked >= 8, "{checked}");
}

/// The largest share of a lobe of exponent n that a patch can contain: all of it, or the patch's height over √2π / √(n + 1), the
/// ratio of a slice's integral to its peak.
fn largest_share(n: f64, key: &KeyLight) -> f64 {
    let [low, high] = key.elevations_rad;
    ((high - low) * ((n + 1.0) / TAU).sqrt()).min(1.0)
}

/// Error of a lobe's integral by slices of width h: h² / 24 times the variation of the slope, which is at most 2.43 σ^-2 of the
/// integral over √2π, σ = 1 / √(n + 1). Twice that where a patch ends within the lobe.
fn slices_error(n: f64, wedge_rad: f64) -> f64 {
    wedge_rad * wedge_rad * (n + 1.0) / 12.0
}

/// On level ground an eye views the reflection of a patch, or of a place beside it: compared with the same integral by 1,024
/// azimuths. The eye is far enough away that all grid points reflect nearly the same direction.
#[test]
fn level_ground_reflects_a_patch_to_the_eye() {
    let mut gpu = Device::new();
    let level = field(4, 5, [1.0, 1.0], |_, _| 3.0);
    let oracle = Oracle::new(&level, Border::Plane);
    // As high in the west as the patches are in the east.
    let eye_m = Some([2.0 - 40.0 * 0.5_f64.cos(), 1.5, 3.0 + 40.0 * 0.5_f64.sin()]);
    let keys = [
        key(0.0, 0.03, [0.49, 0.51]),
        key(0.0, 0.8, [0.2, 0.9]),
        key(0.3, 0.5, [0.0, 0.5]),
        key(0.1, TAU, [0.3, 0.6]),
    ];
    let mut checked = 0;
    for (key, exponent) in
        keys.iter().flat_map(|key| [1.0_f32, 20.0, 100.0, 1000.0].map(|n| (key, n)))
    {
        let n = f64::from(exponent);
        let scene = shiny(level.clone(), Border::Plane, *key, exponent);
        let found = drawn(&mut gpu, &scene, 128, eye_m);
        let brightness = 2.0 * f64::from(SCALE);
        let wedge = key.width_rad / 128.0;
        let share = largest_share(n, key);
        // Directions of f32, at which a lobe changes by √(n / e) of its peak per radian.
        let rounded = key.width_rad * (2.0 * phong_error(n) + (n + 1.0) / TAU * 100.0 * EPSILON)
            + (n / std::f64::consts::E).sqrt() * 100.0 * EPSILON * share;
        let bound = brightness * (share * slices_error(n, wedge) + rounded);
        for (i, found) in found.iter().enumerate() {
            let want = brightness * by_oracle(&oracle, [i / 5, i % 5], key, (n, eye_m), 1024);
            let error = (found - want).abs();
            assert!(error <= bound, "{key:?} {n} texel {i}: {found} for {want} ± {bound}");
            checked += usize::from(want > 5.0 * bound);
        }
    }
    // Most comparisons could fail.
    assert!(checked > 200, "{checked}");
}

/// Rough ground, viewed from above and by an eye at its side, against the oracle's horizons in the middle of as many slices: the root
/// mean square over texels. A patch that is turned by half a radian has a larger error. Marches err by their slopes. Texels that
/// reflect less than a thousandth, here and there, err by no more.
///
/// Slices themselves: against the oracle in twice as many. A horizon is known in the middle of each, so that an edge is misplaced by up
/// to half a slice: h / √12 in the root mean square, of four edges √4 times that, of a lobe √(2π / (n + 1)) wide; for both numbers.
#[test]
fn rough_ground_reflects_what_its_horizons_leave() {
    const SIDES: [usize; 2] = [12, 13];
    const RELIEF_M: f64 = 1.5;
    let mut gpu = Device::new();
    let mut next = random(61);
    let noise: Vec<f64> = (0..SIDES[0] * SIDES[1]).map(|_| next()).collect();
    let rough = field(SIDES[0], SIDES[1], [1.0, 1.0], |r, c| RELIEF_M * noise[r * SIDES[1] + c]);
    let oracle = Oracle::new(&rough, Border::Plane);
    let places: Vec<usize> = (0..noise.len()).step_by(2).collect();
    let keys = [key(0.4, 2.5, [0.35, 1.2]), key(1.0, 2.5, [0.9, 0.98])];
    let eyes = [None, Some([-9.0, 4.0, 8.0])];
    let slope = device_march_slope(RELIEF_M, 1.0);
    let normal_error = ShadeError::new(slope, RELIEF_M, 1.0, 256).normal();
    let brightness = 2.0 * f64::from(SCALE);
    let of_keys = keys.iter().flat_map(|key| [1.0_f32, 20.0, 100.0, 1000.0].map(|n| (key, n)));
    for ((key, exponent), eye_m) in of_keys.flat_map(|of| eyes.map(|eye| (of, eye))) {
        let n = f64::from(exponent);
        let share = largest_share(n, key);
        let scene = shiny(rough.clone(), Border::Plane, *key, exponent);
        // At a width of 2.5 radians, 256 slices.
        let drawn = drawn(&mut gpu, &scene, 64, eye_m);
        let found: Vec<f64> = places.iter().map(|p| drawn[*p]).collect();
        let wanted = |key: &KeyLight, parts: u32| -> Vec<f64> {
            let at = |p: &usize| {
                let place = [p / SIDES[1], p % SIDES[1]];
                brightness * by_oracle(&oracle, place, key, (n, eye_m), parts)
            };
            places.iter().map(at).collect()
        };
        let apart = |a: &[f64], b: &[f64]| {
            let squares = a.iter().zip(b).map(|(a, b)| (a - b).powi(2));
            (squares.sum::<f64>() / places.len() as f64).sqrt()
        };
        let right = wanted(key, 256);
        let little = 1e-3 * brightness * share;
        let is_lit = |(found, want): &(&f64, &f64)| found.max(**want) > little;
        let lit = found.iter().zip(&right).filter(is_lit).count() as f64 / places.len() as f64;
        let of_slices = |parts: f64| {
            let wedge = key.width_rad / parts;
            let edges = (4.0 / 12.0_f64).sqrt() * wedge * ((n + 1.0) / TAU).sqrt();
            share * (edges + slices_error(n, wedge))
        };
        let turned_rad = 2.0 * normal_error + 100.0 * EPSILON;
        let rounded = key.width_rad
            * (2.0 * phong_error(n) + (n + 1.0) / TAU * (2.0 * slope + 100.0 * EPSILON))
            + (n / std::f64::consts::E).sqrt() * turned_rad * share;
        let limit = |each: f64| (lit * (brightness * each).powi(2) + little * little).sqrt();
        let bound = limit(rounded);
        let error = apart(&found, &right);
        let turned = KeyLight { azimuth_rad: key.azimuth_rad + 0.5, ..*key };
        let wrong = apart(&found, &wanted(&turned, 256));
        let sliced = apart(&right, &wanted(key, 512));
        let slices = limit(of_slices(256.0) + of_slices(512.0));
        let of = format!("{n} {:?} {eye_m:?}", key.elevations_rad);
        println!(
            "{of}: {error:.2e} of {bound:.2e}, turned {wrong:.2e}; {sliced:.2e} of {slices:.2e}"
        );
        assert!(error <= bound, "{of}: {error} of {bound}");
        assert!(sliced <= slices, "{of}: slices: {sliced} of {slices}");
        assert!(wrong > bound, "cannot fail: {of}: {wrong} of {bound}");
    }
}

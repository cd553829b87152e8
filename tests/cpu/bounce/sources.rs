//! Sphere lights, Phong specular and key lights in the quadrature.

use ridgelight::scene::{
    Border, HeightField, KeyLight, Lights, PhongSpecular, Scene, Specular, SphereLight, Sun,
};
use ridgelight_cpu::indirect::{Fineness, ground_truth as expected_light, light};
use ridgelight_cpu::light::sun_of;
use ridgelight_cpu::oracle::Oracle;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{COARSE, red, rough, under_sky};
use crate::{BORDERS, field};

const FINE: Fineness = Fineness { azimuths: 8, divisions: 1, strips: 64 };

fn under_sphere_light(
    field: HeightField,
    border: Border,
    position_m: [f64; 3],
    radius_m: f64,
) -> Scene {
    let mut scene = under_sky(field, border, 1.0);
    let light = SphereLight { position_m, radius_m, radiance: [1.0; 3] };
    scene.lights = Lights { sphere_lights: vec![light], ..Lights::default() };
    scene
}

fn direct(scene: &Scene) -> Vec<f64> {
    red(&light(scene, 0, FINE).unwrap()[0])
}

/// A sphere light wholly above the ground, d away in a direction with cosine cos to the normal: L (r/d)² cos,
/// also from straight below. One whose centre lies in the ground is half visible, which with sin a = r/d gives
/// L (a - sin a cos a)/π, like a half-set sun. One that contains the texel gives L.
#[test]
fn a_sphere_light_over_flat_ground_has_closed_forms() {
    for border in BORDERS {
        let flat = || field(5, 7, [1.0, 2.0], |_, _| 300.0);
        // Texel (1, 2) stands at x = 2, y = 6.
        let at = 7 + 2;
        for (place, radius) in
            [([5.0, 7.0, 304.0], 1.5), ([-400.0, 90.0, 390.0], 60.0), ([2.0, 6.0, 302.0], 1.0)]
        {
            let away = [place[0] - 2.0, place[1] - 6.0, place[2] - 300.0];
            let squared: f64 = away.iter().map(|v| v * v).sum();
            let expected = radius * radius / squared * away[2] / squared.sqrt();
            let answer = direct(&under_sphere_light(flat(), border, place, radius))[at];
            // Smooth and periodic in the strips' variable.
            assert!((answer - expected).abs() < 1e-10 * expected, "{place:?} {answer} {expected}");
        }
        let sunk = direct(&under_sphere_light(flat(), border, [6.0, 9.0, 300.0], 2.0))[at];
        let (sin, a) = (0.4_f64, 0.4_f64.asin());
        let expected = (a - sin * a.cos()) / PI;
        assert!((sunk - expected).abs() < 1e-9, "{border:?} {sunk} {expected}");
        let around = direct(&under_sphere_light(flat(), border, [2.5, 6.0, 300.5], 3.0))[at];
        assert!((around - 1.0).abs() < 1e-12, "{border:?} {around}");
        let below = direct(&under_sphere_light(flat(), border, [2.0, 6.0, 290.0], 9.0))[at];
        assert_eq!(below, 0.0);
    }
}

/// From one texel a sphere light beyond all ground is a sun with the same disc: diameter 2 asin(r/d),
/// irradiance L π (r/d)², occluded by the same horizon. Both are cut into the same strips.
#[test]
fn a_distant_sphere_light_is_a_sun() {
    let rough = rough(7, 7, [1.0, 1.0], 5.0);
    for elevation in [0.1, 0.4, 0.8_f64] {
        for (row, col, azimuth) in [(3, 3, 0.4), (1, 5, 2.0), (6, 2, 5.0_f64)] {
            let own = rough.base_m() + f64::from(rough.heights_m()[row * 7 + col]);
            let (distance, radius) = (1000.0, 90.0);
            let flat = distance * elevation.cos();
            let place = [
                col as f64 + flat * azimuth.cos(),
                (6 - row) as f64 + flat * azimuth.sin(),
                own + distance * elevation.sin(),
            ];
            let share = radius / distance;
            let disc = Sun {
                azimuth_rad: azimuth,
                elevation_rad: elevation,
                diameter_rad: 2.0 * share.asin(),
                irradiance: [1.0; 3],
            };
            let scene = under_sphere_light(rough.clone(), Border::Plane, place, radius);
            let light = direct(&scene)[row * 7 + col];
            let expected =
                sun_of(&Oracle::one_ray(&rough, Border::Plane), row, col, &disc, FINE.strips)[0];
            let expected = expected * PI * share * share;
            assert!(
                (light - expected).abs() < 1e-12,
                "{elevation} {row} {col}: {light} {expected}"
            );
        }
    }
}

/// A wall hides a sphere light behind it and not one before it, even where it would hide a sun.
#[test]
fn a_wall_hides_only_sphere_lights_behind_it() {
    let wall = || field(21, 12, [1.0, 1.0], |_, c| if c >= 8 { 30.0 } else { 0.0 });
    let at = 10 * 12 + 1;
    let before = direct(&under_sphere_light(wall(), Border::Plane, [4.0, 10.0, 2.0], 0.5))[at];
    let expected = 0.25 / 13.0 * 2.0 / 13_f64.sqrt();
    assert!((before - expected).abs() < 1e-10, "{before} {expected}");
    let behind = direct(&under_sphere_light(wall(), Border::Plane, [30.0, 10.0, 2.0], 10.0))[at];
    assert_eq!(behind, 0.0);
}

/// A sphere light in a slope is visible where it stands out of it, and a texel inside a sphere light loses the part
/// behind the slope: both against counting directions, as (φ, sin ω) of equal weights, with the ramp z = 2 (x - 6) and
/// the sphere intersected by formula. n² directions err by their rim's share, about 4/n of the answer.
#[test]
fn a_slope_cuts_a_sphere_light() {
    let ramp = || field(15, 16, [1.0, 1.0], |_, c| 2.0 * (c as f64 - 6.0).max(0.0));
    // Texel (7, 3) stands at (3, 7, 0).
    for (centre, radius) in [([4.0, 0.0, 3.0], 1.5), ([5.0, 1.5, 3.0], 2.0), ([1.0, 0.0, 0.5], 3.5)]
    {
        let place = [3.0 + centre[0], 7.0 + centre[1], centre[2]];
        let answer = direct(&under_sphere_light(ramp(), Border::Plane, place, radius))[7 * 16 + 3];
        let n = 300;
        let mut sum = 0.0;
        for i in 0..n * n {
            let azimuth = (f64::from(i / n) + 0.5) / f64::from(n) * 2.0 * PI;
            let up = (f64::from(i % n) + 0.5) / f64::from(n);
            let level = (1.0 - up * up).sqrt();
            let e = [level * azimuth.cos(), level * azimuth.sin(), up];
            let ahead: f64 = e.iter().zip(centre).map(|(e, c)| e * c).sum();
            let outside: f64 = centre.iter().map(|c| c * c).sum::<f64>() - radius * radius;
            let root = ahead * ahead - outside;
            let met = ahead - root.max(0.0).sqrt().copysign(outside);
            let ground = 6.0 / (2.0 * e[0] - e[2]);
            if root > 0.0 && met > 0.0 && (ground < 0.0 || met < ground) {
                sum += up * 2.0 / (f64::from(n) * f64::from(n));
            }
        }
        assert!((answer - sum).abs() < 4.0 / f64::from(n) * sum, "{place:?} {answer} {sum}");
    }
}

/// Finer divisions of cells do not change the light of a sphere light.
#[test]
fn direct_light_does_not_depend_on_divisions() {
    for border in BORDERS {
        let scene = under_sphere_light(rough(4, 5, [1.0, 2.0], 2.0), border, [2.0, 3.0, 5.0], 1.0);
        let fine = light(&scene, 0, Fineness { divisions: 2, ..FINE }).unwrap();
        for (a, b) in direct(&scene).iter().zip(red(&fine[0])) {
            // Heights between texels are rounded to f32.
            assert!((a - b).abs() < 1e-6 * a.max(1e-2), "{border:?} {a} {b}");
        }
    }
}

/// Phong lobes about the mirror direction r of the zenith, under a sky: the whole scale on flat ground, for any
/// n. On a slope under `open` the hemisphere cuts the lobe at an angle θ = tilt from r: for n = 1 it is a
/// cosine about r, of which (1 + cos θ)/2 is left. A point sun at an angle δ from r gives E (n+1)/(2π) cosⁿδ.
#[test]
fn phong_specular_has_closed_forms() {
    let of = |mut scene: Scene, exponent: f32| {
        scene.surface = ridgelight::scene::Surface {
            albedo: ridgelight::scene::Albedo::Constant([0.0; 3]),
            specular: Some(Specular::Constant(PhongSpecular { exponent, scale: 0.5 })),
            ..scene.surface
        };
        let fineness = Fineness { azimuths: 64, divisions: 1, strips: 1 };
        red(&light(&scene, 0, fineness).unwrap()[0])[12]
    };
    let flat = || field(5, 5, [1.0, 1.0], |_, _| 0.0);
    let ramp = || field(5, 5, [1.0, 1.0], |_, c| 0.5 * c as f64);
    for exponent in [0.0, 1.0, 7.5, 1e4] {
        let whole = of(under_sky(flat(), Border::Plane, 0.0), exponent);
        assert!((whole - 0.5).abs() < 1e-5, "{exponent} {whole}");
        let mut lit = under_sky(ramp(), Border::Plane, 0.0);
        let delta: f64 = 0.3;
        // r leans downhill, to the west, by twice the tilt; the sun beyond it by δ.
        let lean = 2.0 * 0.5_f64.atan() + delta / f64::from(exponent + 1.0).sqrt();
        let sun = Sun {
            azimuth_rad: PI,
            elevation_rad: 0.5 * PI - lean,
            diameter_rad: 0.0,
            irradiance: [1.0; 3],
        };
        lit.lights = Lights { suns: vec![sun], ..Lights::default() };
        let n = f64::from(exponent);
        let expected = 0.5 * (n + 1.0) / (2.0 * PI) * (delta / (n + 1.0).sqrt()).cos().powf(n);
        let answer = of(lit, exponent);
        assert!((answer - expected).abs() < 1e-9 * expected, "{exponent} {answer} {expected}");
    }
    let cut = of(under_sky(ramp(), Border::Open, 0.0), 1.0);
    let expected = 0.25 * (1.0 + 0.5_f64.atan().cos());
    assert!((cut - expected).abs() < 1e-3, "{cut} {expected}");
}

/// The stated error is about that of the coarser answer, so it bounds the finer answer's error against one of
/// twice the fineness. Compared by RMS, as two answers may agree by accident at single texels.
#[test]
fn the_stated_error_bounds_the_error() {
    let scene = under_sky(rough(6, 6, [1.0, 1.0], 3.0), Border::Plane, 0.8);
    let stated =
        expected_light(&scene, 2, Fineness { azimuths: 16, divisions: 1, strips: 4 }).unwrap();
    let finest = Fineness { azimuths: 64, divisions: 4, strips: 16 };
    let exact = light(&scene, 2, finest).unwrap();
    for (b, exact) in exact.iter().enumerate() {
        let rms = |v: &[f64]| (v.iter().map(|x| x * x).sum::<f64>() / v.len() as f64).sqrt();
        let (got, want) = (red(&stated.radiance[b]), red(exact));
        let off: Vec<f64> = got.iter().zip(&want).map(|(a, b)| a - b).collect();
        let error = red(&stated.error[b]);
        println!("bounce {b}: off {:.2e}, stated {:.2e}", rms(&off), rms(&error));
        assert!(rms(&off) < rms(&error));
    }
}

/// Wrong settings are named.
#[test]
fn a_fineness_of_zero_is_refused() {
    let scene = under_sky(field(2, 2, [1.0, 1.0], |_, _| 0.0), Border::Plane, 1.0);
    let said = light(&scene, 0, Fineness { azimuths: 0, ..COARSE }).unwrap_err().to_string();
    assert!(said.starts_with("azimuths: "), "{said}");
}

/// A key light over the whole sphere of directions is the sky, for every border and number of bounces: its
/// strips are the sky's azimuths. Only the sky's weights are scaled to sum to 1.
#[test]
fn a_key_light_all_around_is_the_sky() {
    for border in BORDERS {
        let sky = under_sky(rough(5, 6, [1.0, 2.0], 1.5), border, 0.6);
        let radiance = sky.lights.sky.unwrap();
        let key = KeyLight {
            azimuth_rad: PI,
            width_rad: TAU,
            elevations_rad: [-FRAC_PI_2, FRAC_PI_2],
            radiance,
        };
        let lights = Lights { keys: vec![key], ..Lights::default() };
        let fineness = Fineness { azimuths: 32, divisions: 1, strips: 32 };
        let key = light(&Scene { lights, ..sky.clone() }, 2, fineness).unwrap();
        let sky = light(&sky, 2, fineness).unwrap();
        // The midpoint rule over 32 azimuths errs by (π/16)²/24 of the hemisphere's tilted part.
        let off = (PI / 16.0).powi(2) / 24.0;
        for (key, sky) in key.iter().flatten().zip(sky.iter().flatten()) {
            assert!((key[0] - sky[0]).abs() <= off * sky[0], "{border:?}: {key:?} {sky:?}");
        }
    }
}

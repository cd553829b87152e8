//! Suns and key lights.

use glam::DVec3;
use ridgelight::scene::{Border, KeyLight, Lights, Scene, Sun, Surface};
use ridgelight_cpu::light::{key_of, sky_of, sun_of};
use ridgelight_cpu::lit::Lit;
use ridgelight_cpu::oracle::Oracle;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{plane, sun_at};
use crate::{BORDERS, field};

/// A disc wholly above the horizon and the plane of the normal: ∫ e de over it is π sin²a times its
/// centre, so exit radiance is E (N·s)/π whatever its size; also where it holds the zenith.
#[test]
fn a_free_sun_lights_by_the_cosine_of_its_centre() {
    let e = f64::from(PI as f32) / PI;
    for (east, north) in [(0.0, 0.0), (0.25, -0.125)] {
        let ground = plane(5, 5, [1.0, 1.0], east, north);
        let n = DVec3::new(-east, -north, 1.0).normalize();
        for (azimuth, elevation, diameter) in [
            (0.3, 0.7, 0.0),
            (0.3, 0.7, 0.0093),
            (5.0, 0.9, 1e-6),
            (2.0, 1.0, 0.8),
            (1.0, 1.4, 0.8),
            (1.0, FRAC_PI_2, 0.5),
            (1.0, FRAC_PI_2, 0.0),
        ] {
            let s = DVec3::new(
                f64::cos(elevation) * f64::cos(azimuth),
                f64::cos(elevation) * f64::sin(azimuth),
                f64::sin(elevation),
            );
            let disc = sun_at(azimuth, elevation, diameter);
            let [r, g, _] = sun_of(&Oracle::one_ray(&ground, Border::Plane), 2, 2, &disc, 256);
            // Smooth and periodic in the strips' variable: only rounding is left. The smallest disc's
            // chords are differences of angles near 1 of size 1e-6.
            assert!((r - e * n.dot(s)).abs() < 1e-9, "{disc:?} {r} {}", e * n.dot(s));
            assert_eq!(g, 0.0);
        }
    }
}

/// f32's π/2, `asin(1.0)`, is above π/2. It gives the bits of π/2, beside a wall too. f32's 2π is above 2π: a key light
/// of that width has the azimuths of a sky, 720, and not one more.
#[test]
fn f32_right_angles_light_like_exact_ones() {
    let exact = [FRAC_PI_2, TAU];
    let rounded = [std::f32::consts::FRAC_PI_2, std::f32::consts::TAU].map(f64::from);
    assert!(rounded[0] > exact[0] && rounded[1] > exact[1]);
    let wall = field(9, 8, [1.0, 1.0], |r, c| if c == 5 { 5.0 } else { 0.3 * (r % 3) as f64 });
    for border in BORDERS {
        let oracle = Oracle::one_ray(&wall, border);
        let of = |[right, turn]: [f64; 2]| {
            let lit_suns = [0.0, 0.01, right].map(|diameter| sun_at(0.3, right, diameter));
            let key = |width_rad, low| KeyLight {
                azimuth_rad: 0.3,
                width_rad,
                elevations_rad: [low, right],
                radiance: [1.0; 3],
            };
            let suns = lit_suns.map(|sun| sun_of(&oracle, 4, 4, &sun, 32));
            let keys = [key(turn, -right), key(1.0, 1.54)];
            let scene = |suns: &[Sun], keys: &[KeyLight]| Scene {
                field: wall.clone(),
                surface: Surface { border, ..Surface::default() },
                lights: Lights { suns: suns.to_vec(), keys: keys.to_vec(), ..Lights::default() },
            };
            assert_eq!(Lit::of(&scene(&[], &keys[..1])).rays(), 720);
            let together = Lit::of(&scene(&lit_suns, &keys)).at(4, 4);
            let keys = keys.map(|k| key_of(&oracle, 4, 4, &k, 32));
            let all = suns.into_iter().chain(keys).chain([together]);
            all.flatten().map(f64::to_bits).collect::<Vec<_>>()
        };
        assert_eq!(of(rounded), of(exact), "{border:?}");
    }
}

/// A disc centred on a level horizon, half of it set. The flux of e through its upper half is
/// ½∮ e × de along its rim: the arc of the horizon gives a, the half circle -sin a cos a. So
/// exit radiance is (E/π)(a - sin a cos a)/(π sin²a). Under `open` flat ground's own plane cuts alike.
#[test]
fn a_half_set_sun_gives_its_upper_half() {
    let flat = field(5, 5, [1.0, 1.0], |_, _| 0.0);
    for diameter in [0.0093, 0.3, 1.5] {
        let a = 0.5 * diameter;
        let expected = (a - f64::sin(a) * f64::cos(a)) / (PI * f64::sin(a).powi(2));
        for border in BORDERS {
            let [r, ..] =
                sun_of(&Oracle::one_ray(&flat, border), 2, 2, &sun_at(2.0, 0.0, diameter), 512);
            let e = f64::from(PI as f32) / PI;
            // a - sin a cos a cancels: 2a³/3 from terms of size a, relative rounding 1e-16/a².
            assert!((r - e * expected).abs() < 1e-10 * expected.max(1e-3), "{r} {expected}");
        }
    }
    assert_eq!(
        sun_of(&Oracle::one_ray(&flat, Border::Plane), 2, 2, &sun_at(2.0, 0.0, 0.0), 1)[0],
        0.0
    );
}

/// A point sun passes a wall's top between one hair below and one above it; a disc whose lower half
/// the (locally straight, wide) wall hides gives between a third and two thirds.
#[test]
fn a_wall_casts_hard_and_soft_shadows() {
    let wall = field(401, 8, [1.0, 1.0], |_, c| if c == 7 { 5.0 } else { 0.0 });
    let top = 1_f64.atan(); // 5 m at 5 m
    let at = |elevation, diameter| {
        sun_of(
            &Oracle::one_ray(&wall, Border::Plane),
            200,
            2,
            &sun_at(0.0, elevation, diameter),
            64,
        )[0]
    };
    assert_eq!(at(top - 1e-9, 0.0), 0.0);
    let free = f64::from(PI as f32) / PI * (top + 1e-9).sin();
    assert!((at(top + 1e-9, 0.0) - free).abs() < 1e-12);
    let half = at(top, 0.02) / free;
    // By symmetry half the disc; its upper half leans towards the zenith by cot(top)·(4/3π)a/2 < a,
    // and the wall's edge bends over the disc's width by less than a².
    assert!((half - 0.5).abs() < 0.01, "{half}");
    assert_eq!(at(top - 0.011, 0.02), 0.0);
    assert!((at(top + 0.011, 0.02) / f64::sin(top + 0.011) - free / top.sin()).abs() < 1e-8);
}

fn key(azimuth: f64, width: f64, [low, high]: [f64; 2]) -> KeyLight {
    KeyLight {
        azimuth_rad: azimuth.to_radians(),
        width_rad: width.to_radians(),
        elevations_rad: [low.to_radians(), high.to_radians()],
        radiance: [2.0, 0.0, 1.0],
    }
}

/// ∫∫ sin ω cos ω dω dφ = width (sin²high - sin²low) / 2 on level ground, over π, however many strips.
#[test]
fn a_key_over_level_ground_has_its_closed_form() {
    let flat = field(5, 5, [1.0, 3.0], |_, _| 40.0);
    for border in BORDERS {
        let oracle = Oracle::new(&flat, border);
        for (azimuth, width, [low, high]) in
            [(0.0, 360.0, [0.0, 90.0]), (77.0, 20.0, [10.0, 30.0]), (-200.0, 1e-3, [89.0, 90.0])]
        {
            let key = key(azimuth, width, [low, high]);
            let sin2 = |degrees: f64| degrees.to_radians().sin().powi(2);
            let expected = 2.0 * width.to_radians() * (sin2(high) - sin2(low)) / 2.0 / PI;
            assert!((2.0 * key.level_irradiance() / PI - expected).abs() < 1e-15);
            for strips in [1, 3, 100] {
                let [r, g, b] = key_of(&oracle, 2, 2, &key, strips);
                assert!(
                    (r - expected).abs() < 1e-14,
                    "{border:?} {key:?} {strips}: {r} {expected}"
                );
                assert_eq!((g, b), (0.0, r / 2.0));
            }
        }
        // Light from below horizontal adds nothing on level ground.
        let below = |low, high| key_of(&oracle, 2, 2, &key(50.0, 90.0, [low, high]), 8)[0];
        assert!((below(-50.0, 40.0) - below(0.0, 40.0)).abs() < 1e-15);
        assert_eq!(below(-50.0, -1.0), 0.0);
    }
}

/// The whole upper hemisphere is a uniform sky, in its azimuths and on any ground that a border bounds from
/// below; from the nadir up it is an open border's.
#[test]
fn a_key_of_the_whole_sky_is_the_sky() {
    let rough = field(6, 7, [2.0, 3.0], |r, c| ((r * 31 + c * 17) % 7) as f64);
    for (border, low) in [(Border::Plane, 0.0), (Border::Periodic, 0.0), (Border::Open, -90.0)] {
        let oracle = Oracle::new(&rough, border);
        // Strips' middles are multiples of 10°.
        let all = key(5.0 + 180.0, 360.0, [low, 90.0]);
        for place in 0..42 {
            let (row, col) = (place / 7, place % 7);
            let expected = 2.0 * sky_of(&Oracle::one_ray(&rough, border), row, col, 36);
            let [r, ..] = key_of(&oracle, row, col, &all, 36);
            assert!((r - expected).abs() < 1e-12, "{border:?} {place}: {r} {expected}");
        }
    }
}

/// A wall's top cuts a key light from below: 5 m high and 5 m away, along the light's middle at 45°. Above it
/// nothing is lost, below it everything; in between the closed form of the rest holds.
#[test]
fn a_wall_cuts_a_key_from_below() {
    let wall = field(401, 8, [1.0, 1.0], |_, c| if c == 7 { 5.0 } else { 0.0 });
    let oracle = Oracle::new(&wall, Border::Plane);
    let at = |low, high| key_of(&oracle, 200, 2, &key(0.0, 0.01, [low, high]), 4)[0];
    let free = |low, high| 2.0 * key(0.0, 0.01, [low, high]).level_irradiance() / PI;
    // Over the light's width the wall's top sinks by less than 1e-8 rad.
    let near = |a: f64, b: f64| (a - b).abs() < 1e-7 * free(0.0, 90.0);
    assert!(near(at(46.0, 80.0), free(46.0, 80.0)));
    assert!(near(at(20.0, 80.0), free(45.0, 80.0)));
    assert_eq!(at(20.0, 44.9), 0.0);
}

//! Endless V-shaped grooves with slopes of 1: walls of length a at right angles, ridges all of one height.
//! Nothing changes along the groove, so a point at s from the bottom receives light from the other wall's
//! points at t with the kernel of two perpendicular strips, ½ s t / (s² + t²)^(3/2) dt.

use ridgelight::scene::{Border, Lights, Sun};
use ridgelight_cpu::indirect::Fineness;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};

use super::{reds, under_sky};
use crate::field;
use crate::reference_page::{HALF, WALL, groove_parts, grooves};

/// The largest error of a column over the walls. Bottom and ridge are left out: normals there are not a wall's.
fn worst(answer: &[f64], expected: &dyn Fn(f64) -> f64) -> f64 {
    (1..HALF)
        .flat_map(|i| [(HALF + i, i), (HALF - i, i)])
        .map(|(col, i)| (answer[col] - expected(i as f64 * SQRT_2)).abs())
        .fold(0.0, f64::max)
}

/// Sky light, and sky light reflected once and twice, for albedo ½. The sky is exact: slices and horizons are
/// closed forms, and the rule over azimuths leaves (√2 - 1)^azimuths for a slope of 1. Reflected light is
/// linear over each triangle instead of smooth: half the cells, a fourth of the error. For once reflected light
/// the error per cell c is at most (c²/8)·|L''| of the sky's, 1.5·½/(2a²).
#[test]
fn grooves_match_perpendicular_strips() {
    let scene = under_sky(grooves(1), Border::Periodic, 0.5);
    let [sky, once, twice] = groove_parts();
    let [coarse, fine] = [1, 2].map(|divisions| {
        let pictures = reds(&scene, 2, Fineness { azimuths: 40, divisions, strips: 1 });
        let part = |b: usize| -> Vec<f64> {
            pictures[b].iter().zip(&pictures[b - 1]).map(|(all, before)| all - before).collect()
        };
        assert!(worst(&pictures[0], sky.as_ref()) < 1e-14);
        [worst(&part(1), once.as_ref()), worst(&part(2), twice.as_ref())]
    });
    println!("errors of bounces 1 and 2: {coarse:?}, of half the cells {fine:?}");
    let cell = SQRT_2;
    assert!(coarse[0] < 0.25 * cell * cell / 8.0 * 1.5 * 0.5 / (2.0 * WALL * WALL));
    for b in 0..2 {
        let order = (coarse[b] / fine[b]).log2();
        assert!((order - 2.0).abs() < 0.1, "bounce {}: order {order}", b + 1);
    }
}

/// A point sun barely above one wall's slope lights only the other wall, and evenly. The indirect light of that wall
/// has a closed form, ρ (E/π) ½ (1 - s/√(s² + a²)): the radiance is constant, so the closed form of visible intervals
/// leaves only the rule over azimuths, smooth and periodic, and the sine of the sun's angle above the slope.
#[test]
fn a_lit_wall_lights_the_other() {
    let hair = 1e-7;
    let sun = Sun {
        azimuth_rad: 0.0,
        elevation_rad: FRAC_PI_4 + hair,
        diameter_rad: 0.0,
        irradiance: [PI as f32; 3],
    };
    let mut scene = under_sky(grooves(1), Border::Periodic, 0.5);
    scene.lights = Lights { suns: vec![sun], ..Lights::default() };
    let pictures = reds(&scene, 1, Fineness { azimuths: 128, divisions: 1, strips: 1 });
    for i in 1..HALF {
        let s = i as f64 * SQRT_2;
        // The western wall falls eastwards and faces the sun; the eastern faces west.
        let [west, east] = [HALF - i, HALF + i];
        assert!((pictures[0][west] - 0.5).abs() < 1e-6);
        assert!(pictures[0][east] < 1e-6);
        let expected = 0.25 * 0.5 * (1.0 - s / s.hypot(WALL));
        let error = (pictures[1][east] - pictures[0][east] - expected).abs();
        assert!(error < 2.0 * hair, "{i}: {error} of {expected}");
    }
}

/// Walls of lengths a and b that meet at a right angle exchange by crossed strings (a + b - c)/2, c the distance
/// between their ends; the exchange is symmetric. Each wall in turn reflects a constant light that falls straight down
/// (a point sun in the zenith); the mean share that the other wall receives is (a + b - c)/2 over its length.
#[test]
fn walls_exchange_by_crossed_strings() {
    // Slopes 2 over 4 columns and ½ over 16: a right angle, both 8 high, and so is the next groove's.
    let uneven =
        field(
            1,
            20,
            [1.0, 1.0],
            |_, c| if c < 4 { 8.0 - 2.0 * c as f64 } else { 0.5 * (c as f64 - 4.0) },
        );
    let zenith = Sun {
        azimuth_rad: 0.0,
        elevation_rad: FRAC_PI_2,
        diameter_rad: 0.0,
        irradiance: [PI as f32; 3],
    };
    let (steep, gentle) = (80_f64.sqrt(), 320_f64.sqrt());
    let exchanged = 0.5 * (steep + gentle - 20.0);
    let of = |wall: std::ops::RangeInclusive<usize>, lit: f64, length: f64| {
        let mut scene = under_sky(uneven.clone(), Border::Periodic, 1.0);
        scene.lights = Lights { suns: vec![zenith], ..Lights::default() };
        let fineness = Fineness { azimuths: 128, divisions: 1, strips: 1 };
        let pictures = reds(&scene, 1, fineness);
        // Bounce 1 inside the wall, over the radiance of the other wall. At the wall's ends the texels have
        // other normals, so the closed form gives their values: ½ at the bottom of a right angle, ½ (1 - cos of
        // the angle at which the other wall ends) at the ridge.
        let inside: Vec<f64> = wall.map(|c| (pictures[1][c] - pictures[0][c]) / lit).collect();
        let other = steep.hypot(gentle);
        let ridge = 0.5 * (1.0 - length / other);
        (inside.iter().sum::<f64>() + 0.5 * (0.5 + ridge)) / (inside.len() + 1) as f64 * length
    };
    // Light from straight above: the cosine of each wall's tilt.
    let onto_steep = of(1..=3, 1.0 / 1.25_f64.sqrt(), steep);
    let onto_gentle = of(5..=19, 1.0 / 5_f64.sqrt(), gentle);
    // The trapezoid rule: (step²/12)·(difference of the end slopes, below 1/(2·the other's length)).
    let tolerance = |step: f64, other: f64| step * step / 12.0 * 0.5 / other;
    println!("{onto_steep} {onto_gentle} {exchanged}");
    assert!((onto_steep - exchanged).abs() < tolerance(5_f64.sqrt(), gentle));
    assert!((onto_gentle - exchanged).abs() < tolerance(1.25_f64.sqrt(), steep));
}

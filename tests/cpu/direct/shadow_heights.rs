//! Shadow heights: closed forms, and the oracle.

use ridgelight::plan::azimuths::across_sun;
use ridgelight::scene::{Border, HeightField, Sun};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::shadow_height::{ShadowHeight, shadow_heights};
use ridgelight_cpu::shared::sweep::{Heights, March};

use super::plane;
use crate::field;

fn sun(degrees: f64, elevation_rad: f64, diameter_rad: f64) -> Sun {
    Sun { azimuth_rad: degrees.to_radians(), elevation_rad, diameter_rad, irradiance: [1.0; 3] }
}

/// Of a field alone or inside another, and the light's rise per step.
fn heights_of(
    field: &HeightField,
    sun: &Sun,
    outer: Option<&dyn Fn([f64; 2]) -> [f64; 2]>,
) -> (Vec<ShadowHeight>, [f64; 2]) {
    let azimuth = across_sun(&Sun { diameter_rad: 0.0, ..*sun }, 1, field.cell_m())[0];
    let march = March::new(Heights::of(field, Border::Plane), &azimuth);
    let radius = sun.diameter_rad / 2.0;
    let edges = [sun.elevation_rad - radius, sun.elevation_rad + radius];
    let rise = edges.map(|edge| edge.tan() * f64::from(azimuth.step_m));
    (shadow_heights(&march, rise, outer), rise)
}

/// f64 sums of a few terms of heights below 100.
const ROUNDED: f64 = 1e-11;

/// Behind a wall of height H, the shadow height is H minus the rise of the ray over the distance to the wall. It is at least that of the
/// ground one step ahead.
#[test]
fn a_wall_shades_up_to_its_height_less_the_lights_rise() {
    // Rays from the rows in the middle reach the wall.
    let wall = field(31, 30, [2.0, 3.0], |_, c| if c == 25 { 40.0 } else { 0.0 });
    for degrees in [0.0, 12.0, -25.0] {
        for (elevation, diameter) in [(0.5, 0.1), (0.2, 0.0), (1.2, 0.3)] {
            let (all, rise) = heights_of(&wall, &sun(degrees, elevation, diameter), None);
            for (i, found) in all.iter().enumerate().filter(|(i, _)| (10..21).contains(&(i / 30))) {
                let col = (i % 30) as f64;
                let expected = rise.map(|rise| {
                    let of_wall = if col < 25.0 { 40.0 - (25.0 - col) * rise } else { f64::MIN };
                    of_wall.max(-rise)
                });
                let got = [found.lit_above, found.dark_below];
                for (got, expected) in got.into_iter().zip(expected) {
                    assert!((got - expected).abs() < ROUNDED, "{degrees} {i}: {got} {expected}");
                }
                let above = |z: f64| f64::from(u8::from(z >= expected[0]));
                match diameter {
                    0.0 => assert_eq!(found.share(), above(found.ground)),
                    _ => assert!((0.0..=1.0).contains(&found.share())),
                }
            }
        }
    }
}

/// Half of a disc is above a chord through its middle; a quarter of its height hides 0.1955 of it: the segment (1/3 - √3/(4π)).
#[test]
fn a_chord_hides_its_segment() {
    let at = |ground| ShadowHeight { lit_above: 8.0, dark_below: 4.0, ground }.share();
    let segment = 1.0 / 3.0 - 3.0_f64.sqrt() / (4.0 * std::f64::consts::PI);
    let expected = [
        (9.0, 1.0),
        (8.0, 1.0),
        (7.0, 1.0 - segment),
        (6.0, 0.5),
        (5.0, segment),
        (4.0, 0.0),
        (1.0, 0.0),
    ];
    for (ground, share) in expected {
        assert!((at(ground) - share).abs() < 1e-15, "{ground}: {} {share}", at(ground));
    }
}

/// If a ramp is flatter than the ray, the ground one step ahead sets the shadow height; if it is steeper, the ground at the edge does.
#[test]
fn a_ramp_shades_by_its_slope() {
    let ramp = plane(20, 16, [1.0, 1.0], 0.5, 0.0);
    for (elevation, is_lit) in [(0.6_f64, true), (0.3, false)] {
        let (all, [rise, _]) = heights_of(&ramp, &sun(0.0, elevation, 0.0), None);
        for (i, found) in all.iter().enumerate() {
            let ahead = 15 - i % 16;
            // At the edge the ground goes on level.
            let steps = if is_lit || ahead == 0 { 1 } else { ahead };
            let ground = if ahead == 0 { 0.0 } else { 0.5 * steps as f64 };
            let beyond = if !is_lit && ahead > 0 {
                ground - (steps as f64 + 0.0) * rise
            } else {
                ground - rise
            };
            assert!((found.lit_above - found.ground - beyond).abs() < ROUNDED, "{elevation} {i}");
            assert_eq!(found.share(), if is_lit || ahead == 0 { 1.0 } else { 0.0 });
        }
    }
}

/// Inside a coarser field, shadows of what lies beyond arrive: a wall in the east of the outer field shades the inner one by the same
/// closed form. Without the outer field they do not.
#[test]
fn shadows_arrive_from_a_coarser_field() {
    let wall = |c: usize| if c == 18 { 60.0 } else { 0.0 };
    let outer = field(40, 20, [8.0, 8.0], |_, c| wall(c));
    let inner = field(20, 24, [2.0, 2.0], |_, _| 0.0);
    // Grid point (0, 0) of the inner field lies at column 4, row 17 of the outer one.
    for degrees in [0.0, 14.0, -31.0] {
        let sun = sun(degrees, 0.3, 0.05);
        let (around, _) = heights_of(&outer, &sun, None);
        let at = |[col, row]: [f64; 2]| {
            let (x, y) = (4.0 + col / 4.0, 17.0 + row / 4.0);
            let (a, b) = (x.floor(), y.floor());
            let of = |c: f64, r: f64| {
                let s = around[r as usize * 20 + c as usize];
                [s.lit_above, s.dark_below]
            };
            [0, 1].map(|i| {
                let row = |r: f64| of(a, r)[i] + (x - a) * (of(a + 1.0, r)[i] - of(a, r)[i]);
                row(b) + (y - b) * (row(b + 1.0) - row(b))
            })
        };
        let (with, rise) = heights_of(&inner, &sun, Some(&at));
        let (without, _) = heights_of(&inner, &sun, None);
        let mut missed = 0;
        for (i, found) in with.iter().enumerate() {
            // Steps of the inner grid to the wall at column 18: 56 of its columns from its first.
            let steps = (56 - i % 24) as f64;
            let expected = rise.map(|rise| (60.0 - steps * rise).max(-rise));
            for (got, expected) in [found.lit_above, found.dark_below].into_iter().zip(expected) {
                assert!((got - expected).abs() < ROUNDED, "{degrees} {i}: {got} {expected}");
            }
            missed += usize::from(without[i].lit_above < expected[0] - 1.0);
        }
        assert!(missed > 200, "{missed} grid points differ");
    }
}

/// The share of the sun's disc that a grid point sees by the oracle: all chords above its exact horizons.
fn visible_share(oracle: &Oracle, [row, col]: [usize; 2], sun: &Sun) -> f64 {
    let chords = across_sun(sun, 24, oracle.field().cell_m());
    let (mut all, mut above) = (0.0, 0.0);
    for chord in chords {
        let phi = f64::from(chord.centre_rad);
        let horizon = oracle.elevation_rad(row, col, phi);
        let [low, high] = [chord.low_slope, chord.high_slope].map(|s| f64::from(s).atan());
        let width = f64::from(chord.wedge_rad);
        all += width * (high - low);
        above += width * (high - low.max(horizon)).max(0.0);
    }
    above / all
}

/// Smooth hills, on a grid of n².
fn hills(n: usize) -> HeightField {
    let cell = 960.0 / n as f64;
    let peaks = [
        (300.0, 260.0, 190.0, 70.0),
        (620.0, 330.0, 120.0, 55.0),
        (430.0, 640.0, 240.0, 95.0),
        (760.0, 720.0, 90.0, 40.0),
    ];
    field(n, n, [cell; 2], |r, c| {
        let (x, y) = (cell * c as f64, cell * r as f64);
        let of = |(px, py, height, width): &(f64, f64, f64, f64)| {
            height * (-((x - px).powi(2) + (y - py).powi(2)) / (2.0 * width * width)).exp()
        };
        peaks.iter().map(of).sum()
    })
}

/// Mean difference of the shares from the oracle's under a sun whose maps follow an azimuth `turned_rad` away.
fn mean_error(field: &HeightField, sun: &Sun, turned_rad: f64) -> f64 {
    let oracle = Oracle::new(field, Border::Open);
    let turned = Sun { azimuth_rad: sun.azimuth_rad + turned_rad, ..*sun };
    let (found, _) = heights_of(field, &turned, None);
    let cols = field.cols();
    let off = |(i, f): (usize, &ShadowHeight)| {
        (f.share() - visible_share(&oracle, [i / cols, i % cols], sun)).abs()
    };
    found.iter().enumerate().map(off).sum::<f64>() / found.len() as f64
}

/// The error lies at shadow outlines and is less than a cell wide, so a grid three times as fine has about a third of it. The test allows 0.1
/// of the coarse error for the disc's width in azimuth, which a finer grid does not reduce. As a control, maps for an azimuth 2 degrees off
/// have more than twice the error.
#[test]
fn sun_share_converges_to_the_oracle() {
    for (degrees, elevation) in [(30.0, 0.2), (100.0, 0.35), (225.0, 0.5)] {
        let sun = sun(degrees, elevation, 0.0093);
        let [coarse, fine] = [30, 90].map(|n| mean_error(&hills(n), &sun, 0.0));
        println!("{degrees} {elevation}: {coarse:.5} {fine:.5}");
        assert!(fine < coarse * (1.0 / 3.0 + 0.1), "{degrees}: {coarse} {fine}");
        let turned = mean_error(&hills(90), &sun, 0.035);
        assert!(turned > 2.0 * fine, "{degrees}: {turned} {fine}");
    }
}

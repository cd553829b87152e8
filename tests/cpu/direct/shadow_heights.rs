//! Shadow heights: closed forms, and the oracle.

use ridgelight::plan::azimuths::across_sun;
use ridgelight::scene::{Border, HeightField, Sun};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::shadow_height::{Disc, Outer, ShadowHeight, segment, shadow_heights};
use ridgelight_cpu::shared::sweep::{Heights, March};

use super::plane;
use crate::field;

fn sun(degrees: f64, elevation_rad: f64, diameter_rad: f64) -> Sun {
    Sun { azimuth_rad: degrees.to_radians(), elevation_rad, diameter_rad, irradiance: [1.0; 3] }
}

/// Of a field alone or inside another.
fn heights_of(field: &HeightField, sun: &Sun, outer: Option<Outer>) -> (Vec<ShadowHeight>, Disc) {
    let azimuth = across_sun(&Sun { diameter_rad: 0.0, ..*sun }, 1, field.cell_m())[0];
    let march = March::new(Heights::of(field, Border::Plane), &azimuth);
    let radius = sun.diameter_rad / 2.0;
    let edges = [sun.elevation_rad - radius, sun.elevation_rad + radius].map(f64::tan);
    let disc = Disc { edges, diameter_rad: sun.diameter_rad, step_m: f64::from(azimuth.step_m) };
    (shadow_heights(&march, &disc, outer), disc)
}

/// f64 sums of a few terms of heights below 100.
const ROUNDED: f64 = 1e-11;

/// Behind a wall of height H, the shadow height is H minus the rise of the ray over the distance to the wall. It is at least that of the
/// ground one step ahead. The disc is cut at the elevation of the wall's top, near the wall and far from it.
#[test]
fn a_wall_shades_up_to_its_height_less_the_lights_rise() {
    for (cols, wall_m, rows) in [(30, 40.0, 31), (640, 60.0, 401)] {
        // Rays from the rows in the middle reach the wall.
        let top = cols - 5;
        let wall = field(rows, cols, [2.0, 3.0], |_, c| if c == top { wall_m } else { 0.0 });
        for degrees in [0.0, 12.0, -25.0] {
            for (elevation, diameter) in [(0.5, 0.1), (0.2, 0.0), (0.12, 0.0093), (1.2, 0.3)] {
                let (all, disc) = heights_of(&wall, &sun(degrees, elevation, diameter), None);
                let [lower, upper] = disc.rise_m();
                let mut partly = 0;
                for (i, found) in all.iter().enumerate() {
                    let (row, col) = (i / cols, i % cols);
                    if row != rows / 2 || col > top {
                        continue;
                    }
                    let steps = (top - col) as f64;
                    let of_wall = if col < top { wall_m - steps * lower } else { f64::MIN };
                    let (expected, ahead) =
                        if of_wall > -lower { (of_wall, steps) } else { (-lower, 1.0) };
                    let got = [found.shade_m[0], found.penumbra_m(&disc)];
                    for (got, expected) in got.into_iter().zip([expected, ahead * (upper - lower)])
                    {
                        let close = ROUNDED * (1.0 + expected.abs());
                        assert!((got - expected).abs() < close, "{degrees} {i}: {got} {expected}");
                    }
                    let horizon = match col < top {
                        true => (wall_m / (steps * disc.step_m)).atan(),
                        false => 0.0,
                    };
                    let hidden = (horizon - (elevation - diameter / 2.0)) / diameter;
                    let share = match diameter {
                        0.0 => f64::from(u8::from(found.ground_m >= expected)),
                        _ => segment(hidden),
                    };
                    partly += usize::from(share > 0.01 && share < 0.99);
                    // Square roots of rounding near the ends of a segment.
                    assert!(
                        (found.share(&disc) - share).abs() < 1e-6,
                        "{elevation} {col}: {share}"
                    );
                }
                assert!(cols < 100 || elevation != 0.12 || partly > 10, "{partly} in the penumbra");
            }
        }
    }
}

/// On level ground half of a sun that sets is visible everywhere, and of one cut by the horizontal the segment above it.
#[test]
fn level_ground_cuts_a_setting_sun() {
    let level = field(20, 300, [10.0, 10.0], |_, _| 0.0);
    for elevation in [0.0, 0.004, -0.002, 0.0046] {
        let (all, disc) = heights_of(&level, &sun(3.0, elevation, 0.0093), None);
        let expected = segment((0.0093 / 2.0 - elevation) / 0.0093);
        for found in all {
            assert!((found.share(&disc) - expected).abs() < 1e-9, "{elevation}: {expected}");
        }
    }
}

/// Half of a disc is above a chord through its middle; a quarter of its height hides 0.1955 of it: the segment (1/3 - √3/(4π)).
#[test]
fn a_chord_hides_its_segment() {
    let quarter = 1.0 / 3.0 - 3.0_f64.sqrt() / (4.0 * std::f64::consts::PI);
    let expected = [
        (-1.0, 1.0),
        (0.0, 1.0),
        (0.25, 1.0 - quarter),
        (0.5, 0.5),
        (0.75, quarter),
        (1.0, 0.0),
        (2.0, 0.0),
    ];
    for (hidden, share) in expected {
        assert!((segment(hidden) - share).abs() < 1e-15, "{hidden}: {} {share}", segment(hidden));
    }
}

/// If a ramp is flatter than the ray, the ground one step ahead sets the shadow height; if it is steeper, the ground at the edge does.
#[test]
fn a_ramp_shades_by_its_slope() {
    let ramp = plane(20, 16, [1.0, 1.0], 0.5, 0.0);
    for (elevation, is_lit) in [(0.6_f64, true), (0.3, false)] {
        let (all, disc) = heights_of(&ramp, &sun(0.0, elevation, 0.0), None);
        let [rise, _] = disc.rise_m();
        for (i, found) in all.iter().enumerate() {
            let to_edge = 15 - i % 16;
            // At the edge the ground goes on level.
            let beyond = match (to_edge, is_lit) {
                (0, _) => -rise,
                (_, true) => 0.5 - rise,
                (steps, false) => steps as f64 * (0.5 - rise),
            };
            assert!(
                (found.shade_m[0] - found.ground_m - beyond).abs() < ROUNDED,
                "{elevation} {i}"
            );
            assert_eq!(found.share(&disc), if is_lit || to_edge == 0 { 1.0 } else { 0.0 });
        }
    }
}

/// Inside a coarser field, shadows of what lies beyond arrive: a wall in the east of the outer field shades the inner one by the same
/// closed form, share included. Without the outer field they do not.
#[test]
fn shadows_arrive_from_a_coarser_field() {
    let wall = |c: usize| if c == 18 { 60.0 } else { 0.0 };
    let outer = field(40, 20, [8.0, 8.0], |_, c| wall(c));
    let inner = field(20, 24, [2.0, 2.0], |_, _| 0.0);
    // Grid point (0, 0) of the inner field lies at column 4, row 17 of the outer one.
    for degrees in [0.0, 14.0, -31.0] {
        // The wall is in the penumbra.
        let sun = sun(degrees, (60.0 / 86.0_f64).atan(), 0.3);
        let (around, of_outer) = heights_of(&outer, &sun, None);
        let at = |[col, row]: [f64; 2]| {
            let (x, y) = (4.0 + col / 4.0, 17.0 + row / 4.0);
            let (a, b) = (x.floor(), y.floor());
            let of = |c: f64, r: f64| {
                let s = around[r as usize * 20 + c as usize];
                [s.shade_m[0], s.penumbra_m(&of_outer)]
            };
            [0, 1].map(|i| {
                let row = |r: f64| of(a, r)[i] + (x - a) * (of(a + 1.0, r)[i] - of(a, r)[i]);
                row(b) + (y - b) * (row(b + 1.0) - row(b))
            })
        };
        let (with, disc) = heights_of(&inner, &sun, Some(&at));
        let (without, _) = heights_of(&inner, &sun, None);
        let [rise, _] = disc.rise_m();
        let mut missed = 0;
        for (i, found) in with.iter().enumerate() {
            // Steps of the inner grid to the wall at column 18: 56 of its columns from its first.
            let steps = (56 - i % 24) as f64;
            let expected = (60.0 - steps * rise).max(-rise);
            let got = found.shade_m[0];
            assert!((got - expected).abs() < ROUNDED, "{degrees} {i}: {got} {expected}");
            let horizon = (60.0 / (steps * disc.step_m)).atan();
            let share = segment((horizon - disc.edges[0].atan()) / 0.3);
            assert!((found.share(&disc) - share).abs() < 1e-6, "{degrees} {i}: {share}");
            missed += usize::from(without[i].share(&disc) > share + 0.1);
        }
        assert!(missed > 100, "{missed} grid points differ");
    }
}

/// The visible share of the sun's disc at a grid point by the oracle: all chords above its exact horizons.
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

/// The oracle's share at each grid point.
fn visible_shares(field: &HeightField, sun: &Sun) -> Vec<f64> {
    let oracle = Oracle::new(field, Border::Open);
    let (rows, cols) = (field.rows(), field.cols());
    (0..rows * cols).map(|i| visible_share(&oracle, [i / cols, i % cols], sun)).collect()
}

/// Mean difference of the shares from the oracle's under a sun whose maps follow an azimuth `turned_rad` away.
fn mean_error(field: &HeightField, oracle: &[f64], sun: &Sun, turned_rad: f64) -> f64 {
    let turned = Sun { azimuth_rad: sun.azimuth_rad + turned_rad, ..*sun };
    let (found, disc) = heights_of(field, &turned, None);
    assert_eq!(found.len(), oracle.len());
    let off = |(f, share): (&ShadowHeight, &f64)| (f.share(&disc) - share).abs();
    found.iter().zip(oracle).map(off).sum::<f64>() / found.len() as f64
}

/// The error lies at shadow outlines and is less than a cell wide, so a grid three times as fine has about a third of it. The test allows 0.1
/// of the coarse error for the disc's width in azimuth, which a finer grid does not reduce. As a control, maps for an azimuth 2 degrees off
/// have more than twice the error.
#[test]
fn sun_share_converges_to_the_oracle() {
    for (degrees, elevation) in [(30.0, 0.2), (100.0, 0.35), (225.0, 0.5)] {
        let sun = sun(degrees, elevation, 0.0093);
        let (field, finer) = (hills(30), hills(90));
        let [known, finely_known] = [&field, &finer].map(|field| visible_shares(field, &sun));
        let coarse = mean_error(&field, &known, &sun, 0.0);
        let fine = mean_error(&finer, &finely_known, &sun, 0.0);
        println!("{degrees} {elevation}: {coarse:.5} {fine:.5}");
        assert!(fine < coarse * (1.0 / 3.0 + 0.1), "{degrees}: {coarse} {fine}");
        let turned = mean_error(&finer, &finely_known, &sun, 0.035);
        assert!(turned > 2.0 * fine, "{degrees}: {turned} {fine}");
    }
}

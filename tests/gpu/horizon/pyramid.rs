//! Horizons from a height pyramid with known limits, and their convergence.

use std::f64::consts::TAU;

use ridgelight::plan::azimuths::even;
use ridgelight::scene::fractal;
use ridgelight::scene::{Border, HeightField, Levels, Method, Quality};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::tolerance::{ARC_TANGENT, pyramid_angle, pyramid_plane_slope};

use crate::{Device, field};

const STORED: [Levels; 2] = [Levels::Stack, Levels::Pyramid];

fn quality(azimuths: u32, levels: Levels, [level_step, level_offset]: [u32; 2]) -> Quality {
    let method = Method::Pyramid;
    Quality { azimuths, method, levels, level_step, level_offset, ..Quality::default() }
}

/// All levels of a plane are the plane, ends included: tan ω = s cos(φ - uphill) at every texel with ground in that
/// azimuth, uphill and down.
#[test]
fn a_ramp_is_its_own_horizon_at_every_level() {
    const COLS: usize = 29;
    const ROWS: usize = 23;
    let cell = [30.0, 10.0];
    let mut gpu = Device::new();
    for slope in [1e-3, 0.3, 40.0] {
        let ramp = field(ROWS, COLS, cell, |_, c| slope * 30.0 * c as f64);
        let highest = ramp.heights_m().iter().fold(0.0, |m, h| f64::from(h.abs()).max(m));
        for (stored, steps) in
            STORED.iter().flat_map(|s| [[1, 0], [4, 2], [16, 0], [3, 1]].map(|l| (*s, l)))
        {
            let found = gpu.horizons(&ramp, Border::Open, &quality(24, stored, steps));
            for (k, azimuth) in even(24, cell).iter().enumerate() {
                // The marched azimuth, which differs from the requested one by 1/32768 cell a step at most.
                let expected = slope * azimuth.swept_rad(cell).cos();
                // The heights' rounding, 2 ε H.
                let rounded = pyramid_plane_slope(highest, azimuth.step_m.into())
                    + 2.0 * highest * 2.0_f64.powi(-24) / f64::from(azimuth.step_m);
                let flattest = (expected.abs() - rounded).max(0.0);
                let bound = rounded / (1.0 + flattest * flattest)
                    + 2.0 * ARC_TANGENT
                    + pyramid_angle(expected);
                for i in 0..ROWS * COLS {
                    let at = f64::from(found[k * ROWS * COLS + i]);
                    let is_nothing = at < -1.57;
                    assert!(
                        is_nothing || (at - expected.atan()).abs() <= bound,
                        "slope {slope} {stored:?} {steps:?} azimuth {k} texel {i}: {at} {expected}"
                    );
                    // From the middle there is ground in every azimuth.
                    assert!(!is_nothing || i != ROWS / 2 * COLS + COLS / 2, "azimuth {k}");
                }
            }
        }
    }
}

/// The last step stands where the march leaves the field: a wall along the edge has its full height, from as far as
/// texels use the field itself, 2^o steps.
#[test]
fn a_wall_at_the_edge_is_seen_at_its_height() {
    let mut gpu = Device::new();
    let wall = field(9, 33, [2.0, 2.0], |_, c| if c == 32 { 10.0 } else { 0.0 });
    for (stored, step) in STORED.iter().flat_map(|s| [1, 4, 16].map(|k| (*s, k))) {
        let found = gpu.horizons(&wall, Border::Plane, &quality(8, stored, [step, 4]));
        for (row, c) in (0..9).flat_map(|r| (16..32).map(move |c| (r, c))) {
            let expected = (10.0 / (2.0 * (32 - c) as f64)).atan();
            let at = f64::from(found[row * 33 + c]);
            // Nothing but the wall counts, and it stands at a step of the march.
            let bound = 2.0 * ARC_TANGENT + pyramid_angle(1.0 / (32 - c) as f64 * 5.0);
            assert!((at - expected).abs() <= bound, "{stored:?} {step} row {row} column {c}: {at}");
        }
    }
}

/// From the tip of a pit with straight sides the rim stands at the sides' slope in every azimuth: the first step finds
/// it; levels lie above the tip and give less. Along the grid and its diagonals marches pass through texels; between
/// them a chord across a cell lies above the cone, by 1/(8 r²) of it at distance r, at most 1/8.
#[test]
fn the_tip_of_a_pit_sees_its_sides() {
    const SIDE: usize = 33;
    let mut gpu = Device::new();
    let slope = 0.8;
    let pit =
        field(SIDE, SIDE, [1.0, 1.0], |r, c| slope * (r as f64 - 16.0).hypot(c as f64 - 16.0));
    for (stored, steps) in STORED.iter().flat_map(|s| [[1, 0], [4, 2], [8, 4]].map(|l| (*s, l))) {
        let found = gpu.horizons(&pit, Border::Plane, &quality(32, stored, steps));
        for k in 0..32 {
            let at = f64::from(found[k * SIDE * SIDE + 16 * SIDE + 16]);
            let bound = 2.0 * ARC_TANGENT + pyramid_angle(slope) + 2e-6;
            let above = if k % 4 == 0 { 0.0 } else { slope / 8.0 };
            let [low, high] = [slope.atan() - bound, (slope + above).atan() + bound];
            assert!(low <= at && at <= high, "{stored:?} {steps:?} azimuth {k}: {at}");
        }
    }
}

/// Mean error of the horizons, radians, against the f64 oracle at every seventh texel.
fn mean_error(gpu: &mut Device, field: &HeightField, quality: &Quality) -> f64 {
    let found = gpu.horizons(field, Border::Plane, quality);
    let oracle = Oracle::new(field, Border::Plane);
    let plane = field.rows() * field.cols();
    let count = quality.azimuths as usize;
    let (mut sum, mut number) = (0.0, 0);
    for (k, i) in (0..count).flat_map(|k| (0..plane).step_by(7).map(move |i| (k, i))) {
        let phi = TAU * k as f64 / count as f64;
        let ground_truth = oracle.elevation_rad(i / field.cols(), i % field.cols(), phi);
        sum += (f64::from(found[k * plane + i]) - ground_truth).abs();
        number += 1;
    }
    sum / f64::from(number)
}

/// The parameters of the paper's figure 10, k = 1 … 16 with o = 0 … 4: every step lowers the error, in both stores.
#[test]
fn more_and_finer_levels_tend_to_the_oracle() {
    let mut gpu = Device::new();
    let rough = fractal(65, 3).expect("a field");
    for stored in STORED {
        let path = [[1, 0], [2, 1], [4, 2], [8, 3], [16, 4]];
        let errors = path.map(|steps| mean_error(&mut gpu, &rough, &quality(16, stored, steps)));
        println!("{stored:?}: {:?}°", errors.map(f64::to_degrees));
        assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{stored:?}: {errors:?}");
    }
}

/// A bilinear stack and splines evaluated at every look-up are the same levels.
#[test]
fn both_stores_hold_the_same_levels() {
    let mut gpu = Device::new();
    let rough = fractal(65, 4).expect("a field");
    let steps = [4, 1];
    let [stack, levels] =
        STORED.map(|stored| gpu.horizons(&rough, Border::Periodic, &quality(16, stored, steps)));
    let ground_truth_error = mean_error(&mut gpu, &rough, &quality(16, Levels::Stack, steps));
    let apart: f64 = stack.iter().zip(&levels).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>();
    let mean = apart / stack.len() as f64;
    println!("{mean} rad apart, {ground_truth_error} from the ground truth");
    // Bilinear interpolation errs by an eighth of the second difference over a texel, of levels whose texels are
    // 2^(1/4) field texels or more apart and whose splines are smooth over two: less than the levels' own error.
    assert!(mean < 0.1 * ground_truth_error, "{mean} of {ground_truth_error}");
    assert!(mean > 0.0, "the two stores are one");
}

//! Visible intervals along an azimuth.

use ridgelight_cpu::oracle::Oracle;
use std::f64::consts::{FRAC_PI_2, TAU};

use super::rough;
use crate::{BORDERS, field};

/// Intervals fill the elevations from straight down to the oracle's horizon, and the ground that an interval gives for
/// a direction lies in that direction. Relief 3 on cells of 1 and 2: slopes carry few roundings, angles near 3.
#[test]
fn visible_intervals_fill_the_angle_below_the_horizon() {
    let field = rough(7, 9, [1.0, 2.0], 3.0);
    for border in BORDERS {
        let oracle = Oracle::new(&field, border);
        let height = |[r, c]: [usize; 2]| f64::from(field.heights_m()[r * 9 + c]);
        for (row, col, k) in (0..7 * 9 * 13).map(|i| (i / 9 % 7, i % 9, i / 63)) {
            let azimuth = TAU * (k as f64 + 0.3) / 13.0;
            let visible = oracle.visible_intervals(row, col, azimuth);
            let horizon = oracle.elevation_rad(row, col, azimuth);
            let mut reached = -FRAC_PI_2;
            for interval in &visible {
                assert_eq!(interval.low_rad, reached);
                assert!(interval.high_rad > interval.low_rad);
                reached = interval.high_rad;
                for share in [0.1, 0.5, 0.9] {
                    let elevation =
                        interval.low_rad + share * (interval.high_rad - interval.low_rad);
                    let distance = interval.distance_m(elevation);
                    let weights = interval.corner_weights(distance);
                    assert!(
                        weights.iter().all(|w| (-1e-9..=1.0 + 1e-9).contains(w)),
                        "{weights:?}"
                    );
                    let corners = oracle.corners(interval.triangle).map(height);
                    let met: f64 = weights.iter().zip(corners).map(|(w, h)| w * h).sum();
                    let rise = met - height([row, col]);
                    // The last interval of a periodic field may end at horizontal, without a hit.
                    let expected = distance * elevation.tan();
                    let ends = elevation > oracle.horizon(row, col, azimuth).unwrap().slope.atan();
                    assert!(ends || distance == 0.0 || (rise - expected).abs() < 1e-9);
                    assert!(distance > 0.0 || rise.abs() < 1e-12);
                }
            }
            if !visible.is_empty() {
                let above = reached.max(if border == ridgelight::scene::Border::Open {
                    reached
                } else {
                    0.0
                });
                assert!(
                    (above - horizon).abs() < 1e-12,
                    "{border:?} {row} {col} {k} {above} {horizon}"
                );
            } else {
                assert!(
                    oracle
                        .horizon(row, col, azimuth)
                        .is_none_or(|h| h.slope < 0.0 || row * col == 0 || row == 6 || col == 8)
                );
            }
        }
    }
}

/// A step up by 2 at distance 2..3 on cells of 1, along a row: the floor from straight down to horizontal, hit
/// where tan ω = 0, and the ramp up to atan(2/3).
#[test]
fn a_step_shows_its_floor_and_its_face() {
    let step = field(5, 8, [1.0, 1.0], |_, c| if c > 4 { 2.0 } else { 0.0 });
    let oracle = Oracle::new(&step, ridgelight::scene::Border::Plane);
    let visible = oracle.visible_intervals(2, 2, 1e-4);
    let floor = visible[0];
    assert_eq!((floor.low_rad, floor.high_rad), (-FRAC_PI_2, 0.0));
    // Heights over distances that are longer by 1/cos 1e-4.
    assert!((visible.last().unwrap().high_rad.tan() - 2.0 / 3.0).abs() < 1e-7);
    let half = 0.5_f64.atan();
    let face = visible.iter().find(|s| s.low_rad < half && half < s.high_rad).unwrap();
    assert!((face.distance_m(half) - 4.0 / 1.5).abs() < 1e-7, "2 (D - 2) = D / 2");
}

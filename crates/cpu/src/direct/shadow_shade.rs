//! Whether shadow heights prove that a grid point sees all of a sun's chord.

use super::shadow_sweep::{height_of, lines_of};
use crate::shared::field::field_slope;
use crate::shared::fuse::first_crossings;
use crate::shared::sweep::March;
use crate::tolerance::EPSILON;
use ridgelight::plan::azimuths::CELL;
use ridgelight::scene::Border;

/// Whether a grid point provably sees a whole chord, or faces away from it; none where rounding decides.
///
/// `word` is the lattice's word of a line and a step, warm-up included. Slopes err by `slope_error`, and no height is above
/// `largest_m`.
pub fn sees_all(
    march: &March,
    warm_up: i32,
    word: impl Fn(i32, i32) -> u32,
    [col, row]: [i32; 2],
    (slope_error, largest_m): (f64, f64),
) -> Option<bool> {
    let azimuth = &march.azimuth;
    let (lane, step) = march.of_grid_point(col, row);
    let (low, high) = (f64::from(azimuth.low_slope), f64::from(azimuth.high_slope));
    let gradient = field_slope(&march.heights, col, row);
    let mut own = gradient.x * f64::from(azimuth.cos_phi) + gradient.y * f64::from(azimuth.sin_phi);
    if march.heights.border != Border::Open {
        own = own.max(0.0);
    }
    let near = |a: f64, b: f64, error: f64| (a - b).abs() <= error;
    if near(own, high, slope_error) {
        return None;
    }
    if own >= high {
        return Some(true);
    }
    let height = march.height_at(lane, step);
    let ahead = f64::from(first_crossings(march, (lane, step), height).slope);
    if near(ahead, low, slope_error) {
        return None;
    }
    let (lines, first) = lines_of(march, warm_up + march.steps);
    let from_origin = lane * CELL - first - (warm_up + step) * azimuth.shear;
    let line = from_origin.div_euclid(CELL);
    let t = f64::from(from_origin.rem_euclid(CELL)) / f64::from(CELL);
    let word = |line: i32| {
        let line = if march.periodic() { line.rem_euclid(lines) } else { line };
        (0..lines).contains(&line).then(|| word(line, warm_up + step))
    };
    let Some(before) = word(line) else { return Some(false) };
    // On a line there is no other.
    let Some(after) = (if t == 0.0 { Some(before) } else { word(line + 1) }) else {
        return Some(false);
    };
    let shadow = (1.0 - t) * height_of(before) + t * height_of(after);
    let h = |lane: i32| f64::from(march.height_at(lane, step));
    let over = t * (1.0 - t) * (2.0 * h(lane) - h(lane - 1) - h(lane + 1));
    let rounded = 8.0 * EPSILON * (shadow.abs().min(1e20) + largest_m);
    (!near(shadow, over, rounded)).then_some(shadow <= over && ahead <= low)
}

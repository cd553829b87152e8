//! Tolerances of directions on curved base surfaces against their CPU references.

use super::EPSILON;
use crate::bent_directions::ways::Way;
use crate::bent_directions::{Fans, MAX_TURN_RAD};
use glam::{DVec2, DVec3};
use ridgelight::scene::Curvature;

/// By how much `bent_directions` may be off beside a way that ends `to_m` away, m: components of the way err by 2 ε of themselves
/// (a product, the cell's or the difference's rounding) and by the direction's ε, their products and two sums by 4 ε more; what
/// lies beside the ray by the same again.
pub fn way(to_m: f64) -> f64 {
    16.0 * EPSILON * to_m
}

/// By how much `bent_directions` may be off in how far a ray stays over the surface around a grid point, m.
///
/// A cell's climb errs by 4 ε of itself (direction, pace, quotient), its product and sum by 3 ε more; the grid point's rise and its
/// difference by 3 ε. With g the relief around the grid point and n cells of the way: the place beside it errs by 7 ε of n and ε of
/// its own, across which the surface rises by 2 g a cell, and so does where a kink is taken to be; products and sums round 12 ε g.
pub fn over(way: &Way, rise_m: f64) -> f64 {
    EPSILON * (8.0 * way.climb_m + 4.0 * rise_m.abs() + 48.0 * way.relief_m * (1.0 + way.cells))
}

/// By how much a component of a direction that has moved as along a way of `away_m` to `to_m`, at a height `own_m` over the
/// base, may be off. With r the turn of a metre of the way, v = r · away that of all, and g = r (|own| + away), by which heights
/// count:
///
/// the part across the turn is a product of four with v²/6, 8 ε (v² + of the series 1e-8, under ε), and the height's, a sum
/// with 3 roundings times a series of 8 ε: 14 ε g; the vertical part a sum of v/2 (1 + g), 16 ε of it. The way's own error
/// moves the first by r δ g, the second by r δ (1 + g): in the plan an error of [`way`] over the direction's own share p of the
/// plan, squares and quotient 9 ε more. The direction itself errs by 2 ε. The sum is of a length of the
/// least scale times the chord of a right angle over its arc, 0.9, or more, over which the error is spread; normalising
/// rounds by 8 ε.
pub fn bent(e: DVec3, Way { away_m, to_m, .. }: Way, own_m: f64, curvature: Curvature) -> f64 {
    let r = (DVec2::from_array(curvature.per_m) * e.truncate()).length();
    if r == 0.0 {
        return 10.0 * EPSILON;
    }
    let away = away_m.min(MAX_TURN_RAD / r);
    let (v, g) = (r * away, r * (own_m.abs() + away));
    let parts = 8.0 * v * v + 14.0 * g + 16.0 * v * (1.0 + g) + 2.0;
    let plan = e.truncate().length();
    let moved = r * (way(to_m) / plan + 9.0 * EPSILON * away) * (1.0 + 2.0 * g);
    (EPSILON * parts + moved) / (0.9 * Curvature::MIN_SCALE) + 8.0 * EPSILON
}

/// By how much `fan_weights` may be off, of directions as the device has them.
///
/// Half a triangle's area is atan(x) of x = V/B. V is that of two sides u and v, 10 ε |u| |v|; B, a sum of four of at most
/// 1, 8 ε: the angle errs by (|B| δV + |V| δB) / (V² + B²), the quotient by 5 ε of sin·cos ≤ x, the polynomial by 2e-8 and 8 ε of
/// it (of x or of 1/x, whose angle is subtracted from π/2: 2 ε more). Areas are summed, each sum rounded, and divided.
pub fn fan_weight(fans: &Fans, bent: &[DVec3], i: usize) -> f64 {
    let of = |pair: &[u32; 2]| {
        let [a, b, c] = [bent[i], bent[pair[0] as usize], bent[pair[1] as usize]];
        let (u, v) = (b - a, c - a);
        let volume = a.dot(u.cross(v));
        let below = 1.0 + a.dot(b) + b.dot(c) + c.dot(a);
        let square = (volume * volume + below * below).max(1e-12);
        let (off_v, off_b) = (10.0 * EPSILON * u.length() * v.length(), 8.0 * EPSILON);
        let half = (below.abs() * off_v + volume.abs() * off_b) / square;
        let x = volume.atan2(below).abs();
        2.0 * (half + x * (2e-8 + 15.0 * EPSILON) + if x > 0.7 { 4.0 * EPSILON } else { 0.0 })
            + 2.0 * x * EPSILON * fans.pairs[i].len() as f64
    };
    let sum: f64 = fans.pairs[i].iter().map(of).sum();
    let area: f64 = crate::fan_weights::weight(fans, bent, i);
    if fans.flat_sr[i] > 0.0 { sum / fans.flat_sr[i] + 7.0 * EPSILON * area } else { 0.0 }
}

//! Tolerances of `visible_points` rays against the CPU reference.

use super::{EPSILON, Land};
use crate::ellipse_fit::Ellipse;
use crate::oracle::Oracle;
use crate::profile::VisibleInterval;
use crate::scatter_gather::Gathered;

/// By how much a place that is met may be off along either axis of the grid, in cells and as a share of the cells to it:
/// direction and advance 12 ε (normalised, a quotient by the cell, one by the faster axis), the crossing's distance 7 ε
/// (the advance's inverse 5, difference and product 1 each), the place along the piece between two crossings 13 ε (two
/// sums that err alike, a quotient, product and sum of at most a cell).
pub const MET_SHARE: f64 = 32.0 * EPSILON;

/// Error of the elevation at which a ray meets a crossing, radians.
///
/// At a crossing t away a ray and the surface are compared: t · rise errs by 8 ε of itself, which is at most the relief R
/// where it matters, as beyond a ray is over everything; the surface by three differences, two products and two sums of at
/// most R, 8 ε R, and by its place, 10 ε t, times the steepest slope G. What is met first stands half a cell c away or
/// more: 32 ε R / c + 10 ε G. The direction itself errs by 12 ε upwards, and by as much sideways, which is 12 ε G more.
pub fn visible_elevation(land: &Land) -> f64 {
    let Land { relief_m, steepest, cell_m, .. } = *land;
    EPSILON * (12.0 + 32.0 * relief_m / cell_m + 22.0 * steepest)
}

/// Error of the elevation at which a ray meets the upper end of a visible interval, radians.
///
/// At a crossing d away a ray and the surface are compared: t · rise errs by 8 ε of itself, which there is the rise of one of
/// the triangle's corners over the grid point, r at most; the surface by three differences, two products and two sums of at most
/// r, 8 ε r, and along either axis by its place, 10 ε t, and by the direction's, 12 ε t, times the triangle's relief g a cell c,
/// with t c at most d. A slope has an error of (16 r / d + 44 g / c) ε, turned into an angle where it is flattest; the direction
/// itself by 12 ε upwards.
pub fn crossing_elevation(oracle: &Oracle, interval: &VisibleInterval, own_m: f64) -> f64 {
    let field = oracle.field();
    let [x, y] = field.cell_m();
    let corners = oracle
        .corners(interval.triangle)
        .map(|[row, col]| f64::from(field.heights_m()[row * field.cols() + col]) - own_m);
    let rise = corners.iter().fold(0.0_f64, |m, h| m.max(h.abs()));
    let high = corners.iter().fold(f64::MIN, |m, h| m.max(*h));
    let relief = high - corners.iter().fold(f64::MAX, |m, h| m.min(*h));
    let slope = interval.high_rad.tan();
    let off = EPSILON * (16.0 * rise / interval.end_m() + 44.0 * relief / x.min(y));
    (slope + off).atan() - (slope - off).atan() + 12.0 * EPSILON
}

/// [`visible_elevation`] from the middles of triangles, of the threefold finer field whose grid points they are: there the device's
/// height errs by 4 ε R (two differences, their sum's third, a sum), the field's own, rounded, by ε R at either end, half a
/// finer cell apart or more.
pub fn facet_elevation(finer: &Land) -> f64 {
    visible_elevation(finer) + 12.0 * EPSILON * finer.relief_m / finer.cell_m
}

/// Tolerance of one look-up of `scatter_gather` against its CPU reference, R, G, B. The Phong exponent is `n`, 1 or more.
/// The normal has an error of `normal` radians.
///
/// A cosine errs by the normal's turn and 6 ε (three products, two sums, the direction's roundings). What a direction lies
/// apart from the mirror errs by four turns, as that moves by twice the normal's and by twice the cosine's, and 16 ε: the
/// lobe counts with its range within that. Its power x = n ln errs by 8 ε of itself and 1e-7, its exponential by (3 + 2 |x|) ulp
/// (Vulkan): (12 |x| + 8) ε and 1e-7 of it; f32 ends at 1e-37. Products and quotients round 16 times.
pub fn gathered(of: &Gathered, n: f64, normal: f64) -> [f64; 3] {
    let cosine = normal + 6.0 * EPSILON;
    let apart = 4.0 * normal + 16.0 * EPSILON;
    let power = |along: f64| along.clamp(0.0, 1.0).powf(n);
    let [near, far] = [power(of.along + apart), power(of.along - apart)];
    let x = n * of.along.clamp(1e-30, 1.0).ln().abs();
    let phong = near - far + near * ((12.0 * x + 24.0) * EPSILON + 1e-7) + 1e-37;
    [0, 1, 2].map(|c| of.facing[c] * cosine + of.mirrored[c] * phong + 16.0 * EPSILON * of.light[c])
}

/// By how much equation 4 of an ellipse of `ellipse_fit` may be off near its edge, where neither term is over 1.
///
/// A place along an axis errs by 6 ε (the direction's rounding, two products and a sum; its axis), that of the centre c away by
/// 8 ε c, turned there and back; over the radius, squared, twice that; the quotients here and the inverse that is written (5 ε each, Vulkan's 2.5 ulp), a root of
/// 10 ε, their squares twice that, and three roundings, 48 ε.
pub fn ellipse_reach(ellipse: &Ellipse) -> f64 {
    let [along, across] = ellipse.inverse_radii;
    let place = 6.0 + 8.0 * ellipse.centre.length();
    EPSILON * (2.0 * place * (along + across) + 48.0)
}

/// By how much the mean or a covariance of n directions in the unit disc may be off: n terms of at most 1, each weighed and
/// squared within 8 ε, and their sums' roundings, of numerator and of weight.
pub fn ellipse_moment(directions: usize) -> f64 {
    EPSILON * 2.0 * (directions as f64 + 8.0)
}

/// [`ellipse_reach`] of where the search starts: of a mean that has an error of m, and a radius r = 2 √v by 2 m / r.
pub fn ellipse_start(ellipse: &Ellipse, directions: usize) -> f64 {
    let m = ellipse_moment(directions);
    let of = |inverse: f64| 2.0 * inverse * (m + 2.0 * m * inverse);
    ellipse_reach(ellipse) + ellipse.inverse_radii.map(of).iter().sum::<f64>()
}

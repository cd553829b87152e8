//! What rays of `visible_points` err by against its twin.

use super::{EPSILON, Land};

/// By how much a place that is met may be off along either axis of the grid, in cells and as a share of the cells to it:
/// direction and advance 12 ε (normalised, a quotient by the cell, one by the faster axis), the crossing's distance 7 ε
/// (the advance's inverse 5, difference and product 1 each), the place along the piece between two crossings 13 ε (two
/// sums that err alike, a quotient, product and sum of at most a cell).
pub const MET_SHARE: f64 = 32.0 * EPSILON;

/// By how much the elevation in which a ray meets a crossing may be off, radians.
///
/// At a crossing t away a ray and the surface are compared: t · rise errs by 8 ε of itself, which is at most the relief R
/// where it matters, as beyond a ray is over everything; the surface by three differences, two products and two sums of at
/// most R, 8 ε R, and by its place, 10 ε t, times the steepest slope G. What is met first stands half a cell c away or
/// more: 32 ε R / c + 10 ε G. The direction itself errs by 12 ε upwards, and by as much sideways, which is 12 ε G more.
pub fn seen_elevation(land: &Land) -> f64 {
    let Land { relief_m, steepest, cell_m, .. } = *land;
    EPSILON * (12.0 + 32.0 * relief_m / cell_m + 22.0 * steepest)
}

/// What one look-up of `scatter_gather` errs by against its twin, R, G, B: `facing` and `mirrored` are its light for a cosine
/// of 1 and in the middle of a lobe of exponent `n`, 1 or more; the normal may be turned by `normal` radians.
///
/// A cosine errs by the normal's turn and 6 ε (three products, two sums, the direction's roundings). What a direction lies
/// apart from the mirror errs by four turns, as that moves by twice the normal's and by twice the cosine's, and 16 ε; the lobe
/// falls from 1 to (1 - a²/2)ⁿ, nowhere faster than √n. Its power x = n ln errs by 8 ε of itself and 1e-7, its exponential
/// by (3 + 2 |x|) ulp (Vulkan), and |x| eˣ < 0.37: 16 ε and 4e-7. Products and quotients round 16 times.
pub fn gathered(
    (light, facing, mirrored): ([f64; 3], [f64; 3], [f64; 3]),
    n: f64,
    normal: f64,
) -> [f64; 3] {
    let cosine = normal + 6.0 * EPSILON;
    let apart = 4.0 * normal + 16.0 * EPSILON;
    let lobe = n.max(1.0).sqrt() * apart + 16.0 * EPSILON + 4e-7;
    [0, 1, 2].map(|c| facing[c] * cosine + mirrored[c] * lobe + 16.0 * EPSILON * light[c])
}

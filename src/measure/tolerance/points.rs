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

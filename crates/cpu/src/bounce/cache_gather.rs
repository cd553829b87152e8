//! One more bounce at a node, from the visibility cache that the first bounce has filled.

use crate::Rgb;
use crate::shared::sweep::{CELL_SHIFT, March};
use ridgelight::plan::azimuths::CELL;
use std::f64::consts::FRAC_PI_2;

/// The visible surface of a node in one ring, along an azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cast {
    /// The grid point at the mean distance, row-major.
    pub grid_point: usize,
    /// March steps to there.
    pub steps: i32,
    /// Its weight.
    pub weight: f64,
}

/// Steps to the ends of rings; the last one has none.
pub const RING_ENDS: [i32; 3] = [3, 9, 27];

/// Unit of stored weights: for a wedge of so many radians, the 65535th part of the largest weight.
pub fn cast_part(wedge_rad: f64) -> f64 {
    wedge_rad * FRAC_PI_2 / 65535.0
}

/// A word of the visibility cache, of the node at a column and a row.
pub fn cast_of(march: &March, word: u32, [col, row]: [i32; 2]) -> Cast {
    let (lane, step) = march.of_grid_point(col, row);
    let steps = (word & 0xffff) as i32;
    let nearest = (lane * CELL - steps * march.azimuth.shear + CELL / 2) >> CELL_SHIFT;
    let [col, row] = march.grid_point(nearest, step - steps);
    let weight = f64::from(word >> 16) * cast_part(march.azimuth.wedge_rad.into());
    Cast { grid_point: row as usize * march.heights.cols + col as usize, steps, weight }
}

/// Radiance times weight; not yet divided by the sum for whole hemispheres.
pub fn cache_gather<'a>(casts: impl IntoIterator<Item = &'a Cast>, exit: &[Rgb]) -> Rgb {
    casts.into_iter().fold([0.0; 3], |sum, cast| {
        [0, 1, 2].map(|c| sum[c] + cast.weight * exit[cast.grid_point][c])
    })
}

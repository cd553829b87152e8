//! The surface in the layout that rays read: each cell's corners, and each grid point's height and slopes.

use crate::light::normal;
use ridgelight::scene::{Border, HeightField};

/// `cells`: heights above the base at north-west, north-east, south-west and south-east of the cell to the south-east
/// of every grid point. Past the last grid points, the first where the field repeats, else the last.
pub fn cells(field: &HeightField, border: Border) -> Vec<[f32; 4]> {
    let (rows, cols) = (field.rows(), field.cols());
    let next = |i: usize, n: usize| match border {
        Border::Periodic => (i + 1) % n,
        Border::Plane | Border::Open => (i + 1).min(n - 1),
    };
    let h = |r: usize, c: usize| field.heights_m()[r * cols + c];
    (0..rows * cols)
        .map(|i| {
            let (r, c) = (i / cols, i % cols);
            let (south, east) = (next(r, rows), next(c, cols));
            [h(r, c), h(r, east), h(south, c), h(south, east)]
        })
        .collect()
}

/// `ground`: height above the base, slope towards east, slope towards north, of each grid point's normal.
pub fn ground(field: &HeightField, border: Border) -> Vec<[f64; 3]> {
    let cols = field.cols();
    let heights = field.heights_m().iter().enumerate();
    heights
        .map(|(i, h)| {
            let n = normal(field, border, i / cols, i % cols);
            [f64::from(*h), -n.x / n.z, -n.y / n.z]
        })
        .collect()
}

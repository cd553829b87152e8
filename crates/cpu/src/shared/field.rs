//! `field.glsl`: the slope of the surface at a grid point.

use super::sweep::{Heights, inside};
use glam::{DVec2, DVec3};
use ridgelight::scene::{Border, HeightField, SphereLight};

/// Slope of the surface at a grid point towards east and north: the mean over the adjoining quads, which is the
/// direction of the sum of their unnormalised normals. Where a field is one grid point wide there is no quad across
/// it, and the slope across is 0.
pub fn field_slope(heights: &Heights, col: i32, row: i32) -> DVec2 {
    let wraps = heights.border == Border::Periodic;
    let (cols, rows) = (heights.cols as i32, heights.rows as i32);
    // Neighbours, how many quads lie to each side (0 or 1), and what the lines across weigh.
    let axis = |i: i32, n: i32| {
        let near = [inside(i - 1, n, wraps), i, inside(i + 1, n, wraps)];
        let quads = |exists: bool| f64::from(u8::from((wraps || exists) && n > 1));
        let (before, after) = (quads(i > 0), quads(i < n - 1));
        let both = before + after;
        // Across an axis without quads the one line of grid points stands for them.
        let weight = if both > 0.0 {
            [before, both, after].map(|w| w / (2.0 * both))
        } else {
            [0.0, 1.0, 0.0]
        };
        (near, both, weight)
    };
    let (x, both_x, col_weight) = axis(col, cols);
    let (y, both_y, row_weight) = axis(row, rows);
    let h = |col: i32, row: i32| f64::from(heights.at(col, row));
    let rise_x: f64 = (0..3).map(|i| row_weight[i] * (h(x[2], y[i]) - h(x[0], y[i]))).sum();
    let rise_y: f64 = (0..3).map(|i| col_weight[i] * (h(x[i], y[0]) - h(x[i], y[2]))).sum();
    let [cell_x, cell_y] = heights.cell_m.map(f64::from);
    DVec2::new(
        if both_x > 0.0 { rise_x / (both_x * cell_x) } else { 0.0 },
        if both_y > 0.0 { rise_y / (both_y * cell_y) } else { 0.0 },
    )
}

/// The unit normal of a surface that rises by `slope` towards east and north.
pub fn normal_of(slope: DVec2) -> DVec3 {
    DVec3::new(-slope.x, -slope.y, 1.0).normalize()
}

/// Horizontal vector from a grid point to the sphere's centre: east, north.
pub(crate) fn towards_m(
    field: &HeightField,
    row: usize,
    col: usize,
    sphere: &SphereLight,
) -> [f64; 2] {
    let [cell_x, cell_y] = field.cell_m();
    let [x, y, _] = sphere.position_m;
    [x - col as f64 * cell_x, y - (field.rows() - 1 - row) as f64 * cell_y]
}

//! Normals of grid points.

use glam::DVec3;

use crate::scene::{Border, HeightField};

/// The unit normal at a grid point: the sum of the unnormalised normals of the adjoining quads.
///
/// A quad's normal is the cross product of its diagonals, (dx, dy, NE - SW) × (-dx, dy, NW - SE) = 2 dx dy (-g_x, -g_y, 1),
/// where g is the mean of the gradients along its two opposite edges. All quads weigh the same, so the sum is the mean
/// of their gradients. At an edge only existing quads count; under `periodic` all four do. A field one grid point wide
/// has no quads: the gradient is the difference along the other axis (central inside, one-sided at the ends).
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn normal(field: &HeightField, border: Border, row: usize, col: usize) -> DVec3 {
    let (rows, cols) = (field.rows(), field.cols());
    assert!(row < rows && col < cols, "grid point (row {row}, column {col}) of {rows} × {cols}");
    let [cell_x, cell_y] = field.cell_m();
    let wrap = border == Border::Periodic;
    // Indices before, at and after `i`; a missing neighbour is replaced by `i`.
    let around = |i: usize, count: usize| {
        if wrap {
            [(i + count - 1) % count, i, (i + 1) % count]
        } else {
            [i.saturating_sub(1), i, (i + 1).min(count - 1)]
        }
    };
    let (r, c) = (around(row, rows), around(col, cols));
    let h = |r: usize, c: usize| f64::from(field.heights_m()[r * cols + c]);
    let exists = |i: [usize; 3], side: usize| wrap || i[side] != i[side + 1];

    let (mut east, mut north, mut quads) = (0.0, 0.0, 0.0);
    for side_r in 0..2 {
        for side_c in 0..2 {
            if exists(r, side_r) && exists(c, side_c) {
                let (n, s) = (r[side_r], r[side_r + 1]);
                let (w, e) = (c[side_c], c[side_c + 1]);
                east += 0.5 * ((h(n, e) - h(n, w)) + (h(s, e) - h(s, w)));
                north += 0.5 * ((h(n, w) - h(s, w)) + (h(n, e) - h(s, e)));
                quads += 1.0;
            }
        }
    }
    if quads > 0.0 {
        return DVec3::new(-east / (quads * cell_x), -north / (quads * cell_y), 1.0).normalize();
    }
    let steps = |i: [usize; 3]| (i[2] - i[0]).max(1) as f64;
    DVec3::new(
        -(h(row, c[2]) - h(row, c[0])) / (steps(c) * cell_x),
        -(h(r[0], col) - h(r[2], col)) / (steps(r) * cell_y),
        1.0,
    )
    .normalize()
}

//! Exit radiance under an environment from a visibility series.

use crate::basis::receiver;
use crate::mirror_map::mirrored;
use crate::shared::field::{field_slope, normal_of};
use crate::shared::sweep::Heights;
use crate::specular_visibility::specular_visibility;
use glam::{DVec2, DVec3};
use ridgelight::basis::bands;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::zonal::phong_bands;
use ridgelight::plan::Nodes;
use ridgelight::scene::PhongSpecular;

/// Distance off each other's planes, over their distance, at which a node has half weight for a grid point: the
/// shader's value, fitted there.
pub const OFF_PLANE: f64 = 0.25;

/// The nodes around a grid point, as (column, row) among them, with their weights: bilinear, reduced where node and
/// grid point lie off each other's planes. They sum to 1.
pub fn nodes_around(heights: &Heights, nodes: Nodes, [col, row]: [i32; 2]) -> [([u32; 2], f64); 4] {
    let size = [heights.cols as u32, heights.rows as u32];
    let [cell_x, cell_y] = heights.cell_m.map(f64::from);
    let (cols, x) = nodes.around(col as u32, size[0]);
    let (rows, y) = nodes.around(row as u32, size[1]);
    let h = f64::from(heights.at(col, row));
    let slope = field_slope(heights, col, row);
    let mut all = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| {
        let node = [cols[i], rows[j]];
        let [c, r] = [0, 1].map(|axis| nodes.place(node[axis], size[axis]) as i32);
        let offset = DVec2::new(f64::from(c - col) * cell_x, f64::from(row - r) * cell_y);
        let rise = f64::from(heights.at(c, r)) - h;
        let theirs = field_slope(heights, c, r);
        let off = (rise - slope.dot(offset)).abs() + (rise - theirs.dot(offset)).abs();
        let distance = offset.length().max(cell_x.min(cell_y));
        let near = [1.0 - x, x][i] * [1.0 - y, y][j];
        (node, near / (1.0 + (off / (OFF_PLANE * distance)).powi(2)))
    });
    let sum: f64 = all.iter().map(|(_, weight)| weight).sum();
    all.iter_mut().for_each(|(_, weight)| *weight /= sum);
    all
}

/// Exit radiance of one grid point of albedo 1, before clamping at 0; `matrix` is [`crate::light_matrix`]'s.
pub fn light_at(
    heights: &Heights,
    visibility: &[f64],
    matrix: &[Vec<DVec3>],
    [col, row]: [i32; 2],
) -> DVec3 {
    light_on(normal_of(field_slope(heights, col, row)), visibility, matrix)
}

/// The same on a surface of this normal.
pub fn light_on(normal: DVec3, visibility: &[f64], matrix: &[Vec<DVec3>]) -> DVec3 {
    let all = receiver(normal.to_array());
    let rows = if matrix.len() == 3 { &all[1..4] } else { &all[..matrix.len()] };
    times(rows, visibility, matrix)
}

/// What a lobe on a surface of this normal mirrors towards a unit `view`; `matrix` is
/// [`crate::light_matrix::specular_matrix`]'s.
pub fn specular_on(
    (normal, view): (DVec3, DVec3),
    phong: PhongSpecular,
    visibility: &[f64],
    matrix: &[Vec<DVec3>],
) -> DVec3 {
    let mirror = mirrored(normal, view);
    let order = matrix.len().isqrt();
    let kept = phong_bands(order, phong.exponent.into());
    let rows = bands(order).zip(evaluate(order, mirror)).map(|((l, _), y)| kept[l] * y);
    f64::from(phong.scale) * times(&rows.collect::<Vec<_>>(), visibility, matrix)
}

fn times(rows: &[f64], visibility: &[f64], matrix: &[Vec<DVec3>]) -> DVec3 {
    let shares = specular_visibility(visibility, matrix);
    rows.iter().zip(shares).map(|(r, share)| *r * DVec3::from_array(share)).sum()
}

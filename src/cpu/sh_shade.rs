//! The light of an environment from what is seen of it.

use super::shared::field::{field_slope, normal_of};
use super::shared::sweep::Heights;
use crate::basis::light::receiver;
use glam::DVec3;

/// Exit radiance of one sample of albedo 1, before what is below 0 is set to 0; `matrix` is
/// [`super::light_matrix`]'s.
///
/// # Panics
/// Outside the field, or a matrix of neither receiver.
pub fn light_at(
    heights: &Heights,
    seen: &[f64],
    matrix: &[Vec<DVec3>],
    [col, row]: [i32; 2],
) -> DVec3 {
    light_on(normal_of(field_slope(heights, col, row)), seen, matrix)
}

/// The same on a surface of this normal.
///
/// # Panics
/// A matrix of neither receiver.
pub fn light_on(normal: DVec3, seen: &[f64], matrix: &[Vec<DVec3>]) -> DVec3 {
    let all = receiver(normal.to_array());
    let rows = if matrix.len() == 3 { &all[1..4] } else { &all[..matrix.len()] };
    let share = |row: &[DVec3]| row.iter().zip(seen).map(|(m, v)| *v * *m).sum::<DVec3>();
    rows.iter().zip(matrix).map(|(r, row)| *r * share(row)).sum()
}

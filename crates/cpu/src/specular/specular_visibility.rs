//! Incident light of sky and environment at every grid point, as a series.

use crate::specular_gather::Series;
use glam::DVec3;

/// The product of visibility and light, whose `matrix` is [`crate::light_matrix::specular_matrix`]'s.
pub fn specular_visibility(visibility: &[f64], matrix: &[Vec<DVec3>]) -> Series {
    let share = |row: &Vec<DVec3>| row.iter().zip(visibility).map(|(m, v)| *v * *m).sum::<DVec3>();
    matrix.iter().map(|row| share(row).to_array()).collect()
}

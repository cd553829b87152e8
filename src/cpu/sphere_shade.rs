//! What a ball of light gives to every sample: the shader's own slices, each by the oracle's profile in f64
//! where the shader marches over blocks of cells.

use super::light::{Receiver, normal};
use super::oracle::Oracle;
use super::sphere::sphere_on;
use crate::scene::SphereLight;

/// Exit radiance of a sample for a ball of radiance 1 and albedo 1, in `slices` slices or twice as many where
/// it stands under the ball.
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn sphere_at(
    oracle: &Oracle,
    sphere: &SphereLight,
    slices: u32,
    row: usize,
    col: usize,
) -> f64 {
    let receivers = [Receiver::diffuse(normal(oracle.field(), oracle.border(), row, col))];
    sphere_on(oracle, row, col, &receivers, sphere, slices as usize)[0]
}

/// [`sphere_at`] of every sample, row-major.
pub fn sphere_shade(oracle: &Oracle, sphere: &SphereLight, slices: u32) -> Vec<f64> {
    let (rows, cols) = (oracle.field().rows(), oracle.field().cols());
    let of = |i: usize| sphere_at(oracle, sphere, slices, i / cols, i % cols);
    (0..rows * cols).map(of).collect()
}

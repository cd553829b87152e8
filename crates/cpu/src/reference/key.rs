//! Light of a key light at one grid point, in f64: a quadrature over azimuths, exact within each.

use crate::light::{Receiver, normal};
use crate::oracle::Oracle;
use ridgelight::scene::KeyLight;
use std::f64::consts::PI;

/// Exit radiance of a diffuse grid point of albedo 1, linear RGB: `strips` azimuths in the middles of equal parts of
/// the light, its elevations in each clipped at the horizon exactly.
///
/// Without occlusion, the rule over azimuths has an error of (width / strips)² / 24 of the contribution of the
/// normal's horizontal part, and none for its vertical one.
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn key_of(oracle: &Oracle, row: usize, col: usize, key: &KeyLight, strips: usize) -> [f64; 3] {
    let receiver = Receiver::diffuse(normal(oracle.field(), oracle.border(), row, col));
    let share = key_on(oracle, row, col, &[receiver], key, strips)[0];
    key.radiance.map(|l| share * f64::from(l))
}

/// [`key_of`] for receivers other than the grid point's diffuse one, for radiance 1.
///
/// # Panics
/// When `row` or `col` lies outside the field.
pub fn key_on(
    oracle: &Oracle,
    row: usize,
    col: usize,
    receivers: &[Receiver],
    key: &KeyLight,
    strips: usize,
) -> Vec<f64> {
    let [low, high] = key.elevations_rad;
    let width = key.width_rad / strips as f64;
    let mut sums = vec![0.0; receivers.len()];
    for i in 0..strips {
        let azimuth = key.azimuth_rad + width * (i as f64 + 0.5) - key.width_rad / 2.0;
        let horizon = oracle.elevation_rad(row, col, azimuth);
        for (receiver, sum) in receivers.iter().zip(&mut sums) {
            *sum += width * receiver.slice(azimuth).above(horizon).light(low, high);
        }
    }
    sums.iter().map(|s| s / PI).collect()
}

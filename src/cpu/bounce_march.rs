//! What the surface throws at every sample, exactly but for the azimuths.

use super::bounce::mean_distance_m;
use super::light::{Receiver, normal};
use super::oracle::Oracle;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Light of one more bounce at a sample, for albedo 1, from the exit radiance of all samples, in `azimuths` at the
/// middles of equal parts of the circle. Weights of a whole hemisphere sum to 1.
///
/// # Panics
/// Outside the field, or where `exit` is not one colour a sample.
pub fn bounce_march(
    oracle: &Oracle,
    exit: &[[f64; 3]],
    azimuths: u32,
    row: usize,
    col: usize,
) -> [f64; 3] {
    let field = oracle.field();
    assert_eq!(exit.len(), field.rows() * field.cols());
    let receiver = Receiver::diffuse(normal(field, oracle.border(), row, col));
    let (mut light, mut whole, mut seen) = ([0.0; 3], 0.0, Vec::new());
    for k in 0..azimuths {
        let azimuth = TAU * (f64::from(k) + 0.5) / f64::from(azimuths);
        let slice = receiver.slice(azimuth);
        whole += slice.light(-FRAC_PI_2, FRAC_PI_2);
        oracle.stretches(row, col, azimuth, &mut seen);
        for stretch in &seen {
            let weight = slice.light(stretch.low_rad, stretch.high_rad);
            if weight > 0.0 {
                let shares = stretch.corner_weights(mean_distance_m(&slice, stretch));
                for (share, [r, c]) in shares.into_iter().zip(oracle.corners(stretch.triangle)) {
                    let from = exit[r * field.cols() + c];
                    light = [0, 1, 2].map(|i| light[i] + weight * share * from[i]);
                }
            }
        }
    }
    light.map(|l| l / whole)
}

//! Real orthonormal spherical harmonics: values, rotation about the vertical, zonal functions about any axis.

use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, TAU};

use super::bands;
use super::legendre::{associated, value};

/// Y_lm of every coefficient at a unit direction.
///
/// sinᵐθ cos mφ and sinᵐθ sin mφ are the parts of (x + iy)ᵐ, which is defined at the poles.
pub fn evaluate(order: usize, direction: DVec3) -> Vec<f64> {
    let DVec3 { x, y, z } = direction;
    let mut powers = vec![(1.0, 0.0)];
    for m in 1..order {
        let (re, im) = powers[m - 1];
        powers.push((re * x - im * y, re * y + im * x));
    }
    bands(order)
        .map(|(l, m)| {
            let (re, im) = powers[m.unsigned_abs()];
            let around = match m {
                0 => (1.0 / TAU).sqrt(),
                1.. => re * FRAC_1_PI.sqrt(),
                _ => im * FRAC_1_PI.sqrt(),
            };
            around * value(associated(l, m.unsigned_abs()), z)
        })
        .collect()
}

/// Directions and weights that integrate the product of two functions of an order exactly: Gauss' n points in z times
/// 2n - 1 even azimuths, n (2n - 1) in all.
pub fn product_rule(order: usize) -> Vec<(DVec3, f64)> {
    let turns = 2 * order - 1;
    let step = TAU / turns as f64;
    let rows = super::quadrature::rule(order).into_iter();
    rows.flat_map(|(z, weight)| {
        let sin = ((1.0 - z) * (1.0 + z)).sqrt();
        (0..turns).map(move |k| {
            let (s, c) = (step * k as f64).sin_cos();
            (DVec3::new(sin * c, sin * s, z), step * weight)
        })
    })
    .collect()
}

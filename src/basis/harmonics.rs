//! Real orthonormal spherical harmonics: values, rotation about the vertical, zonal functions about any axis.

use glam::DVec3;
use std::f64::consts::{FRAC_1_PI, PI, TAU};

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

/// The value of a series at a unit direction: Σ of coefficients times Y.
///
/// # Panics
/// If the number of `coefficients` is not a square.
pub fn reconstruct(coefficients: &[f64], direction: DVec3) -> f64 {
    let values = evaluate(order_of(coefficients), direction);
    coefficients.iter().zip(values).map(|(c, y)| c * y).sum()
}

/// Directions and weights that integrate the product of two functions of an order exactly: Gauss' n points in z times
/// 2n - 1 even azimuths, n (2n - 1) in all.
pub(crate) fn product_rule(order: usize) -> Vec<(DVec3, f64)> {
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

/// The function rotated by half a turn about a unit axis: its value at o is the old one at 2 (a·o) a - o.
///
/// # Panics
/// If the number of `coefficients` is not a square.
pub fn half_turn(coefficients: &[f64], axis: DVec3) -> Vec<f64> {
    let order = order_of(coefficients);
    let mut out = vec![0.0; coefficients.len()];
    for (o, weight) in product_rule(order) {
        let value = reconstruct(coefficients, 2.0 * axis.dot(o) * axis - o);
        out.iter_mut().zip(evaluate(order, o)).for_each(|(sum, y)| *sum += weight * value * y);
    }
    out
}

/// A zonal function about z (n coefficients of Y_l0) rotated to a unit axis: z_l √(4π/(2l+1)) Y_lm (Sloan, Luna & Snyder
/// 2005).
///
/// # Panics
/// If there are none, or more than [`super::MAX_ORDER`].
pub fn turned(zonal: &[f64], axis: DVec3) -> Vec<f64> {
    let values = evaluate(zonal.len(), axis);
    bands(zonal.len())
        .zip(values)
        .map(|((l, _), y)| zonal[l] * (4.0 * PI / (2 * l + 1) as f64).sqrt() * y)
        .collect()
}

/// The order n of n² coefficients.
pub(super) fn order_of(coefficients: &[f64]) -> usize {
    let order = coefficients.len().isqrt();
    assert_eq!(order * order, coefficients.len(), "coefficients: not a square number of them");
    order
}

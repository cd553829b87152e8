//! The factor Φ of a basis function: 1/√2π, cos mφ/√π and sin mφ/√π.

use std::f64::consts::{FRAC_1_PI, TAU};

use super::check_order;

/// Φ_m(φ) at place m + n - 1, for |m| < n.
pub fn around(order: usize, phi_rad: f64) -> Vec<f64> {
    check_order(order);
    turns(order).map(|m| phi(m, phi_rad)).collect()
}

fn turns(order: usize) -> impl Iterator<Item = isize> {
    1 - order as isize..order as isize
}

fn phi(m: isize, phi_rad: f64) -> f64 {
    let (sin, cos) = (m.unsigned_abs() as f64 * phi_rad).sin_cos();
    match m {
        0 => (1.0 / TAU).sqrt(),
        1.. => cos * FRAC_1_PI.sqrt(),
        _ => sin * FRAC_1_PI.sqrt(),
    }
}

//! Zonal functions about z, as their n coefficients of Y_l0 = P̂_l/√2π: discs of light and reflection lobes.

use std::f64::consts::PI;

use super::check_order;

/// √((2l+1)/4π), the coefficient of a lobe of unit integral whose band keeps the share 1.
fn whole_band(l: usize) -> f64 {
    ((2 * l + 1) as f64 / (4.0 * PI)).sqrt()
}

/// max(cos θ, 0), of integral π; exit radiance of a diffuse surface divides by π once (NS09 §7). It is π times the Phong
/// lobe of exponent 1; odd bands from 3 on are 0.
pub fn clamped_cosine(order: usize) -> Vec<f64> {
    phong(order, 1.0).iter().map(|c| PI * c).collect()
}

/// The Phong lobe (S+1)/2π max(cos θ, 0)^S of unit integral and exponent S ≥ 0, exact: [`phong_bands`] of √((2l+1)/4π).
pub fn phong(order: usize, exponent: f64) -> Vec<f64> {
    let kept = phong_bands(order, exponent);
    kept.iter().enumerate().map(|(l, r)| r * whole_band(l)).collect()
}

/// Factor of each band in a convolution with the Phong lobe of unit integral.
///
/// r_l = (S+1) ∫ from 0 to 1 of zˢ P_l dz: r_0 = 1, r_1 = (S+1)/(S+2) and r_l = r_{l-2} (S+2-l)/(S+l+1).
pub fn phong_bands(order: usize, exponent: f64) -> Vec<f64> {
    check_order(order);
    let s = exponent;
    let mut ratios = vec![1.0, (s + 1.0) / (s + 2.0)];
    for l in 2..order {
        ratios.push(ratios[l - 2] * (s + 2.0 - l as f64) / (s + (l + 1) as f64));
    }
    ratios.truncate(order);
    ratios
}

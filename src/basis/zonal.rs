//! Zonal functions about z, as their n coefficients of Y_l0 = P̂_l/√2π: discs of light and reflection lobes.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::check_order;
use super::legendre::{derivative, legendre, value};

/// √((2l+1)/4π), the coefficient of a lobe of unit integral whose band keeps the share 1.
fn whole_band(l: usize) -> f64 {
    ((2 * l + 1) as f64 / (4.0 * PI)).sqrt()
}

/// A disc of radiance 1 and half-angle `half_rad`, [0..π]: a spherical cap (thesis appendix A).
///
/// 2π ∫ from cos a to 1 of Y_l0 dz = 2π √((2l+1)/4π) sin²a P_l'(cos a)/(l(l+1)), by Legendre's equation;
/// band 0: √π (1 - cos a) = 2√π sin²(a/2). Small discs keep their digits.
pub fn cap(order: usize, half_rad: f64) -> Vec<f64> {
    let (sin, cos) = half_rad.sin_cos();
    cap_of(order, sin * sin, cos)
}

/// [`cap`] from sin² and cos of its half-angle.
fn cap_of(order: usize, sin_squared: f64, cos: f64) -> Vec<f64> {
    check_order(order);
    let missing = if cos > 0.0 { sin_squared / (1.0 + cos) } else { 1.0 - cos };
    (0..order)
        .map(|l| {
            let share = match l {
                0 => missing,
                _ => sin_squared * value(&derivative(&legendre(l)), cos) / (l * (l + 1)) as f64,
            };
            TAU * whole_band(l) * share
        })
        .collect()
}

/// A sphere light of radiance 1 and this radius at this distance of its centre, about the direction to the centre.
///
/// Outside, a [`cap`] with sin a = radius/distance. Inside, and on the inner side of its surface, light comes from every
/// direction: the whole sphere. At the surface the cap is a half-space, so the light doubles across the surface, as it
/// physically does. Coefficients fall off as distance⁻² and are finite at any f64 distance.
pub fn sphere(order: usize, radius: f64, distance: f64) -> Vec<f64> {
    if distance < radius {
        return cap_of(order, 0.0, -1.0);
    }
    let sin = if radius > 0.0 { radius / distance } else { 0.0 };
    cap_of(order, sin * sin, ((1.0 - sin) * (1.0 + sin)).sqrt())
}

/// A sky of radiance 1 above horizontal.
pub fn sky(order: usize) -> Vec<f64> {
    cap(order, FRAC_PI_2)
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

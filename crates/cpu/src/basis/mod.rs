//! Basis functions that the CPU references and tests use beyond those of [`ridgelight::basis`], and the GLSL that is
//! generated from formulas.

use std::f64::consts::PI;

use ridgelight::basis::legendre::{associated, value};
use ridgelight::basis::quadrature::integral;
use ridgelight::basis::slice::parts;
use ridgelight::basis::{bands, index};

pub mod glsl;
pub mod wedge;
pub mod window;

/// P̂_l = √((2l+1)/2) P_l at `z`, for l < `order`: orthonormal on [-1, 1] (NS09 §4).
pub fn nlp(order: usize, z: f64) -> Vec<f64> {
    (0..order).map(|l| value(associated(l, 0), z)).collect()
}

/// The slice of a function of elevation, smooth in θ, from its values at z.
pub fn project(order: usize, f: impl Fn(f64) -> f64) -> Vec<f64> {
    parts(order)
        .map(|(l, m)| {
            let q = associated(l, m);
            integral(0.0, PI, |theta| {
                let (sin, cos) = theta.sin_cos();
                f(cos) * value(q, cos) * sin.powi(m as i32 + 1)
            })
        })
        .collect()
}

/// The NLP reconstruction of a function of elevation at z (NS09 eq. 13).
pub fn nlp_value(coefficients: &[f64], z: f64) -> f64 {
    coefficients.iter().zip(nlp(coefficients.len(), z)).map(|(c, p)| c * p).sum()
}

/// The function rotated counter-clockwise about z: f'(φ) = f(φ - angle).
///
/// # Panics
/// If the number of `coefficients` is not a square.
pub fn rotate_z(coefficients: &[f64], angle_rad: f64) -> Vec<f64> {
    bands(order_of(coefficients))
        .map(|(l, m)| {
            // cos m(φ - a) = cos mφ cos ma + sin mφ sin ma; sin m(φ - a) = sin mφ cos ma - cos mφ sin ma.
            let (sin, cos) = (m as f64 * angle_rad).sin_cos();
            coefficients[index(l, m)] * cos - coefficients[index(l, -m)] * sin
        })
        .collect()
}

/// Half the azimuthal extent of a sphere light, radians, from its radius and the horizontal distance of its centre. `None`
/// if it is above, below or around the point: all azimuths.
pub fn sphere_half_azimuth(radius: f64, distance_in_plane: f64) -> Option<f64> {
    (distance_in_plane > radius).then(|| (radius / distance_in_plane).asin())
}

/// The paper's Phong lobe: band l keeps e^(-l²/2S) (NS09 §7, Ramamoorthi & Hanrahan 2002), S > 0.
///
/// Times √((2l+1)/4π), which the paper omits, for a lobe of unit integral. Approaches [`phong`](ridgelight::basis::zonal::phong) for large S, which keeps
/// e^(-l(l+1)/2S): a relative error of l/(2S) in band l.
pub fn phong_gaussian(order: usize, exponent: f64) -> Vec<f64> {
    (0..order)
        .map(|l| {
            (-((l * l) as f64) / (2.0 * exponent)).exp() * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt()
        })
        .collect()
}

/// The order n of n² coefficients.
fn order_of(coefficients: &[f64]) -> usize {
    let order = coefficients.len().isqrt();
    assert_eq!(order * order, coefficients.len(), "coefficients: not a square number of them");
    order
}

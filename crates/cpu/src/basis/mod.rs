//! Basis functions that the CPU references and tests use beyond those of [`ridgelight::basis`], and the GLSL that is
//! generated from formulas.

use glam::DVec3;
use ridgelight::basis::harmonics::{evaluate, product_rule};
use ridgelight::basis::legendre::{associated, legendre, value};
use ridgelight::basis::product::{Triple, orders};
use ridgelight::basis::quadrature::integral;
use ridgelight::basis::slice::parts;
use ridgelight::basis::zonal::phong_bands;
use ridgelight::basis::{bands, index};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

pub mod azimuth;
pub mod glsl;
pub mod key;
pub mod wedge;

/// P̂_l = √((2l+1)/2) P_l at `z`, for l < `order`: orthonormal on [-1, 1] (NS09 §4).
pub fn nlp(order: usize, z: f64) -> Vec<f64> {
    (0..order).map(|l| value(associated(l, 0), z)).collect()
}

/// The function rotated counter-clockwise about z: f'(φ) = f(φ - angle).
pub fn rotate_z(coefficients: &[f64], angle_rad: f64) -> Vec<f64> {
    bands(order_of(coefficients))
        .map(|(l, m)| {
            // cos m(φ - a) = cos mφ cos ma + sin mφ sin ma; sin m(φ - a) = sin mφ cos ma - cos mφ sin ma.
            let (sin, cos) = (m as f64 * angle_rad).sin_cos();
            coefficients[index(l, m)] * cos - coefficients[index(l, -m)] * sin
        })
        .collect()
}

/// ∫ P̂_c Θ_lm dz: `[slice_index][c]`, the map from NLP coefficients to a slice.
///
/// 0 where l + m + c is odd; the unit matrix at m = 0.
pub fn from_nlp(order: usize) -> Vec<Vec<f64>> {
    parts(order)
        .map(|(l, m)| {
            let q = associated(l, m);
            (0..order)
                .map(|c| {
                    if (l + m + c) % 2 == 1 {
                        return 0.0;
                    }
                    let p = associated(c, 0);
                    integral(0.0, PI, |theta| {
                        let (sin, cos) = theta.sin_cos();
                        value(p, cos) * value(q, cos) * sin.powi(m as i32 + 1)
                    })
                })
                .collect()
        })
        .collect()
}

/// D_l in v̂_l(σ) = cos²σ · D_l(sin σ), for 1 ≤ l < `order`; v̂_0 = (1 + sin σ)/√2.
///
/// By Legendre's equation ((1 - z²) P_l')' = -l(l+1) P_l, so ∫ from -1 to s of P̂_l is
/// -(1 - s²) √((2l+1)/2)/(l(l+1)) P_l'(s). These are NS09's coefficients after eq. 13, for any order.
/// With a horizon's slope t, sin σ = t/√(1+t²) and cos²σ = 1/(1+t²): no angle is needed.
pub fn occlusion_polynomials(order: usize) -> Vec<Vec<f64>> {
    (1..order)
        .map(|l| {
            let scale = -((2 * l + 1) as f64 / 2.0).sqrt() / (l * (l + 1)) as f64;
            slope(l).iter().map(|c| scale * c).collect()
        })
        .collect()
}

/// NLP coefficients of the part below elevation σ: v̂_l(σ) = ∫ from -1 to sin σ of P̂_l dz (NS09 eq. 10).
///
/// Takes sin σ and cos σ ≥ 0, σ in [-π/2..π/2]. The part above is v̂(π/2) - v̂(σ), v̂(π/2) = (√2, 0, …).
pub fn occlusion(order: usize, sin: f64, cos: f64) -> Vec<f64> {
    let squared = cos * cos;
    // 1 + sin σ without cancellation near the nadir.
    let below = if sin < 0.0 { squared / (1.0 - sin) } else { 1.0 + sin };
    let first = below * std::f64::consts::FRAC_1_SQRT_2;
    let rest = occlusion_polynomials(order);
    std::iter::once(first).chain(rest.iter().map(|d| squared * value(d, sin))).collect()
}

/// The derivative of P_l: coefficients of z⁰, z¹, …
fn slope(l: usize) -> Vec<f64> {
    legendre(l).iter().enumerate().skip(1).map(|(k, c)| k as f64 * c).collect()
}

/// The product of two series, truncated to their order.
pub fn product(triples: &[Triple], a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut out = vec![0.0; a.len()];
    for triple in triples {
        for [i, j, k] in orders(triple.places) {
            out[k] += triple.value * a[i] * b[j];
        }
    }
    out
}

/// The polynomials of a unit normal in Y_lm without their factors: 1; y, z, x; xy, yz, 3z² - 1, xz, x² - y². They are the
/// rows of [`cosine_lobe`](ridgelight::basis::light::cosine_lobe) in order; the second to fourth are those of [`plane`](ridgelight::basis::light::plane).
pub fn receiver([x, y, z]: [f64; 3]) -> [f64; 9] {
    [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, x * z, x * x - y * y]
}

/// Reflection of arriving light, given as a series, by a Phong lobe of unit integral about a direction r: Σ r_l Y_lm(r)
/// U_lm, as band l of a zonal function rotated to r has coefficients √(4π/(2l+1)) Y_lm(r) (NS09 §7, with the exact bands of
/// the lobe: [`phong_bands`]).
///
/// If U is the product of V and L ([`light_matrix`](ridgelight::basis::product::light_matrix) times V), then V, L and the lobe are all truncated, and the product
/// lacks bands of V: sharper lobes lose more.
pub fn specular(arriving: &[f64], direction: DVec3, exponent: f64) -> f64 {
    let order = arriving.len().isqrt();
    let kept = phong_bands(order, exponent);
    let all = bands(order).zip(evaluate(order, direction)).zip(arriving);
    all.map(|(((l, _), y), u)| kept[l] * y * u).sum()
}

/// The value of a series at a unit direction: Σ of coefficients times Y.
pub fn reconstruct(coefficients: &[f64], direction: DVec3) -> f64 {
    let values = evaluate(order_of(coefficients), direction);
    coefficients.iter().zip(values).map(|(c, y)| c * y).sum()
}

/// The function rotated by half a turn about a unit axis: its value at o is the old one at 2 (a·o) a - o.
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
pub fn turned(zonal: &[f64], axis: DVec3) -> Vec<f64> {
    let values = evaluate(zonal.len(), axis);
    bands(zonal.len())
        .zip(values)
        .map(|((l, _), y)| zonal[l] * (4.0 * PI / (2 * l + 1) as f64).sqrt() * y)
        .collect()
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
    let missing = if cos > 0.0 { sin_squared / (1.0 + cos) } else { 1.0 - cos };
    (0..order)
        .map(|l| {
            let share = match l {
                0 => missing,
                _ => sin_squared * value(&slope(l), cos) / (l * (l + 1)) as f64,
            };
            TAU * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt() * share
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

/// Coefficients times the factors of their bands.
pub fn apply_window(factors: &[f64], coefficients: &[f64]) -> Vec<f64> {
    bands(order_of(coefficients)).zip(coefficients).map(|((l, _), c)| factors[l] * c).collect()
}

/// The order n of n² coefficients.
fn order_of(coefficients: &[f64]) -> usize {
    let order = coefficients.len().isqrt();
    assert_eq!(order * order, coefficients.len(), "coefficients: not a square number of them");
    order
}

//! Light as a series, and as the matrix that maps visibility to exit radiance.
//!
//! Exit radiance of a diffuse surface of normal N and albedo 1 is 1/π ∫ L V max(N·e, 0) de. Two receivers:
//!
//! - [`plane`]: V also ends at the surface's own plane, so N·e needs no maximum: three numbers of band 1, exact. L of order
//!   n - 1 times N·e is a series of order n, so V of order n truncates nothing: the only approximation is L's. It rings only
//!   where L does.
//! - [`cosine_lobe`]: V ends at the horizon only and the maximum is a series of three bands (NS09 §7), so V does not depend on the
//!   normal. V, L and the cosine lobe are all truncated; L has order n.
//!
//! V first, then the matrix: n² products per azimuth and 9 n² (27 n² for [`cosine_lobe`]) per texel. Light summed over azimuths
//! without V would take 9 n(n+1)/2 per azimuth: 90 against 16 at order 4.
//!
//! All are linear in L: one constant matrix maps its series to the light's matrix.

use std::f64::consts::PI;

use super::legendre::{associated, value};
use super::product::{Triple, light_matrix};
use super::quadrature::integral;
use super::{bands, check_order, index, zonal};

/// Bands of the clamped cosine that are kept: of the rest, odd ones are 0 and band 4 is 4 % of band 0.
const COSINE_BANDS: usize = 3;

/// Weight of light below ground in a fit.
///
/// Without it, the condition of the fit is that of ∫ over the upper hemisphere of Y Y': 250 at order 3, 1.5e5 at 5, and f32
/// loses as many digits. With 1e-4 it is at most 1e4; under a real sky's light up to order 4 the error changes by less than
/// a tenth.
const BELOW: f64 = 1e-4;

/// Maps integrals ∫ L Y over the upper hemisphere to the series that fits L there best, by least squares: n² × n²,
/// `[coefficient][integral]`.
///
/// Below horizontal nothing is visible, so light there is free: it is fitted to the mean of the upper hemisphere with the
/// weight 1e-4. A series over the whole sphere would spend its order on the step at the horizon; this one fits the visible
/// half. Constants stay exact. Each m is a block of its own.
pub fn fit_above_ground(order: usize) -> Vec<Vec<f64>> {
    check_order(order);
    let mut fit = vec![vec![0.0; order * order]; order * order];
    for m in 0..order {
        let theta = |l: usize, z: f64| {
            value(associated(l, m), z) * ((1.0 - z) * (1.0 + z)).powi(m as i32).sqrt()
        };
        let count = order - m;
        let product = |from: f64, to: f64, a: usize, b: usize| {
            integral(from, to, |z| theta(m + a, z) * theta(m + b, z))
        };
        let gram = |a, b| product(0.0, 1.0, a, b) + BELOW * product(-1.0, 0.0, a, b);
        let inverse =
            inverted((0..count).map(|a| (0..count).map(|b| gram(a, b)).collect()).collect());
        // The mean from Y_00's integral: (1/2π) √4π of it, √4π times Y_00; 2 in all.
        let mean = |a: usize| if m == 0 { 2.0 * BELOW * product(-1.0, 0.0, a, 0) } else { 0.0 };
        for (a, row) in inverse.iter().enumerate() {
            let of_mean: f64 = row.iter().enumerate().map(|(i, v)| v * mean(i)).sum();
            for (b, value) in row.iter().enumerate() {
                let value = if b == 0 { value + of_mean } else { *value };
                for m in [m as isize, -(m as isize)] {
                    let place = |i: usize| index(i + m.unsigned_abs(), m);
                    fit[place(a)][place(b)] = value;
                }
            }
        }
    }
    fit
}

/// Inverse of a symmetric positive matrix, by Gauss and Jordan.
fn inverted(mut a: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
    for p in 0..a.len() {
        let pivot = std::mem::replace(&mut a[p][p], 1.0);
        a[p].iter_mut().for_each(|v| *v /= pivot);
        let row = a[p].clone();
        for (_, other) in a.iter_mut().enumerate().filter(|(i, _)| *i != p) {
            let factor = std::mem::replace(&mut other[p], 0.0);
            other.iter_mut().zip(&row).for_each(|(v, r)| *v -= factor * r);
        }
    }
    a
}

/// The matrix of a light for [`plane`]: `[row][k]`, rows N_y, N_z and N_x, n² columns. Exit radiance is Σ N_row M_row,k
/// V_k, with V above the horizon and the surface's own plane.
///
/// `light` has order n - 1, `triples` are of order n, 2 or more.
///
/// # Panics
/// If the order of `triples` is not that of the light plus 1.
pub fn plane(triples: &[Triple], order: usize, light: &[f64]) -> Vec<Vec<f64>> {
    assert_eq!(light.len(), (order - 1) * (order - 1), "a light of order {}", order - 1);
    // N·e = √(4π/3) (N_y Y_1-1 + N_z Y_10 + N_x Y_11).
    let scale = (4.0 * PI / 3.0).sqrt() / PI;
    let mut longer = light.to_vec();
    longer.resize(order * order, 0.0);
    light_matrix(triples, &longer)[1..4]
        .iter()
        .map(|row| row.iter().map(|v| v * scale).collect())
        .collect()
}

/// The matrix of a light for the cosine lobe: `[row][k]`, 9 rows (4 at order 2), n² columns. Exit radiance is Σ R_row
/// M_row,k V_k with R the polynomials of the normal, 1; y, z, x; xy, yz, 3z² - 1, xz, x² - y², and V above the horizon.
///
/// # Panics
/// If `light` does not have the order of the `triples`.
pub fn cosine_lobe(triples: &[Triple], order: usize, light: &[f64]) -> Vec<Vec<f64>> {
    assert_eq!(light.len(), order * order, "a light of order {order}");
    let kept = order.min(COSINE_BANDS);
    let cosine = zonal::clamped_cosine(kept);
    let matrix = light_matrix(triples, light);
    bands(kept)
        .zip(matrix)
        .map(|((l, m), row)| {
            // Rotated to N, band l has coefficients √(4π/(2l+1)) Y_lm(N); Y's own factors are included here.
            let scale = cosine[l] * (4.0 * PI / (2 * l + 1) as f64).sqrt() * factor(l, m) / PI;
            row.iter().map(|v| v * scale).collect()
        })
        .collect()
}

/// The factor of the polynomial in Y_lm.
fn factor(l: usize, m: isize) -> f64 {
    let root = |a: f64| (a / PI).sqrt();
    match (l, m) {
        (0, _) => 0.5 * root(1.0),
        (1, _) => root(0.75),
        (_, 0) => 0.25 * root(5.0),
        (_, 2) => 0.25 * root(15.0),
        _ => 0.5 * root(15.0),
    }
}

/// ∫ from `low` to `high` of (a cos²ω + b sin ω cos ω) dω, 0 when the interval is empty.
///
/// Antiderivative a/2 (ω + sin 2ω / 2) + b/2 sin²ω. With Δ = high - low and Σ = high + low,
/// sin 2high - sin 2low = 2 cos Σ sin Δ and sin²high - sin²low = sin Σ sin Δ: no cancellation.
pub fn slice(a: f64, b: f64, low: f64, high: f64) -> f64 {
    if high <= low {
        return 0.0;
    }
    let (width, sum) = (high - low, high + low);
    0.5 * (a * (width + sum.cos() * width.sin()) + b * sum.sin() * width.sin())
}

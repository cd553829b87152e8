//! Products of two series: Γ_ijk = ∫ Y_i Y_j Y_k.
//!
//! A product truncated to its order n is (a b)_k = Σ Γ_ijk a_i b_j; a receiver H gets Σ Γ_ijk L_i V_j H_k from light L
//! with visibility V.

use std::f64::consts::TAU;

use super::azimuth::around;
use super::legendre::{associated, value};
use super::quadrature::points;
use super::{bands, check_order};

/// One coefficient that is not 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triple {
    /// The three indices, ascending; the value holds for every order of them.
    pub places: [usize; 3],
    /// Γ.
    pub value: f64,
}

/// Every Γ_ijk of an order that is not 0, i ≤ j ≤ k, by places.
///
/// Elevation uses Gauss' rule: where the azimuth integral is not 0, |m| sums to an even number and the integrand is a
/// polynomial of degree 15 at most. Azimuth uses 32 even points, exact below frequency 32. Values that are not 0 exceed
/// 1e-3.
pub fn triples(order: usize) -> Vec<Triple> {
    check_order(order);
    let elevations: Vec<(f64, Vec<f64>)> = points(-1.0, 1.0)
        .map(|(z, weight)| {
            let sin = ((1.0 - z) * (1.0 + z)).sqrt();
            let theta = |(l, m): (usize, isize)| {
                let m = m.unsigned_abs();
                value(associated(l, m), z) * sin.powi(m as i32)
            };
            (weight, bands(order).map(theta).collect())
        })
        .collect();
    let azimuths: Vec<(f64, Vec<f64>)> = (0..32)
        .map(|k| {
            let turns = around(order, TAU / 32.0 * f64::from(k));
            let phi = |(_, m): (usize, isize)| turns[(order - 1).wrapping_add_signed(m)];
            (TAU / 32.0, bands(order).map(phi).collect())
        })
        .collect();
    let sum = |at: &[(f64, Vec<f64>)], [i, j, k]: [usize; 3]| -> f64 {
        at.iter().map(|(weight, y)| weight * y[i] * y[j] * y[k]).sum()
    };
    let count = order * order;
    let mut triples = Vec::new();
    for i in 0..count {
        for j in i..count {
            for k in j..count {
                let places = [i, j, k];
                let value = sum(&azimuths, places) * sum(&elevations, places);
                if value.abs() > 1e-12 {
                    triples.push(Triple { places, value });
                }
            }
        }
    }
    triples
}

/// Every permutation of three indices once: 6, 3 or 1 of them.
pub fn orders([i, j, k]: [usize; 3]) -> Vec<[usize; 3]> {
    let mut all = vec![[i, j, k], [i, k, j], [j, i, k], [j, k, i], [k, i, j], [k, j, i]];
    all.sort_unstable();
    all.dedup();
    all
}

/// M_jk = Σ_i Γ_ijk L_i: the matrix of a light, `[row][column]`, symmetric.
///
/// M V is light times visibility. Its first rows are its first bands: a diffuse receiver needs 9 coefficients at order 4.
/// M is the same at every texel, so a shader needs no Γ: at order 4, 144 products per colour where visibility is known,
/// and 9 per colour at each receiver.
///
/// # Panics
/// If `triples` have a higher order than `light`.
pub fn light_matrix(triples: &[Triple], light: &[f64]) -> Vec<Vec<f64>> {
    let mut matrix = vec![vec![0.0; light.len()]; light.len()];
    for triple in triples {
        for [i, j, k] in orders(triple.places) {
            matrix[j][k] += triple.value * light[i];
        }
    }
    matrix
}

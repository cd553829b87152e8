//! A table of what is reflected as a short sum of products of two functions of one direction each.

use glam::DVec3;

use super::{Angles, Brdf};
use crate::{Error, Result};

/// f(l, v) ≈ Σ g_k(l) g_k(v), each g_k over a grid of angles, R, G, B (separable approximation: Kautz & McCool 1999).
///
/// With w the parts of ∫ cos θ dω, the matrix √w_i f_ij √w_j is symmetric, as light and view can be exchanged, and has no
/// eigenvalue below 0: direct light is a sum over places of what each receives from l times the same of v, and scattered
/// light is what these throw to each other and back. Of all sums of so many products that of its largest eigenvalues λ_k and
/// their vectors q_k leaves the least squares of f, weighted by what a plane receives and sends, g_k = √λ_k q_k / √w.
#[derive(Clone, Debug, PartialEq)]
pub struct Factors {
    angles: Angles,
    /// Of each k, all angles in order.
    values: Vec<Vec<[f64; 3]>>,
}

/// Turns of the iteration, each of which brings vectors nearer by the quotient of two neighbouring eigenvalues: those that are
/// not told apart after so many leave nearly the same squares.
const TURNS: usize = 60;

impl Factors {
    /// The first `count` of a table over these angles; of what chance has made different with light and view exchanged the mean.
    ///
    /// # Errors
    /// None, or more than angles; a table of others.
    pub fn of(table: &Brdf, angles: Angles, count: usize) -> Result<Self> {
        let size = angles.count();
        if table.directions().len() != size {
            let found = format!("{} directions", table.directions().len());
            return Err(Error::setting("angles of a table", found, size.to_string()));
        }
        if !(1..=size).contains(&count) {
            return Err(Error::setting("factors", count.to_string(), format!("1 to {size}")));
        }
        let roots: Vec<f64> = angles.projected_sr().iter().map(|w| w.sqrt()).collect();
        let mut values = vec![vec![[0.0; 3]; size]; count];
        for channel in [0, 1, 2] {
            let of = |i: usize| {
                let (a, b) = (i / size, i % size);
                let both = table.at(a, b)[channel] + table.at(b, a)[channel];
                0.5 * both * roots[a] * roots[b]
            };
            let matrix: Vec<f64> = (0..size * size).map(of).collect();
            for (k, (value, vector)) in largest(&matrix, count).into_iter().enumerate() {
                let scale = value.max(0.0).sqrt();
                let texels = values[k].iter_mut().zip(vector.iter().zip(&roots));
                texels.for_each(|(texel, (v, root))| texel[channel] = scale * v / root);
            }
        }
        Ok(Self { angles, values })
    }

    /// One for each product, R, G, B of all angles.
    pub fn values(&self) -> &[Vec<[f64; 3]>] {
        &self.values
    }

    /// For a light and a view above horizontal, unit vectors; each factor linear between its angles.
    pub fn at(&self, light: DVec3, view: DVec3) -> [f64; 3] {
        let [light, view] = [light, view].map(|e| self.angles.around(e));
        let mut sum = [0.0; 3];
        for of_k in &self.values {
            let at = |around: &[(usize, f64); 4], c: usize| -> f64 {
                around.iter().map(|(i, share)| share * of_k[*i][c]).sum()
            };
            (0..3).for_each(|c| sum[c] += at(&light, c) * at(&view, c));
        }
        sum
    }
}

/// The largest eigenvalues of a symmetric matrix and their unit vectors, by orthogonal iteration from fixed beginnings.
fn largest(matrix: &[f64], count: usize) -> Vec<(f64, Vec<f64>)> {
    let size = matrix.len().isqrt();
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let times =
        |v: &[f64]| -> Vec<f64> { matrix.chunks_exact(size).map(|row| dot(row, v)).collect() };
    // Fractions of multiples of an irrational number: no vector is at right angles to them by chance.
    let begin =
        |k: usize| (0..size).map(move |i| ((k * size + i + 1) as f64 * 0.618_034).fract() - 0.5);
    let mut vectors: Vec<Vec<f64>> = (0..count).map(|k| begin(k).collect()).collect();
    for turn in 0..=TURNS {
        if turn > 0 {
            vectors = vectors.iter().map(|v| times(v)).collect();
        }
        for k in 0..count {
            let (before, rest) = vectors.split_at_mut(k);
            // Twice, as what is left after the first may be mostly rounding.
            for other in before.iter().chain(before.iter()) {
                let along = dot(other, &rest[0]);
                rest[0].iter_mut().zip(other).for_each(|(v, o)| *v -= along * o);
            }
            let length = dot(&rest[0], &rest[0]).sqrt();
            let scale = if length > f64::MIN_POSITIVE { 1.0 / length } else { 0.0 };
            rest[0].iter_mut().for_each(|v| *v *= scale);
        }
    }
    vectors.into_iter().map(|v| (dot(&v, &times(&v)), v)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 2 a aᵀ + b bᵀ of two vectors of length 1 at right angles: their squares' shares, and nothing left of a third.
    #[test]
    fn eigenvectors_are_found() {
        let (a, b) = ([0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]);
        let matrix: Vec<f64> =
            (0..9).map(|i| 2.0 * a[i / 3] * a[i % 3] + b[i / 3] * b[i % 3]).collect();
        let found = largest(&matrix, 3);
        for ((value, vector), (known, axis)) in found.iter().zip([(2.0, a), (1.0, b)]) {
            let along: f64 = vector.iter().zip(axis).map(|(v, a)| v * a).sum();
            assert!((value - known).abs() < 1e-9 && (along.abs() - 1.0).abs() < 1e-9, "{value}");
        }
        assert!(found[2].0.abs() < 1e-9);
    }
}

//! A rival of factors: a table of what is reflected as the sum over two sets of spherical harmonics.

use glam::DVec3;
use ridgelight::bake::Brdf;
use ridgelight::basis::MAX_ORDER;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::{Error, Result};

/// A BRDF as the sum over two sets of spherical harmonics, Σ c_ij Y_i(light) Y_j(view), symmetric.
#[derive(Clone, Debug, PartialEq)]
pub struct Harmonics {
    /// Bands of either set.
    pub order: usize,
    /// n² × n² colours, i first.
    pub coefficients: Vec<[f64; 3]>,
}

impl Harmonics {
    /// Of a table, by least squares over its directions, each of its weight, which span harmonics on the hemisphere alone: no
    /// value below horizontal means anything.
    ///
    /// With B the values of the harmonics in the directions and B⁺ = (BᵀWB + r)⁻¹BᵀW, C = B⁺ F B⁺ᵀ minimises the squares over
    /// all pairs; r, a millionth of the largest diagonal, keeps what the hemisphere cannot tell apart near 0. C + Cᵀ halves what
    /// is not reciprocal.
    ///
    /// # Errors
    /// An order outside of [1..6]; fewer directions than harmonics.
    pub fn of(table: &Brdf, order: usize, weights: &[f64]) -> Result<Self> {
        if !(1..=MAX_ORDER).contains(&order) {
            let expected = format!("a whole number from 1 to {MAX_ORDER}");
            return Err(Error::setting("order", order.to_string(), expected));
        }
        let count = table.directions().len();
        let terms = order * order;
        if terms > count {
            let found = format!("{terms} harmonics for {count} directions");
            return Err(Error::setting("order", found, "no more harmonics than directions"));
        }
        let rows: Vec<Vec<f64>> = table.directions().iter().map(|v| evaluate(order, *v)).collect();
        let inverse = pseudo_inverse(&rows, terms, weights);
        let channel = |c: usize| {
            // B⁺ F, then its product with B⁺ᵀ.
            let mut half = vec![0.0; terms * count];
            for (row, half) in inverse.iter().zip(half.chunks_exact_mut(count)) {
                for (light, weight) in row.iter().enumerate() {
                    for (view, sum) in half.iter_mut().enumerate() {
                        *sum += weight * table.at(light, view)[c];
                    }
                }
            }
            let product = |i: usize, j: usize| -> f64 {
                let half = &half[i * count..(i + 1) * count];
                half.iter().zip(&inverse[j]).map(|(a, b)| a * b).sum()
            };
            let pairs = (0..terms * terms).map(|i| (i / terms, i % terms));
            pairs.map(|(i, j)| 0.5 * (product(i, j) + product(j, i))).collect::<Vec<f64>>()
        };
        let [r, g, b] = [0, 1, 2].map(channel);
        let coefficients = (0..terms * terms).map(|i| [r[i], g[i], b[i]]).collect();
        Ok(Self { order, coefficients })
    }

    /// For a light and a view above horizontal, unit vectors.
    pub fn at(&self, light: DVec3, view: DVec3) -> [f64; 3] {
        let [of_light, of_view] = [light, view].map(|v| evaluate(self.order, v));
        let mut sum = [0.0; 3];
        for (i, a) in of_light.iter().enumerate() {
            for (j, b) in of_view.iter().enumerate() {
                let [r, g, blue] = self.coefficients[i * of_light.len() + j];
                let weight = a * b;
                sum = [sum[0] + weight * r, sum[1] + weight * g, sum[2] + weight * blue];
            }
        }
        sum
    }
}

/// (BᵀWB + r)⁻¹BᵀW by Gauss & Jordan with the largest pivots.
fn pseudo_inverse(rows: &[Vec<f64>], terms: usize, weights: &[f64]) -> Vec<Vec<f64>> {
    let mut left = vec![vec![0.0; terms]; terms];
    for (row, weight) in rows.iter().zip(weights) {
        for i in 0..terms {
            (0..terms).for_each(|j| left[i][j] += weight * row[i] * row[j]);
        }
    }
    let largest = (0..terms).map(|i| left[i][i]).fold(0.0, f64::max);
    (0..terms).for_each(|i| left[i][i] += 1e-6 * largest);
    let mut right: Vec<Vec<f64>> =
        (0..terms).map(|i| rows.iter().zip(weights).map(|(row, w)| w * row[i]).collect()).collect();
    for column in 0..terms {
        let pivot = (column..terms)
            .max_by(|a, b| left[*a][column].abs().total_cmp(&left[*b][column].abs()))
            .expect("a row");
        left.swap(column, pivot);
        right.swap(column, pivot);
        let scale = 1.0 / left[column][column];
        left[column].iter_mut().chain(&mut right[column]).for_each(|v| *v *= scale);
        let (from_left, from_right) = (left[column].clone(), right[column].clone());
        for row in (0..terms).filter(|row| *row != column) {
            let share = left[row][column];
            left[row].iter_mut().zip(&from_left).for_each(|(v, f)| *v -= share * f);
            right[row].iter_mut().zip(&from_right).for_each(|(v, f)| *v -= share * f);
        }
    }
    right
}

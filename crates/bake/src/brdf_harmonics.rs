//! A BRDF table as a double sum of spherical harmonics.

use glam::DVec3;

use super::{Angles, Brdf};
use ridgelight::basis::MAX_ORDER;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::{Error, Result};

/// f(l, v) ≈ Σ c_ij Y_i(l) Y_j(v), R, G, B. Real orthonormal harmonics about x east, y north, z up,
/// index l(l+1) + m. c is symmetric unless the surface has Phong specular.
///
/// It is smooth in both directions, where a table has steps. It resolves nothing finer than its
/// order, and ringing may make it negative. It is undefined below horizontal.
#[derive(Clone, Debug, PartialEq)]
pub struct BrdfHarmonics {
    order: usize,
    coefficients: Vec<[f64; 3]>,
}

/// Ridge relative to the largest diagonal element of BᵀWB. It bounds coefficients that the
/// hemisphere alone does not determine. Its error is at most half its root of their share in the
/// values.
const RIDGE: f64 = 1e-6;

impl BrdfHarmonics {
    /// Least-squares fit of order n to a table over `angles`.
    ///
    /// B holds the values of n² harmonics in all directions, W the parts of ∫ cos θ dω. With B⁺ =
    /// (BᵀWB + r)⁻¹BᵀW and F the table, C = B⁺ F B⁺ᵀ is the least-squares solution over all pairs,
    /// weighted by cos θ dω of both directions. Without Phong specular, (C + Cᵀ)/2 halves the Monte
    /// Carlo noise.
    ///
    /// # Errors
    /// An order outside [1..6]; fewer angles than harmonics; a table over other angles.
    pub fn of(table: &Brdf, angles: Angles, order: usize, has_specular: bool) -> Result<Self> {
        let (count, terms) = (angles.count(), order.saturating_mul(order));
        table.check_angles(angles)?;
        if !(1..=MAX_ORDER).contains(&order) {
            let expected = format!("a whole number from 1 to {MAX_ORDER}");
            return Err(Error::setting("order of harmonics", order.to_string(), expected));
        }
        if terms > count {
            let found = format!("{order}, {terms} harmonics for {count} angles");
            let expected = "no more harmonics than angles";
            return Err(Error::setting("order of harmonics", found, expected));
        }
        let rows: Vec<Vec<f64>> = table.directions().iter().map(|v| evaluate(order, *v)).collect();
        let inverse = pseudo_inverse(&rows, terms, &angles.projected_sr());
        let mut coefficients = vec![[0.0; 3]; terms * terms];
        for channel in [0, 1, 2] {
            // B⁺ F; the product with B⁺ᵀ follows.
            let mut half = vec![0.0; terms * count];
            for (row, half) in inverse.iter().zip(half.chunks_exact_mut(count)) {
                for (light, weight) in row.iter().enumerate() {
                    for (view, sum) in half.iter_mut().enumerate() {
                        *sum += weight * table.at(light, view)[channel];
                    }
                }
            }
            let product = |i: usize, j: usize| -> f64 {
                let half = &half[i * count..(i + 1) * count];
                half.iter().zip(&inverse[j]).map(|(a, b)| a * b).sum()
            };
            for (at, texel) in coefficients.iter_mut().enumerate() {
                let (i, j) = (at / terms, at % terms);
                let other = if has_specular { product(i, j) } else { product(j, i) };
                texel[channel] = 0.5 * (product(i, j) + other);
            }
        }
        Ok(Self { order, coefficients })
    }

    /// n² × n² colours; those of the light's first harmonic come first.
    pub fn coefficients(&self) -> &[[f64; 3]] {
        &self.coefficients
    }

    /// Value for unit vectors above horizontal; 1/sr.
    pub fn at(&self, light: DVec3, view: DVec3) -> [f64; 3] {
        weighted(self.under(light), &evaluate(self.order, view))
    }

    /// [`at`](Self::at) for each light in turn, towards all directions. Each direction's harmonics
    /// are evaluated once.
    pub fn rows(&self, directions: &[DVec3]) -> impl Iterator<Item = Vec<[f64; 3]>> {
        let all: Vec<Vec<f64>> = directions.iter().map(|v| evaluate(self.order, *v)).collect();
        directions.iter().map(move |light| {
            let under = self.under(*light);
            all.iter().map(|of_view| weighted(under.iter().copied(), of_view)).collect()
        })
    }

    /// Coefficients over the view for one light.
    fn under(&self, light: DVec3) -> Vec<[f64; 3]> {
        let of_light = evaluate(self.order, light);
        let mut sums = vec![[0.0; 3]; of_light.len()];
        for (row, a) in self.coefficients.chunks_exact(sums.len()).zip(of_light) {
            for (sum, texel) in sums.iter_mut().zip(row) {
                (0..3).for_each(|c| sum[c] += a * texel[c]);
            }
        }
        sums
    }
}

/// Weighted sum of colours.
pub(crate) fn weighted(colours: impl IntoIterator<Item = [f64; 3]>, weights: &[f64]) -> [f64; 3] {
    let mut sum = [0.0; 3];
    for (colour, weight) in colours.into_iter().zip(weights) {
        (0..3).for_each(|c| sum[c] += weight * colour[c]);
    }
    sum
}

/// (BᵀWB + r)⁻¹BᵀW by Gauss-Jordan elimination with partial pivoting.
fn pseudo_inverse(rows: &[Vec<f64>], terms: usize, weights: &[f64]) -> Vec<Vec<f64>> {
    let mut left = vec![vec![0.0; terms]; terms];
    for (row, weight) in rows.iter().zip(weights) {
        for i in 0..terms {
            (0..terms).for_each(|j| left[i][j] += weight * row[i] * row[j]);
        }
    }
    let largest = (0..terms).map(|i| left[i][i]).fold(0.0, f64::max);
    (0..terms).for_each(|i| left[i][i] += RIDGE * largest);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The fit recovers a sum of harmonics; with Phong specular one that is not reciprocal. For an
    /// eigenvalue s of BᵀWB the ridge removes the share r/(s + r) of the coefficients, and √s r/(s +
    /// r) ≤ √r/2 of the values, as a norm weighted by cos θ dω. At one direction of weight w that
    /// is at most √(r/w)/2 of the coefficients' length. It counts once for lights and once for
    /// views; the other side's harmonics have the length √(n²/4π) everywhere.
    #[test]
    fn fit_recovers_a_sum_of_harmonics() {
        let angles = Angles { zeniths: 8, azimuths: 16 };
        let directions = angles.directions().expect("angles").vectors().to_vec();
        let order = 3;
        let terms = order * order;
        for has_specular in [false, true] {
            let known: Vec<f64> = (0..terms * terms)
                .map(|at| {
                    let (i, j) = (at / terms, at % terms);
                    0.1 * ((i * j + i + (1 + usize::from(has_specular)) * j) as f64 * 0.618_034)
                        .fract()
                })
                .collect();
            let sum = |l: DVec3, v: DVec3| -> f64 {
                let [a, b] = [l, v].map(|e| evaluate(order, e));
                (0..terms * terms).map(|at| known[at] * a[at / terms] * b[at % terms]).sum()
            };
            let pairs = directions.iter().flat_map(|l| directions.iter().map(move |v| (*l, *v)));
            let values = pairs.map(|(l, v)| [sum(l, v), 0.0, 2.0 * sum(l, v)]).collect();
            let table = Brdf::from_values(directions.clone(), values).expect("a table");
            let found = BrdfHarmonics::of(&table, angles, order, has_specular).expect("harmonics");
            let weights = angles.projected_sr();
            let size = known.iter().map(|c| c * c).sum::<f64>().sqrt();
            // The largest diagonal element of BᵀWB is ∫ Y² cos θ dω ≤ max Y² π ≤ n²/4π · π.
            let root = (RIDGE * terms as f64 / 4.0).sqrt();
            let other = (terms as f64 / (2.0 * std::f64::consts::TAU)).sqrt();
            let rows = found.rows(&directions).collect::<Vec<_>>();
            for (i, l) in directions.iter().enumerate() {
                for (j, v) in directions.iter().enumerate() {
                    let (got, own) = (found.at(*l, *v), sum(*l, *v));
                    assert_eq!(rows[i][j], got, "{i} {j}");
                    let bound =
                        size * other * 0.5 * root * (weights[i].powf(-0.5) + weights[j].powf(-0.5));
                    assert!((got[0] - own).abs() <= bound, "{i} {j}: {} {own} {bound}", got[0]);
                    assert!(got[1].abs() < 1e-12 && (got[2] - 2.0 * got[0]).abs() < 1e-9);
                }
            }
            let most = directions.iter().map(|l| sum(*l, *l).abs()).fold(0.0, f64::max);
            assert!(most > 0.1, "{most}");
        }
    }

    #[test]
    fn invalid_orders_and_angles_are_refused() {
        let angles = Angles { zeniths: 2, azimuths: 4 };
        let directions = angles.directions().expect("angles").vectors().to_vec();
        let table = Brdf::from_values(directions, vec![[0.1; 3]; 64]).expect("a table");
        let of = |angles, order| BrdfHarmonics::of(&table, angles, order, false).map(|_| ());
        assert!(of(angles, 2).is_ok());
        for order in [0, 7, usize::MAX] {
            assert!(of(angles, order).unwrap_err().to_string().contains("1 to 6"), "{order}");
        }
        assert!(of(angles, 3).unwrap_err().to_string().contains("9 harmonics for 8 angles"));
        assert!(of(Angles { zeniths: 2, azimuths: 5 }, 2).is_err());
    }
}

//! A BRDF table as a short sum of products of two functions of one direction each.

use glam::DVec3;

use super::{Angles, Brdf};
use ridgelight::{Error, Result};

/// f(l, v) ≈ Σ g_k(l) h_k(v), each g_k and h_k over a grid of angles, R, G, B (separable
/// approximation: Kautz & McCool 1999).
///
/// For diffuse surfaces g_k = h_k. With w the parts of ∫ cos θ dω, the matrix √w_i f_ij √w_j is
/// symmetric by reciprocity. It has no negative eigenvalue: direct light is a sum over places of
/// the irradiance from l times the same for v, and indirect light is what these places exchange.
/// The largest eigenvalues λ_k and their vectors q_k give the least squares of f, weighted by cos θ
/// dω, with g_k = √λ_k q_k / √w.
///
/// With Phong specular the matrix is neither symmetric nor positive. The largest singular values
/// σ_k and their vectors a_k, b_k then give the least squares, with g_k = √σ_k a_k / √w and h_k =
/// √σ_k b_k / √w.
#[derive(Clone, Debug, PartialEq)]
pub struct Factors {
    angles: Angles,
    /// g of each k, all angles in order.
    values: Vec<Vec<[f64; 3]>>,
    /// h, where it differs from g.
    of_views: Option<Vec<Vec<[f64; 3]>>>,
}

/// Orthogonal iterations. Each improves the vectors by the quotient of two neighbouring
/// eigenvalues. Eigenvalues that are too close to separate give nearly the same squares.
const ITERATIONS: usize = 60;

impl Factors {
    /// The first `count` products for a table over `angles`. Without Phong specular the mean with
    /// light and view exchanged is used, which reduces Monte Carlo noise.
    ///
    /// # Errors
    /// A count of 0, or above that of the angles; a table over other angles.
    pub fn of(table: &Brdf, angles: Angles, count: usize, has_specular: bool) -> Result<Self> {
        let size = angles.count();
        table.check_angles(angles)?;
        if !(1..=size).contains(&count) {
            return Err(Error::setting("factors", count.to_string(), format!("1 to {size}")));
        }
        let roots: Vec<f64> = angles.projected_sr().iter().map(|w| w.sqrt()).collect();
        let mut values = vec![vec![[0.0; 3]; size]; count];
        let mut views = values.clone();
        for channel in [0, 1, 2] {
            let of = |i: usize| {
                let (a, b) = (i / size, i % size);
                let [own, other] = [(a, b), (b, a)].map(|(a, b)| table.at(a, b)[channel]);
                (if has_specular { own } else { 0.5 * (own + other) }) * roots[a] * roots[b]
            };
            let matrix: Vec<f64> = (0..size * size).map(of).collect();
            if !has_specular {
                let once = |v: &[f64]| times(&matrix, v);
                for (k, (value, vector)) in largest(&once, size, count).into_iter().enumerate() {
                    let scale = value.max(0.0).sqrt();
                    (0..size).for_each(|i| values[k][i][channel] = scale * vector[i] / roots[i]);
                }
                continue;
            }
            let turned: Vec<f64> =
                (0..size * size).map(|i| matrix[i % size * size + i / size]).collect();
            // Eigenvectors of MᵀM are b, its eigenvalues σ², and M b is σ a.
            let twice = |v: &[f64]| times(&turned, &times(&matrix, v));
            for (k, (square, vector)) in largest(&twice, size, count).into_iter().enumerate() {
                let scale = square.max(0.0).powf(0.25);
                let other = times(&matrix, &vector);
                let shrink = if scale > f64::MIN_POSITIVE { 1.0 / scale } else { 0.0 };
                for i in 0..size {
                    values[k][i][channel] = shrink * other[i] / roots[i];
                    views[k][i][channel] = scale * vector[i] / roots[i];
                }
            }
        }
        Ok(Self { angles, values, of_views: has_specular.then_some(views) })
    }

    /// g: one per product, R, G, B of all angles. Also h unless [`of_views`](Self::of_views) holds
    /// it.
    pub fn values(&self) -> &[Vec<[f64; 3]>] {
        &self.values
    }

    /// h, where it differs from g.
    pub fn of_views(&self) -> Option<&[Vec<[f64; 3]>]> {
        self.of_views.as_deref()
    }

    /// Value of each light in turn, towards all angles; 1/sr.
    pub fn rows(&self) -> impl Iterator<Item = Vec<[f64; 3]>> {
        let of_views = self.of_views.as_ref().unwrap_or(&self.values);
        let at = move |light: usize, view: usize, c: usize| -> f64 {
            self.values.iter().zip(of_views).map(|(g, h)| g[light][c] * h[view][c]).sum()
        };
        let count = self.angles.count();
        (0..count).map(move |l| (0..count).map(|v| [0, 1, 2].map(|c| at(l, v, c))).collect())
    }

    /// Value for unit vectors above horizontal, each factor interpolated between its angles.
    pub fn at(&self, light: DVec3, view: DVec3) -> [f64; 3] {
        let [light, view] = [light, view].map(|e| self.angles.around(e));
        let mut sum = [0.0; 3];
        let of_views = self.of_views.as_ref().unwrap_or(&self.values);
        for (of_light, of_view) in self.values.iter().zip(of_views) {
            let at = |of: &[[f64; 3]], around: &[(usize, f64); 4], c: usize| -> f64 {
                around.iter().map(|(i, share)| share * of[*i][c]).sum()
            };
            (0..3).for_each(|c| sum[c] += at(of_light, &light, c) * at(of_view, &view, c));
        }
        sum
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A square matrix, row by row, times a vector.
fn times(matrix: &[f64], v: &[f64]) -> Vec<f64> {
    matrix.chunks_exact(v.len()).map(|row| dot(row, v)).collect()
}

/// The largest eigenvalues of a symmetric linear map, and their unit vectors, by orthogonal
/// iteration from fixed starting vectors.
fn largest(times: &dyn Fn(&[f64]) -> Vec<f64>, size: usize, count: usize) -> Vec<(f64, Vec<f64>)> {
    // Fractions of multiples of an irrational number: practically never orthogonal to an
    // eigenvector.
    let begin =
        |k: usize| (0..size).map(move |i| ((k * size + i + 1) as f64 * 0.618_034).fract() - 0.5);
    let mut vectors: Vec<Vec<f64>> = (0..count).map(|k| begin(k).collect()).collect();
    for iteration in 0..=ITERATIONS {
        if iteration > 0 {
            vectors = vectors.iter().map(|v| times(v)).collect();
        }
        for k in 0..count {
            let (before, rest) = vectors.split_at_mut(k);
            // Twice: the remainder of the first pass may be mostly rounding.
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

    /// 2 a aᵀ + b bᵀ for two orthogonal unit vectors: their eigenvalues, and 0 for the third.
    #[test]
    fn iteration_finds_eigenvectors() {
        let (a, b) = ([0.6, 0.8, 0.0], [-0.8, 0.6, 0.0]);
        let matrix: Vec<f64> =
            (0..9).map(|i| 2.0 * a[i / 3] * a[i % 3] + b[i / 3] * b[i % 3]).collect();
        let found = largest(&|v| times(&matrix, v), 3, 3);
        for ((value, vector), (known, axis)) in found.iter().zip([(2.0, a), (1.0, b)]) {
            let along: f64 = vector.iter().zip(axis).map(|(v, a)| v * a).sum();
            assert!((value - known).abs() < 1e-9 && (along.abs() - 1.0).abs() < 1e-9, "{value}");
        }
        assert!(found[2].0.abs() < 1e-9);
    }

    /// A product of two different functions, one of them negative somewhere, needs one product of
    /// two functions, and no product of one function with itself fits it. A sum of two squares,
    /// symmetric and without a negative eigenvalue like diffuse ground, needs two products.
    #[test]
    fn different_sides_need_two_functions() {
        let angles = Angles { zeniths: 2, azimuths: 4 };
        let directions = angles.directions().unwrap().vectors().to_vec();
        let (g, h) = (|e: &DVec3| 2.0 + e.x, |e: &DVec3| e.z - e.y - 0.5);
        let values = directions.iter().flat_map(|l| directions.iter().map(move |v| (l, v)));
        let values = values.map(|(l, v)| [g(l) * h(v), 1.0, 0.0]).collect();
        let table = Brdf::from_values(directions.clone(), values).unwrap();
        let factors = Factors::of(&table, angles, 1, true).unwrap();
        assert!(factors.of_views().is_some());
        let off = |factors: &Factors| {
            let pairs = directions.iter().flat_map(|l| directions.iter().map(move |v| (l, v)));
            let off = pairs.map(|(l, v)| {
                let found = factors.at(*l, *v);
                (found[0] - g(l) * h(v)).abs() + (found[1] - 1.0).abs() + found[2].abs()
            });
            off.fold(0.0, f64::max)
        };
        assert!(off(&factors) < 1e-9, "{}", off(&factors));
        let alike = Factors::of(&table, angles, 1, false).unwrap();
        assert!(alike.of_views().is_none() && off(&alike) > 0.1, "no contrast: {}", off(&alike));
        let squares = |l: &DVec3, v: &DVec3| g(l) * g(v) + h(l) * h(v);
        let values = directions.iter().flat_map(|l| directions.iter().map(move |v| (l, v)));
        let values = values.map(|(l, v)| [0.0, squares(l, v), 1.0]).collect();
        let table = Brdf::from_values(directions.clone(), values).unwrap();
        let factors = Factors::of(&table, angles, 2, false).unwrap();
        let rows = factors.rows().collect::<Vec<_>>();
        for (i, j) in (0..64).map(|i| (i / 8, i % 8)) {
            let (l, v) = (&directions[i], &directions[j]);
            for (found, known) in rows[i][j].into_iter().zip([0.0, squares(l, v), 1.0]) {
                assert!((found - known).abs() < 1e-9, "{i} {j}: {found} {known}");
            }
            let between = factors.at(*l, *v);
            assert!((0..3).all(|c| (rows[i][j][c] - between[c]).abs() < 1e-9), "{between:?}");
        }
    }
}

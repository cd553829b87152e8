//! What a field is seen from afar: a BRDF of its own, as the mean of what its visible samples reflect (Heidrich et al.
//! 2000, §6, after Cabral et al. 1987).

use glam::DVec3;

use crate::basis::MAX_ORDER;
use crate::basis::harmonics::evaluate;
use crate::cpu::scatter_gather::Samples;
use crate::scene::{Scene, VisiblePoint, VisiblePoints};
use crate::{Error, Result};
use std::f64::consts::PI;

/// How bright the mean of a field's visible samples is for a light from one direction seen from another: a square table
/// over the same directions for both, R, G, B, 1/sr.
#[derive(Clone, Debug, PartialEq)]
pub struct Facets {
    directions: Vec<DVec3>,
    values: Vec<[f64; 3]>,
}

/// What samples show of themselves in each direction of a set above horizontal, all directions of one field.
pub struct Shown<'a> {
    samples: Samples<'a>,
    points: &'a VisiblePoints,
    count: usize,
}

impl<'a> Shown<'a> {
    /// Of the directions of `points`, which must lie above horizontal: what sees the sky is seen from there.
    ///
    /// # Errors
    /// Points of another field, or a direction at or below horizontal.
    pub fn of(scene: &'a Scene, points: &'a VisiblePoints) -> Result<Self> {
        points.check(&scene.field, scene.surface.border)?;
        let vectors = points.directions().vectors();
        if let Some(i) = vectors.iter().position(|v| v.z <= 0.0) {
            let found = format!("{}", vectors[i]);
            return Err(Error::setting(format!("direction {i}"), found, "one above horizontal"));
        }
        let count = scene.field.rows() * scene.field.cols();
        Ok(Self { samples: Samples::of(scene), points, count })
    }

    /// How much of the view from direction `view` a sample fills, over a sample's own cell: its slope's area, foreshortened,
    /// where nothing hides it.
    pub fn share(&self, view: usize, sample: usize) -> f64 {
        let normal = self.samples.normal(sample);
        let towards = normal.dot(self.points.directions().vectors()[view]).max(0.0);
        let is_seen = self.points.seen(view, sample) == VisiblePoint::Sky;
        if is_seen { towards / normal.z } else { 0.0 }
    }

    /// Exit radiance of what is diffuse under a light of irradiance 1 facing it from direction `light`.
    pub fn lit_from(&self, light: usize) -> Vec<[f64; 3]> {
        let e = self.points.directions().vectors()[light];
        let of = |at: usize| {
            let cosine = self.samples.normal(at).dot(e).max(0.0);
            let is_lit = self.points.seen(light, at) == VisiblePoint::Sky;
            let lit = if is_lit { cosine / PI } else { 0.0 };
            self.samples.albedo(at).map(|albedo| albedo * lit)
        };
        (0..self.count).map(of).collect()
    }

    /// What a cell fills of the view from a direction, in the mean, over a cell seen from above: cos θ where the field repeats,
    /// but for its shape between samples.
    pub fn mean_share(&self, view: usize) -> f64 {
        (0..self.count).map(|at| self.share(view, at)).sum::<f64>() / self.count as f64
    }

    /// The mean of radiances over what is seen from direction `view`, each by its share of it; 0 where nothing is.
    pub fn mean_from(&self, view: usize, radiance: &[[f64; 3]]) -> [f64; 3] {
        let (mut sum, mut whole) = ([0.0; 3], 0.0);
        for (at, light) in radiance.iter().enumerate() {
            let share = self.share(view, at);
            (0..3).for_each(|c| sum[c] += share * light[c]);
            whole += share;
        }
        if whole > 0.0 { sum.map(|s| s / whole) } else { sum }
    }
}

impl Facets {
    /// Of all pairs of the directions of `shown`: `radiance` is that of all samples under a light of irradiance 1 facing it
    /// from each direction, all its bounces included.
    ///
    /// What arrives is counted as what is seen is, by [`Shown::mean_share`], not by cos θ: near horizontal, where samples and
    /// cells differ, light and view are thereby treated alike, and the table stays reciprocal.
    ///
    /// # Errors
    /// A direction that shows no sample, for which nothing can be told; the first error of `radiance`.
    pub fn of(
        shown: &Shown,
        mut radiance: impl FnMut(usize) -> Result<Vec<[f64; 3]>>,
    ) -> Result<Self> {
        let directions = shown.points.directions().vectors().to_vec();
        let irradiances: Vec<f64> = (0..directions.len()).map(|i| shown.mean_share(i)).collect();
        if let Some(i) = irradiances.iter().position(|share| *share <= 0.0) {
            let expected = "one from which some sample that faces it is seen";
            return Err(Error::setting(
                format!("direction {i}"),
                directions[i].to_string(),
                expected,
            ));
        }
        let mut values = Vec::new();
        for (light, irradiance) in irradiances.into_iter().enumerate() {
            let leaving = radiance(light)?;
            values.extend(
                (0..directions.len())
                    .map(|view| shown.mean_from(view, &leaving).map(|m| m / irradiance)),
            );
        }
        Ok(Self { directions, values })
    }

    /// Those of lights and views alike.
    pub fn directions(&self) -> &[DVec3] {
        &self.directions
    }

    /// For a light and a view, by their numbers.
    ///
    /// # Panics
    /// Outside the table.
    pub fn at(&self, light: usize, view: usize) -> [f64; 3] {
        self.values[light * self.directions.len() + view]
    }

    /// Share of a light's irradiance that leaves again, R, G, B: the sum over all views of the table times cos θ, each view
    /// for the same solid angle of the hemisphere. What is left out by a set of directions is as much as it misses of ∫ cos.
    ///
    /// Near horizontal samples may fill less of a view than cos θ: by so much it may be above the albedo. Weighted by
    /// [`Shown::mean_share`] in the place of cos θ it is not.
    pub fn reflected(&self, light: usize) -> [f64; 3] {
        let cosines: f64 = self.directions.iter().map(|v| v.z).sum();
        let mut sum = [0.0; 3];
        for (view, v) in self.directions.iter().enumerate() {
            let value = self.at(light, view);
            (0..3).for_each(|c| sum[c] += value[c] * v.z / cosines * PI);
        }
        sum
    }

    /// How far it is from being the same with light and view exchanged: rms of half the difference over the rms, all
    /// channels.
    pub fn unreciprocal(&self) -> f64 {
        let (mut apart, mut all) = (0.0, 0.0);
        let count = self.directions.len();
        for (light, view) in (0..count * count).map(|i| (i / count, i % count)) {
            for (a, b) in self.at(light, view).into_iter().zip(self.at(view, light)) {
                apart += 0.25 * (a - b).powi(2);
                all += a * a;
            }
        }
        (apart / f64::max(all, f64::MIN_POSITIVE)).sqrt()
    }
}

/// A BRDF as the sum over two sets of spherical harmonics, Σ c_ij Y_i(light) Y_j(view), symmetric.
#[derive(Clone, Debug, PartialEq)]
pub struct FacetHarmonics {
    /// Bands of either set.
    pub order: usize,
    /// n² × n² colours, i first.
    pub coefficients: Vec<[f64; 3]>,
    /// Rms of what is left over the rms, all pairs and channels of the table that it was made of.
    pub residual: f64,
}

impl FacetHarmonics {
    /// Of a table, by least squares over its directions, which span harmonics on the hemisphere alone: no value below
    /// horizontal means anything.
    ///
    /// With B the values of the harmonics in the directions and B⁺ = (BᵀB + r)⁻¹Bᵀ, C = B⁺ F B⁺ᵀ minimises the squares over
    /// all pairs; r, a millionth of the largest diagonal, keeps what the hemisphere cannot tell apart near 0. C + Cᵀ halves what
    /// is not reciprocal.
    ///
    /// # Errors
    /// An order outside of [1..6]; fewer directions than harmonics.
    pub fn of(table: &Facets, order: usize) -> Result<Self> {
        if !(1..=MAX_ORDER).contains(&order) {
            let expected = format!("a whole number from 1 to {MAX_ORDER}");
            return Err(Error::setting("order", order.to_string(), expected));
        }
        let count = table.directions.len();
        let terms = order * order;
        if terms > count {
            let found = format!("{terms} harmonics for {count} directions");
            return Err(Error::setting("order", found, "no more harmonics than directions"));
        }
        let rows: Vec<Vec<f64>> = table.directions.iter().map(|v| evaluate(order, *v)).collect();
        let inverse = pseudo_inverse(&rows, terms);
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
        let mut of = Self { order, coefficients, residual: 0.0 };
        let (mut left, mut all) = (0.0, 0.0);
        for light in 0..count {
            for view in 0..count {
                let found = of.at(table.directions[light], table.directions[view]);
                for (a, b) in table.at(light, view).into_iter().zip(found) {
                    left += (a - b).powi(2);
                    all += a * a;
                }
            }
        }
        of.residual = (left / f64::max(all, f64::MIN_POSITIVE)).sqrt();
        Ok(of)
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

/// (BᵀB + r)⁻¹Bᵀ by Gauss & Jordan with the largest pivots.
fn pseudo_inverse(rows: &[Vec<f64>], terms: usize) -> Vec<Vec<f64>> {
    let mut left = vec![vec![0.0; terms]; terms];
    for row in rows {
        for i in 0..terms {
            (0..terms).for_each(|j| left[i][j] += row[i] * row[j]);
        }
    }
    let largest = (0..terms).map(|i| left[i][i]).fold(0.0, f64::max);
    (0..terms).for_each(|i| left[i][i] += 1e-6 * largest);
    let mut right: Vec<Vec<f64>> =
        (0..terms).map(|i| rows.iter().map(|row| row[i]).collect()).collect();
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

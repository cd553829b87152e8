//! Light by spherical harmonics in f64 from given horizons, and the tolerance of a device against it: the f32 error
//! at any order, environment and field. The truncation error of the harmonics is in neither.

use crate::basis::receiver;
use crate::env_rotation::env_rotation;
use crate::light_matrix::{add_sky, is_fitted, light_matrix, row_weights, series, specular_matrix};
use crate::sh_shade::{light_on, specular_on};
use crate::sh_visibility::{Series, visibility_above};
use crate::sh_wedges::sh_wedges;
use crate::tolerance::{
    ShadeError, device_light_matrix, device_sh_shade, device_sh_specular, device_turn,
};
use glam::DVec3;
use ridgelight::basis::bands;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::wedge::WedgeTable;
use ridgelight::basis::zonal::phong_bands;
use ridgelight::plan::Azimuth;
use ridgelight::plan::lowest_rad;
use ridgelight::scene::{Border, Environment, PhongSpecular, Quality, Wedges};
use std::f64::consts::TAU;

/// Visibility of a grid point: coefficients, and a device's error in each.
#[derive(Clone, Debug, PartialEq)]
pub struct Visibility {
    /// n² of them.
    pub values: Vec<f64>,
    /// As many.
    pub errors: Vec<f64>,
}

impl Visibility {
    /// Visibility of a grid point from that of nodes, each with its weight.
    pub fn between<'a>(nodes: impl Iterator<Item = (&'a Self, f64)>, error: &ShadeError) -> Self {
        let counted = error.node_weight();
        let mut sum = Self { values: Vec::new(), errors: Vec::new() };
        for (node, weight) in nodes {
            sum.values.resize(node.values.len(), 0.0);
            sum.errors.resize(node.values.len(), 0.0);
            for (k, value) in node.values.iter().enumerate() {
                sum.values[k] += weight * value;
                sum.errors[k] += weight * (node.errors[k] + counted * value.abs());
            }
        }
        sum
    }
}

/// An environment by spherical harmonics, in f64.
#[derive(Clone, Debug)]
pub struct Harmonics {
    series: Series,
    table: Option<WedgeTable>,
    /// `[row of the receiver][coefficient]`, and a device's error in each.
    matrix: Vec<Vec<DVec3>>,
    errors: Vec<Vec<DVec3>>,
}

impl Harmonics {
    /// The light's matrix of a quality; `specular`: for Phong specular, from all bands of visibility, of an environment
    /// and a sky of this radiance.
    pub fn of(
        environment: Option<&Environment>,
        specular: Option<[f32; 3]>,
        border: Border,
        quality: &Quality,
    ) -> Self {
        let order = quality.sh_order as usize;
        let light_order = if specular.is_some() { order } else { quality.light_order() };
        let (height, fitted) =
            (environment.map_or(1, Environment::height), is_fitted(quality, border));
        let rows = environment.map_or(0, |_| if fitted { height.div_ceil(2) } else { height });
        let turns = environment.map_or(Vec::new(), |e| env_rotation(e, rows, light_order));
        let mut light = series(&turns, height, light_order, fitted);
        let matrix = match specular {
            None => light_matrix(quality, &light),
            Some(sky) => {
                add_sky(&mut light, sky);
                specular_matrix(quality, &light)
            }
        };
        let turned = |environment: &Environment| -> Vec<Vec<DVec3>> {
            let width = environment.width();
            let of_row = |row: usize| {
                let texels = environment.texels()[row * width..].iter().take(width);
                let sum: DVec3 = texels.map(|l| DVec3::from_array(l.map(f64::from))).sum();
                vec![device_turn(width) * sum / width as f64; 2 * light_order - 1]
            };
            (0..rows).map(of_row).collect()
        };
        let turned = environment.map_or(Vec::new(), turned);
        let summed = matrix_magnitudes(quality, border, height, &turns, specular);
        let turned =
            matrix_magnitudes(quality, border, height, &turned, specular.map(|_| [0.0; 3]));
        let rounded = device_light_matrix(height);
        let entry = |(s, t): (&DVec3, &DVec3)| rounded * *s + *t;
        let row = |(s, t): (&Vec<DVec3>, &Vec<DVec3>)| s.iter().zip(t).map(entry).collect();
        let series = Series { order, wedges: quality.wedges, receiver: quality.receiver };
        let [side, azimuths] = [quality.wedge_side, quality.azimuths].map(|n| n as usize);
        let table = (quality.wedges == Wedges::Table)
            .then(|| WedgeTable::new(order, side, lowest_rad(border), TAU / azimuths as f64));
        Self { table, series, matrix, errors: summed.iter().zip(&turned).map(row).collect() }
    }

    /// Visibility above slopes with these errors, each that of the lowest visible direction: above the horizon, and
    /// for [`Receiver::Plane`](ridgelight::scene::Receiver::Plane) above the grid point's own plane.
    pub fn visibility(&self, lowest: &[(Azimuth, f64)], error: &ShadeError) -> Visibility {
        let Series { order, wedges, .. } = self.series;
        let of_band: Vec<f64> = (0..order).map(|l| error.series(l, wedges)).collect();
        let errors = bands(order).map(|(l, _)| of_band[l]).collect();
        let values = match &self.table {
            Some(table) => sh_wedges(table, lowest),
            None => visibility_above(self.series, lowest),
        };
        Visibility { values, errors }
    }

    /// Errors of all products, and their magnitudes: each row's with its share of either.
    fn sums(&self, of: &Visibility, shares: impl Iterator<Item = [f64; 2]>) -> [DVec3; 2] {
        let (mut off, mut summed) = (DVec3::ZERO, DVec3::ZERO);
        for ((share, row), errors) in shares.zip(&self.matrix).zip(&self.errors) {
            for (k, (entry, error)) in row.iter().zip(errors).enumerate() {
                let (value, error_of) = (of.values[k].abs(), of.errors[k]);
                off += share[0] * (entry.abs() * error_of + *error * (value + error_of));
                summed += share[1] * entry.abs() * value;
            }
        }
        [off, summed]
    }

    /// Exit radiance of albedo 1, clamped at 0 where harmonics ring, and a device's error in it.
    pub fn light(&self, normal: DVec3, visibility: &Visibility, error: &ShadeError) -> [DVec3; 2] {
        let all = receiver(normal.to_array());
        let rows = if self.matrix.len() == 3 { &all[1..4] } else { &all[..self.matrix.len()] };
        let [off, summed] = self.sums(visibility, rows.iter().map(|row| [row.abs(), 1.0]));
        let tolerance = off + device_sh_shade(self.series.order, error.normal()) * summed;
        let light = light_on(normal, &visibility.values, &self.matrix);
        [light.max(DVec3::ZERO), tolerance]
    }

    /// Phong specular straight upwards, from the matrix [of Phong specular](Self::of), and a device's error in it.
    pub fn mirrored(
        &self,
        normal: DVec3,
        phong: PhongSpecular,
        visibility: &Visibility,
        error: &ShadeError,
    ) -> [DVec3; 2] {
        let order = self.series.order;
        let mirrored = evaluate(order, 2.0 * normal.z * normal - DVec3::Z);
        let kept = phong_bands(order, phong.exponent.into());
        let rows = bands(order).zip(&mirrored).map(|((l, _), y)| [(kept[l] * y).abs(), kept[l]]);
        let [off, summed] = self.sums(visibility, rows);
        let tolerance = off + device_sh_specular(order, error.normal()) * summed;
        let light = specular_on((normal, DVec3::Z), phong, &visibility.values, &self.matrix);
        [light.max(DVec3::ZERO), f64::from(phong.scale) * tolerance]
    }
}

/// Entries of the light's matrix, from sums of an environment's rows (none: no environment), with the magnitudes of
/// all summed products. `specular`: for incident light of the Phong specular, including a sky.
pub fn matrix_magnitudes(
    quality: &Quality,
    border: Border,
    height: usize,
    turns: &[Vec<DVec3>],
    specular: Option<[f32; 3]>,
) -> Vec<Vec<DVec3>> {
    let order = quality.sh_order as usize;
    let light_order = turns.first().map_or(order, |row| row.len().div_ceil(2));
    let fitted = is_fitted(quality, border);
    let weights = row_weights((height, turns.len()), light_order, fitted);
    let mut all: Vec<Vec<DVec3>> = Vec::new();
    for (i, ((_, m), weights)) in bands(light_order).zip(weights).enumerate() {
        let turn = (light_order - 1).wrapping_add_signed(m);
        let mut sum = [weights.iter().zip(turns).map(|(w, t)| w.abs() * t[turn].abs()).sum()];
        if let Some(sky) = specular.filter(|_| i == 0) {
            add_sky(&mut sum, sky);
        }
        // Light with 1 in this coefficient alone.
        let mut unit = vec![DVec3::ZERO; light_order * light_order];
        unit[i] = DVec3::ONE;
        let shares = match specular {
            None => light_matrix(quality, &unit),
            Some(_) => specular_matrix(quality, &unit),
        };
        all.resize(shares.len(), vec![DVec3::ZERO; shares[0].len()]);
        for (row, shares) in all.iter_mut().zip(&shares) {
            row.iter_mut().zip(shares).for_each(|(entry, s)| *entry += s.abs() * sum[0]);
        }
    }
    all
}

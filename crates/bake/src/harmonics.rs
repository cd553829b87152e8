//! What is free, and what a diffuse surface makes of light from there, as spherical harmonics.

use glam::DVec3;
use std::f64::consts::PI;

use super::{Ray, Sum};
use ridgelight::basis::azimuth::around;
use ridgelight::basis::product::{orders, triples};
use ridgelight::basis::slice::{Slices, slice_index};
use ridgelight::basis::{MAX_ORDER, bands};

/// The highest order of a transfer: the cosine takes one band more of what is free.
pub const MAX_TRANSFER_ORDER: usize = MAX_ORDER - 1;

/// Sums of slices of an order: what is free above elevations, times weights of azimuths.
struct Series {
    slices: Slices,
    /// Of each coefficient: its place in a slice, and its weight among an azimuth's.
    places: Vec<[usize; 2]>,
}

impl Series {
    fn new(order: usize) -> Self {
        let place = |(l, m): (usize, isize)| {
            [slice_index(l, m.unsigned_abs()), (order - 1).wrapping_add_signed(m)]
        };
        Self { slices: Slices::new(order), places: bands(order).map(place).collect() }
    }

    fn turn(&self, ray: Ray) -> Vec<f64> {
        let weights = around(self.slices.order(), ray.azimuth_rad);
        weights.iter().map(|w| w * ray.width_rad).collect()
    }

    fn add(&self, turn: &[f64], elevation_rad: f64, sums: &mut [f64]) {
        let mut slice = [0.0; MAX_ORDER * (MAX_ORDER + 1) / 2];
        self.slices.above_into(elevation_rad, &mut slice);
        for (sum, [part, at]) in sums.iter_mut().zip(&self.places) {
            *sum += turn[*at] * slice[*part];
        }
    }
}

/// Visibility as n² coefficients v_i = ∫ V Y_i de: V is 1 above the horizon, 0 below; the normal has no part in it.
///
/// Real orthonormal harmonics without the sign of Condon and Shortley, index l(l+1) + m, about the world's axes (x
/// east, y north, z up). Σ v_i f_i is the integral of a function f of that order over all that is free.
pub struct ShVisibility(Series);

impl ShVisibility {
    /// n² coefficients, n of 1 to [`MAX_ORDER`].
    ///
    /// # Panics
    /// Outside that.
    pub fn new(order: usize) -> Self {
        Self(Series::new(order))
    }
}

impl Sum for ShVisibility {
    fn sums(&self) -> usize {
        self.0.places.len()
    }

    fn values(&self) -> usize {
        self.0.places.len()
    }

    fn turn(&self, ray: Ray) -> Vec<f64> {
        self.0.turn(ray)
    }

    fn add(&self, turn: &[f64], _: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        self.0.add(turn, elevation_rad, sums);
    }

    fn end(&self, _: DVec3, sums: &[f64], values: &mut [f64]) {
        values.copy_from_slice(sums);
    }
}

/// Diffuse transfer as n² coefficients t_i = 1/π ∫ V max(N·e, 0) Y_i de, in the basis of [`ShVisibility`].
///
/// Σ t_i L_i is the exit radiance that light L of that order gives to a surface of albedo 1 by direct light, shadows
/// and cosine in it (Sloan, Kautz & Snyder 2002, without interreflection). Exact but for the azimuths: what is free
/// above the horizon *and* the normal's own plane is summed to one band more, of which N·e, a function of band 1, takes
/// all that there is.
pub struct ShTransfer {
    free: Series,
    count: usize,
    /// Coefficient of the transfer, component of the normal (0 x, 1 y, 2 z), coefficient of what is free, factor.
    products: Vec<(usize, usize, usize, f64)>,
}

impl ShTransfer {
    /// n² coefficients, n of 1 to [`MAX_TRANSFER_ORDER`].
    ///
    /// # Panics
    /// Outside that.
    pub fn new(order: usize) -> Self {
        let count = order * order;
        // N·e = √(4π/3) (N_y Y_1-1 + N_z Y_10 + N_x Y_11), at places 1, 2 and 3.
        let scale = (4.0 * PI / 3.0).sqrt() / PI;
        let component = [1, 2, 0];
        let mut products = Vec::new();
        for triple in triples(order + 1) {
            for [band, i, j] in orders(triple.places) {
                if (1..=3).contains(&band) && i < count {
                    products.push((i, component[band - 1], j, scale * triple.value));
                }
            }
        }
        Self { free: Series::new(order + 1), count, products }
    }
}

impl Sum for ShTransfer {
    fn sums(&self) -> usize {
        self.free.places.len()
    }

    fn values(&self) -> usize {
        self.count
    }

    fn turn(&self, ray: Ray) -> Vec<f64> {
        let (sin, cos) = ray.azimuth_rad.sin_cos();
        let mut turn = self.free.turn(ray);
        turn.extend([cos, sin]);
        turn
    }

    fn add(&self, turn: &[f64], normal: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        let (weights, direction) = turn.split_at(turn.len() - 2);
        let along = normal.x * direction[0] + normal.y * direction[1];
        self.free.add(weights, elevation_rad.max((-along).atan2(normal.z)), sums);
    }

    fn end(&self, normal: DVec3, sums: &[f64], values: &mut [f64]) {
        values.fill(0.0);
        let normal = normal.to_array();
        for (i, component, j, factor) in &self.products {
            values[*i] += factor * normal[*component] * sums[*j];
        }
    }
}

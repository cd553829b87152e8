//! Visibility and diffuse transfer as spherical harmonics.

use glam::DVec3;
use std::f64::consts::PI;

use super::{HorizonMap, Ray};
use ridgelight::basis::azimuth::around;
use ridgelight::basis::product::{orders, triples};
use ridgelight::basis::slice::{Slices, slice_index};
use ridgelight::basis::{MAX_ORDER, bands};

/// The highest order of a transfer: the cosine needs one more band of the visibility.
pub const MAX_TRANSFER_ORDER: usize = MAX_ORDER - 1;

/// SH coefficients of the unoccluded slices, summed over azimuths.
struct Series {
    slices: Slices,
    /// For each coefficient: its index in a slice, and its azimuth weight's index.
    places: Vec<[usize; 2]>,
}

impl Series {
    fn new(order: usize) -> Self {
        let place = |(l, m): (usize, isize)| {
            [slice_index(l, m.unsigned_abs()), (order - 1).wrapping_add_signed(m)]
        };
        Self { slices: Slices::new(order), places: bands(order).map(place).collect() }
    }

    fn azimuth_factors(&self, ray: Ray) -> Vec<f64> {
        let weights = around(self.slices.order(), ray.azimuth_rad);
        weights.iter().map(|w| w * ray.width_rad).collect()
    }

    fn add(&self, factors: &[f64], elevation_rad: f64, sums: &mut [f64]) {
        let slice = self.slices.above(elevation_rad);
        for (sum, [part, at]) in sums.iter_mut().zip(&self.places) {
            *sum += factors[*at] * slice[*part];
        }
    }
}

/// Visibility as n² coefficients v_i = ∫ V Y_i de: V is 1 above the horizon, 0 below; the surface
/// normal is ignored.
///
/// Real orthonormal harmonics without the Condon-Shortley phase, index l(l+1) + m, about the
/// world's axes (x east, y north, z up). Σ v_i f_i is the integral of a function f of that order
/// over the unoccluded directions.
pub struct ShVisibility(Series);

impl ShVisibility {
    /// n² coefficients, n from 1 to [`MAX_ORDER`].
    ///
    /// # Panics
    /// Another order.
    pub fn new(order: usize) -> Self {
        Self(Series::new(order))
    }
}

impl HorizonMap for ShVisibility {
    fn sums(&self) -> usize {
        self.0.places.len()
    }

    fn azimuth_factors(&self, ray: Ray) -> Vec<f64> {
        self.0.azimuth_factors(ray)
    }

    fn add(&self, factors: &[f64], _: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        self.0.add(factors, elevation_rad, sums);
    }
}

/// Diffuse transfer as n² coefficients t_i = 1/π ∫ V max(N·e, 0) Y_i de, in the basis of [`ShVisibility`].
///
/// Σ t_i L_i is the exit radiance of a surface of albedo 1 under direct light L of that order, with
/// shadows and cosine (Sloan, Kautz & Snyder 2002, without interreflection). It is exact but for
/// the number of azimuths: visibility above the horizon *and* the tangent plane is summed to one
/// more band, which the product with N·e (band 1) needs.
pub struct ShTransfer {
    free: Series,
    count: usize,
    /// Index of the transfer coefficient, component of the normal (0 x, 1 y, 2 z), index of the
    /// visibility coefficient, factor.
    products: Vec<(usize, usize, usize, f64)>,
}

impl ShTransfer {
    /// n² coefficients, n from 1 to [`MAX_TRANSFER_ORDER`].
    ///
    /// # Panics
    /// Another order.
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

impl HorizonMap for ShTransfer {
    fn sums(&self) -> usize {
        self.free.places.len()
    }

    fn values(&self) -> usize {
        self.count
    }

    fn azimuth_factors(&self, ray: Ray) -> Vec<f64> {
        let (sin, cos) = ray.azimuth_rad.sin_cos();
        let mut factors = self.free.azimuth_factors(ray);
        factors.extend([cos, sin]);
        factors
    }

    fn add(&self, factors: &[f64], normal: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        let (weights, direction) = factors.split_at(factors.len() - 2);
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

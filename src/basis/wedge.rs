//! Spherical harmonics of one visible wedge, and their table (Snyder & Nowrouzezahrai 2008, as described in the thesis,
//! §4.2.1, §4.3.1 and §5.1).

use std::f64::consts::FRAC_PI_2;

use super::azimuth::around;
use super::bands;
use super::quadrature::points;
use super::slice::{Slices, slice_index};

/// Y_lm of the part of azimuths 0 to `width_rad` above a horizon that rises linearly, as an angle, from `horizon_rad[0]` to
/// `horizon_rad[1]`; each in [-π/2..π/2] (thesis eq. 4.17, 4.18).
pub fn wedge(slices: &Slices, horizon_rad: [f64; 2], width_rad: f64) -> Vec<f64> {
    let order = slices.order();
    let [first, last] = horizon_rad;
    let mut sums = vec![0.0; order * order];
    for (t, weight) in points(0.0, 1.0) {
        let turns = around(order, t * width_rad);
        let slice = slices.above(first + t * (last - first));
        for (sum, (l, m)) in sums.iter_mut().zip(bands(order)) {
            let turn = turns[(order - 1).wrapping_add_signed(m)];
            *sum += weight * width_rad * turn * slice[slice_index(l, m.unsigned_abs())];
        }
    }
    sums
}

/// [`wedge`] on a square grid of horizons, with bilinear interpolation.
#[derive(Clone, Debug, PartialEq)]
pub struct WedgeTable {
    /// Horizons along either side, evenly from `lowest_rad` to the zenith: 2 or more.
    pub side: usize,
    /// The lowest horizon: 0 for the sky, -π/2 for local lights.
    pub lowest_rad: f64,
    /// Width of the wedges, 2π over the number of azimuths.
    pub width_rad: f64,
    /// n² coefficients of each texel, `[first horizon][last horizon]`.
    pub texels: Vec<Vec<f64>>,
}

impl WedgeTable {
    /// The table of an order.
    ///
    /// # Panics
    /// When `side` is below 2.
    pub fn new(order: usize, side: usize, lowest_rad: f64, width_rad: f64) -> Self {
        assert!(side >= 2, "{side} horizons");
        let slices = Slices::new(order);
        let spacing = (FRAC_PI_2 - lowest_rad) / (side - 1) as f64;
        let horizon = |i: usize| lowest_rad + spacing * i as f64;
        let texels = (0..side * side)
            .map(|i| wedge(&slices, [horizon(i / side), horizon(i % side)], width_rad))
            .collect();
        Self { side, lowest_rad, width_rad, texels }
    }
}

//! `gather.glsl`: iterates over the azimuths at one grid point. The shader's order by octants only saves loads and operations;
//! here azimuths come in their own.

use super::field::{field_slope, normal_of};
use super::fuse::{Found, fused};
use super::sweep::{Heights, March};
use crate::lattice::Lattices;
use glam::{DVec2, DVec3};
use ridgelight::plan::azimuths::Azimuth;
use ridgelight::scene::{Border, Fuse};
use std::f64::consts::FRAC_PI_4;

/// A swept field: the input of every pass after the sweep.
#[derive(Clone, Copy, Debug)]
pub struct Swept<'a> {
    /// The heights.
    pub heights: Heights<'a>,
    /// The azimuths that were swept, with their layers.
    pub azimuths: &'a [Azimuth],
    /// The result of the sweep.
    pub lattices: &'a Lattices,
    /// The fusing mode; `None` where the lattice holds one value per grid point.
    pub fuse: Option<Fuse>,
    /// Lines are 2^line_shift / 32768 cells apart.
    pub line_shift: u32,
    /// Steps marched before the first that was written, along columns and along rows.
    pub warm_up: [i32; 2],
}

impl Swept<'_> {
    /// Horizon of a grid point in one azimuth.
    pub fn found(&self, azimuth: &Azimuth, col: i32, row: i32) -> Found {
        let march = March::new(self.heights, azimuth);
        fused(self, &march, march.of_grid_point(col, row))
    }

    /// Steps marched before the first that was written.
    pub fn warm_up(&self, azimuth: &Azimuth) -> i32 {
        self.warm_up[usize::from(azimuth.marches_rows())]
    }

    /// Hands every azimuth's number, direction, lowest slope and the normal to `add_light`.
    ///
    /// The lowest slope is that of the lowest direction above the horizon and, if requested, the grid point's own
    /// plane.
    pub fn add_all(
        &self,
        [col, row]: [i32; 2],
        own_plane_hides: bool,
        mut add_light: impl FnMut(usize, &Azimuth, f64, DVec3),
    ) {
        let gradient = field_slope(&self.heights, col, row);
        let normal = normal_of(gradient);
        for (k, azimuth) in self.azimuths.iter().enumerate() {
            let horizon = f64::from(self.found(azimuth, col, row).slope);
            // Rise of the grid point's own tangent plane along the azimuth (TW10 eq. 4).
            let direction = DVec2::new(azimuth.cos_phi.into(), azimuth.sin_phi.into());
            let own = if own_plane_hides { gradient.dot(direction) } else { horizon };
            let mut lowest = horizon.max(own);
            if self.heights.border != Border::Open {
                lowest = lowest.max(0.0);
            }
            add_light(k, azimuth, lowest, normal);
        }
    }

    /// `of` at every grid point, row-major.
    pub fn per_grid_point<T>(&self, of: impl Fn(i32, i32) -> T) -> Vec<T> {
        let cols = self.heights.cols;
        (0..cols * self.heights.rows).map(|i| of((i % cols) as i32, (i / cols) as i32)).collect()
    }
}

/// Integrals over elevation from the one of this slope to the zenith, of cos² and of sin cos: contribution of a slice
/// of the sky to the horizontal and the vertical component of a normal (Timonen & Westerholm 2010, eq. 5, with
/// elevation instead of zenith angle).
///   ∫ cos² = π/4 - ω/2 - sin ω cos ω / 2,   ∫ sin cos = cos² ω / 2.
pub fn elevation_moments(slope: f64) -> [f64; 2] {
    let cos2 = 1.0 / (1.0 + slope * slope);
    [FRAC_PI_4 - 0.5 * slope.atan() - 0.5 * slope * cos2, 0.5 * cos2]
}

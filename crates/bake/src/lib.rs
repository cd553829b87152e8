//! Maps for engines, baked from the horizons of a static height field, and their texture encodings.
//!
//! Horizons arrive one azimuth at a time, from [`plan::horizons`](ridgelight::plan::horizons) or
//! elsewhere. A [`HorizonMap`] sums a closed form in elevation over all azimuths, in f64 on the
//! CPU: the horizons are read back from the device anyway.
//!
//! - [`SkyView`]: cosine-weighted unoccluded share of the sky. [`VisibleSky`]: unweighted share.
//! - [`BentNormal`], [`ShVisibility`], [`ShTransfer`].
//! - [`Ellipse`]s and visible points come from the device unchanged
//!   ([`plan::ellipses`](ridgelight::plan::ellipses),
//!   [`plan::visible_points`](ridgelight::plan::visible_points)). [`CurvedEllipses`] interpolate
//!   those of [`plan::curved_ellipses`](ridgelight::plan::curved_ellipses) on a curved base surface.
//! - [`Facets`]: a field as flat triangles. [`Brdf`]: its far-field reflection as a table.
//!   [`Factors`] and [`BrdfHarmonics`]: the table in short form.
//! - [`Encoding`]: values to texels and back, with guaranteed error bounds.

#![deny(clippy::missing_errors_doc)]

mod brdf;
mod brdf_harmonics;
mod curved;
mod encoding;
mod facets;
mod factors;
mod far_field;
mod harmonics;
mod sky;

use glam::DVec3;
use std::f64::consts::FRAC_PI_2;
use std::thread;

use ridgelight::scene::{Border, HeightField};
use ridgelight::{Error, Result};
use ridgelight_cpu::light::normal;

pub use brdf::{Angles, Brdf, pairs};
pub use brdf_harmonics::BrdfHarmonics;
pub use curved::CurvedEllipses;
pub use encoding::{
    BENT_NORMAL, Bound, COEFFICIENTS, CURVED_ELLIPSE, Component, ELLIPSE, Encoding,
    HARMONIC_WEIGHTS, HORIZON, POINTS, RADIANCE, REFLECTED, SHARE, TEXELS, encoding_named,
};
pub use facets::{ExitRadiance, Facets};
pub use factors::Factors;
pub use far_field::{facets, lit_from};
pub use harmonics::{MAX_TRANSFER_ORDER, ShTransfer, ShVisibility};
pub use ridgelight_cpu::ellipse_fit::Ellipse;
pub use sky::{BentNormal, SkyView, VisibleSky};

/// One azimuth of a circle and its angular width, radians, counter-clockwise from east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Direction of its centre.
    pub azimuth_rad: f64,
    /// The widths of a whole circle add up to 2π.
    pub width_rad: f64,
}

/// A map that is a sum over azimuths of the unoccluded part above the horizon.
pub trait HorizonMap: Send + Sync {
    /// Number of sums per texel.
    fn sums(&self) -> usize;

    /// Number of values per texel, in the order of [`end`](Self::end).
    fn values(&self) -> usize {
        self.sums()
    }

    /// Factors of an azimuth that all texels share.
    fn azimuth_factors(&self, ray: Ray) -> Vec<f64>;

    /// Adds the unoccluded part above an elevation, [-π/2..π/2], for a unit normal.
    fn add(&self, factors: &[f64], normal: DVec3, elevation_rad: f64, sums: &mut [f64]);

    /// The texel's values: the sums themselves unless the map overrides this.
    fn end(&self, _normal: DVec3, sums: &[f64], values: &mut [f64]) {
        values.copy_from_slice(sums);
    }
}

/// Unit normals of all texels, row-major: [`normal`].
pub fn normals(field: &HeightField, border: Border) -> Vec<DVec3> {
    let cols = field.cols();
    let count = field.rows() * cols;
    let mut all = vec![DVec3::Z; count];
    in_parts((&mut all, 1, MIN_PART), |first, part| {
        for (i, n) in part.iter_mut().enumerate() {
            *n = normal(field, border, (first + i) / cols, (first + i) % cols);
        }
    });
    all
}

/// Sums of a map over a field, azimuth by azimuth.
pub struct HorizonSums {
    map: Box<dyn HorizonMap>,
    texels: usize,
    /// Empty before the first azimuth.
    sums: Vec<f64>,
}

impl HorizonSums {
    /// All sums start at 0. Memory is allocated with the first azimuth.
    pub fn new(map: Box<dyn HorizonMap>, texels: usize) -> Self {
        Self { map, texels, sums: Vec::new() }
    }

    /// Size of the sums and of the values in bytes.
    pub fn bytes(map: &dyn HorizonMap, texels: usize) -> u64 {
        (8 * map.sums() + 4 * map.values()) as u64 * texels as u64
    }

    /// Adds an azimuth: elevations of the horizon, radians, and unit normals, row-major.
    ///
    /// # Errors
    /// Not enough memory for the sums.
    ///
    /// # Panics
    /// Another number of elevations or normals than texels.
    pub fn add(&mut self, ray: Ray, elevations_rad: &[f32], normals: &[DVec3]) -> Result<()> {
        let (map, count) = (&*self.map, self.map.sums());
        let texels = self.texels;
        assert_eq!([elevations_rad.len(), normals.len()], [texels; 2], "one per texel");
        if self.sums.is_empty() {
            self.sums = zeros(texels, count)?;
        }
        let factors = map.azimuth_factors(ray);
        in_parts((&mut self.sums, count, MIN_PART), |first, part| {
            for (i, sums) in part.chunks_exact_mut(count).enumerate() {
                let at = first + i;
                // π/2 in f32 is slightly above π/2.
                let elevation = f64::from(elevations_rad[at]).clamp(-FRAC_PI_2, FRAC_PI_2);
                map.add(&factors, normals[at], elevation, sums);
            }
        });
        Ok(())
    }

    /// The values, one row-major plane each.
    ///
    /// # Errors
    /// Not enough memory for the values.
    ///
    /// # Panics
    /// Another number of normals than texels, or no azimuth added.
    pub fn end(self, normals: &[DVec3]) -> Result<Vec<Vec<f32>>> {
        let Self { map, texels, sums } = self;
        let count = map.values();
        assert_eq!(normals.len(), texels, "one normal per texel");
        assert_eq!(sums.len(), texels * map.sums(), "at least one azimuth");
        let mut planes = Vec::new();
        for _ in 0..count {
            planes.push(zeros(texels, 1)?);
        }
        let mut values = vec![0.0; count];
        for (at, sums) in sums.chunks_exact(map.sums()).enumerate() {
            map.end(normals[at], sums, &mut values);
            for (plane, value) in planes.iter_mut().zip(&values) {
                plane[at] = *value as f32;
            }
        }
        Ok(planes)
    }
}

/// `each` zeros per texel.
fn zeros<T: Clone + Default>(texels: usize, each: usize) -> Result<Vec<T>> {
    let mut all = Vec::new();
    let count = texels.saturating_mul(each);
    all.try_reserve_exact(count).map_err(|_| Error::Limit {
        what: format!("{each} values for each of {texels} texels"),
        needs: format!("{} bytes", count.saturating_mul(size_of::<T>())),
        limit: "the memory of this machine".into(),
    })?;
    all.resize(count, T::default());
    Ok(all)
}

/// Smallest number of texels that is worth a thread.
const MIN_PART: usize = 1024;

/// Runs `work(first, its part)` on all processors, in parts of at least `least`; each of them has
/// `each` values.
fn in_parts<T: Send>(
    (values, each, least): (&mut [T], usize, usize),
    work: impl Fn(usize, &mut [T]) + Sync,
) {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let part = (values.len() / each).div_ceil(threads).max(least);
    if values.len() <= part * each {
        return work(0, values);
    }
    thread::scope(|scope| {
        for (i, part_values) in values.chunks_mut(part * each).enumerate() {
            let work = &work;
            scope.spawn(move || work(i * part, part_values));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Memory is not allocated before the first azimuth, and a failed allocation is an error.
    #[test]
    fn more_sums_than_memory_are_an_error() {
        assert!(matches!(zeros::<f64>(1 << 60, 36), Err(Error::Limit { .. })));
        assert!(zeros::<f64>(3, 2).is_ok_and(|all| all == [0.0; 6]));
        drop(HorizonSums::new(Box::new(ShTransfer::new(5)), 1 << 60));
    }
}

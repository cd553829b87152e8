//! What engines keep of a field that does not move, made from its horizons: maps of numbers a sample, and how
//! they are packed for textures.
//!
//! Horizons along the azimuths of a circle come one azimuth at a time, from
//! [`plan::horizons`](ridgelight::plan::horizons) or elsewhere. A [`Sum`] is what is kept of each sample: closed forms of
//! elevation along an azimuth, times the width of that azimuth, in f64 on the processor. Baking is done once, and
//! what it reads comes back from the device anyway for the horizons themselves; sums there would be a pass and a
//! rounding more a kind.
//!
//! Each kind is defined where it is computed: [`SkyView`] and [`VisibleSky`] (two things: light of the sky on the
//! ground as it lies, and how much of the sky is seen), [`BentNormal`], [`ShVisibility`], [`ShTransfer`].
//! [`Ellipse`]s of visible sky and visible points come off the device as they are ([`plan::ellipses`](ridgelight::plan::ellipses),
//! [`plan::visible_points`](ridgelight::plan::visible_points)).
//! [`CurvedEllipses`] go between those of [`plan::curved_ellipses`](ridgelight::plan::curved_ellipses) on a curved base.
//! [`Facets`] are a field as its flat triangles, [`Brdf`] what it reflects as seen from afar, [`Factors`] and
//! [`BrdfHarmonics`] that in short.
//! [`Encoding`]s take values to texels and back, within errors that they state.

#![deny(clippy::missing_errors_doc)]

mod bent;
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

pub use bent::BentNormal;
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
pub use sky::{SkyView, VisibleSky};

/// An azimuth of a circle, and the width that it stands for; both radians, counter-clockwise from east.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Direction.
    pub azimuth_rad: f64,
    /// Widths of a whole circle add up to 2π.
    pub width_rad: f64,
}

/// What is kept of every sample: sums over azimuths of what is free above the horizon.
pub trait Sum: Send + Sync {
    /// Numbers that are summed, a sample.
    fn sums(&self) -> usize;

    /// Values of a sample in the end, in the order of [`end`](Self::end).
    fn values(&self) -> usize;

    /// What of an azimuth is the same at every sample.
    fn turn(&self, ray: Ray) -> Vec<f64>;

    /// Adds what a sample of this unit normal sees above an elevation, [-π/2..π/2].
    fn add(&self, turn: &[f64], normal: DVec3, elevation_rad: f64, sums: &mut [f64]);

    /// The sample's values.
    fn end(&self, normal: DVec3, sums: &[f64], values: &mut [f64]);
}

/// Unit normals of all samples, row-major: [`normal`].
pub fn normals(field: &HeightField, border: Border) -> Vec<DVec3> {
    let cols = field.cols();
    let count = field.rows() * cols;
    let mut all = vec![DVec3::Z; count];
    in_parts(count, &mut all, 1, |first, part| {
        for (i, n) in part.iter_mut().enumerate() {
            *n = normal(field, border, (first + i) / cols, (first + i) % cols);
        }
    });
    all
}

/// A kind's sums over a field, azimuth by azimuth.
pub struct Summing {
    what: Box<dyn Sum>,
    samples: usize,
    /// None before the first azimuth.
    sums: Vec<f64>,
}

impl Summing {
    /// Of so many samples, all sums 0; their memory is taken with the first azimuth.
    pub fn new(what: Box<dyn Sum>, samples: usize) -> Self {
        Self { what, samples, sums: Vec::new() }
    }

    /// Bytes of the sums.
    pub fn bytes(what: &dyn Sum, samples: usize) -> u64 {
        8 * what.sums() as u64 * samples as u64
    }

    /// Adds an azimuth: elevations of the horizon, radians, and unit normals, row-major.
    ///
    /// # Errors
    /// More sums than there is memory for.
    ///
    /// # Panics
    /// When there are not as many of either as samples.
    pub fn add(&mut self, ray: Ray, elevations_rad: &[f32], normals: &[DVec3]) -> Result<()> {
        let (what, count) = (&*self.what, self.what.sums());
        let samples = self.samples;
        assert_eq!([elevations_rad.len(), normals.len()], [samples; 2], "one a sample");
        if self.sums.is_empty() {
            self.sums = zeros(samples, count)?;
        }
        let turn = what.turn(ray);
        in_parts(samples, &mut self.sums, count, |first, part| {
            for (i, sums) in part.chunks_exact_mut(count).enumerate() {
                let at = first + i;
                // A right angle in f32 is a little more than one.
                let elevation = f64::from(elevations_rad[at]).clamp(-FRAC_PI_2, FRAC_PI_2);
                what.add(&turn, normals[at], elevation, sums);
            }
        });
        Ok(())
    }

    /// The values: a plane each, row-major.
    ///
    /// # Errors
    /// More values than there is memory for.
    ///
    /// # Panics
    /// When there are not as many normals as samples, or no azimuth was added.
    pub fn end(self, normals: &[DVec3]) -> Result<Vec<Vec<f32>>> {
        let Self { what, samples, sums } = self;
        let count = what.values();
        assert_eq!(normals.len(), samples, "one normal a sample");
        assert_eq!(sums.len(), samples * what.sums(), "an azimuth at least");
        let mut planes = Vec::new();
        for _ in 0..count {
            planes.push(zeros(samples, 1)?);
        }
        let mut values = vec![0.0; count];
        for (at, sums) in sums.chunks_exact(what.sums()).enumerate() {
            what.end(normals[at], sums, &mut values);
            for (plane, value) in planes.iter_mut().zip(&values) {
                plane[at] = *value as f32;
            }
        }
        Ok(planes)
    }
}

/// As many a sample, all 0.
fn zeros<T: Clone + Default>(samples: usize, each: usize) -> Result<Vec<T>> {
    let mut all = Vec::new();
    let count = samples.saturating_mul(each);
    all.try_reserve_exact(count).map_err(|_| Error::Limit {
        what: format!("{each} numbers of each of {samples} samples"),
        needs: format!("{} bytes", count.saturating_mul(size_of::<T>())),
        limit: "the memory of this machine".into(),
    })?;
    all.resize(count, T::default());
    Ok(all)
}

/// Fewer samples are not worth a thread.
const LEAST_PART: usize = 1024;

/// Runs `work(first sample, its part)` on as many threads as there are processors; samples have `each` values.
fn in_parts<T: Send>(
    samples: usize,
    values: &mut [T],
    each: usize,
    work: impl Fn(usize, &mut [T]) + Sync,
) {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let part = samples.div_ceil(threads).max(LEAST_PART);
    if samples <= part {
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

    /// More sums than an address space holds: nothing is taken to begin with, and then it is said.
    #[test]
    fn more_sums_than_memory_are_an_error() {
        assert!(matches!(zeros::<f64>(1 << 60, 36), Err(Error::Limit { .. })));
        assert!(zeros::<f64>(3, 2).is_ok_and(|all| all == [0.0; 6]));
        drop(Summing::new(Box::new(ShTransfer::new(5)), 1 << 60));
    }
}

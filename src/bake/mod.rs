//! What engines keep of a field that does not move, made from its horizons: maps of numbers a sample, and how
//! they are packed for textures.
//!
//! Horizons along the azimuths of a circle come one azimuth at a time, from
//! [`plan::horizons`](crate::plan::horizons) or elsewhere. A [`Sum`] is what is kept of each sample: closed forms of
//! elevation along an azimuth, times the width of that azimuth, in f64 on the processor. Baking is done once, and
//! what it reads comes back from the device anyway for the horizons themselves; sums there would be a pass and a
//! rounding more a kind.
//!
//! Each kind is defined where it is computed: [`SkyView`] and [`VisibleSky`] (two things: light of the sky on the
//! ground as it lies, and how much of the sky is seen), [`BentNormal`], [`ShVisibility`], [`ShTransfer`].
//! [`Ellipse`]s of visible sky and visible points come off the device as they are ([`plan::ellipses`](crate::plan::ellipses),
//! [`plan::visible_points`](crate::plan::visible_points)).
//! [`Encoding`]s take values to texels and back, within errors that they state.

mod bent;
mod encoding;
mod harmonics;
mod sky;

use glam::DVec3;
use std::f64::consts::FRAC_PI_2;
use std::thread;

use crate::cpu::light::normal;
use crate::scene::{Border, HeightField};

pub use crate::cpu::ellipse_fit::Ellipse;
pub use bent::BentNormal;
pub use encoding::{
    BENT_NORMAL, Bound, COEFFICIENTS, Component, ELLIPSE, Encoding, HORIZON, POINTS, SHARE,
    encoding_named,
};
pub use harmonics::{MAX_TRANSFER_ORDER, ShTransfer, ShVisibility};
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
    sums: Vec<f64>,
}

impl Summing {
    /// Of so many samples, all sums 0.
    pub fn new(what: Box<dyn Sum>, samples: usize) -> Self {
        Self { sums: vec![0.0; samples * what.sums()], what }
    }

    /// Bytes of the sums.
    pub fn bytes(what: &dyn Sum, samples: usize) -> u64 {
        8 * what.sums() as u64 * samples as u64
    }

    /// Adds an azimuth: elevations of the horizon, radians, and unit normals, row-major.
    ///
    /// # Panics
    /// When there are not as many of either as samples.
    pub fn add(&mut self, ray: Ray, elevations_rad: &[f32], normals: &[DVec3]) {
        let (what, count) = (&*self.what, self.what.sums());
        let samples = self.sums.len() / count;
        assert_eq!([elevations_rad.len(), normals.len()], [samples; 2], "one a sample");
        let turn = what.turn(ray);
        in_parts(samples, &mut self.sums, count, |first, part| {
            for (i, sums) in part.chunks_exact_mut(count).enumerate() {
                let at = first + i;
                // A right angle in f32 is a little more than one.
                let elevation = f64::from(elevations_rad[at]).clamp(-FRAC_PI_2, FRAC_PI_2);
                what.add(&turn, normals[at], elevation, sums);
            }
        });
    }

    /// The values: a plane each, row-major.
    ///
    /// # Panics
    /// When there are not as many normals as samples.
    pub fn end(self, normals: &[DVec3]) -> Vec<Vec<f32>> {
        let Self { what, sums } = self;
        let count = what.values();
        let samples = normals.len();
        assert_eq!(sums.len(), samples * what.sums(), "one normal a sample");
        let mut planes = vec![vec![0.0; samples]; count];
        let mut values = vec![0.0; count];
        for (at, sums) in sums.chunks_exact(what.sums()).enumerate() {
            what.end(normals[at], sums, &mut values);
            for (plane, value) in planes.iter_mut().zip(&values) {
                plane[at] = *value as f32;
            }
        }
        planes
    }
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

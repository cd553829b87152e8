//! CPU references of the passes that find horizons, against the oracle and closed forms.

mod azimuths;
pub(crate) mod fuse;
mod march;
mod oracle;
mod surface;
mod sweep;

use ridgelight::plan::Axis;
pub(crate) use ridgelight::plan::azimuths::{Azimuth, CELL};
use ridgelight::plan::azimuths::{FLIPS_LANES, FLIPS_MARCH};
pub(crate) use ridgelight::scene::{Border, HeightField};
pub(crate) use ridgelight_cpu::horizon_march::{MarchOptions, horizon_march};
pub(crate) use ridgelight_cpu::horizon_sweep::{SweepOptions, horizon_sweep};
pub(crate) use ridgelight_cpu::lattice::{Lattices, number_layers};
pub(crate) use ridgelight_cpu::oracle::Oracle;
pub(crate) use ridgelight_cpu::shared::sweep::Heights;

pub(crate) use crate::{BORDERS, field};

/// (rows, columns): without a cell, one wide, the smallest with cells, primes.
pub(crate) const SIZES: [(usize, usize); 9] =
    [(1, 1), (1, 9), (9, 1), (2, 3), (3, 2), (2, 2), (7, 5), (5, 13), (11, 11)];

/// Uneven heights from an integer hash, 0..1 in steps of 1/256.
pub(crate) fn noise(seed: u64, row: usize, col: usize) -> f64 {
    let mut x = (seed + row as u64 * 0x9E37_79B9 + col as u64 * 0x85EB_CA6B) ^ 0x5bd1_e995;
    x = (x ^ (x >> 15)).wrapping_mul(0x2545_F491_4F6C_DD1D);
    ((x >> 40) & 0xff) as f64 / 256.0
}

/// The largest |height| and the relief.
pub(crate) fn extent(field: &HeightField) -> (f64, f64) {
    let h = || field.heights_m().iter().map(|h| f64::from(*h));
    let (low, high) = (h().fold(f64::MAX, f64::min), h().fold(f64::MIN, f64::max));
    (high.abs().max(low.abs()), high - low)
}

/// Columns and rows that a march step advances by, towards the horizon, times 32768 or times the
/// march component of the grid vector: whole numbers.
pub(crate) fn grid_vector(azimuth: &Azimuth) -> [f64; 2] {
    let (march, lane) = if azimuth.vector_march > 0 {
        (azimuth.vector_march, azimuth.vector_lane)
    } else {
        (CELL, azimuth.shear)
    };
    let flips = |flag: u32| azimuth.flags & flag != 0;
    let march = f64::from(if flips(FLIPS_MARCH) { march } else { -march });
    let lane = f64::from(if flips(FLIPS_LANES) { lane } else { -lane });
    if azimuth.marches_rows() { [lane, march] } else { [march, lane] }
}

/// Whole periods before a periodic field: for marches along columns and along rows.
pub(crate) fn warm_ups(field: &HeightField, border: Border) -> [i32; 2] {
    let size = [field.cols() as u32, field.rows() as u32];
    [false, true].map(|by_row| Axis::of(by_row, size, border).warm_up as i32)
}

fn warm_up_of(warm_up: [i32; 2], azimuth: &Azimuth) -> i32 {
    warm_up[usize::from(azimuth.marches_rows())]
}

/// Sweeps all azimuths, numbering their layers.
pub(crate) fn swept(
    field: &HeightField,
    border: Border,
    azimuths: &mut [Azimuth],
    warm_up: [i32; 2],
    options: SweepOptions,
) -> Lattices {
    number_layers(azimuths);
    let size = [field.cols(), field.rows()];
    let mut lattices = Lattices::new(azimuths, size, options.line_shift, border);
    for azimuth in azimuths.iter() {
        let options = SweepOptions { warm_up: warm_up_of(warm_up, azimuth), ..options };
        horizon_sweep(Heights::of(field, border), azimuth, &options, lattices.of_mut(azimuth));
    }
    lattices
}

/// Marches all azimuths, numbering their layers.
pub(crate) fn marched(
    field: &HeightField,
    border: Border,
    azimuths: &mut [Azimuth],
    warm_up: [i32; 2],
    all_crossings: bool,
) -> Lattices {
    number_layers(azimuths);
    let size = [field.cols(), field.rows()];
    let mut lattices = Lattices::new(azimuths, size, 15, border);
    for azimuth in azimuths.iter() {
        let options = MarchOptions { all_crossings, warm_up: warm_up_of(warm_up, azimuth) };
        horizon_march(Heights::of(field, border), azimuth, options, lattices.of_mut(azimuth));
    }
    lattices
}

/// Checks an exact answer (slope, march steps to the occluder) against the oracle's.
///
/// Steps are compared where the oracle's occluder wins by more than both errors; crossings within its one-place
/// distance are one. A periodic march ends before the oracle: ground beyond its reach does not count.
pub(crate) fn check_exact(
    oracle: &Oracle,
    (row, col): (usize, usize),
    azimuth: &Azimuth,
    (slope, steps): (f32, f32),
    tolerance: f64,
    reach_steps: Option<i32>,
) -> Result<(), String> {
    let ground_truth = oracle.horizon_along(row, col, grid_vector(azimuth));
    let says =
        || format!("({row}, {col}) {azimuth:?}: {slope} at {steps}, ground truth {ground_truth:?}");
    let Some(ground_truth) = ground_truth else {
        return if slope <= -1e9 { Ok(()) } else { Err(says()) };
    };
    let step_m = f64::from(azimuth.step_m);
    let off = f64::from(slope) - ground_truth.slope;
    let visible =
        reach_steps.is_none_or(|reach| ground_truth.distance_m <= f64::from(reach) * step_m);
    if off > tolerance || (visible && off < -tolerance) {
        return Err(format!("{}, off {off:e} of {tolerance:e}", says()));
    }
    let apart = (f64::from(steps) - ground_truth.distance_m / step_m).abs();
    if visible && ground_truth.margin > 2.0 * tolerance && apart > 2e-3 {
        return Err(says());
    }
    Ok(())
}

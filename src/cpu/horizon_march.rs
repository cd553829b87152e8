//! Horizons by testing everything a sample's own line meets: the baseline of every speed claim and,
//! with all crossings, the truth on the device.

use super::lattice::Lattice;
use super::shared::fuse::Found;
use super::shared::surface::{segment_crossings, surface_rise};
use super::shared::sweep::{CELL_SHIFT, Heights, March, NO_SLOPE, PER_CELL};
use crate::plan::azimuths::{Azimuth, CELL};

/// The settings of a march, as the shader's constants.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MarchOptions {
    /// All crossings with grid lines and diagonals, or only those with grid lines across the march.
    pub all_crossings: bool,
    /// Steps marched beyond the field: whole periods, or 0.
    pub warm_up: i32,
}

/// What the sample (lane, step) meets highest.
pub fn marched(march: &March, lane: i32, step: i32, options: MarchOptions) -> Found {
    let (azimuth, periodic) = (&march.azimuth, march.periodic());
    let split_along = march.split_along();
    let advance = azimuth.shear as f32 * PER_CELL;
    let own = march.height_at(lane, step);
    let mut best = Found { slope: NO_SLOPE, steps: 0.0 };
    let mut offer = |rise: f32, steps: f32| {
        let slope = rise / (steps * azimuth.step_m);
        if slope > best.slope {
            best = Found { slope, steps };
        }
    };
    for back in 1..=step + options.warm_up {
        let y = lane * CELL - back * azimuth.shear;
        if !periodic && y + azimuth.shear <= 0 && azimuth.shear > 0 {
            break;
        }
        let cell = y >> CELL_SHIFT;
        let f0 = (y & (CELL - 1)) as f32 * PER_CELL;
        let at = step - back;
        if periodic || y >= 0 {
            let h = march.height_at(cell, at);
            let slant = if f0 > 0.0 { f0 * (march.height_at(cell + 1, at) - h) } else { 0.0 };
            offer((h - own) + slant, back as f32);
        }
        if !options.all_crossings {
            continue;
        }
        for u in segment_crossings(f0, advance, split_along) {
            if u > 1.0 || (!periodic && y as f32 + u * (azimuth.shear as f32) < -0.5) {
                continue;
            }
            let (mut f, mut low) = (f0 + u * advance, cell);
            if f > 1.0 {
                f -= 1.0;
                low += 1;
            }
            let corners = [
                march.height_at(low, at),
                march.height_at(low, at + 1),
                march.height_at(low + 1, at),
                march.height_at(low + 1, at + 1),
            ];
            offer(surface_rise(corners, own, u, f, split_along), back as f32 - u);
        }
    }
    best
}

/// Marches every sample in one azimuth: `slopes` and `distances` of its layer, one slot a lane.
///
/// # Panics
/// When the lattice is not one slot a lane.
pub fn horizon_march(
    heights: Heights,
    azimuth: &Azimuth,
    options: MarchOptions,
    lattice: &mut Lattice,
) {
    let march = March::new(heights, azimuth);
    for step in 0..march.steps {
        for lane in 0..march.lanes {
            let found = marched(&march, lane, step, options);
            let texel = lattice.texel(lane, march.march_position(step), azimuth.layer);
            lattice.slopes[texel] = found.slope;
            lattice.distances[texel] = found.steps;
        }
    }
}

//! Horizons by testing every crossing of a grid point's own line: the baseline of every speed-up and, with all
//! crossings, the ground truth on the device.

use crate::lattice::Lattice;
use crate::shared::fuse::{Found, NOTHING};
use crate::shared::surface::met_within;
use crate::shared::sweep::{Heights, March};
use ridgelight::plan::azimuths::Azimuth;

/// The settings of a march. The shader always takes all crossings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MarchOptions {
    /// All crossings with grid lines and diagonals, or only those with grid lines across the march.
    pub all_crossings: bool,
    /// Steps marched beyond the field: whole periods, or 0.
    pub warm_up: i32,
}

/// Horizon of the grid point (lane, step).
pub fn marched(march: &March, lane: i32, step: i32, options: MarchOptions) -> Found {
    let mut best = NOTHING;
    for back in 1..=step + options.warm_up {
        if !met_within(march, (lane, step), back, options.all_crossings, &mut best) {
            break;
        }
    }
    best
}

/// Marches from every grid point in one azimuth: `slopes` and `distances` of its layer, one slot a lane.
pub fn horizon_march(
    heights: Heights,
    azimuth: &Azimuth,
    options: MarchOptions,
    lattice: &mut Lattice,
) {
    let march = March::new(heights, azimuth);
    lattice.fill(&march, |lane, step| marched(&march, lane, step, options));
}

//! The horizon of every grid point in the azimuths of a batch, from the lattice of a sweep.

use crate::shared::fuse::Found;
use crate::shared::gather::Swept;
use crate::shared::sweep::LOWEST_MET;
use ridgelight::plan::azimuths::Azimuth;
use ridgelight::scene::Border;
use std::f64::consts::FRAC_PI_2;

/// Output of the pass for one grid point in one azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FusedHorizon {
    /// The horizon before the border is applied.
    pub found: Found,
    /// Elevation, radians: 0 or more unless the border is open.
    pub angle_rad: f64,
    /// World length to the horizon; 0 for none, and in modes that read slopes.
    pub distance_m: f32,
}

/// One grid point in one azimuth.
pub fn fused_horizon(swept: &Swept, azimuth: &Azimuth, col: i32, row: i32) -> FusedHorizon {
    let found = swept.found(azimuth, col, row);
    let open = swept.heights.border == Border::Open;
    let nothing = found.slope <= LOWEST_MET;
    let angle = if nothing { -FRAC_PI_2 } else { f64::from(found.slope).atan() };
    let ground = nothing || (!open && found.slope <= 0.0);
    FusedHorizon {
        found,
        angle_rad: if open { angle } else { angle.max(0.0) },
        distance_m: if ground { 0.0 } else { found.steps * azimuth.step_m },
    }
}

/// All grid points in all azimuths, as `[azimuth][row][column]`.
pub fn sweep_fuse(swept: &Swept) -> Vec<FusedHorizon> {
    let one = |a| swept.per_grid_point(|col, row| fused_horizon(swept, a, col, row));
    swept.azimuths.iter().flat_map(one).collect()
}

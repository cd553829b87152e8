//! The grids of a preview that fit the time.

use std::ops::Range;

use super::super::state::State;
use super::level::{GRIDS, SLOPES, grid_work};

/// The stages of a preview: while input goes on; at rest, before the full light.
pub const STAGES: usize = 2;
pub const DRAG: usize = 0;
pub const REST: usize = 1;

/// Intended GPU times of the grids while input goes on: with drawing and copies, 15 pictures per second.
const INTENDED_MS: [f64; GRIDS] = [6.0, 12.0, 24.0];
/// Times of a stage over those. At rest, input waits for one grid at most.
const LONGER: [f64; STAGES] = [1.0, 3.0];
/// The parts of those times that are left where a camera draws a mesh.
const WITH_MESH: [f64; GRIDS] = [1.0, 0.4, 0.3];
/// The parts of those times that do not grow with the grid: tables of the sky, starts of passes.
pub const FIXED_MS: [f64; GRIDS] = [2.0, 1.0, 0.0];
/// Shortest side of a coarser grid, grid points.
pub const LEAST_GRID: usize = 32;

/// Shares of the intended time where a preview keeps its grids: while input goes on, and at rest.
pub const DRAGGED: Range<f64> = 0.0..3.0;
pub const RESTED: Range<f64> = 0.4..1.4;

/// What a device does in a millisecond before anything was measured, in texels times azimuths of the grids' light, and texels of
/// slopes: lavapipe on two cores; a GPU.
const CPU_RATES: [f64; GRIDS] = [1e5, 1e5, 5.5e4];
const GPU_RATES: [f64; GRIDS] = [2e7; GRIDS];

/// Chooses the sides of blocks.
pub struct Sides {
    pub rates: [f64; GRIDS],
    /// Of each stage, where a script gives them: sky, sun, slopes. A stage without them has no grids.
    pub fixed: Option<[Option<[usize; GRIDS]>; STAGES]>,
}

impl Sides {
    pub fn new(is_cpu: bool) -> Self {
        Self { rates: if is_cpu { CPU_RATES } else { GPU_RATES }, fixed: None }
    }

    /// Whether a script gives them.
    pub fn are_fixed(&self) -> bool {
        self.fixed.is_some()
    }

    /// Sides for a stage that fit the time, unless those in use are kept.
    pub fn others(
        &self,
        state: &State,
        (stage, kept): (usize, Option<[usize; GRIDS]>),
        kept_at: Range<f64>,
    ) -> Option<[usize; GRIDS]> {
        let field = &state.scene.field;
        let most = (field.rows().min(field.cols()) / LEAST_GRID).max(1);
        // Shares of the intended time.
        let share = |of: usize, side: usize| {
            let ms = grid_work(&state.scene, &state.quality, of, side) / self.rates[of];
            let left = if state.has_camera() { WITH_MESH[of] } else { 1.0 };
            (FIXED_MS[of] + ms) / (left * LONGER[stage] * INTENDED_MS[of])
        };
        let wanted = if let Some(fixed) = self.fixed {
            fixed[stage]?
        } else {
            let least = |of: usize| (1..most).find(|side| share(of, *side) <= 1.0).unwrap_or(most);
            let slopes = least(SLOPES);
            std::array::from_fn(|of| least(of).max(slopes))
        };
        // Other grids take a third of a second of the host, so the present ones are kept while they roughly fit, longest in a drag.
        let is_kept = kept.is_some_and(|kept| {
            let fits = |of: usize| kept[of] <= most && kept_at.contains(&share(of, kept[of]));
            kept == wanted || !self.are_fixed() && (0..GRIDS).all(fits)
        });
        (!is_kept).then_some(wanted)
    }
}

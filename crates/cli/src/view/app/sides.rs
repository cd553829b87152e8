//! The grids of previews that fit the time.

use std::ops::Range;

use super::super::state::State;
use super::level::{GRIDS, SLOPES, grid_work};

/// The two previews: while input goes on; at rest, before the full light.
pub const STAGES: usize = 2;
pub const DRAG: usize = 0;
pub const REST: usize = 1;

/// Intended GPU times of the drag preview's grids: with drawing and copies, 15 pictures per second.
const INTENDED_MS: [f64; GRIDS] = [6.0, 12.0, 24.0];
/// Factor on those times for the rest preview. New input waits for one grid at most.
const REST_FACTOR: f64 = 3.0;
/// Factor on a grid's time in a camera view, which also draws a mesh.
const CAMERA_FACTOR: [f64; GRIDS] = [1.0, 0.4, 0.3];
/// Milliseconds that do not grow with the grid: tables of the sky, starts of passes.
pub const FIXED_MS: [f64; GRIDS] = [2.0, 1.0, 0.0];
/// Shortest side of a coarser grid, grid points.
pub const LEAST_GRID: usize = 32;

/// A preview keeps its grids while each takes this part of its intended time: in a drag, and at rest.
pub const KEPT_IN_DRAG: Range<f64> = 0.0..3.0;
pub const KEPT_AT_REST: Range<f64> = 0.4..1.4;

/// Assumed speeds until measured, per millisecond: texels times azimuths of sky and sun, and texels of slopes. lavapipe on two
/// cores; a GPU.
const CPU_RATES: [f64; GRIDS] = [1e5, 1e5, 5.5e4];
const GPU_RATES: [f64; GRIDS] = [2e7; GRIDS];

/// Chooses the sides of each grid's blocks, in grid points.
pub struct Sides {
    pub rates: [f64; GRIDS],
    /// Where a script gives them: of the drag preview, and of the rest preview if it is to have any. Times then decide nothing.
    pub fixed: Option<([usize; GRIDS], Option<[usize; GRIDS]>)>,
}

impl Sides {
    pub fn new(is_cpu: bool) -> Self {
        Self { rates: if is_cpu { CPU_RATES } else { GPU_RATES }, fixed: None }
    }

    /// Whether a script gives them.
    pub fn are_fixed(&self) -> bool {
        self.fixed.is_some()
    }

    /// Whether there may be a rest preview.
    pub fn has_rest(&self) -> bool {
        self.fixed.is_none_or(|(_, rest)| rest.is_some())
    }

    /// Sides for the drag preview that fit the time, unless those in use are kept. Other grids take a third of a second of the host
    /// (two cores, 2,048 x 2,048), so grids that roughly fit are kept.
    pub fn for_drag(
        &self,
        state: &State,
        used: Option<[usize; GRIDS]>,
        kept_at: Range<f64>,
    ) -> Option<[usize; GRIDS]> {
        let wanted = self.fixed.map_or_else(|| self.fitting(state, 1.0), |(drag, _)| drag);
        (!self.are_kept(state, used, (wanted, 1.0), kept_at)).then_some(wanted)
    }

    /// Sides for the rest preview, none coarser than the drag preview's and one of them finer, unless those in use are kept.
    pub fn for_rest(
        &self,
        state: &State,
        drag: [usize; GRIDS],
        used: Option<[usize; GRIDS]>,
    ) -> Option<[usize; GRIDS]> {
        let wanted = match self.fixed {
            Some((_, rest)) => rest?,
            None => {
                let fitting = self.fitting(state, REST_FACTOR);
                std::array::from_fn(|of| fitting[of].min(drag[of]))
            }
        };
        let is_kept = self.are_kept(state, used, (wanted, REST_FACTOR), KEPT_AT_REST);
        (wanted != drag && !is_kept).then_some(wanted)
    }

    /// The finest sides that fit a factor on the intended time.
    fn fitting(&self, state: &State, factor: f64) -> [usize; GRIDS] {
        let most = most_side(state);
        let fits = |of: usize, side: usize| self.part_of_time(state, (of, side), factor) <= 1.0;
        let least = |of: usize| (1..most).find(|side| fits(of, *side)).unwrap_or(most);
        let slopes = least(SLOPES);
        std::array::from_fn(|of| least(of).max(slopes))
    }

    fn are_kept(
        &self,
        state: &State,
        used: Option<[usize; GRIDS]>,
        (wanted, factor): ([usize; GRIDS], f64),
        kept_at: Range<f64>,
    ) -> bool {
        let Some(used) = used else { return false };
        let fits = |of: usize| {
            let part = self.part_of_time(state, (of, used[of]), factor);
            used[of] <= most_side(state) && kept_at.contains(&part)
        };
        used == wanted || !self.are_fixed() && (0..GRIDS).all(fits)
    }

    /// The time of a grid over the intended one.
    fn part_of_time(&self, state: &State, (of, side): (usize, usize), factor: f64) -> f64 {
        let ms = grid_work(&state.scene, &state.quality, of, side) / self.rates[of];
        let in_view = if state.has_camera() { CAMERA_FACTOR[of] } else { 1.0 };
        (FIXED_MS[of] + ms) / (in_view * factor * INTENDED_MS[of])
    }
}

fn most_side(state: &State) -> usize {
    let field = &state.scene.field;
    (field.rows().min(field.cols()) / LEAST_GRID).max(1)
}

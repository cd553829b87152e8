//! One step of a grid point's own line: what `horizon_march` tests step by step, and `fuse.glsl` around proposals.

use super::fuse::Found;
use super::surface::{segment_crossings, surface_rise};
use super::sweep::{CELL_SHIFT, March, PER_CELL};
use ridgelight::plan::azimuths::CELL;

/// Raises `best` to the highest point that the grid point (lane, step) has `back` steps ahead and, if requested, at
/// the crossings with lane lines and diagonals from there to the step before. Returns whether any of that lies on the
/// field.
pub fn met_within(
    march: &March,
    (lane, step): (i32, i32),
    back: i32,
    all_crossings: bool,
    best: &mut Found,
) -> bool {
    let (azimuth, periodic) = (&march.azimuth, march.periodic());
    let y = lane * CELL - back * azimuth.shear;
    if !periodic && y + azimuth.shear <= 0 && azimuth.shear > 0 {
        return false;
    }
    let own = march.height_at(lane, step);
    let mut offer = |rise: f32, steps: f32| {
        let slope = rise / (steps * azimuth.step_m);
        if slope > best.slope {
            *best = Found { slope, steps };
        }
    };
    let cell = y >> CELL_SHIFT;
    let f0 = (y & (CELL - 1)) as f32 * PER_CELL;
    let at = step - back;
    if periodic || y >= 0 {
        let h = march.height_at(cell, at);
        let slant = if f0 > 0.0 { f0 * (march.height_at(cell + 1, at) - h) } else { 0.0 };
        offer((h - own) + slant, back as f32);
    }
    if !all_crossings {
        return true;
    }
    let split_along = march.split_along();
    let advance = azimuth.shear as f32 * PER_CELL;
    for u in segment_crossings(f0, advance, split_along) {
        if u > 1.0 || (!periodic && y as f32 + u * (azimuth.shear as f32) < -0.5) {
            continue;
        }
        let (mut f, mut low) = (f0 + u * advance, cell);
        if f > 1.0 {
            f -= 1.0;
            low += 1;
        }
        offer(surface_rise(march.cell_heights(low, at), own, u, f, split_along), back as f32 - u);
    }
    true
}

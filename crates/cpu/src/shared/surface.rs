//! `surface.glsl`: the surface between two march steps, in local coordinates of a line: u along the
//! march from the earlier step, f across the lanes from the line's cell, both from 0 to 1.

use super::fuse::Found;
use super::sweep::{CELL_SHIFT, March, PER_CELL};
use ridgelight::plan::azimuths::CELL;

/// No crossing: beyond the end of the segment.
pub const NO_CROSSING: f32 = 2.0;

/// Threshold between equal and greater: positions are multiples of 1/32768 of a cell, or quotients with integers up
/// to 4096, which a device may round with an error of 2.5 ulp.
pub const HAIR: f32 = 1e-5;

/// Where a line that starts at `f0` and advances by `shear` crosses lane lines and cell diagonals
/// strictly between two steps, sorted; these and the steps themselves are all the vertices of the
/// profile. `split_along` says that diagonals run from (0, 0) to (1, 1), else from (1, 0) to (0, 1).
pub fn segment_crossings(f0: f32, shear: f32, split_along: bool) -> [f32; 3] {
    let mut u = [NO_CROSSING; 3];
    if f0 + shear > 1.0 + HAIR {
        u[0] = (1.0 - f0) / shear;
    }
    if split_along {
        // f - u is an integer: from f0 down to f0 + shear - 1, past 0.
        if f0 > 0.0 && f0 + shear < 1.0 - HAIR {
            u[1] = f0 / (1.0 - shear);
        }
    } else {
        // f + u is an integer: from f0 up to f0 + shear + 1, past 1 and perhaps 2.
        if f0 + shear > 0.0 {
            u[1] = (1.0 - f0) / (1.0 + shear);
        }
        if f0 + shear > 1.0 + HAIR {
            u[2] = (2.0 - f0) / (1.0 + shear);
        }
    }
    u.sort_by(f32::total_cmp);
    u
}

/// Rise over `own` of the two triangles with corner heights h00, h10 (march), h01 (lane), h11, given
/// in that order. Takes differences first, so that a small rise on a high summit keeps its digits.
pub fn surface_rise(corners: [f32; 4], own: f32, u: f32, f: f32, split_along: bool) -> f32 {
    let [h00, h10, h01, h11] = corners;
    if split_along {
        if f <= u {
            (h00 - own) + u * (h10 - h00) + f * (h11 - h10)
        } else {
            (h00 - own) + f * (h01 - h00) + u * (h11 - h01)
        }
    } else if u + f <= 1.0 {
        (h00 - own) + u * (h10 - h00) + f * (h01 - h00)
    } else {
        (h11 - own) + (1.0 - u) * (h01 - h11) + (1.0 - f) * (h10 - h11)
    }
}

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

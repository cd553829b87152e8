//! `fuse.glsl`: resamples the lattice of a sweep at the field's grid points.

use super::gather::Swept;
use super::surface::met_within;
use super::sweep::{LOWEST_MET, March, NO_SLOPE, PER_CELL, on_field, wrapped};
use ridgelight::plan::azimuths::CELL;
use ridgelight::scene::Fuse;

/// Horizon of a grid point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Found {
    /// Rise over world distance; [`NO_SLOPE`] for none.
    pub slope: f32,
    /// March steps to the occluder; 0 where unknown.
    pub steps: f32,
}

/// No horizon.
pub const NOTHING: Found = Found { slope: NO_SLOPE, steps: 0.0 };

/// The height of the surface at a lane position and a march step; `None` outside the field.
pub fn surface_on_line(march: &March, y: i32, step: i32) -> Option<f32> {
    let is_there = march.periodic() || (on_field(y, march.lanes) && step >= 0);
    is_there.then(|| march.line_height(y, step))
}

/// The higher of two horizons.
fn higher(a: Found, b: Found) -> Found {
    if b.slope > a.slope { b } else { a }
}

/// Horizon of the line of a grid point (lane, step) of height `own` within its first step: its crossing with the next
/// grid line, and with the cell's diagonal where that lies across. Nearly everything that unit steps miss lies here.
pub fn first_crossings(march: &March, (lane, step): (i32, i32), own: f32) -> Found {
    let azimuth = &march.azimuth;
    if !march.periodic() && (step == 0 || (azimuth.shear > 0 && lane == 0)) {
        return NOTHING;
    }
    let [ahead, ahead_low] = [lane, lane - 1].map(|lane| march.height_at(lane, step - 1));
    let rise = (ahead - own) + azimuth.shear as f32 * PER_CELL * (ahead_low - ahead);
    let found = Found { slope: rise / azimuth.step_m, steps: 1.0 };
    split_crossing(march, (lane, step), own).map_or(found, |split| higher(found, split))
}

/// Where that line crosses the diagonal of the grid point's cell, if it does within its first step.
pub fn split_crossing(march: &March, (lane, step): (i32, i32), own: f32) -> Option<Found> {
    if march.split_along() || !(march.periodic() || (lane > 0 && step > 0)) {
        return None;
    }
    // (1, 0) to (0, 1) is crossed by (u, u * shear) at u = 1 / (1 + shear).
    let u = 1.0 / (1.0 + march.azimuth.shear as f32 * PER_CELL);
    let [low, ahead] = [(lane - 1, step), (lane, step - 1)].map(|(l, s)| march.height_at(l, s));
    let rise = (low - own) + u * (ahead - low);
    Some(Found { slope: rise / (u * march.azimuth.step_m), steps: u })
}

/// The surface at a proposed distance, relative to a height at lane position y.
fn surface_at(march: &March, y: i32, back: u16, step: i32, own: f32) -> Found {
    if back == 0 {
        return NOTHING;
    }
    let whole = i32::from(back);
    let h = surface_on_line(march, y - whole * march.azimuth.shear, step - whole);
    let steps = f32::from(back);
    h.map_or(NOTHING, |h| Found { slope: (h - own) / (steps * march.azimuth.step_m), steps })
}

/// The swept lines around a position: before it (or through it) and after it, where they are on the field.
struct Around {
    before: i32,
    after: i32,
    before_texel: Option<usize>,
    after_texel: Option<usize>,
    /// From the one before to the one after, 0 to 1.
    t: f32,
    /// Whether the one after is nearer or alone; on a tie, the one before is taken.
    takes_after: bool,
}

fn lines_around(swept: &Swept, march: &March, y: i32, step: i32) -> Around {
    let (azimuth, lanes, line_shift) = (&march.azimuth, march.lanes, swept.line_shift);
    let (lattice, warm_up) = (swept.lattices.of(azimuth), swept.warm_up(azimuth));
    let at = march.march_position(step);
    let wraps = march.periodic();
    let spacing = 1_i32 << line_shift;
    let slots = (lanes * CELL) >> line_shift;
    let phase = ((step + warm_up) * azimuth.shear) & (spacing - 1);
    let slot = (y - phase) >> line_shift;
    let before = slot * spacing + phase;
    let after = before + spacing;
    let has_before = wraps || before >= 0;
    let has_after = before < y && (wraps || after <= (lanes - 1) * CELL);
    let texel = |slot: i32, exists: bool| {
        let slot = if wraps { wrapped(slot, slots) } else { slot };
        exists.then(|| lattice.texel(slot, at, azimuth.layer))
    };
    let (before_texel, after_texel) = (texel(slot, has_before), texel(slot + 1, has_after));
    let t = (y - before) as f32 / spacing as f32;
    let takes_after = has_after && (t > 0.5 || !has_before);
    Around { before, after, before_texel, after_texel, t, takes_after }
}

/// The swept line nearest to a lane position at a step of the field: its own lane position, and the index of its
/// value; none where no line is on the field.
pub fn nearest_line(swept: &Swept, march: &March, (y, step): (i32, i32)) -> Option<(i32, usize)> {
    let around = lines_around(swept, march, y, step);
    match around.takes_after {
        true => around.after_texel.map(|texel| (around.after, texel)),
        false => around.before_texel.map(|texel| (around.before, texel)),
    }
}

/// Slope of the horizon at a grid point (lane, step) and its distance in march steps: 0, unknown, where slopes are
/// read. Without a mode, the lattice holds one value per grid point.
pub fn fused(swept: &Swept, march: &March, (lane, step): (i32, i32)) -> Found {
    let (lattice, warm_up) = (swept.lattices.of(&march.azimuth), swept.warm_up(&march.azimuth));
    let (y, own) = (lane * CELL, march.height_at(lane, step));
    let Some(fuse) = swept.fuse else {
        let texel = lattice.texel(lane, march.march_position(step), march.azimuth.layer);
        return Found { slope: lattice.slopes[texel], steps: lattice.distances[texel] };
    };
    let Around { before, after, before_texel, after_texel, t, takes_after } =
        lines_around(swept, march, y, step);
    let slope = |texel: Option<usize>| Found {
        slope: texel.map_or(NO_SLOPE, |i| sloped(lattice.slopes[i])),
        steps: 0.0,
    };
    let back = |texel: Option<usize>| texel.map_or(0, |i| lattice.occluders[i]);
    // A proposal one step back is the first crossing itself.
    let aimed = |texel: Option<usize>| match back(texel) {
        0 | 1 => NOTHING,
        back => surface_at(march, y, back, step, own),
    };

    // Ridges that unit steps miss stand beside the nearer line's proposal: a step to either side, and one more towards
    // the other line's.
    let around = || {
        let [before, after] = [before_texel, after_texel].map(|t| i32::from(back(t)));
        let (nearer, other) = if takes_after { (after, before) } else { (before, after) };
        let at = if nearer > 0 { nearer } else { other };
        let towards = if other > 0 { (other - at).signum() } else { 0 };
        let mut best = NOTHING;
        if at > 0 {
            let first = (at + towards.min(0)).max(1);
            for back in first..=(at + 1 + towards.max(0)).min(step + warm_up) {
                met_within(march, (lane, step), back, true, &mut best);
            }
        }
        best
    };

    let first = || first_crossings(march, (lane, step), own);
    let (nearest, farther) =
        if takes_after { (after_texel, before_texel) } else { (before_texel, after_texel) };
    let (a, b) = match fuse {
        Fuse::Nearest => return slope(nearest),
        Fuse::AimedNearest => return higher(first(), aimed(nearest)),
        Fuse::Aimed => return higher(higher(first(), aimed(before_texel)), aimed(after_texel)),
        // `around` already tests the step of the nearer line's occluder.
        Fuse::AimedAround => return higher(higher(first(), aimed(farther)), around()),
        Fuse::Own => (
            surface_at(march, after, back(after_texel), step, own),
            surface_at(march, before, back(before_texel), step, own),
        ),
        Fuse::Slopes => (slope(after_texel), slope(before_texel)),
    };
    // Where only one line has an occluder, use it alone.
    if b.slope <= LOWEST_MET || a.slope <= LOWEST_MET {
        return higher(a, b);
    }
    Found {
        slope: b.slope * (1.0 - t) + a.slope * t,
        steps: if takes_after { a.steps } else { b.steps },
    }
}

/// A slope of the lattice; a value that f16 clamped is "none", too.
fn sloped(slope: f32) -> f32 {
    if slope <= -65504.0 { NO_SLOPE } else { slope }
}

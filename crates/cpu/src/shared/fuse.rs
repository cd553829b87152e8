//! `fuse.glsl`: resamples the lattice of a sweep at the field's grid points.

use super::segment::met_within;
use super::sweep::{CELL_SHIFT, LOWEST_MET, March, NO_SLOPE, PER_CELL, on_field, wrapped};
use crate::lattice::Lattice;
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

/// A grid point's surroundings in march and lane coordinates of one octant of azimuths: heights one step towards the
/// horizon, straight, and to the lower lane; and of the lower lane's neighbour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Octant {
    /// The grid point itself.
    pub own: f32,
    /// One step towards the horizon.
    pub ahead: f32,
    /// One step towards the horizon, one lane lower.
    pub ahead_low: f32,
    /// One lane lower.
    pub low: f32,
    /// Whether there is a step towards the horizon.
    pub ahead_exists: bool,
    /// Whether there is a lower lane.
    pub low_exists: bool,
    /// The cell's diagonal runs between `ahead` and `low`.
    pub split_crosses: bool,
}

/// The height of the surface at a lane position and a march step; `None` outside the field.
pub fn surface_on_line(march: &March, y: i32, step: i32) -> Option<f32> {
    let (lanes, steps) = (march.lanes, march.steps);
    let (mut cell, mut step) = (y >> CELL_SHIFT, step);
    let mut next = (cell + 1).min(lanes - 1);
    if march.periodic() {
        cell = wrapped(cell, lanes);
        next = (cell + 1) % lanes;
        step = wrapped(step, steps);
    } else if !on_field(y, lanes) || step < 0 {
        return None;
    }
    let at = march.march_position(step);
    let ha = march.fetch(march.lane_position(cell), at);
    let hb = march.fetch(march.lane_position(next), at);
    Some(ha + (y & (CELL - 1)) as f32 * PER_CELL * (hb - ha))
}

/// The grid point's surroundings for all azimuths that share its march axis and flips.
pub fn octant_around(march: &March, lane: i32, step: i32, own: f32) -> Octant {
    let (lanes, steps) = (march.lanes, march.steps);
    let ahead_exists = march.periodic() || step > 0;
    let low_exists = march.periodic() || lane > 0;
    let here = march.march_position(step);
    let ahead = march.march_position(if ahead_exists { (step + steps - 1) % steps } else { step });
    let middle = march.lane_position(lane);
    let low = march.lane_position(if low_exists { (lane + lanes - 1) % lanes } else { lane });
    Octant {
        own,
        ahead: march.fetch(middle, ahead),
        ahead_low: march.fetch(low, ahead),
        low: march.fetch(low, here),
        ahead_exists,
        low_exists,
        split_crosses: !march.split_along(),
    }
}

/// The higher of two horizons.
fn higher(a: Found, b: Found) -> Found {
    if b.slope > a.slope { b } else { a }
}

/// Horizon of the grid point's own line within its first step: its crossing with the next grid line, and with the
/// cell's diagonal where that lies across. Nearly everything that unit steps miss lies here.
pub fn first_crossings(march: &March, o: &Octant) -> Found {
    let azimuth = &march.azimuth;
    let shear = azimuth.shear as f32 * PER_CELL;
    if !o.ahead_exists || (azimuth.shear > 0 && !o.low_exists) {
        return NOTHING;
    }
    let rise = (o.ahead - o.own) + shear * (o.ahead_low - o.ahead);
    let found = Found { slope: rise / azimuth.step_m, steps: 1.0 };
    split_slope(march, o).map_or(found, |split| higher(found, split))
}

/// Where the grid point's own line crosses the diagonal of its cell, if it does within its first step.
fn split_slope(march: &March, o: &Octant) -> Option<Found> {
    let shear = march.azimuth.shear as f32 * PER_CELL;
    if !(o.split_crosses && o.low_exists && o.ahead_exists) {
        return None;
    }
    // (1, 0) to (0, 1) is crossed by (u, u * shear) at u = 1 / (1 + shear).
    let u = 1.0 / (1.0 + shear);
    let rise = (o.low - o.own) + u * (o.ahead - o.low);
    Some(Found { slope: rise / (u * march.azimuth.step_m), steps: u })
}

/// The same for a grid point (lane, step) of height `own`.
pub fn split_crossing(march: &March, (lane, step): (i32, i32), own: f32) -> Option<Found> {
    split_slope(march, &octant_around(march, lane, step, own))
}

/// The surface at a proposed distance, relative to a height at lane position y.
fn surface_at(march: &March, y: i32, back: u16, step: i32, own: f32) -> Found {
    let steps = i32::from(back);
    let Some(h) = (back > 0)
        .then(|| surface_on_line(march, y - steps * march.azimuth.shear, step - steps))
        .flatten()
    else {
        return NOTHING;
    };
    let steps = f32::from(back);
    Found { slope: (h - own) / (steps * march.azimuth.step_m), steps }
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

fn lines_around(
    lattice: &Lattice,
    march: &March,
    (line_shift, warm_up): (u32, i32),
    y: i32,
    step: i32,
) -> Around {
    let (azimuth, lanes) = (&march.azimuth, march.lanes);
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

/// Index of the nearest swept line's value at a lane position and a step of the field; none where no line is on the
/// field.
///
/// # Panics
/// When the lattice is not that of the azimuth and `line_shift`.
pub fn nearest_texel(
    lattice: &Lattice,
    march: &March,
    settings: (u32, i32),
    y: i32,
    step: i32,
) -> Option<usize> {
    let around = lines_around(lattice, march, settings, y, step);
    if around.takes_after { around.after_texel } else { around.before_texel }
}

/// Slope of the horizon at a grid point (lane, step) and its distance in march steps: 0, unknown, where slopes are
/// read. Without a mode, the lattice holds one value per grid point.
///
/// # Panics
/// When the lattice is not that of the azimuth and `line_shift`.
pub fn fused(
    lattice: &Lattice,
    march: &March,
    (fuse, line_shift, warm_up): (Option<Fuse>, u32, i32),
    (lane, step): (i32, i32),
    o: &Octant,
) -> Found {
    let y = lane * CELL;
    let Some(fuse) = fuse else {
        let texel = lattice.texel(lane, march.march_position(step), march.azimuth.layer);
        return Found { slope: lattice.slopes[texel], steps: lattice.distances[texel] };
    };
    let lines = lines_around(lattice, march, (line_shift, warm_up), y, step);
    let Around { before, after, before_texel, after_texel, t, takes_after } = lines;
    let slope = |texel: Option<usize>| Found {
        slope: texel.map_or(NO_SLOPE, |i| sloped(lattice.slopes[i])),
        steps: 0.0,
    };
    let back = |texel: Option<usize>| texel.map_or(0, |i| lattice.occluders[i]);
    // A proposal one step back is the first crossing itself.
    let aimed = |texel: Option<usize>| match back(texel) {
        0 | 1 => NOTHING,
        back => surface_at(march, y, back, step, o.own),
    };

    // Ridges that unit steps miss stand beside a proposal.
    let around = |texel: Option<usize>| {
        let mut best = NOTHING;
        let back = i32::from(back(texel));
        if back > 0 {
            for back in (back - 1).max(1)..=(back + 2).min(step + warm_up) {
                met_within(march, (lane, step), back, true, &mut best);
            }
        }
        best
    };

    let nearest = if takes_after { after_texel } else { before_texel };
    let (a, b) = match fuse {
        Fuse::Nearest => return slope(nearest),
        Fuse::AimedNearest => return higher(first_crossings(march, o), aimed(nearest)),
        Fuse::Aimed => {
            let found = higher(first_crossings(march, o), aimed(before_texel));
            return higher(found, aimed(after_texel));
        }
        Fuse::AimedAround => {
            let found = higher(first_crossings(march, o), aimed(before_texel));
            let found = higher(found, aimed(after_texel));
            return higher(higher(found, around(before_texel)), around(after_texel));
        }
        Fuse::Own => (
            surface_at(march, after, back(after_texel), step, o.own),
            surface_at(march, before, back(before_texel), step, o.own),
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

//! Shadow heights along a line: a running maximum of the ground over a plane that rises with a sun's light, raised so far that
//! nothing between two lines is above the interpolation of their maxima.

use crate::shared::sweep::{CELL_SHIFT, March};
use ridgelight::plan::azimuths::CELL;

/// A line at a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowStep {
    /// Height of the line over the plane, metres.
    pub over_plane: f64,
    /// The highest raised ground before this step, over the plane; none at first.
    pub top: Option<f64>,
    /// The raised ground of this step and of the way to it from the step before.
    pub raised: f64,
}

/// Lines of an azimuth: how many, and the lane position of the first at step 0 (`lattice.glsl`).
pub fn lines_of(march: &March, total: i32) -> (i32, i32) {
    if march.periodic() {
        return (march.lanes, 0);
    }
    let lead = ((total - 1) * march.azimuth.shear + CELL - 1) / CELL;
    (march.lanes + lead, -lead * CELL)
}

/// A shadow's height: the high half of an f32.
pub fn height_of(word: u32) -> f64 {
    f32::from_bits(word & 0xffff_0000).into()
}

/// Shadow heights of a line, by steps; none where it is a cell or more beside the field. `y` is its lane position at step 0 of
/// `total`, `warm_up` of them before the field's own.
pub fn shadow_line(march: &March, y: i32, (total, warm_up): (i32, i32)) -> Vec<Option<ShadowStep>> {
    let azimuth = &march.azimuth;
    let rise = f64::from(azimuth.low_slope) * f64::from(azimuth.step_m);
    let mut top = None;
    let mut before: Option<(f64, i32)> = None;
    let mut all = Vec::new();
    for step in 0..total {
        let y = y + step * azimuth.shear;
        // Beyond the edge the heights stay the same: from there rays enter the field.
        if !(march.periodic() || y > -2 * CELL && y < march.lanes * CELL) {
            before = None;
            all.push(None);
            continue;
        }
        let row = step - warm_up;
        let (cell, f) = (y >> CELL_SHIFT, f64::from(y & (CELL - 1)) / f64::from(CELL));
        let h = |lane: i32, row: i32| f64::from(march.height_at(lane, row));
        let over_plane = (1.0 - f) * h(cell, row) + f * h(cell + 1, row) + f64::from(step) * rise;
        let bend = |lane: i32| 2.0 * h(lane, row) - h(lane - 1, row) - h(lane + 1, row);
        let now = over_plane + f * (1.0 - f) * bend(cell).max(bend(cell + 1)).max(0.0);
        let raised = before.map_or(now, |(was, cell)| {
            let between = between(march, cell, row);
            let apart = (now - was).abs();
            if apart < 4.0 * between {
                0.5 * (now + was) + between + apart * apart / (16.0 * between)
            } else {
                now.max(was)
            }
        });
        before = Some((now, cell));
        if !(march.periodic() || y > -CELL) {
            all.push(None);
            continue;
        }
        all.push(Some(ShadowStep { over_plane, top, raised }));
        top = Some(top.map_or(raised, |top: f64| top.max(raised)));
    }
    all
}

/// How far the surface is above a bilinear one half-way from the step before `row`, where the line was in `cell`, and on the
/// cells beside it.
fn between(march: &March, cell: i32, row: i32) -> f64 {
    let slope = |lane: i32, row: i32| {
        f64::from(march.height_at(lane + 1, row)) - f64::from(march.height_at(lane, row))
    };
    let (mut turn, mut twist) = (0.0_f64, 0.0_f64);
    for lane in cell - 1..=cell + 2 {
        let same = slope(lane, row - 1) - slope(lane, row);
        turn = turn.max(same);
        twist = twist.max(if march.split_along() { -same } else { same });
        if lane < cell + 2 {
            turn = turn.max(slope(lane, row - 1) - slope(lane + 1, row));
        }
    }
    let shear = f64::from(march.azimuth.shear) / f64::from(CELL);
    0.25 * (shear * turn + twist)
}

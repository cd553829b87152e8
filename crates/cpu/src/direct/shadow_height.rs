//! The shadow heights of a sun at each grid point.

use std::f64::consts::PI;

use super::shadow_sweep::lines_of;
use crate::shared::sweep::{CELL_SHIFT, March};
use ridgelight::plan::azimuths::CELL;

/// Shadow heights of a sun at a grid point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadowHeight {
    /// From this height on the whole sun is visible, metres over the field's base.
    pub lit_above: f64,
    /// Below this height none of the sun is visible.
    pub dark_below: f64,
    /// Height of the ground.
    pub ground: f64,
}

impl ShadowHeight {
    /// Visible share of the disc at the ground: the segment above a chord at the hidden part of the disc's height.
    pub fn share(&self) -> f64 {
        let penumbra = (self.lit_above - self.dark_below).max(1e-30);
        let hidden = ((self.lit_above - self.ground) / penumbra).clamp(0.0, 1.0);
        let u = 1.0 - 2.0 * hidden;
        0.5 + (u * (1.0 - u * u).sqrt() + u.asin()) / PI
    }
}

/// Shadow heights of all grid points, row-major. `rise` is the increase in height of the ray per march step, for the sun's lower and upper
/// edge. `outer` gives shadow heights of the outer field, over this field's base, at any column and row of this field.
pub fn shadow_heights(
    march: &March,
    rise: [f64; 2],
    outer: Option<&dyn Fn([f64; 2]) -> [f64; 2]>,
) -> Vec<ShadowHeight> {
    let (lines, first) = lines_of(march, march.steps);
    let all: Vec<_> =
        (0..lines).map(|line| shade_of_line(march, first + line * CELL, rise, outer)).collect();
    let (cols, rows) = (march.heights.cols as i32, march.heights.rows as i32);
    let grid_points = (0..rows).flat_map(|row| (0..cols).map(move |col| (col, row)));
    grid_points
        .map(|(col, row)| {
            let (lane, step) = march.of_grid_point(col, row);
            let from_first = lane * CELL - first - step * march.azimuth.shear;
            let line = from_first.div_euclid(CELL) as usize;
            let t = f64::from(from_first.rem_euclid(CELL)) / f64::from(CELL);
            let at = |line: usize| all[line][step as usize].expect("beside a grid point");
            let before = at(line);
            let after = if t > 0.0 { at(line + 1) } else { before };
            let [lit_above, dark_below] = [0, 1].map(|i| (1.0 - t) * before[i] + t * after[i]);
            ShadowHeight { lit_above, dark_below, ground: march.height_at(lane, step).into() }
        })
        .collect()
}

/// The shadow heights of a line at each step; none where the line is a cell or more outside the field.
fn shade_of_line(
    march: &March,
    y: i32,
    rise: [f64; 2],
    outer: Option<&dyn Fn([f64; 2]) -> [f64; 2]>,
) -> Vec<Option<[f64; 2]>> {
    // Heights and steps of the ground that shades the line.
    let mut tops: Option<[(f64, i32); 2]> = None;
    (0..march.steps)
        .map(|step| {
            let y = y + step * march.azimuth.shear;
            if y <= -CELL || y >= march.lanes * CELL {
                return None;
            }
            let f = f64::from(y & (CELL - 1)) / f64::from(CELL);
            let h = |lane: i32| f64::from(march.height_at(lane, step));
            let here = (1.0 - f) * h(y >> CELL_SHIFT) + f * h((y >> CELL_SHIFT) + 1);
            let begin = || {
                let lane = (f64::from(y) / f64::from(CELL)).clamp(0.0, f64::from(march.lanes - 1));
                let beyond = outer.map(|outer| outer(place(march, lane, step)));
                [0, 1].map(|i| {
                    let beyond = beyond.map_or(here, |b| b[i] + rise[i]);
                    (beyond.max(here), step - 1)
                })
            };
            let before = tops.unwrap_or_else(begin);
            let shade = [0, 1].map(|i| before[i].0 - f64::from(step - before[i].1) * rise[i]);
            tops = Some([0, 1].map(|i| if here >= shade[i] { (here, step) } else { before[i] }));
            Some(shade)
        })
        .collect()
}

/// Column and row of a lane and a step.
fn place(march: &March, lane: f64, step: i32) -> [f64; 2] {
    // The flips of whole lanes, for fractions too.
    let low = f64::from(march.lane_position(0));
    let lane = if low > 0.0 { low - lane } else { lane };
    let step = f64::from(march.march_position(step));
    if march.azimuth.marches_rows() { [lane, step] } else { [step, lane] }
}

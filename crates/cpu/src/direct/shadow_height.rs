//! The shadow heights of a sun at each grid point.

use std::f64::consts::{FRAC_PI_2, PI};

use super::shadow_sweep::lines_of;
use crate::shared::sweep::{CELL_SHIFT, March};
use ridgelight::plan::azimuths::CELL;

/// A sun above one azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Tangents of the elevations of its lower and its upper edge; the second very large where that is the zenith or beyond.
    pub edges: [f64; 2],
    /// Angular diameter; 0 for a point.
    pub diameter_rad: f64,
    /// World length of a march step.
    pub step_m: f64,
}

impl Disc {
    /// Increase in height of the ray per march step, for each edge.
    pub fn rise_m(&self) -> [f64; 2] {
        self.edges.map(|edge| edge * self.step_m)
    }
}

/// Shadow heights of a sun at a grid point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ShadowHeight {
    /// From this height on the whole sun is visible, metres over the field's base; and below the second one none of it.
    pub shade_m: [f64; 2],
    /// March steps to the ground that shades from the lower edge, and to that which shades from the upper edge.
    pub ahead: [f64; 2],
    /// Height of the ground.
    pub ground_m: f64,
}

impl ShadowHeight {
    /// Distance from the first height down to that at which its occluder hides the whole sun, metres.
    pub fn penumbra_m(&self, disc: &Disc) -> f64 {
        let [lower, upper] = disc.rise_m();
        self.ahead[0] * (upper - lower)
    }

    /// Visible share of the disc at the ground: the segment above a chord at the higher of the two occluders' elevations.
    pub fn share(&self, disc: &Disc) -> f64 {
        let Disc { edges: [low, high], diameter_rad, step_m } = *disc;
        let over = |i: usize| (self.shade_m[i] - self.ground_m) / (self.ahead[i] * step_m);
        if diameter_rad == 0.0 {
            return f64::from(u8::from(self.ground_m >= self.shade_m[0]));
        }
        let from_low = ((low + over(0)).atan() - low.atan()) / diameter_rad;
        let of_high = (high.atan() - (high + over(1)).atan()) / diameter_rad;
        let is_zenith = high.atan() > FRAC_PI_2 - 1e-8;
        let hidden = if is_zenith { from_low } else { from_low.max(1.0 - of_high) };
        segment(hidden)
    }
}

/// Share of a disc above a chord that cuts off `hidden` of its height.
pub fn segment(hidden: f64) -> f64 {
    let u = 1.0 - 2.0 * hidden.clamp(0.0, 1.0);
    0.5 + (u * (1.0 - u * u).sqrt() + u.asin()) / PI
}

/// lit_above and penumbra of the outer field, over this field's base, at any column and row of this field.
pub type Outer<'a> = &'a dyn Fn([f64; 2]) -> [f64; 2];

/// Shadow heights of all grid points, row-major.
pub fn shadow_heights(march: &March, disc: &Disc, outer: Option<Outer>) -> Vec<ShadowHeight> {
    let (lines, first) = lines_of(march, march.steps);
    let all: Vec<_> =
        (0..lines).map(|line| shade_of_line(march, first + line * CELL, disc, outer)).collect();
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
            let [shade_m, ahead] =
                [0, 1].map(|k| [0, 1].map(|edge| (1.0 - t) * before[k][edge] + t * after[k][edge]));
            ShadowHeight { shade_m, ahead, ground_m: march.height_at(lane, step).into() }
        })
        .collect()
}

/// The shadow heights of a line at each step, and how many steps away the ground is that decides each; none where the line is a cell
/// or more outside the field.
fn shade_of_line(
    march: &March,
    y: i32,
    disc: &Disc,
    outer: Option<Outer>,
) -> Vec<Option<[[f64; 2]; 2]>> {
    let rise = disc.rise_m();
    // Heights and steps of the ground that shades the line.
    let mut tops: Option<[(f64, f64); 2]> = None;
    (0..march.steps)
        .map(|step| {
            let y = y + step * march.azimuth.shear;
            if y <= -CELL || y >= march.lanes * CELL {
                return None;
            }
            let f = f64::from(y & (CELL - 1)) / f64::from(CELL);
            let h = |lane: i32| f64::from(march.height_at(lane, step));
            let here = (1.0 - f) * h(y >> CELL_SHIFT) + f * h((y >> CELL_SHIFT) + 1);
            let step_at = f64::from(step);
            let begin = || {
                let level = [(here, step_at - 1.0); 2];
                let Some(outer) = outer else { return level };
                let place = place(march, f64::from(y) / f64::from(CELL), step);
                let [lit_above, penumbra] = outer(place);
                let ahead = (penumbra / (rise[1] - rise[0]).max(1e-30)).max(1.0);
                let shade = [lit_above, lit_above - penumbra];
                [0, 1].map(|i| match shade[i] > here - rise[i] {
                    true => (shade[i] + ahead * rise[i], step_at - ahead),
                    false => level[i],
                })
            };
            let before = tops.unwrap_or_else(begin);
            let ahead = before.map(|top| step_at - top.1);
            let shade = [0, 1].map(|i| before[i].0 - ahead[i] * rise[i]);
            tops = Some([0, 1].map(|i| if here >= shade[i] { (here, step_at) } else { before[i] }));
            Some([shade, ahead])
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

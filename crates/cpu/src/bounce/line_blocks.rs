//! Blocks of swept lines: the largest height of each, and the mean radiance of its ground.

use crate::Rgb;
use crate::shared::sweep::{CELL_SHIFT, March, PER_CELL};
use glam::DVec3;
use ridgelight::plan::azimuths::CELL;

/// Up to this distance a walk reads every step; with lines more than a cell apart, to as many times that.
pub fn near_steps(line_shift: u32) -> i32 {
    8 << line_shift.saturating_sub(CELL_SHIFT)
}

/// log2 of the longest block.
pub const MOST_LEVEL: u32 = 8;

/// Every piece has this rise in addition, over world distance.
const FLAT_RISE: f64 = 1e-3;

/// A block of a line.
#[derive(Clone, Copy, Debug)]
pub struct Block {
    /// Its largest height, metres; the place nearest to the grid point where it occurs more than once.
    pub top_m: f32,
    /// Steps from its end towards the grid point to there, from 1.
    pub top_steps: i32,
    /// Mean radiance of its ground, weighted by its rise above all nearer ground of the block.
    pub light: DVec3,
    /// Largest less smallest radiance.
    pub spread: DVec3,
    /// The largest radiance.
    pub brightest: Rgb,
}

/// A field in the frame of one azimuth, and the radiance that leaves it.
#[derive(Clone, Copy)]
pub struct Ground<'a> {
    /// The field.
    pub march: March<'a>,
    /// Exit radiance of every grid point.
    pub exit: &'a [[f32; 3]],
}

impl Ground<'_> {
    /// Exit radiance of a grid point.
    pub fn leaving(&self, lane: i32, step: i32) -> DVec3 {
        let [col, row] = self.march.grid_point(lane, step);
        let texel = self.exit[row as usize * self.march.heights.cols + col as usize];
        DVec3::from_array(texel.map(f64::from))
    }

    /// The same between two lanes.
    pub fn light_at(&self, y: i32, step: i32) -> DVec3 {
        let t = f64::from((y & (CELL - 1)) as f32 * PER_CELL);
        let cell = y >> CELL_SHIFT;
        self.leaving(cell, step).lerp(self.leaving(cell + 1, step), t)
    }

    /// The block of 2^level steps of a line that ends at a lane position and a step. Beside the field the edge
    /// goes on.
    pub fn line_block(&self, (y, step): (i32, i32), level: u32) -> Block {
        let point = |back: i32| {
            let y = y - back * self.march.azimuth.shear;
            let y =
                if self.march.periodic() { y } else { y.clamp(0, (self.march.lanes - 1) * CELL) };
            (self.march.line_height(y, step - back), self.light_at(y, step - back))
        };
        let points: Vec<(f32, DVec3)> = (0..=1 << level).map(point).collect();
        let (_, first) = points[0];
        let ends = points
            .iter()
            .fold((first, first), |(low, high), (_, light)| (low.min(*light), high.max(*light)));
        let flat_m = FLAT_RISE * f64::from(self.march.azimuth.step_m);
        let Part { top_m, top_steps, light } = part(&points, flat_m);
        let (low, high) = ends;
        let brightest = low.abs().max(high.abs()).to_array();
        Block { top_m, top_steps, light, spread: high - low, brightest }
    }
}

/// A block without the extremes of its radiance.
struct Part {
    top_m: f32,
    top_steps: i32,
    light: DVec3,
}

/// Of 2^n + 1 points, from near to far. The nearest one is the block's before.
fn part(points: &[(f32, DVec3)], flat_m: f64) -> Part {
    if let [near, far] = points {
        return Part { top_m: far.0, top_steps: 1, light: 0.5 * (near.1 + far.1) };
    }
    let middle = points.len() / 2;
    let [near, far] = [&points[..=middle], &points[middle..]].map(|half| part(half, flat_m));
    let begin_m = points[0].0;
    let over_m = near.top_m.max(begin_m);
    let flat_m = flat_m * middle as f64;
    let near_weight = f64::from(over_m) - f64::from(begin_m) + flat_m;
    let far_weight = (f64::from(far.top_m) - f64::from(over_m)).max(0.0) + flat_m;
    let light = near.light.lerp(far.light, far_weight / (near_weight + far_weight));
    match far.top_m > near.top_m {
        true => Part { top_steps: far.top_steps + middle as i32, light, ..far },
        false => Part { light, ..near },
    }
}

/// The level of the block that begins `at` steps from a grid point, at step `end` of the march. Its length divides `end`. It is at
/// most a quarter of `at` and at most what is left up to `limit`, but at least 2 steps.
pub fn level_at(at: i32, end: i32, limit: i32) -> u32 {
    let longest = (at.ilog2() - 2).min((limit - at).ilog2());
    end.trailing_zeros().min(longest).clamp(1, MOST_LEVEL)
}

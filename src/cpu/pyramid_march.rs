//! Horizons from a height pyramid: one sample a level along each azimuth, the largest value of the
//! cubic B-spline over their angles (Nowrouzezahrai & Snyder 2009, eq. 14-17).

use super::lattice::Lattice;
use super::shared::levels::LevelTexels;
use super::shared::surface::{HAIR, surface_rise};
use super::shared::sweep::{Heights, March, NO_SLOPE, PER_CELL, wrapped};
use crate::plan::azimuths::{Azimuth, FLIPS_LANES, FLIPS_MARCH};
use crate::plan::pyramid::Pyramid;

/// The levels beside the field itself, as they are stored.
#[derive(Clone, Copy, Debug)]
pub enum Stored<'a> {
    /// At every sample of the field, level after level.
    Stack(&'a [f32]),
    /// At their own texels.
    Levels(&'a [f32]),
}

/// The last four angles, the newest last, and the largest value of the spline so far.
///
/// Angles, not slopes: these have no bound, and one of them would outweigh the others. Before the
/// first and after the last, angles go on as they are, so that the spline begins and ends with them.
#[derive(Clone, Copy, Debug)]
struct Blocked {
    angles: [f32; 4],
    highest: f32,
}

impl Blocked {
    fn first(angle: f32) -> Self {
        Self { angles: [angle; 4], highest: angle }
    }

    fn by(self, angle: f32) -> Self {
        let [_, a, b, c] = self.angles;
        let knot = (b + 4.0 * c + angle) * (1.0 / 6.0);
        let middle = ((a + angle) + 23.0 * (b + c)) * (1.0 / 48.0);
        Self { angles: [a, b, c, angle], highest: self.highest.max(knot.max(middle)) }
    }
}

/// A march over a pyramid.
struct PyramidMarch<'a> {
    march: March<'a>,
    pyramid: &'a Pyramid,
    stored: Stored<'a>,
}

impl PyramidMarch<'_> {
    /// Lanes that lie between a sample and the march `back` steps along.
    fn aside(&self, back: f32) -> f32 {
        back * (self.march.azimuth.shear as f32 * PER_CELL)
    }

    /// Rise of the surface over the sample itself.
    fn surface_rise_at(&self, lane: i32, step: i32, back: f32) -> f32 {
        let aside = self.aside(back);
        let (whole, lower) = (back.ceil(), aside.ceil());
        let (cell, at) = (lane - lower as i32, step - whole as i32);
        let h = |lane, step| self.march.height_at(lane, step);
        let corners = [h(cell, at), h(cell, at + 1), h(cell + 1, at), h(cell + 1, at + 1)];
        let own = h(lane, step);
        surface_rise(corners, own, whole - back, lower - aside, self.march.split_along())
    }

    /// Column and row `back` steps along.
    fn place_at(&self, lane: i32, step: i32, back: f32) -> [f32; 2] {
        let flags = self.march.azimuth.flags;
        let along = |from: i32, by: f32, flips: bool| {
            if flips { from as f32 + by } else { from as f32 - by }
        };
        let (lane, step) = (self.march.lane_position(lane), self.march.march_position(step));
        let lane = along(lane, self.aside(back), flags & FLIPS_LANES != 0);
        let step = along(step, back, flags & FLIPS_MARCH != 0);
        if self.march.azimuth.marches_rows() { [lane, step] } else { [step, lane] }
    }

    fn level_height(&self, number: u32, place: [f32; 2]) -> f32 {
        let [cols, rows] = self.pyramid.size.map(|n| n as i32);
        match self.stored {
            Stored::Levels(texels) => {
                let level = self.pyramid.level(number);
                let at = [place[0] * level.per_sample[0], place[1] * level.per_sample[1]];
                LevelTexels { pyramid: self.pyramid, texels }.spline_at(&level, at)
            }
            Stored::Stack(stack) => {
                let inside = |i: i32, n: i32| {
                    if self.pyramid.periodic { wrapped(i, n) } else { i.clamp(0, n - 1) }
                };
                let texel = |x: i32, y: i32| {
                    let row = (number as i32 - 1) * rows + inside(y, rows);
                    stack[(row * cols + inside(x, cols)) as usize]
                };
                let cell = place.map(f32::floor);
                let t = [place[0] - cell[0], place[1] - cell[1]];
                let [x, y] = cell.map(|c| c as i32);
                let row = |y: i32| texel(x, y) + t[0] * (texel(x + 1, y) - texel(x, y));
                row(y) + t[1] * (row(y + 1) - row(y))
            }
        }
    }

    /// Slope of the horizon of a sample.
    fn slope(&self, lane: i32, step: i32, warm_up: i32) -> f32 {
        let azimuth = &self.march.azimuth;
        let across = lane as f32 / (azimuth.shear.max(1) as f32 * PER_CELL);
        let all = (step + warm_up) as f32;
        let bounded = !self.march.periodic() && azimuth.shear > 0;
        let reach = if bounded { all.min(across) } else { all };
        if reach <= 0.0 {
            return NO_SLOPE;
        }
        let here = self.place_at(lane, step, 0.0);
        let (mut back, mut blocked): (f32, Option<Blocked>) = (1.0, None);
        for i in 0.. {
            let is_last = back >= reach * (1.0 - HAIR);
            let at = if is_last { reach } else { back };
            let rise = if i < self.pyramid.fine_samples() {
                self.surface_rise_at(lane, step, at)
            } else {
                let number = (i + 1 - self.pyramid.fine_samples()).min(self.pyramid.levels());
                self.level_height(number, self.place_at(lane, step, at))
                    - self.level_height(number, here)
            };
            let angle = (rise / (at * azimuth.step_m)).atan();
            blocked = Some(blocked.map_or(Blocked::first(angle), |b| b.by(angle)));
            if is_last {
                break;
            }
            back *= self.pyramid.growth();
        }
        let blocked = blocked.expect("one sample at least");
        let last = blocked.angles[3];
        blocked.by(last).by(last).highest.tan()
    }
}

/// Marches every sample in one azimuth: `slopes` of its layer, one slot a lane.
///
/// # Panics
/// When the lattice is not one slot a lane, or levels lack texels.
pub fn pyramid_march(
    heights: Heights,
    azimuth: &Azimuth,
    pyramid: &Pyramid,
    stored: Stored,
    warm_up: i32,
    lattice: &mut Lattice,
) {
    let march = PyramidMarch { march: March::new(heights, azimuth), pyramid, stored };
    for step in 0..march.march.steps {
        for lane in 0..march.march.lanes {
            let texel = lattice.texel(lane, march.march.march_position(step), azimuth.layer);
            lattice.slopes[texel] = march.slope(lane, step, warm_up);
        }
    }
}

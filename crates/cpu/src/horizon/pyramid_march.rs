//! Horizons from a height pyramid: one lookup per level along each azimuth, at distances that grow by 2^(1/k) and are
//! rounded to whole march steps; the largest value of the cubic B-spline over their angles (Nowrouzezahrai & Snyder
//! 2009, eq. 14-17).

use crate::lattice::Lattice;
use crate::shared::fuse::Found;
use crate::shared::levels::LevelTexels;
use crate::shared::sweep::{CELL_SHIFT, Heights, March, NO_SLOPE, PER_CELL, inside};
use ridgelight::plan::azimuths::{Azimuth, CELL, FLIPS_LANES};
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::scene::HeightField;

/// Storage of the levels besides the field itself.
#[derive(Clone, Copy, Debug)]
pub enum Stored<'a> {
    /// At every grid point of the field, level after level.
    Stack(&'a [f32]),
    /// At their own texels.
    Levels(&'a [f32]),
}

/// The last four angles, the newest last, and the largest value of the spline so far.
///
/// Angles, because slopes have no bound and a single one could outweigh the others. The first and last angles repeat,
/// so that the spline begins and ends with them.
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
#[derive(Clone, Copy, Debug)]
pub struct PyramidMarch<'a> {
    /// Over the field itself.
    pub march: March<'a>,
    /// Its levels.
    pub pyramid: &'a Pyramid,
    /// Their heights.
    pub stored: Stored<'a>,
}

impl PyramidMarch<'_> {
    /// Height of level `number` where a line crosses a march step, `f` past the lane `cell`.
    fn height(&self, number: u32, (cell, f): (i32, f32), step: i32) -> f32 {
        let march = &self.march;
        let grid_points = march.heights.heights_m.len();
        let heights = match self.stored {
            Stored::Levels(texels) if number > 0 => {
                let flips = march.azimuth.flags & FLIPS_LANES != 0;
                let from_end = (march.lanes - 1 - cell) as f32 - f;
                let lane = if flips { from_end } else { cell as f32 + f };
                let step = march.march_position(step) as f32;
                let place = if march.azimuth.marches_rows() { [lane, step] } else { [step, lane] };
                return LevelTexels { pyramid: self.pyramid, texels }.spline_at(number, place);
            }
            Stored::Stack(stack) if number > 0 => &stack[(number as usize - 1) * grid_points..],
            _ => march.heights.heights_m,
        };
        let texel = |lane: i32| {
            let [col, row] = march.grid_point(lane, step);
            heights[row as usize * march.heights.cols + col as usize]
        };
        let h = texel(cell);
        h + f * (texel(cell + 1) - h)
    }

    /// Rise of a level from a grid point to `whole` steps along.
    fn rise_to(&self, number: u32, lane: i32, step: i32, whole: i32) -> f32 {
        let y = lane * CELL - whole * self.march.azimuth.shear;
        let line = (y >> CELL_SHIFT, (y & (CELL - 1)) as f32 * PER_CELL);
        self.height(number, line, step - whole) - self.height(number, (lane, 0.0), step)
    }

    /// Slope of the horizon of a grid point; [`NO_SLOPE`] where the march leaves the field at once.
    pub fn slope(&self, lane: i32, step: i32, warm_up: i32) -> f32 {
        let azimuth = &self.march.azimuth;
        let across = lane * CELL / azimuth.shear.max(1);
        let all = step + warm_up;
        let bounded = !self.pyramid.periodic && azimuth.shear > 0;
        let reach = if bounded { all.min(across) } else { all };
        if reach <= 0 {
            return NO_SLOPE;
        }
        let (mut back, mut before, mut angle) = (1.0_f32, 0, 0.0);
        let mut blocked: Option<Blocked> = None;
        for i in 1.. {
            let whole = (back + 0.5) as i32;
            if whole > before {
                let at = whole.min(reach);
                let number = (i - self.pyramid.fine_samples() as i32).max(0) as u32;
                let number = number.min(self.pyramid.levels());
                let rise = self.rise_to(number, lane, step, at);
                angle = (rise / (at as f32 * azimuth.step_m)).atan();
            }
            blocked = Some(blocked.map_or(Blocked::first(angle), |b| b.by(angle)));
            if whole >= reach {
                break;
            }
            before = whole;
            back *= self.pyramid.growth();
        }
        let blocked = blocked.expect("one sample at least");
        let last = blocked.angles[3];
        blocked.by(last).by(last).highest.tan()
    }
}

/// Marches from every grid point in one azimuth: `slopes` of its layer, one slot a lane.
pub fn pyramid_march(
    heights: Heights,
    azimuth: &Azimuth,
    pyramid: &Pyramid,
    stored: Stored,
    warm_up: i32,
    lattice: &mut Lattice,
) {
    let march = PyramidMarch { march: March::new(heights, azimuth), pyramid, stored };
    lattice.fill(&march.march, |lane, step| Found {
        slope: march.slope(lane, step, warm_up),
        steps: 0.0,
    });
}

/// Heights of a field and its pyramid's levels on the field's grid lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LevelHeights<'a> {
    pub(crate) field: &'a HeightField,
    pub(crate) pyramid: &'a Pyramid,
    pub(crate) stored: Stored<'a>,
}

impl LevelHeights<'_> {
    /// The two grid points around a place on a column (`by_x`) or on a row, and the fraction between.
    pub(crate) fn beside(&self, by_x: bool, [x, y]: [f64; 2]) -> ([usize; 2], f64) {
        let [cols, rows] = self.pyramid.size.map(|n| n as i32);
        let periodic = self.pyramid.periodic;
        let at = |x: i32, y: i32| {
            (inside(y, rows, periodic) * cols + inside(x, cols, periodic)) as usize
        };
        if by_x {
            let (x, low) = (x.round() as i32, y.floor());
            ([at(x, low as i32), at(x, low as i32 + 1)], y - low)
        } else {
            let (y, low) = (y.round() as i32, x.floor());
            ([at(low as i32, y), at(low as i32 + 1, y)], x - low)
        }
    }

    /// Height of a level there.
    pub(crate) fn height(&self, level: u32, by_x: bool, place: [f64; 2]) -> f64 {
        let grid_points = self.field.heights_m().len();
        let heights = match self.stored {
            Stored::Levels(texels) if level > 0 => {
                let of = LevelTexels { pyramid: self.pyramid, texels };
                return of.spline_at(level, place.map(|p| p as f32)).into();
            }
            Stored::Stack(stack) if level > 0 => &stack[(level as usize - 1) * grid_points..],
            _ => self.field.heights_m(),
        };
        let (two, t) = self.beside(by_x, place);
        let [low, high] = two.map(|i| f64::from(heights[i]));
        low + t * (high - low)
    }

    /// `within.glsl`: the horizon of a pyramid up to a distance, in any direction.
    ///
    /// Slope of the lowest visible direction up to a distance; -∞ where the march leaves the field at once.
    ///
    /// The spline over the angles is evaluated up to the distance. It includes the two lookups beyond that it depends
    /// on there (NS09 eq. 14-17; the thesis, eq. 4.24, 4.25).
    pub(crate) fn slope(&self, [row, col]: [usize; 2], azimuth_rad: f64, within_m: f64) -> f64 {
        let [cell_x, cell_y] = self.field.cell_m();
        let (sin, cos) = azimuth_rad.sin_cos();
        let direction = [cos / cell_x, -sin / cell_y];
        let scale = direction[0].abs().max(direction[1].abs());
        let advance = direction.map(|d| d / scale);
        let here = [col as f64, row as f64];
        let last = self.pyramid.size.map(|n| f64::from(n) - 1.0);
        let room = |i: usize| {
            let to = if advance[i] > 0.0 { last[i] - here[i] } else { here[i] };
            if advance[i].abs() < 1e-8 { 1e8 } else { to / advance[i].abs() }
        };
        // Slightly more, so that rounding does not leave the field a step early.
        let inside = room(0).min(room(1)) + 1e-4;
        let reach = if self.pyramid.periodic { 1e8 } else { inside } as i32;
        if reach <= 0 {
            return f64::NEG_INFINITY;
        }
        let by_x = advance[0].abs() > advance[1].abs();
        let end = f64::from(self.pyramid.level_step) * (within_m * scale).max(1e-6).log2();
        let (mut back, mut before, mut angle) = (1.0_f32, 0, 0.0);
        let mut blocked = BlockedWithin { angles: [0.0; 4], taken: 0, end, highest: 0.0 };
        for i in 0..self.pyramid.samples().max(self.pyramid.fine_samples()) {
            let whole = (back + 0.5) as i32;
            if whole > before {
                let at = f64::from(whole.min(reach));
                let number = (i + 1).saturating_sub(self.pyramid.fine_samples());
                let number = number.min(self.pyramid.levels());
                let place = [0, 1].map(|k| here[k] + at * advance[k]);
                let rise = self.height(number, by_x, place) - self.height(number, by_x, here);
                angle = (rise * scale / at).atan();
            }
            blocked.take(angle);
            if whole >= reach || f64::from(i) >= end.floor() + 2.0 {
                break;
            }
            before = whole;
            back *= self.pyramid.growth();
        }
        blocked.take(angle);
        blocked.take(angle);
        blocked.highest.tan()
    }
}

/// The last four angles, the newest last, their count, and the largest value of their spline up to its end, where it
/// is evaluated too.
#[derive(Clone, Copy, Debug)]
struct BlockedWithin {
    angles: [f64; 4],
    taken: i32,
    end: f64,
    highest: f64,
}

impl BlockedWithin {
    fn take(&mut self, angle: f64) {
        if self.taken == 0 {
            (self.angles, self.highest) = ([angle; 4], angle);
        } else {
            self.angles.rotate_left(1);
            self.angles[3] = angle;
        }
        let [a, b, c, d] = self.angles;
        let newest = f64::from(self.taken);
        let t = self.end - (newest - 2.0);
        let mut look = |is_there: bool, value: f64| {
            self.highest = if is_there { self.highest.max(value) } else { self.highest };
        };
        look(newest - 1.0 <= self.end, (b + 4.0 * c + d) / 6.0);
        look(newest - 1.5 <= self.end, (a + d + 23.0 * (b + c)) / 48.0);
        let inner = |v: f64| (3.0 * v - 6.0) * v * v + 4.0;
        let s = 1.0 - t;
        let at_end = (s.powi(3) * a + inner(t) * b + inner(s) * c + t.powi(3) * d) / 6.0;
        look((0.0..1.0).contains(&t), at_end);
        self.taken += 1;
    }
}

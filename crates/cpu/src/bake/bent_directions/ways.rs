//! Distance of a visible point, in f64; on a repeating field, its repetition.
//!
//! Only the grid point nearest to the hit in plan is stored, and a repeating field contains it again and again, in
//! rows and columns of repetitions. A ray passes many of them, high above or beside the one that it hits, and may
//! cross a hundred repetitions: from a ridge, falling by s per metre, it continues for up to relief / s. The hit lies
//! within half a cell of the grid point in its first repetition whose surface, six flat triangles around the grid
//! point, the ray touches.

use super::MAX_TURN_RAD;
use glam::{DVec2, DVec3};
use ridgelight::scene::{Border, Curvature, HeightField};

/// Search range, in columns or rows along the faster axis of the direction: the reach of rays (`walk.glsl`).
pub use ridgelight::scene::REACH_CELLS;
/// Half the side of the square around a grid point that contains its hits, in cells, plus a margin: any hit outside
/// it belongs to another grid point.
pub const HALF_SIDE: f64 = 0.51;
/// Relative tolerance of a hit, against the heights that are compared and the surface's rise along the way: 128
/// roundings, more than the combined error of the rays and this code (`crossing_elevation` and `over` of the
/// tolerances).
pub const GRAZE: f64 = 1.0 / (1 << 17) as f64;

/// One repetition of a grid point beside a ray.
#[derive(Clone, Copy, Debug)]
pub struct Way {
    /// Horizontal distance along the ray, m. The hit lies within half a cell of the grid point in plan, except on a
    /// steep wall, so the moved direction has an error of at most half a cell's turn at any slope. Infinite where the
    /// base has turned by [`MAX_TURN_RAD`] before.
    pub away_m: f64,
    /// Distance, m; 0 if infinitely far.
    pub to_m: f64,
    /// Smallest height of the ray over the surface around it, m; negative where it passes through.
    pub over_m: f64,
    /// Largest such height that counts as a hit, m.
    pub graze_m: f64,
    /// Cells along the ray's faster axis.
    pub cells: f64,
    /// Largest rise or fall of the surface from the grid point to a neighbour, m.
    pub relief_m: f64,
    /// Rise or fall of the ray up to half a cell past the grid point, m.
    pub climb_m: f64,
}

/// The repetitions of a grid point that a ray may have hit, nearest first.
pub struct Ways {
    /// The grid point beside the ray, columns and rows: along the faster axis first.
    gap: [i64; 2],
    size: [i64; 2],
    cell_m: [f64; 2],
    by_rows: bool,
    e: DVec3,
    /// Heights relative to the grid point, of its neighbours along the faster and the slower axis, back along either,
    /// along both and back along both.
    around: [f64; 6],
    rise_m: f64,
    is_periodic: bool,
    /// Cells along the faster and the slower axis, towards east or south, per cell of the faster.
    ahead: f64,
    aside: f64,
    climb_m: f64,
    /// Repetitions tested along the faster axis.
    turns: std::ops::RangeInclusive<i64>,
    /// Whether there are more: the hit may lie beyond a right angle of the base.
    pub is_cut: bool,
}

impl Ways {
    /// For the grid point `there`, visible from `here` along e.
    pub fn of(
        (field, border): (&HeightField, Border),
        curvature: Curvature,
        [here, there]: [usize; 2],
        e: DVec3,
    ) -> Self {
        let (cols, rows) = (field.cols() as i64, field.rows() as i64);
        let [cell_x, cell_y] = field.cell_m();
        let is_periodic = border == Border::Periodic;
        let height = |at: i64| f64::from(field.heights_m()[at as usize]);
        let place = |at: usize| [at as i64 % cols, at as i64 / cols];
        let [[x, y], [to_x, to_y]] = [here, there].map(place);
        let pace = [e.x / cell_x, -e.y / cell_y];
        let by_rows = pace[1].abs() > pace[0].abs();
        let swap = |[a, b]: [i64; 2]| if by_rows { [b, a] } else { [a, b] };
        let neighbour = |to: [i64; 2]| {
            let [right, down] = swap(to);
            let at = (to_y + down).rem_euclid(rows) * cols + (to_x + right).rem_euclid(cols);
            height(at) - height(there as i64)
        };
        let around = [[1, 0], [0, 1], [-1, 0], [0, -1], [1, 1], [-1, -1]].map(neighbour);
        let rise_m = height(there as i64) - height(here as i64);
        let main = pace[0].abs().max(pace[1].abs()).max(1e-30);
        let [ahead, aside] = if by_rows { [pace[1], pace[0]] } else { pace }.map(|p| p / main);
        let [gap, size] = [[to_x - x, to_y - y], [cols, rows]].map(swap);
        let mut ways = Self {
            gap,
            size,
            cell_m: [cell_x, cell_y],
            by_rows,
            e,
            around,
            rise_m,
            is_periodic: is_periodic && e.truncate().length_squared() >= 1e-12,
            ahead,
            aside,
            climb_m: e.z / main,
            turns: 0..=0,
            is_cut: false,
        };
        if ways.is_periodic {
            let rate = (DVec2::from_array(curvature.per_m) * e.truncate()).length();
            ways.search(MAX_TURN_RAD / rate.max(1e-30) * main);
        }
        ways
    }

    /// Where rays are level with the surface around the grid point, limited to the base's turn.
    fn search(&mut self, turned_cells: f64) {
        let [size, first] = [self.size[0], self.first().abs()].map(|n| n as f64);
        let level = |rise: f64| {
            let climb = if self.climb_m.abs() < 1e-30 {
                1e-30_f64.copysign(self.climb_m)
            } else {
                self.climb_m
            };
            (self.rise_m + rise) / climb
        };
        let [a, b] = [f64::min, f64::max].map(|end| level(self.around.into_iter().fold(0.0, end)));
        // One more cell for half a square and roundings.
        let turn = |cells: f64| {
            ((cells.clamp(-2.0, f64::from(REACH_CELLS)) - first) / size).floor() as i64
        };
        let (from, to) = (turn(a.min(b) - 1.0).max(0), turn(a.max(b) + 1.0).max(0));
        let last = turn(turned_cells + 1.0).max(0);
        self.is_cut = to > last;
        self.turns = from..=to.min(last);
    }

    /// Cells to the nearest repetition ahead, negative towards west or north.
    fn first(&self) -> i64 {
        let [gap, size] = [self.gap[0], self.size[0]];
        if self.ahead > 0.0 { gap.rem_euclid(size) } else { -(-gap).rem_euclid(size) }
    }

    /// All possible hits, nearest first; `half_side` as [`HALF_SIDE`]. On a field that does not repeat, the grid
    /// point itself.
    pub fn all(&self, half_side: f64) -> impl Iterator<Item = Way> + use<'_> {
        let turns = if self.is_periodic { self.turns.clone() } else { 0..=0 };
        turns.flat_map(move |k| self.beside(k).into_iter().flatten()).filter_map(move |gaps| {
            match self.is_periodic {
                true => self.way(gaps, half_side),
                false => Some(self.whole(gaps)),
            }
        })
    }

    /// The first hit; where roundings leave none, the one that the ray passes nearest.
    pub fn met(&self) -> Way {
        let mut nearest = None::<Way>;
        for way in self.all(HALF_SIDE) {
            if way.over_m <= way.graze_m {
                return way;
            }
            if nearest.is_none_or(|best| way.over_m < best.over_m) {
                nearest = Some(way);
            }
        }
        if self.is_cut { self.far() } else { nearest.unwrap_or(self.whole(self.gap)) }
    }

    /// Hits so far away that the base has turned away.
    pub fn far(&self) -> Way {
        Way { away_m: f64::INFINITY, to_m: 0.0, ..self.whole(self.gap) }
    }

    /// The repetitions that a ray may pass at its k-th along the faster axis, in order.
    fn beside(&self, k: i64) -> [Option<[i64; 2]>; 2] {
        if !self.is_periodic {
            return [Some(self.gap), None];
        }
        let [size, other_size] = self.size;
        let main = self.first() + if self.ahead > 0.0 { k * size } else { -k * size };
        let turns = (main.abs() as f64 * self.aside - self.gap[1] as f64) / other_size as f64;
        let gaps = |turns: f64| Some([main, self.gap[1] + turns as i64 * other_size]);
        // Within the width of a column or row, a ray moves sideways by at most one. Only on fields two grid points
        // wide or less does it cross two.
        if other_size > 2 {
            return [gaps((turns + 0.5).floor()), None];
        }
        let [low, high] = [turns.floor(), turns.floor() + 1.0];
        if self.aside < 0.0 { [gaps(high), gaps(low)] } else { [gaps(low), gaps(high)] }
    }

    /// Where the ray crosses the square around a grid point.
    fn way(&self, gaps: [i64; 2], half_side: f64) -> Option<Way> {
        let [main, other] = gaps.map(|gap| gap as f64);
        let cells = main.abs();
        let beside = cells * self.aside - other;
        // Cells from the closest approach, along the faster axis; starts at the ray start.
        let (mut from, mut to) = ((-half_side).max(-cells), half_side);
        if self.aside == 0.0 {
            if beside.abs() > half_side {
                return None;
            }
        } else {
            let [a, b] = [(-half_side - beside) / self.aside, (half_side - beside) / self.aside];
            (from, to) = (from.max(a.min(b)), to.min(a.max(b)));
        }
        if from > to {
            return None;
        }
        let (start, advance) = (DVec2::new(0.0, beside), DVec2::new(self.ahead, self.aside));
        let over =
            |u: f64| (cells + u) * self.climb_m - self.rise_m - self.risen(start + u * advance);
        // Linear between grid lines and the diagonal.
        let kink = |at: f64, pace: f64| if pace == 0.0 { to } else { (-at / pace).clamp(from, to) };
        let mut least = over(to);
        // The ray starts on the grid point's own surface.
        if gaps != [0, 0] {
            let (p, a) = (start, advance);
            for u in [from, kink(p.x, a.x), kink(p.y, a.y), kink(p.x - p.y, a.x - a.y)] {
                least = least.min(over(u));
            }
        }
        Some(Way { over_m: least, ..self.whole(gaps) })
    }

    /// Height of the surface above the grid point, within a cell, along the faster and the slower axis: six triangles
    /// meet there.
    fn risen(&self, at: DVec2) -> f64 {
        let [x, y] = [at.x.abs(), at.y.abs()];
        let along = self.around[if at.x >= 0.0 { 0 } else { 2 }];
        let down = self.around[if at.y >= 0.0 { 1 } else { 3 }];
        if (at.x >= 0.0) != (at.y >= 0.0) {
            return x * along + y * down;
        }
        let (both, corner) = (x.min(y), self.around[if at.x >= 0.0 { 4 } else { 5 }]);
        both * corner + (x - both) * along + (y - both) * down
    }

    /// A repetition, hit at any heights.
    fn whole(&self, gaps: [i64; 2]) -> Way {
        let [x, y] = if self.by_rows { [gaps[1], gaps[0]] } else { gaps };
        let to = DVec3::new(x as f64 * self.cell_m[0], -y as f64 * self.cell_m[1], self.rise_m);
        let flat = self.e.truncate();
        let away_m = match flat.length_squared() {
            f if f < 1e-12 => 0.0,
            f => to.truncate().dot(flat).max(0.0) / f,
        };
        let cells = gaps[0].abs() as f64;
        let relief_m = self.around.iter().fold(0.0_f64, |most, rise| most.max(rise.abs()));
        let graze_m = GRAZE * (self.rise_m.abs() + relief_m * (1.0 + 2.0 * cells));
        let climb_m = (cells + HALF_SIDE) * self.climb_m.abs();
        Way { away_m, to_m: to.length(), over_m: 0.0, graze_m, cells, relief_m, climb_m }
    }
}

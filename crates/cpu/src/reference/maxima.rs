//! The oracle's elevations from fewer crossings: a ray skips pieces of the surface that cannot exceed the best slope so far.
//!
//! The slopes of a piece have an upper bound: the height of the highest grid point around the piece over the ray's start, divided by
//! the distance of the piece's nearer end. If that height is negative, the farther end counts. Blocks of heights hold the highest
//! grid points. A piece whose bound exceeds the best slope is halved, and the shortest pieces are visited crossing by crossing, as
//! [`Oracle`] visits all. The best slope is then the maximum of the same numbers, in whatever order, and has the same bits.
//!
//! The first piece visited is the one that held the horizon of the previous azimuth. The next horizon is usually near it, so a
//! steep slope is found early.

use super::oracle::{Family, Oracle, Ray, elevation_of_slope, grid_direction};

/// The length of the shortest piece, in cells along the axis that the ray crosses faster, is two to this power. Each further level of blocks
/// doubles it.
const FINEST: usize = 2;

/// How far, in cells, rounding may move a crossing out of its piece. Coordinates are below 2³² and have errors of a few
/// 2⁻⁵³ of that, 1e-6.
const SLACK_CELLS: f64 = 1e-5;

/// Rounding of slopes and of interpolated heights, relative to the largest |height|: an upper bound of some 1e-15.
const ROUNDING: f64 = 1e-12;

/// The highest grid points of blocks of a field that is not repeated.
#[derive(Debug)]
pub(crate) struct Maxima {
    levels: Vec<Level>,
    slack_m: f64,
}

/// Blocks that begin at every `side`-th row and column and are 2 · `side` + 2 rows and columns long: the grid points around
/// any piece of `side` cells lie in one of them.
///
/// If the least coordinate of a piece is x, its lowest neighbour is above x - 1, and its highest one is at most x + side + 1:
/// together with the lowest, at most side + 2 farther. The block of the lowest begins at most side - 1 before it.
#[derive(Debug)]
struct Level {
    size: [usize; 2],
    highest_m: Vec<f32>,
}

impl Maxima {
    /// Of an oracle's field. Reads each height a few times.
    pub(crate) fn of(oracle: &Oracle) -> Self {
        let field = oracle.field();
        let (size, heights) = ([field.rows(), field.cols()], field.heights_m());
        let mut levels = vec![Level::finest(size, heights)];
        while let Some(coarser) = levels.last().and_then(Level::coarser) {
            levels.push(coarser);
        }
        let largest_m = heights.iter().fold(0.0_f32, |largest, h| largest.max(h.abs()));
        Self { levels, slack_m: ROUNDING * f64::from(largest_m) }
    }

    /// [`Oracle::elevation_rad`] of the same field. `first_cells`, a multiple of 4, is where the piece begins that is visited
    /// first; it becomes that of the horizon. Any value gives the same elevation.
    pub(crate) fn elevation_rad(
        &self,
        oracle: &Oracle,
        [row, col]: [usize; 2],
        azimuth_rad: f64,
        first_cells: &mut usize,
    ) -> f64 {
        let direction = grid_direction(oracle.field(), azimuth_rad);
        let ray = oracle.ray([row, col], direction);
        let steepest =
            ray.map_or(f64::NEG_INFINITY, |ray| self.steepest(oracle, &ray, first_cells).0);
        elevation_of_slope(oracle.border(), steepest)
    }

    /// The largest slope along a ray, -∞ without a crossing, and the number of crossings that were visited.
    fn steepest(&self, oracle: &Oracle, ray: &Ray, first_cells: &mut usize) -> (f64, usize) {
        // In cells along the axis that the ray crosses faster.
        let cells_per_t = ray.cols_per_t.abs().max(ray.rows_per_t.abs());
        let (here, last) = ([ray.row, ray.col], <[f64; 2]>::from(oracle.last()));
        let per_cell = [ray.rows_per_t, ray.cols_per_t].map(|per_t| per_t / cells_per_t);
        let metres_per_cell = ray.metres_per_t / cells_per_t;
        let families = [0, 1, 2].map(|index| ray.family(index));
        let end = end_cells(here, per_cell, last);
        let most_m = oracle.highest_m - ray.own_m + self.slack_m;
        let (mut steepest, mut visited) = (f64::NEG_INFINITY, 0);
        let first = *first_cells;
        // All crossings of the shortest piece from a cell on.
        let mut visit = |start: usize, steepest: &mut f64| {
            let ends = [start, start + (1_usize << FINEST)].map(|cells| cells as f64);
            for family in families.iter().flatten() {
                let [first, until] = family.numbers(ends, cells_per_t);
                for j in first..until {
                    let crossing = ray.crossing(family, f64::from(j));
                    if !oracle.inside(crossing.row, crossing.col) {
                        break;
                    }
                    let height_m = oracle.height(family, &crossing);
                    let slope = (height_m - ray.own_m) / crossing.distance_m;
                    visited += 1;
                    if slope > *steepest {
                        (*steepest, *first_cells) = (slope, start);
                    }
                }
            }
        };
        visit(first, &mut steepest);
        let (mut start, mut level) = (0_usize, 0_usize);
        loop {
            let near = start as f64;
            if near > end || most_m < steepest * (near * metres_per_cell) {
                return (steepest, visited);
            }
            let length_bits = FINEST + level;
            let length = 1_usize << length_bits;
            let far = (start + length) as f64;
            let corner = [0, 1].map(|axis| {
                let ends = [near, far].map(|cells| here[axis] + cells * per_cell[axis]);
                let least = ends[0].min(ends[1]) - SLACK_CELLS;
                least.clamp(0.0, last[axis]) as u32 as usize >> length_bits
            });
            let rise_m = self.levels[level].highest_m(corner) - ray.own_m + self.slack_m;
            let at_m = if rise_m > 0.0 { near } else { far } * metres_per_cell;
            // False where nothing was met: -∞ · 0 is NaN.
            if rise_m < steepest * at_m {
                start += length;
                if level + 1 < self.levels.len() && start.is_multiple_of(2 * length) {
                    level += 1;
                }
                continue;
            }
            if level > 0 {
                level -= 1;
                continue;
            }
            if start != first {
                visit(start, &mut steepest);
            }
            start += length;
        }
    }
}

impl Family {
    /// The first crossing of a piece, and that of the next piece. A crossing at an end belongs to one of the two pieces,
    /// whichever way its place is rounded.
    #[inline]
    fn numbers(&self, ends_cells: [f64; 2], cells_per_t: f64) -> [u32; 2] {
        let lines_per_cell = self.per_t / cells_per_t;
        ends_cells.map(|cells| (cells * lines_per_cell) as u32 + 1)
    }
}

impl Level {
    fn finest([rows, cols]: [usize; 2], heights_m: &[f32]) -> Self {
        let side = 1_usize << FINEST;
        let size = [rows, cols].map(|count| (count - 1) / side + 1);
        let block = |i: usize, count: usize| i * side..(i * side + 2 * side + 2).min(count);
        let mut along = Vec::with_capacity(rows * size[1]);
        for row in heights_m.chunks(cols) {
            let of = |j: usize| highest(row[block(j, cols)].iter().copied());
            along.extend((0..size[1]).map(of));
        }
        let across =
            |i: usize, j: usize| highest(block(i, rows).map(|row| along[row * size[1] + j]));
        let places = (0..size[0]).flat_map(|i| (0..size[1]).map(move |j| (i, j)));
        let highest_m = places.map(|(i, j)| across(i, j)).collect();
        Self { size, highest_m }
    }

    /// Blocks twice as far apart, each of those at its beginning and at its middle along both axes. None where one block
    /// is left.
    fn coarser(&self) -> Option<Self> {
        if self.size == [1, 1] {
            return None;
        }
        let size = self.size.map(|count| (count - 1) / 2 + 1);
        let two = |i: usize, axis: usize| [2 * i, 2 * i + 2].map(|at| at.min(self.size[axis] - 1));
        let mut highest_m = Vec::with_capacity(size[0] * size[1]);
        for (i, j) in (0..size[0]).flat_map(|i| (0..size[1]).map(move |j| (i, j))) {
            let all = two(i, 0).map(|i| two(j, 1).map(|j| self.highest_m[i * self.size[1] + j]));
            highest_m.push(highest(all.into_iter().flatten()));
        }
        Some(Self { size, highest_m })
    }

    #[inline]
    fn highest_m(&self, [i, j]: [usize; 2]) -> f64 {
        f64::from(self.highest_m[i * self.size[1] + j])
    }
}

fn highest(all: impl Iterator<Item = f32>) -> f32 {
    all.fold(f32::NEG_INFINITY, f32::max)
}

/// Where a ray has left the field, in cells; at most [`SLACK_CELLS`] beyond its border.
fn end_cells(here: [f64; 2], per_cell: [f64; 2], last: [f64; 2]) -> f64 {
    let ends = [0, 1].map(|axis| {
        let room = if per_cell[axis] > 0.0 { last[axis] - here[axis] } else { here[axis] };
        (room + SLACK_CELLS) / per_cell[axis].abs()
    });
    ends[0].min(ends[1])
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{Border, HeightField};
    use std::f64::consts::TAU;

    /// Compared with an oracle that knows no highest point: it visits every crossing up to the border. Rough ground, two
    /// hills, a plateau with walls, a plane, level ground, and rough ground with a deep hole; sizes that blocks do not divide, and
    /// lines.
    #[test]
    fn skipping_keeps_the_bits_of_elevations() {
        type Ground<'a> = &'a dyn Fn(usize, usize) -> f64;
        let noise = |r: usize, c: usize| ((r * 7919 + c * 104_729) % 1013) as f64 / 1013.0;
        let hill = |r: f64, c: f64| (-(r * r + c * c) / 90.0).exp();
        let grounds: [Ground<'_>; 6] = [
            &|r, c| 3.0 * noise(r, c),
            &|r, c| {
                let (r, c) = (r as f64, c as f64);
                12.0 * hill(r - 9.0, c - 20.0) + 30.0 * hill(r - 30.0, c - 45.0)
            },
            &|r, c| if (12..20).contains(&r) && c > 10 || c == 50 { 9.0 } else { noise(r, c) },
            &|r, c| 0.3 * r as f64 - 0.7 * c as f64,
            &|_, _| 2.0,
            &|r, c| if (r, c) == (17, 33) { -1e6 } else { 0.4 * noise(r, c) },
        ];
        let sizes = [[41, 67], [64, 32], [1, 50], [50, 1], [2, 9], [1, 1]];
        for (ground, [rows, cols]) in grounds.iter().flat_map(|g| sizes.map(|size| (g, size))) {
            let places = (0..rows * cols).map(|i| (i / cols, i % cols));
            let heights: Vec<f64> = places.map(|(r, c)| ground(r, c)).collect();
            let field = HeightField::new(rows, cols, &heights, [1.0, 1.5], None).unwrap();
            for border in [Border::Plane, Border::Open] {
                let all = Oracle::one_ray(&field, border);
                let some = Oracle::new(&field, border);
                let maxima = Maxima::of(&some);
                // Every grid point of the small fields, some of the others, and their corners.
                let step = (rows * cols).div_ceil(50);
                let corners = [0, cols - 1, (rows - 1) * cols, rows * cols - 1];
                for place in (0..rows * cols).step_by(step).chain(corners) {
                    let (row, col) = (place / cols, place % cols);
                    // Every eighth is along a row or a column. The first piece is that of another azimuth, often a wrong one.
                    let mut first = 0;
                    for azimuth in (0..32).map(|k| TAU * f64::from(k) / 32.0) {
                        let wanted = all.elevation_rad(row, col, azimuth);
                        let found = maxima.elevation_rad(&some, [row, col], azimuth, &mut first);
                        assert_eq!(
                            found.to_bits(),
                            wanted.to_bits(),
                            "{rows} × {cols} {border:?} {place} {azimuth}: {found} {wanted}"
                        );
                    }
                }
            }
        }
    }

    /// East of a grid point at height 0 stand a wall 3 cells away, of height 8, and a peak 60 cells away, of height 100. The
    /// first piece has 4 columns and 4 diagonals. The wall's slope, 8/3, exceeds that of a height of 8 at 4 cells or more, and
    /// that of the peak's height at 48 cells. The pieces from 4 to 8, 16, 32 and 48 cells, whose blocks hold no more than the wall,
    /// are skipped. Without the wall the peak's slope is found.
    #[test]
    fn what_lies_behind_a_wall_is_skipped() {
        for (wall, slope) in [(8.0, 8.0 / 3.0), (0.0, 100.0 / 60.0)] {
            let height = |i: usize| match i % 64 {
                3 => wall,
                60 => 100.0,
                _ => 0.0,
            };
            let heights: Vec<f64> = (0..9 * 64).map(height).collect();
            let field = HeightField::new(9, 64, &heights, [1.0; 2], None).unwrap();
            let oracle = Oracle::new(&field, Border::Open);
            let ray = oracle.ray([4, 0], grid_direction(&field, 0.0)).unwrap();
            let (steepest, visited) = Maxima::of(&oracle).steepest(&oracle, &ray, &mut 0);
            assert_eq!(steepest, slope);
            assert_eq!(visited == 8, wall > 0.0, "{visited}");
        }
    }

    /// Ground that rises as c² up to column 40, with level ground behind: the slope from column 0 is c, so each piece exceeds
    /// those before. All pieces up to column 44 are visited, the last one as its block begins at column 36: 11 pieces of 4
    /// columns and 4 diagonals each. The horizon lies in the piece from 36 to 40. A walk that begins there visits only three
    /// others: the first, as nothing bounds slopes at the grid point itself; that from 32, whose block ends at column 37
    /// (37² / 32 is 42.8); and the last.
    #[test]
    fn a_walk_from_the_last_horizon_visits_fewer_pieces() {
        let height = |i: usize| if i % 64 <= 40 { ((i % 64) * (i % 64)) as f64 } else { 0.0 };
        let heights: Vec<f64> = (0..3 * 64).map(height).collect();
        let field = HeightField::new(3, 64, &heights, [1.0; 2], None).unwrap();
        let oracle = Oracle::new(&field, Border::Open);
        let maxima = Maxima::of(&oracle);
        let ray = oracle.ray([1, 0], grid_direction(&field, 0.0)).unwrap();
        let mut first = 0;
        assert_eq!(maxima.steepest(&oracle, &ray, &mut first), (40.0, 11 * 8));
        assert_eq!(first, 36);
        assert_eq!(maxima.steepest(&oracle, &ray, &mut first), (40.0, 4 * 8));
        assert_eq!(first, 36);
    }

    /// East of a grid point at height 0 the first column is at -0 and all others are at 0: of equal slopes the first that is visited
    /// stays, and the piece that comes first holds another.
    #[test]
    fn equal_slopes_of_either_sign_have_the_same_bits() {
        let heights: Vec<f64> = (0..12).map(|i| if i == 1 { -1e-60 } else { 0.0 }).collect();
        let field = HeightField::new(1, 12, &heights, [1.0; 2], None).unwrap();
        assert!(field.heights_m()[1].is_sign_negative());
        let oracle = Oracle::new(&field, Border::Open);
        let maxima = Maxima::of(&oracle);
        for mut first in [0, 4, 8] {
            let found = maxima.elevation_rad(&oracle, [0, 0], 0.0, &mut first);
            assert_eq!(found.to_bits(), oracle.elevation_rad(0, 0, 0.0).to_bits(), "{first}");
        }
    }

    /// Each block is the maximum of the rows and columns that [`Level`] states.
    #[test]
    fn blocks_hold_their_highest_grid_points() {
        let [rows, cols] = [23, 38];
        let heights: Vec<f64> = (0..rows * cols).map(|i| ((i * i * 31) % 997) as f64).collect();
        let field = HeightField::new(rows, cols, &heights, [1.0; 2], None).unwrap();
        let maxima = Maxima::of(&Oracle::new(&field, Border::Open));
        // Sides of 4, 8, 16, 32 and 64.
        assert_eq!(maxima.levels.len(), 5);
        for (level, blocks) in maxima.levels.iter().enumerate() {
            let side = 4 << level;
            assert_eq!(blocks.size, [(rows - 1) / side + 1, (cols - 1) / side + 1]);
            for (i, j) in (0..blocks.size[0]).flat_map(|i| (0..blocks.size[1]).map(move |j| (i, j)))
            {
                let span = |at: usize, count| at * side..(at * side + 2 * side + 2).min(count);
                let all = span(i, rows).flat_map(|r| span(j, cols).map(move |c| r * cols + c));
                let wanted = highest(all.map(|at| field.heights_m()[at]));
                assert_eq!(blocks.highest_m([i, j]), f64::from(wanted), "{side} {i} {j}");
            }
        }
    }
}

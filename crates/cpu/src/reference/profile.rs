//! Surface visible from a grid point along one azimuth: every visible interval, exactly, in f64.
//!
//! Along an azimuth the surface is a chain of straight pieces, one per triangle. A piece's slope from the grid point
//! is monotonic in the distance (see the oracle's page), so its visible part is what rises above the largest slope so
//! far: one interval of elevations per piece. The intervals of all pieces fill the elevations from straight down to
//! the horizon without gap or overlap.

use crate::oracle::{Oracle, cap_m, grid_direction};
use ridgelight::scene::Border;
use std::f64::consts::FRAC_PI_2;

/// The visible part of one triangle along an azimuth.
///
/// The first interval contains the grid point itself. Directions below it lead into the ground at once; they belong
/// to it too, hit at distance 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VisibleInterval {
    /// Elevations of the visible interval, radians.
    pub low_rad: f64,
    /// The upper one.
    pub high_rad: f64,
    /// Which triangle: see [`Oracle::corners`].
    pub triangle: usize,
    /// The piece's height above the grid point is `rise_m` + `slope`·distance.
    pub rise_m: f64,
    /// Tangent of the piece's own inclination.
    pub slope: f64,
    /// Horizontal distances at which the piece begins and ends, metres.
    span_m: [f64; 2],
    /// Weights of the triangle's corners at distance 0 and their change a metre.
    weights: [[f64; 3]; 2],
}

impl VisibleInterval {
    /// Horizontal distance to the piece along an elevation, metres.
    pub fn distance_m(&self, elevation_rad: f64) -> f64 {
        let [near, far] = self.span_m;
        // rise + slope D = D tan ω; a piece viewed edge-on is hit where it begins.
        let distance = self.rise_m / (elevation_rad.tan() - self.slope);
        if distance.is_finite() { distance.clamp(near, far) } else { near }
    }

    /// What lies above an elevation, in parts of equal elevation. One part ends at exactly `high_rad`. Where nothing lies
    /// above, the parts are empty: their upper ends are not above the elevation.
    pub(crate) fn parts(self, above_rad: f64, count: usize) -> impl Iterator<Item = Self> {
        let low_rad = self.low_rad.max(above_rad);
        let end = move |i: usize| {
            let t = i as f64 / count as f64;
            (1.0 - t) * low_rad + t * self.high_rad
        };
        (0..count).map(move |i| Self { low_rad: end(i), high_rad: end(i + 1), ..self })
    }

    /// Horizontal distance at which the piece ends, metres.
    pub fn end_m(&self) -> f64 {
        self.span_m[1]
    }

    /// Weights of the triangle's corners at a horizontal distance; they sum to 1.
    pub fn corner_weights(&self, distance_m: f64) -> [f64; 3] {
        let [at_0, per_m] = self.weights;
        [0, 1, 2].map(|k| at_0[k] + per_m[k] * distance_m)
    }
}

impl Oracle<'_> {
    /// Cells of the surface: rows, columns. Under `periodic` the last cell connects to the first grid point.
    pub fn cells(&self) -> [usize; 2] {
        let count = |grid_points| match self.border() {
            Border::Periodic => grid_points,
            Border::Plane | Border::Open => grid_points - 1,
        };
        [count(self.field().rows()), count(self.field().cols())]
    }

    /// The grid points (row, col) at a triangle's corners. Cell i holds the triangles 2i, with the corners (r, c),
    /// (r, c+1), (r+1, c+1), and 2i + 1, with (r, c), (r+1, c), (r+1, c+1).
    pub fn corners(&self, triangle: usize) -> [[usize; 2]; 3] {
        let [_, across] = self.cells();
        let (row, col) = (triangle / 2 / across, triangle / 2 % across);
        let (below, right) = ((row + 1) % self.field().rows(), (col + 1) % self.field().cols());
        let between = if triangle.is_multiple_of(2) { [row, right] } else { [below, col] };
        [[row, col], between, [below, right]]
    }

    /// The visible intervals along an azimuth, from below upwards.
    ///
    /// Nothing where the ray leaves the field at once. Under `periodic` a ray without a hit at its own height after
    /// [`cap_m`] extends its last visible interval up to horizontal.
    pub fn visible_intervals(
        &self,
        row: usize,
        col: usize,
        azimuth_rad: f64,
    ) -> Vec<VisibleInterval> {
        self.nearly_visible([row, col], azimuth_rad, 0.0)
    }

    /// The same with all surface that is hidden by less than `nearly_rad`, as intervals of equal ends.
    pub fn nearly_visible(
        &self,
        [row, col]: [usize; 2],
        azimuth_rad: f64,
        nearly_rad: f64,
    ) -> Vec<VisibleInterval> {
        let mut intervals: Vec<VisibleInterval> = Vec::new();
        let field = self.field();
        let (rows, cols) = (field.rows(), field.cols());
        assert!(
            row < rows && col < cols,
            "grid point (row {row}, column {col}) of {rows} × {cols}"
        );
        let [cols_per_m, rows_per_m] = grid_direction(field, azimuth_rad);
        let here = [row as f64, col as f64];
        let above_m = self.highest_m - self.vertex(here[0], here[1]);
        let periodic = self.border() == Border::Periodic;
        let cap_m = cap_m(field);
        // Crossing j with columns, rows, diagonals lies at j metres a line.
        let per_line = [cols_per_m, rows_per_m, rows_per_m - cols_per_m].map(|p| 1.0 / p.abs());
        let mut lines = [1.0; 3];
        let (mut near, mut reached) = (0.0, -FRAC_PI_2);
        loop {
            let lowest = f64::max(reached - nearly_rad, -FRAC_PI_2);
            let nothing_higher = near > 0.0 && above_m / near <= lowest.tan();
            if nothing_higher || (periodic && near > cap_m) {
                break;
            }
            let crossings = [0, 1, 2].map(|i| lines[i] * per_line[i]);
            let far = crossings.into_iter().fold(f64::INFINITY, f64::min);
            for i in 0..3 {
                // Crossings a few roundings apart are one vertex.
                if crossings[i] <= far * (1.0 + 1e-13) {
                    lines[i] += 1.0;
                }
            }
            let Some(piece) = self.piece(here, [rows_per_m, cols_per_m], [near, far]) else {
                break;
            };
            // The surface is continuous: no piece begins above the largest slope before it.
            if piece.high_rad > lowest {
                let high_rad = piece.high_rad.max(reached);
                intervals.push(VisibleInterval { low_rad: reached, high_rad, ..piece });
                reached = high_rad;
            }
            near = far;
        }
        if let Some(last) = intervals.last_mut()
            && periodic
        {
            last.high_rad = last.high_rad.max(0.0);
        }
        intervals
    }

    /// Slope of the lowest visible direction along an azimuth over the surface up to a distance; the grid point's own
    /// piece occludes at any distance. -∞ where the ray leaves the field at once.
    pub fn slope_within(&self, row: usize, col: usize, azimuth_rad: f64, within_m: f64) -> f64 {
        let intervals = self.visible_intervals(row, col, azimuth_rad);
        let slope = |interval: &VisibleInterval| {
            let [near, far] = interval.span_m;
            let end = if near == 0.0 { far } else { far.min(within_m) };
            (near == 0.0 || near < within_m).then(|| interval.slope + interval.rise_m / end)
        };
        intervals.iter().filter_map(slope).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The piece of surface between two distances from a grid point, all of it taken as visible; none outside the
    /// field. There is no crossing in between.
    fn piece(&self, here: [f64; 2], per_m: [f64; 2], span_m: [f64; 2]) -> Option<VisibleInterval> {
        let [near, far] = span_m;
        let middle = 0.5 * (near + far);
        let grid_points = [self.field().rows(), self.field().cols()];
        let cells = self.cells();
        // Along the last row or column lies the last cell.
        let is_last = [0, 1].map(|i| {
            let is_edge = self.border() != Border::Periodic && here[i] == cells[i] as f64;
            is_edge && per_m[i] == 0.0
        });
        let cell =
            [0, 1].map(|i| (here[i] + per_m[i] * middle).floor() - f64::from(u8::from(is_last[i])));
        let [down, right] = [0, 1].map(|i| here[i] + per_m[i] * middle - cell[i]);
        let lower = down > right;
        let at = match self.border() {
            Border::Periodic => [0, 1].map(|i| (cell[i] as i64).rem_euclid(grid_points[i] as i64)),
            Border::Plane | Border::Open => [0, 1].map(|i| cell[i] as i64),
        };
        if (0..2).any(|i| !(0..cells[i] as i64).contains(&at[i])) {
            return None;
        }
        let triangle = 2 * (at[0] as usize * cells[1] + at[1] as usize) + usize::from(lower);
        let weights_at = |down: f64, right: f64| {
            if lower {
                [1.0 - down, down - right, right]
            } else {
                [1.0 - right, right - down, down]
            }
        };
        let at_0 = weights_at(here[0] - cell[0], here[1] - cell[1]);
        let ahead = weights_at(per_m[0], per_m[1]);
        let change = [ahead[0] - 1.0, ahead[1], ahead[2]];
        let heights = self.corners(triangle).map(|[r, c]| self.vertex(r as f64, c as f64));
        let sum = |w: [f64; 3]| w[0] * heights[0] + w[1] * heights[1] + w[2] * heights[2];
        let slope = sum(change);
        // The first piece contains the grid point: rounding must not lift the grid point off it.
        let rise_m = if near == 0.0 { 0.0 } else { sum(at_0) - self.vertex(here[0], here[1]) };
        Some(VisibleInterval {
            low_rad: -FRAC_PI_2,
            high_rad: (slope + rise_m / far).atan(),
            triangle,
            rise_m,
            slope,
            span_m,
            weights: [at_0, change],
        })
    }
}

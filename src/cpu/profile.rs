//! What a sample sees of the surface along one azimuth: every visible stretch, exactly, in f64.
//!
//! Along an azimuth the surface is a chain of straight pieces, one a triangle. Seen from the sample a
//! piece's slope is monotonic in the distance (see the oracle's page), so what is visible of it is what
//! rises above the largest slope so far: one interval of elevations a piece, and the intervals of all
//! pieces fill the elevations from straight down to the horizon without gap or overlap.

use super::oracle::{Oracle, PERIOD_CAP, grid_direction};
use crate::scene::Border;
use std::f64::consts::FRAC_PI_2;

/// The visible part of one triangle along an azimuth.
///
/// The first one a ray meets holds the sample itself. Directions below it lead into the ground at
/// once; they are its too, met at distance 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stretch {
    /// Elevations between which it is seen, radians.
    pub low_rad: f64,
    /// The upper one.
    pub high_rad: f64,
    /// Which triangle: see [`Oracle::corners`].
    pub triangle: usize,
    /// The piece's height above the sample is `rise_m` + `slope`·distance.
    pub rise_m: f64,
    /// Tangent of the piece's own inclination.
    pub slope: f64,
    /// Horizontal distances at which the piece begins and ends, metres.
    span_m: [f64; 2],
    /// Weights of the triangle's corners at distance 0 and their change a metre.
    weights: [[f64; 3]; 2],
}

impl Stretch {
    /// Horizontal distance to the piece along an elevation, metres.
    pub fn distance_m(&self, elevation_rad: f64) -> f64 {
        let [near, far] = self.span_m;
        // rise + slope D = D tan ω; a piece seen edge on is met where it begins.
        let distance = self.rise_m / (elevation_rad.tan() - self.slope);
        if distance.is_finite() { distance.clamp(near, far) } else { near }
    }

    /// Weights of the triangle's corners at a horizontal distance; they sum to 1.
    pub fn corner_weights(&self, distance_m: f64) -> [f64; 3] {
        let [at_0, per_m] = self.weights;
        [0, 1, 2].map(|k| at_0[k] + per_m[k] * distance_m)
    }
}

impl Oracle<'_> {
    /// Cells of the surface: rows, columns. Under `periodic` the last sample's cell leads to the first.
    pub fn cells(&self) -> [usize; 2] {
        let count = |samples| match self.border() {
            Border::Periodic => samples,
            Border::Plane | Border::Open => samples - 1,
        };
        [count(self.field().rows()), count(self.field().cols())]
    }

    /// The samples (row, col) at a triangle's corners. Cell i holds the triangles 2i, with the corners
    /// (r, c), (r, c+1), (r+1, c+1), and 2i + 1, with (r, c), (r+1, c), (r+1, c+1).
    pub fn corners(&self, triangle: usize) -> [[usize; 2]; 3] {
        let [_, across] = self.cells();
        let (row, col) = (triangle / 2 / across, triangle / 2 % across);
        let (below, right) = ((row + 1) % self.field().rows(), (col + 1) % self.field().cols());
        let between = if triangle % 2 == 0 { [row, right] } else { [below, col] };
        [[row, col], between, [below, right]]
    }

    /// Writes what is seen along an azimuth into `seen`, from below upwards.
    ///
    /// Nothing where the ray leaves the field at once. Under `periodic` a ray that has met nothing at
    /// its own height after [`PERIOD_CAP`] periods goes on seeing its last stretch up to horizontal.
    ///
    /// # Panics
    /// When `row` or `col` lies outside the field.
    pub fn stretches(&self, row: usize, col: usize, azimuth_rad: f64, seen: &mut Vec<Stretch>) {
        seen.clear();
        let field = self.field();
        assert!(row < field.rows() && col < field.cols(), "sample (row {row}, column {col})");
        let [rows, cols] = [field.rows() as i64, field.cols() as i64];
        let [cells_down, cells_across] = self.cells().map(|n| n as i64);
        let [cols_per_m, rows_per_m] = grid_direction(field, azimuth_rad);
        let (row, col) = (row as f64, col as f64);
        let own_m = self.vertex(row, col);
        let periodic = self.border() == Border::Periodic;
        let [cell_x, cell_y] = field.cell_m();
        let cap_m = PERIOD_CAP as f64 * (cols as f64 * cell_x).max(rows as f64 * cell_y);
        let per_line = [cols_per_m, rows_per_m, rows_per_m - cols_per_m].map(|p| 1.0 / p.abs());
        let mut lines = [1.0; 3];
        let (mut near, mut best) = (0.0, f64::NEG_INFINITY);
        while !(periodic && near > cap_m)
            && !(near > 0.0 && (self.highest_m - own_m) / near <= best)
        {
            let crossings = [0, 1, 2].map(|i| lines[i] * per_line[i]);
            let far = crossings.into_iter().fold(f64::INFINITY, f64::min);
            for i in 0..3 {
                // Crossings a few roundings apart are one vertex.
                if crossings[i] <= far * (1.0 + 1e-13) {
                    lines[i] += 1.0;
                }
            }
            let middle = 0.5 * (near + far);
            let (r, c) = (row + rows_per_m * middle, col + cols_per_m * middle);
            let (cell_r, cell_c) = (r.floor(), c.floor());
            let (mut in_r, mut in_c) = (cell_r as i64, cell_c as i64);
            if periodic {
                (in_r, in_c) = (in_r.rem_euclid(rows), in_c.rem_euclid(cols));
            } else if !(0..cells_down).contains(&in_r) || !(0..cells_across).contains(&in_c) {
                break;
            }
            let lower = r - cell_r > c - cell_c;
            let along = |down: f64, right: f64| {
                if lower {
                    [1.0 - down, down - right, right]
                } else {
                    [1.0 - right, right - down, down]
                }
            };
            let at_0 = along(row - cell_r, col - cell_c);
            let ahead = along(rows_per_m, cols_per_m);
            let per_m = [ahead[0] - 1.0, ahead[1], ahead[2]];
            let triangle = 2 * (in_r * cells_across + in_c) as usize + usize::from(lower);
            let heights = self.corners(triangle).map(|[r, c]| self.vertex(r as f64, c as f64));
            let sum = |w: [f64; 3]| w[0] * heights[0] + w[1] * heights[1] + w[2] * heights[2];
            let slope = sum(per_m);
            // The first piece holds the sample: no rounding may lift it off.
            let rise_m = if near == 0.0 { 0.0 } else { sum(at_0) - own_m };
            let top = slope + rise_m / far;
            if top > best {
                // The surface is continuous: no piece begins above the largest slope before it.
                seen.push(Stretch {
                    low_rad: seen.last().map_or(-FRAC_PI_2, |last| last.high_rad),
                    high_rad: top.atan(),
                    triangle,
                    rise_m,
                    slope,
                    span_m: [near, far],
                    weights: [at_0, per_m],
                });
                best = top;
            }
            near = far;
        }
        if let Some(last) = seen.last_mut()
            && periodic
        {
            last.high_rad = last.high_rad.max(0.0);
        }
    }
}

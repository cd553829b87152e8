//! Brute-force ground truth: the horizon of one grid point over the triangulated surface, in f64.
//!
//! Along any line the surface is piecewise linear between the line's crossings with grid columns,
//! grid rows and cell diagonals. Over one such piece the slope from the receiver,
//! (h₀ + g·(d - d₀) - h_receiver) / d, is monotonic in d (its derivative keeps the sign of
//! h_receiver - h₀ + g·d₀), so its maximum stands at an end of the piece: the crossings hold every
//! candidate, and visiting all of them is exact. Nothing is shared with the sweep that this judges.

use ridgelight::scene::{Border, HeightField};

/// Periods of the longer side of a periodic field after which a ray stops, where they are a thousand cells or more
/// ([`cap_m`]).
///
/// A slope s > 0 can only occur within D = (highest - own height) / s, so a ray ends as soon as nothing beyond can
/// exceed its two best positions. The only endless rays have found nothing above their own height; past this cap they
/// can only miss an elevation of at most atan((highest - own height) / (64 · longer side)).
pub const PERIOD_CAP: usize = 64;

/// The distance after which a ray over a periodic field stops, in metres: farther than any march goes
/// ([`ridgelight::plan::sweep::warm_up`]).
pub fn cap_m(field: &HeightField) -> f64 {
    let [cell_x, cell_y] = field.cell_m();
    let side_m = (field.cols() as f64 * cell_x).max(field.rows() as f64 * cell_y);
    (PERIOD_CAP as f64 * side_m).max(1024.0 * cell_x.max(cell_y))
}

/// Two vertices of the profile closer than this are one place, in cells: a ray that passes very near a grid point
/// crosses its column, its row and its diagonal at almost one point.
pub const ONE_PLACE_CELLS: f64 = 1e-3;

/// Margin, relative to the largest |slope| on the profile, below which the occluder is ambiguous.
/// Rationale: a slope carries a few roundings of f64 (1e-15 of the scale of the heights involved); 1e-9 is far above
/// them and far below the resolution of any f32 sweep.
pub const TIE_TOLERANCE: f64 = 1e-9;

/// The horizon of a ray over the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Horizon {
    /// Tangent of the elevation: rise over world distance. May be negative whatever the border.
    pub slope: f64,
    /// Horizontal distance to the occluder, metres.
    pub distance_m: f64,
    /// Column of the occluder, in grid points; beyond the field's columns in a repetition.
    pub col: f64,
    /// Row of the occluder, in grid points; beyond the field's rows in a repetition.
    pub row: f64,
    /// Slope by which the occluder exceeds every vertex at another place; infinite if it is alone.
    pub margin: f64,
    /// Whether `margin` exceeds [`TIE_TOLERANCE`] times the largest |slope| of the profile: the occluder is unique,
    /// not one of several in line.
    pub unique: bool,
}

/// Ground truth of one field: holds the highest point, so that rays end where nothing can exceed their best.
#[derive(Clone, Copy, Debug)]
pub struct Oracle<'a> {
    field: &'a HeightField,
    border: Border,
    pub(crate) highest_m: f64,
}

impl<'a> Oracle<'a> {
    /// Scans all heights once for the highest.
    pub fn new(field: &'a HeightField, border: Border) -> Self {
        let highest_m = field.heights_m().iter().copied().fold(f32::NEG_INFINITY, f32::max);
        Self { field, border, highest_m: f64::from(highest_m) }
    }

    /// For one ray: scans all heights only where the ray would not end without it.
    pub fn one_ray(field: &'a HeightField, border: Border) -> Self {
        match border {
            Border::Periodic => Self::new(field, border),
            Border::Plane | Border::Open => Self { field, border, highest_m: f64::INFINITY },
        }
    }

    /// The field this answers for.
    pub fn field(&self) -> &'a HeightField {
        self.field
    }

    /// What lies beyond the field's edge.
    pub fn border(&self) -> Border {
        self.border
    }

    /// The horizon along an azimuth (radians, counter-clockwise from east).
    ///
    /// `None` when the ray leaves the field at once.
    pub fn horizon(&self, row: usize, col: usize, azimuth_rad: f64) -> Option<Horizon> {
        self.horizon_along(row, col, grid_direction(self.field, azimuth_rad))
    }

    /// The horizon along (columns, rows) of any length: small integers stay exact.
    ///
    /// `None` when the ray leaves the field at once, or has no direction (0, infinite, NaN).
    pub fn horizon_along(&self, row: usize, col: usize, direction: [f64; 2]) -> Option<Horizon> {
        let mut best = Best::NONE;
        self.walk([row, col], direction, |slope, at| {
            best.offer(slope, at);
            best.runner_up
        });
        best.horizon()
    }

    /// Calls `offer` for every vertex of the profile along (columns, rows), a vector of any length, with its slope, and its
    /// distance, row and column. `offer` returns the slope below which no further vertex matters.
    fn walk(
        &self,
        place: [usize; 2],
        direction: [f64; 2],
        mut offer: impl FnMut(f64, [f64; 3]) -> f64,
    ) {
        let Some(ray) = self.ray(place, direction) else { return };
        let cap_m = cap_m(self.field);
        let mut least = f64::NEG_INFINITY;
        for family in (0..3).filter_map(|index| ray.family(index)) {
            let mut j = 0.0;
            loop {
                j += 1.0;
                let crossing = ray.crossing(&family, j);
                let Crossing { row, col, distance_m, .. } = crossing;
                if self.border == Border::Periodic {
                    if distance_m > cap_m {
                        break;
                    }
                } else if !self.inside(row, col) {
                    break;
                }
                if (self.highest_m - ray.own_m) / distance_m < least {
                    break;
                }
                let slope = (self.height(&family, &crossing) - ray.own_m) / distance_m;
                least = offer(slope, [distance_m, row, col]);
            }
        }
    }

    /// The ray from a grid point along (columns, rows), a vector of any length. None where its length is 0 or not finite.
    pub(super) fn ray(
        &self,
        [row, col]: [usize; 2],
        [cols_per_t, rows_per_t]: [f64; 2],
    ) -> Option<Ray> {
        let [cell_x, cell_y] = self.field.cell_m();
        let metres_per_t = (cols_per_t * cell_x).hypot(rows_per_t * cell_y);
        if !(metres_per_t > 0.0 && metres_per_t.is_finite()) {
            return None;
        }
        assert!(
            row < self.field.rows() && col < self.field.cols(),
            "grid point (row {row}, column {col}) of a field of {} × {}",
            self.field.rows(),
            self.field.cols()
        );
        let (row, col) = (row as f64, col as f64);
        Some(Ray { row, col, cols_per_t, rows_per_t, metres_per_t, own_m: self.vertex(row, col) })
    }

    /// Height of the surface at a crossing inside the field.
    #[inline]
    pub(super) fn height(&self, family: &Family, crossing: &Crossing) -> f64 {
        let (last_r, last_c) = self.last();
        let Crossing { row: r, col: c, diagonal: k, .. } = *crossing;
        match family.index {
            0 => self.between(r, 0.0, last_r, |r| self.vertex(r, c)),
            1 => self.between(c, 0.0, last_c, |c| self.vertex(r, c)),
            _ => self.between(c, (-k).max(0.0), last_c.min(last_r - k), |c| self.vertex(c + k, c)),
        }
    }

    /// The elevation above which the sky is visible along an azimuth, radians in [-π/2, π/2].
    ///
    /// `plane`: at least 0, the ground continues at horizontal. `open`: -π/2 where nothing is hit. `periodic`: at
    /// least 0, because the repetitions' slopes (h - own height) / D reach 0 in the limit D → ∞ whatever their
    /// heights.
    pub fn elevation_rad(&self, row: usize, col: usize, azimuth_rad: f64) -> f64 {
        // The inner loop of every quadrature, which needs the slope but not the occluder.
        let mut steepest = f64::NEG_INFINITY;
        self.walk([row, col], grid_direction(self.field, azimuth_rad), |slope, _| {
            if slope > steepest {
                steepest = slope;
            }
            steepest
        });
        elevation_of_slope(self.border, steepest)
    }

    /// The last row and column as coordinates.
    pub(super) fn last(&self) -> (f64, f64) {
        ((self.field.rows() - 1) as f64, (self.field.cols() - 1) as f64)
    }

    /// Whether a point belongs to the field, the edge included.
    ///
    /// A crossing is computed with two roundings of its coordinate; four units in the last place of the field's size
    /// keep a ray aimed exactly at a corner or along the edge inside.
    #[inline]
    pub(super) fn inside(&self, row: f64, col: f64) -> bool {
        let (last_r, last_c) = self.last();
        let hair = 4.0 * f64::EPSILON * (last_r + last_c);
        (-hair..=last_r + hair).contains(&row) && (-hair..=last_c + hair).contains(&col)
    }

    /// Height at integer coordinates, repeated under `periodic`.
    #[inline]
    pub(crate) fn vertex(&self, row: f64, col: f64) -> f64 {
        let (rows, cols) = (self.field.rows(), self.field.cols());
        let at = |x: f64, count: usize| match self.border {
            Border::Periodic => (x as i64).rem_euclid(count as i64) as usize,
            Border::Plane | Border::Open => x as usize,
        };
        f64::from(self.field.heights_m()[at(row, rows) * cols + at(col, cols)])
    }

    /// Linear interpolation at `x` between its neighbouring integers; exact at an integer. At the field's ends `x` is
    /// clamped to [first, last], against the tolerance of [`Self::inside`].
    #[inline]
    fn between(&self, x: f64, first: f64, last: f64, height: impl Fn(f64) -> f64) -> f64 {
        let (x, whole) = match self.border {
            Border::Periodic => (x, x.floor()),
            Border::Plane | Border::Open => {
                let x = x.min(last).max(first);
                // x is 0 or more, so the conversion equals `floor`, which is a call on x86-64 without SSE4.1.
                (x, f64::from(x as u32))
            }
        };
        let share = x - whole;
        let here = height(whole);
        if share == 0.0 { here } else { here + share * (height(whole + 1.0) - here) }
    }
}

/// A straight line over the field from a grid point.
pub(super) struct Ray {
    pub(super) row: f64,
    pub(super) col: f64,
    pub(super) cols_per_t: f64,
    pub(super) rows_per_t: f64,
    pub(super) metres_per_t: f64,
    /// Height of the grid point.
    pub(super) own_m: f64,
}

/// The lines of one kind that a ray crosses: crossing j, from 1 on, lies at t = j / `per_t`.
pub(super) struct Family {
    /// 0 for columns, 1 for rows, 2 for diagonals.
    index: usize,
    /// Lines crossed per t, and whether their numbers rise (1) or fall (-1).
    pub(super) per_t: f64,
    sign: f64,
    metres_per_line: f64,
}

/// Where a ray crosses a line.
#[derive(Clone, Copy)]
pub(super) struct Crossing {
    pub(super) row: f64,
    pub(super) col: f64,
    /// A whole number k: on a diagonal, row = column + k.
    diagonal: f64,
    pub(super) distance_m: f64,
}

impl Ray {
    /// None where the ray crosses no line of the family.
    #[inline]
    pub(super) fn family(&self, index: usize) -> Option<Family> {
        let Self { cols_per_t, rows_per_t, .. } = *self;
        let lines_per_t = [cols_per_t, rows_per_t, rows_per_t - cols_per_t][index];
        let per_t = lines_per_t.abs();
        let (sign, metres_per_line) = (lines_per_t.signum(), self.metres_per_t / per_t);
        (lines_per_t != 0.0).then_some(Family { index, per_t, sign, metres_per_line })
    }

    /// Crossing j. Multiplying before dividing keeps crossings of integer directions on their vertices.
    #[inline]
    pub(super) fn crossing(&self, family: &Family, j: f64) -> Crossing {
        let Self { row, col, cols_per_t, rows_per_t, .. } = *self;
        let signed = j * family.sign;
        // A diagonal is the line row = column + k, k whole: its rows follow from its columns.
        let k = row - col + signed;
        let (r, c) = match family.index {
            0 => (row + rows_per_t * j / family.per_t, col + signed),
            1 => (row + signed, col + cols_per_t * j / family.per_t),
            _ => {
                let c = col + cols_per_t * j / family.per_t;
                (c + k, c)
            }
        };
        Crossing { row: r, col: c, diagonal: k, distance_m: j * family.metres_per_line }
    }
}

/// The best vertex so far and the best slope at any other place.
struct Best {
    slope: f64,
    /// Distance, row, column.
    at: [f64; 3],
    runner_up: f64,
    largest_slope: f64,
}

impl Best {
    const NONE: Self = Self {
        slope: f64::NEG_INFINITY,
        runner_up: f64::NEG_INFINITY,
        at: [0.0; 3],
        largest_slope: 0.0,
    };

    /// The order of offers does not matter: a former best is at least the runner-up, and stays so unless the winner
    /// is at the same place.
    fn offer(&mut self, slope: f64, at: [f64; 3]) {
        self.largest_slope = self.largest_slope.max(slope.abs());
        let elsewhere = (at[1] - self.at[1]).abs() + (at[2] - self.at[2]).abs() > ONE_PLACE_CELLS;
        let beaten = slope.min(self.slope);
        if slope > self.slope {
            (self.slope, self.at) = (slope, at);
        }
        if elsewhere {
            self.runner_up = self.runner_up.max(beaten);
        }
    }

    fn horizon(&self) -> Option<Horizon> {
        let Self { slope, at: [distance_m, row, col], runner_up, largest_slope } = *self;
        (slope > f64::NEG_INFINITY).then(|| {
            let margin = slope - runner_up;
            let unique = margin > TIE_TOLERANCE * largest_slope;
            Horizon { slope, distance_m, col, row, margin, unique }
        })
    }
}

/// The azimuth's direction in (columns, rows): (cos φ / cell x, -sin φ / cell y).
///
/// A component below 1e-15 of the other is taken as 0: it is the rounding of π in the azimuth
/// (sin of the f64 next to π is 1.2e-16), not a direction, and along the field's edge its sign would
/// decide between everything and nothing. Over 16 384 cells it moves the ray by 2e-11 of a cell.
pub fn grid_direction(field: &HeightField, azimuth_rad: f64) -> [f64; 2] {
    let [cell_x, cell_y] = field.cell_m();
    let (sin, cos) = azimuth_rad.sin_cos();
    let cos = if cos.abs() < 1e-15 { 0.0 } else { cos };
    let sin = if sin.abs() < 1e-15 { 0.0 } else { sin };
    [cos / cell_x, -sin / cell_y]
}

/// The elevation of an oracle's result under a border; see [`Oracle::elevation_rad`].
pub fn elevation_of(border: Border, horizon: Option<Horizon>) -> f64 {
    elevation_of_slope(border, horizon.map_or(f64::NEG_INFINITY, |h| h.slope))
}

/// The same of a slope, -∞ where nothing is hit: its arc tangent is -π/2. A slope of -0, which is equal to 0, gives 0: of the two
/// the first crossing would decide.
pub(super) fn elevation_of_slope(border: Border, slope: f64) -> f64 {
    let met = slope.atan() + 0.0;
    match border {
        Border::Open => met,
        Border::Plane | Border::Periodic => met.max(0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, TAU};

    /// The slope alone equals that of the occluder: both are the maximum over the same vertices. The walk leaves out only
    /// vertices that cannot exceed it, except by the rounding of an interpolated height.
    #[test]
    fn elevations_are_those_of_the_occluders() {
        let (rows, cols) = (7, 9);
        let heights: Vec<f64> = (0..rows * cols).map(|i| ((i * i) % 13) as f64 * 0.7).collect();
        let field = HeightField::new(rows, cols, &heights, [1.0, 1.5], None).unwrap();
        for border in [Border::Plane, Border::Open, Border::Periodic] {
            let oracle = Oracle::new(&field, border);
            for (place, k) in (0..rows * cols).flat_map(|p| (0..40).map(move |k| (p, k))) {
                // Every tenth is along a row or a column.
                let azimuth = TAU * f64::from(k) / 40.0;
                let (row, col) = (place / cols, place % cols);
                let wanted = elevation_of(border, oracle.horizon(row, col, azimuth));
                let found = oracle.elevation_rad(row, col, azimuth);
                assert!(
                    (found - wanted).abs() <= 1e-15,
                    "{border:?} {place} {k}: {found} {wanted}"
                );
            }
        }
        let nothing = elevation_of(Border::Open, None);
        assert_eq!([nothing, elevation_of(Border::Plane, None)], [-FRAC_PI_2, 0.0]);
    }
}

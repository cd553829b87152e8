//! Tolerances of indirect light against its CPU references: per grid point, from the CPU reference's own visible
//! intervals.

use super::{ARC_TANGENT, EPSILON, device_level, device_spline};
use crate::Rgb;
use crate::line_blocks::MOST_LEVEL;
use crate::shared::bounced::{Along, Cast, NEARLY_RAD, light_and_weight};
use crate::shared::field::field_slope;
use crate::shared::sweep::{Heights, inside};
use ridgelight::scene::{Border, HeightField, Receiver};

/// Properties of a field that errors depend on.
#[derive(Clone, Copy, Debug)]
pub struct Land {
    /// The largest |height| over the base.
    pub largest_m: f64,
    /// Highest less lowest.
    pub relief_m: f64,
    /// The steepest slope between neighbours along rows, columns and both diagonals.
    pub steepest: f64,
    /// The smaller side of a cell.
    pub cell_m: f64,
}

impl Land {
    /// Of a field.
    pub fn of(field: &HeightField, border: Border) -> Self {
        let (rows, cols) = (field.rows(), field.cols());
        let at = |r: usize, c: usize| f64::from(field.heights_m()[r % rows * cols + c % cols]);
        let [x, y] = field.cell_m();
        let repeats = border == Border::Periodic;
        let mut steepest = 0.0_f64;
        let mut ends = [f64::MAX, f64::MIN];
        for (r, c) in (0..rows * cols).map(|i| (i / cols, i % cols)) {
            let here = at(r, c);
            ends = [ends[0].min(here), ends[1].max(here)];
            let (down, right) = (repeats || r + 1 < rows, repeats || c + 1 < cols);
            for (is_there, rise, distance) in [
                (right, at(r, c + 1) - here, x),
                (down, at(r + 1, c) - here, y),
                (down && right, at(r + 1, c + 1) - here, x.min(y)),
                (down && right, at(r + 1, c) - at(r, c + 1), x.min(y)),
            ] {
                if is_there {
                    steepest = steepest.max(rise.abs() / distance);
                }
            }
        }
        let [low, high] = ends;
        let largest_m = low.abs().max(high.abs());
        Self { largest_m, relief_m: high - low, steepest, cell_m: x.min(y) }
    }

    /// Error of a grid point's normal, radians.
    ///
    /// A component of the gradient has differences of neighbours, at most 2 of the steepest around the grid point, each
    /// rounded, weighted exactly and summed twice, over a quotient's 5 ε: 8 ε; two of them √2 of that, which turn a
    /// normal that leans by the gradient itself by less. `inversesqrt` and products 8 ε.
    pub fn normal_at(field: &HeightField, border: Border, [row, col]: [usize; 2]) -> f64 {
        let heights = Heights::of(field, border);
        let (row, col) = (row as i32, col as i32);
        let [x, y] = field.cell_m();
        let mut steepest = 0.0_f64;
        for (down, right) in (0..9).map(|i| (i / 3 - 1, i % 3 - 1)) {
            let [r, c] = [(row + down, field.rows()), (col + right, field.cols())]
                .map(|(i, n)| inside(i, n as i32, border == Border::Periodic));
            let rise = f64::from(heights.at(c, r)) - f64::from(heights.at(col, row));
            steepest = steepest.max(rise.abs() / x.min(y));
        }
        let leans = field_slope(&heights, col, row).length();
        let gradient = 2.0_f64.sqrt() * 16.0 * EPSILON * steepest;
        gradient / (1.0 + leans * leans).sqrt() + 8.0 * EPSILON
    }
}

/// Errors of a method where a visible part ends.
#[derive(Clone, Copy, Debug, Default)]
pub struct CastError {
    /// Of its upper elevation, radians.
    pub elevation_rad: f64,
    /// Of the weight of all below it besides.
    pub end: f64,
    /// Of its own weight besides.
    pub weight: f64,
    /// Of its radiance, whatever its spread.
    pub radiance: f64,
}

/// Values common to all azimuths.
#[derive(Clone, Copy, Debug)]
pub struct Slices {
    /// Error of the grid point's normal, radians.
    pub normal: f64,
    /// Weight of a slice: its wedge in radians, or 1.
    pub wedge: f64,
    /// The largest radiance of all ground.
    pub brightest: f64,
}

/// Error of the indirect light at a grid point.
#[derive(Clone, Copy, Debug)]
pub struct BounceError {
    /// Radiance times weight, R, G, B.
    pub sum: Rgb,
    /// Exit radiance for albedo 1.
    pub light: Rgb,
    /// The weight of a whole hemisphere.
    pub whole: f64,
}

impl BounceError {
    /// From all visible intervals of a CPU reference, each with what an engine errs by there.
    ///
    /// With F the weight of all below an elevation a slice contributes Σ (F(ω_i) - F(ω_i-1)) L_i. An end ω_i that has an error of
    /// δ moves (F' + 2 δ) δ from L_i to L_i+1 (nothing beyond the last): differences of neighbours count, not the light
    /// itself. What is hidden by less than δ may be visible instead of either: it is among the casts, without weight, up
    /// to [`NEARLY_RAD`]; beyond, it may be as bright as any. The first end is the own plane, where F' is 0 and F
    /// itself errs as at other ends; a normal that turns by ν changes a slice's weight by ν ∫ cos ω dω. Where on a
    /// piece a mean is taken errs by what its ends err by, in shares of the piece: mean weight times (2 δ + 16 ε),
    /// times the spread. Sums round once a cast.
    pub fn of(all: &[Along], error: impl Fn(&Along, &Cast) -> CastError, of: &Slices) -> Self {
        let (sum, whole) = light_and_weight(all);
        let normal = of.normal * of.wedge;
        let mut off = [0.0; 3];
        for along in all {
            let mut before = CastError::default();
            for (i, cast) in along.casts.iter().enumerate() {
                let here = error(along, cast);
                let delta = here.elevation_rad.min(std::f64::consts::PI);
                let next = along.casts.get(i + 1).map_or([0.0; 3], |next| next.radiance);
                let width = cast.high_rad - cast.low_rad;
                let mean = if width > 0.0 { cast.weight.abs() / width } else { 0.0 };
                let ends = before.elevation_rad.max(delta);
                let turned = normal * (cast.high_rad.sin() - cast.low_rad.sin());
                let first = if i == 0 { here.end } else { 0.0 };
                let moved = (cast.facing + 2.0 * delta * of.wedge) * delta + here.end;
                for c in 0..3 {
                    let radiance = cast.radiance[c].abs();
                    let step = match delta < 0.5 * NEARLY_RAD {
                        true => (cast.radiance[c] - next[c]).abs(),
                        false => of.brightest,
                    };
                    off[c] += moved * step
                        + mean * (2.0 * ends + 16.0 * EPSILON) * cast.spread[c]
                        + cast.weight.abs() * here.radiance
                        + (turned + here.weight + first) * radiance;
                }
                before = here;
            }
        }
        let casts = all.iter().map(|along| along.casts.len()).max().unwrap_or(0);
        let rounded = (casts + all.len() + 8) as f64 * EPSILON;
        let sum_off = [0, 1, 2].map(|c| off[c] + rounded * sum[c].abs());
        // Whole hemispheres: a normal turns both moments, of an arc tangent and 12 ε; a sum; a quotient.
        let slice = 2.0 * normal + of.wedge * (12.0 * EPSILON + 0.5 * ARC_TANGENT);
        let count = all.len() as f64;
        let relative = count * slice / whole + (count + 6.0) * EPSILON;
        let light = [0, 1, 2].map(|c| sum_off[c] / whole + relative * sum[c].abs() / whole);
        Self { sum: sum_off, light, whole: relative * whole }
    }

    /// Of light that is so many times as bright.
    pub fn times(&self, scale: f64) -> Self {
        let [sum, light] = [self.sum, self.light].map(|of| of.map(|v| scale * v));
        Self { sum, light, ..*self }
    }
}

/// The largest magnitude of a colour.
fn largest(of: Rgb) -> f64 {
    of.iter().fold(0.0, |m, l| m.max(l.abs()))
}

/// What `bounce_march` errs by where a visible interval ends.
///
/// A direction is turned by 40 ε: a quotient of 5 ε and its difference from a half, times π, as halves of turns, and
/// sines of 6e-8. Its components err by 23 ε besides: products and three quotients. A crossing t cells away stands
/// 65 ε t beside its place, a cell's diagonal by 1 / a of that, a being how fast the ray comes nearer to it, and the
/// land there differs by twice that times its steepest slope: 130 (1 + 1/a) ε of that slope. A rise costs 8 roundings
/// of the largest around; distance and quotient 20 ε of the slope, a direction ε. d atan(s) = ds / (1 + s²).
///
/// Weights: two products whose difference is a sine, 2 ε; that of the width itself, of squares, a
/// root, a quotient and an arc tangent, and the length of a direction, 5 ε: 24 ε of the width. Radiance between three
/// corners 8 ε, and their spread times 65 ε t.
pub fn march_error(cell_m: [f64; 2], along: &Along, cast: &Cast) -> CastError {
    let (sin, cos) = along.azimuth_rad.sin_cos();
    let [x, y] = [cos.abs() / cell_m[0], sin.abs() / cell_m[1]];
    let nearer = if cos * sin < 0.0 { (x - y).abs() } else { x + y } / x.max(y);
    let slope = cast.high_rad.tan();
    let place = 65.0 * (1.0 + 1.0 / nearer.max(1e-3));
    let cell = cell_m[0].min(cell_m[1]);
    let rise = 8.0 * cast.rise_m / cast.distance.max(0.5 * cell);
    let of_slope = rise + 2.0 * place * cast.steepest + 20.0 * slope.abs();
    let width = cast.high_rad - cast.low_rad;
    let [brightest, spread] = [cast.radiance, cast.spread].map(largest);
    let cells = cast.distance / cell;
    CastError {
        elevation_rad: EPSILON * (of_slope / (1.0 + slope * slope) + 1.0),
        end: 0.0,
        weight: EPSILON * (2.0 + 24.0 * width),
        radiance: EPSILON * (8.0 * (brightest + spread) + 65.0 * cells * spread),
    }
}

/// What `bounce_walk` errs by where a visible part ends, given what the device's own sweep has met.
///
/// Rises are sums and products that are not fused, as the CPU reference's. A slope is their quotient by a product: 6 ε and the
/// CPU reference's own 2 ε. Moments: half an arc tangent and 5 ε, and 4 ε, each times its part of the wedge, which errs
/// by its cosine, sine and width of f32. A block has an error of its own.
pub fn walk_error(wedge_rad: f64, cast: &Cast) -> CastError {
    let slope = cast.high_rad.tan();
    let [brightest, spread] = [cast.radiance, cast.spread].map(largest);
    let block = match cast.is_block {
        true => block_error(brightest, spread) + place_error(brightest + spread),
        false => 0.0,
    };
    CastError {
        elevation_rad: 8.0 * EPSILON * slope.abs() / (1.0 + slope * slope),
        end: wedge_rad * (0.5 * ARC_TANGENT + 9.0 * EPSILON),
        weight: 0.0,
        radiance: 12.0 * EPSILON * (brightest + spread) + block,
    }
}

/// What a block of `line_blocks` errs by in its mean radiance.
///
/// A point's radiance is a mix of two, 3 ε, and the mean of two points 2 ε more. Each level mixes two means, 3 ε, by a share
/// a / (a + b) of weights that are a difference of heights and a product, 4 ε each: that moves the share by 2 ε at most, and
/// the quotient by 5 ε. [`place_error`] besides.
pub fn block_error(brightest: f64, spread: f64) -> f64 {
    let levels = f64::from(MOST_LEVEL);
    EPSILON * ((5.0 + 3.0 * levels) * (brightest + spread) + 7.0 * levels * spread)
}

/// What the first channel of a block errs by: its last eight bits are the place of the top, and half of them 2^-16.
pub fn place_error(brightest: f64) -> f64 {
    2.0_f64.powi(-16) * brightest
}

/// How `bounce_gather` samples a field.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// The field.
    pub land: Land,
    /// World length of a march step, at least.
    pub step_m: f64,
    /// Levels are there at every grid point.
    pub is_stack: bool,
    /// Levels, too, are the CPU references', not the device's.
    pub own_levels: bool,
    /// The exact cosine, or three bands of it.
    pub receiver: Receiver,
    /// The largest radiance.
    pub brightest: f64,
    /// Largest less smallest.
    pub spread: f64,
}

impl Gathered {
    /// What it errs by where a cast ends.
    ///
    /// A direction errs as in [`march_error`], by 65 ε of the way, and the land with it, by twice that of the steepest
    /// slope. The ends of a rise: a spline ([`device_spline`]) each, or between two samples of a stack 3 ε; of levels that
    /// are the CPU references' a [`device_level`] an octave, and the stack's own spline. Product and quotient turn an angle by
    /// 3 ε, an arc tangent; a spline's weights are positive and sum to 1, 12 ε, its sine and cosine 4 ε. Steps are
    /// those of the nearest grid point that a spline reads.
    ///
    /// Weights as [`march_error`]'s. Three bands: four polynomials of an end, 8 ε of √2 each, times weights of
    /// at most 1. Radiance: a spline, an octave's levels where they are the CPU references', and its place: two lookups farther,
    /// 4 times as far at most, but no more than 16 texels of its level, as offsets of 4 octaves at most have it.
    pub fn error(&self, cast: &Cast) -> CastError {
        let Land { largest_m, relief_m, steepest, .. } = self.land;
        let octaves = 1.0 + cast.distance.log2().max(0.0);
        let levels = if self.own_levels { octaves } else { 0.0 };
        let of_stack =
            if self.own_levels { device_spline(largest_m) } else { 3.0 * EPSILON * largest_m };
        let end = if self.is_stack { of_stack } else { device_spline(largest_m) };
        let rise = 2.0 * (end + levels * device_level(largest_m)) / (cast.distance * self.step_m);
        let steep = (relief_m / self.step_m).min(1.0);
        let angle = rise + 130.0 * EPSILON * steepest + ARC_TANGENT * steep + 19.0 * EPSILON;
        let width = cast.high_rad - cast.low_rad;
        let texels = (4.0 * cast.distance).min(20.0);
        let places = 130.0 * EPSILON * texels * self.spread;
        let radiance =
            device_spline(self.brightest) + levels * device_level(self.brightest) + places;
        let (end, weight) = match self.receiver {
            Receiver::Plane => (0.0, EPSILON * (2.0 + 24.0 * width)),
            Receiver::Cosine => (4.0 * 2.0_f64.sqrt() * 8.0 * EPSILON, 4.0 * EPSILON * width),
        };
        CastError { elevation_rad: angle, end, weight, radiance }
    }
}

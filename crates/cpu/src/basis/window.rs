//! The mildest window of one series.

use super::{order_of, reconstruct};
use glam::DVec3;
use ridgelight::basis::bands;
use ridgelight::basis::window::nonnegative;
use std::f64::consts::{PI, TAU};

/// The mildest window, between none and [`nonnegative`], that makes this series non-negative.
///
/// Factors 1 - t + t κ_l. At a direction where the series f is negative and its windowed f_κ is not, t must reach
/// -f/(f_κ - f); the result is the largest such t over the sphere, as Sloan (Deringing Spherical Harmonics, 2017) finds the
/// mildest of another family. t = 1, the whole of [`nonnegative`], if f_κ is negative too: then f is not a series of light.
/// Several colours share the smallest factors; otherwise hues shift.
pub fn mildest(coefficients: &[f64]) -> Vec<f64> {
    let whole = nonnegative(order_of(coefficients));
    let windowed = apply(&whole, coefficients);
    let needed = |[theta, phi]: [f64; 2]| {
        let (sin, cos) = theta.sin_cos();
        let direction = DVec3::new(sin * phi.cos(), sin * phi.sin(), cos);
        let (f, g) = (reconstruct(coefficients, direction), reconstruct(&windowed, direction));
        match () {
            () if f >= 0.0 => 0.0,
            () if g < 0.0 => 1.0,
            () => f / (f - g),
        }
    };
    let t = largest(needed);
    whole.iter().map(|k| 1.0 - t + t * k).collect()
}

/// Rows of the grid that [`largest`] starts from: 2.8°, a thirteenth of the shortest wave of order 6.
const ROWS: usize = 64;

/// The largest value over the sphere of a function of (θ, φ): the best of a grid, then steps that halve
/// around the best few, down to 1e-9 rad.
fn largest(f: impl Fn([f64; 2]) -> f64) -> f64 {
    let step = PI / ROWS as f64;
    let mut grid: Vec<(f64, [f64; 2])> = (0..=ROWS)
        .flat_map(|i| {
            (0..2 * ROWS).map(move |j| [step * i as f64, TAU / (2 * ROWS) as f64 * j as f64])
        })
        .map(|place| (f(place), place))
        .collect();
    grid.sort_by(|a, b| b.0.total_cmp(&a.0));
    grid.iter().take(16).map(|start| climb(&f, *start, step)).fold(0.0, f64::max)
}

fn climb(f: impl Fn([f64; 2]) -> f64, start: (f64, [f64; 2]), step: f64) -> f64 {
    let (mut best, mut place) = start;
    let mut step = step;
    while step > 1e-9 {
        let [theta, phi] = place;
        let tries =
            [[theta + step, phi], [theta - step, phi], [theta, phi + step], [theta, phi - step]];
        let (value, there) = tries
            .map(|there| (f(there), there))
            .into_iter()
            .fold((best, place), |a, b| if b.0 > a.0 { b } else { a });
        if value > best {
            (best, place) = (value, there);
        } else {
            step *= 0.5;
        }
    }
    best
}

/// Coefficients times the factors of their bands.
pub fn apply(factors: &[f64], coefficients: &[f64]) -> Vec<f64> {
    bands(order_of(coefficients)).zip(coefficients).map(|((l, _), c)| factors[l] * c).collect()
}

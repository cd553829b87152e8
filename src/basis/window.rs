//! SH windows: one factor per band, against the ringing of truncated series.
//!
//! A truncated series of non-negative light may be negative. Milder windows ring more, stronger ones blur more.

use glam::DVec3;
use std::f64::consts::{PI, TAU};

use super::harmonics::{order_of, reconstruct};
use super::legendre::{Polynomial, derivative, legendre, product, value};
use super::quadrature::integral;
use super::{bands, check_order};

/// Hann's window, (1 + cos πl/w)/2 below l = w and 0 from there on; width w > 0 in bands.
pub fn hann(order: usize, width: f64) -> Vec<f64> {
    window(order, width, |x| 0.5 * (1.0 + (PI * x).cos()))
}

/// Lanczos' window, sin(πl/w)/(πl/w) below l = w and 0 from there on; width w > 0 in bands.
pub fn lanczos(order: usize, width: f64) -> Vec<f64> {
    window(order, width, |x| if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) })
}

fn window(order: usize, width: f64, f: impl Fn(f64) -> f64) -> Vec<f64> {
    check_order(order);
    (0..order).map(|l| l as f64 / width).map(|x| if x < 1.0 { f(x) } else { 0.0 }).collect()
}

/// The window after which no series of non-negative light is negative anywhere: the factors of the sharpest non-negative
/// kernel of these bands.
///
/// Factors are those of a convolution with a zonal kernel K(z), and light convolved with K ≥ 0 stays above
/// 0. Of all such polynomials of degree d = n - 1 the one here keeps the most of band 1, the largest mean
/// of z: by Gauss' rule with weight (1+z)^e, e = d mod 2, that mean is at most the rule's last node x,
/// and reached by K = (1+z)^e (R(z)/(z-x))², R the polynomial of the nodes.
pub fn nonnegative(order: usize) -> Vec<f64> {
    check_order(order);
    let (half, odd) = ((order - 1) / 2, (order - 1) % 2);
    let mut nodes = legendre(half + 1);
    let mut kernel = vec![1.0];
    if odd == 1 {
        // Radau's: P_{k+1} + P_{k+2} vanishes at -1, the node that the weight takes over.
        let mut sum = legendre(half + 2);
        sum.iter_mut().zip(&nodes).for_each(|(s, n)| *s += n);
        nodes = without_root(&sum, -1.0);
        kernel = vec![1.0, 1.0];
    }
    let root = without_root(&nodes, last_root(&nodes));
    kernel = product(&kernel, &product(&root, &root));
    let band = |l: usize| integral(-1.0, 1.0, |z| value(&kernel, z) * value(&legendre(l), z));
    (0..order).map(|l| band(l) / band(0)).collect()
}

/// The largest root of a polynomial whose roots are real and at most 1: Newton's method from 1 approaches it without
/// passing it.
fn last_root(polynomial: &[f64]) -> f64 {
    let slope = derivative(polynomial);
    (0..64).fold(1.0, |x, _| x - value(polynomial, x) / value(&slope, x))
}

/// A polynomial divided by (z - root).
fn without_root(polynomial: &[f64], root: f64) -> Polynomial {
    let mut rest = vec![0.0; polynomial.len() - 1];
    let mut carried = 0.0;
    for (k, c) in polynomial.iter().enumerate().skip(1).rev() {
        carried = carried * root + c;
        rest[k - 1] = carried;
    }
    rest
}

/// The mildest window, between none and [`nonnegative`], that makes this series non-negative.
///
/// Factors 1 - t + t κ_l. At a direction where the series f is negative and its windowed f_κ is not, t must reach
/// -f/(f_κ - f); the result is the largest such t over the sphere, as Sloan (Deringing Spherical Harmonics, 2017) finds the
/// mildest of another family. t = 1, the whole of [`nonnegative`], if f_κ is negative too: then f is not a series of light.
/// Several colours share the smallest factors; otherwise hues shift.
///
/// # Panics
/// If the number of `coefficients` is not a square.
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
///
/// # Panics
/// If there are fewer factors than bands.
pub fn apply(factors: &[f64], coefficients: &[f64]) -> Vec<f64> {
    bands(order_of(coefficients)).zip(coefficients).map(|((l, _), c)| factors[l] * c).collect()
}

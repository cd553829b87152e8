//! SH windows: one factor per band, against the ringing of truncated series.
//!
//! A truncated series of non-negative light may be negative. Milder windows ring more, stronger ones blur more.

use std::f64::consts::PI;

use super::check_order;
use super::legendre::{Polynomial, derivative, legendre, product, value};
use super::quadrature::integral;

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

//! Legendre polynomials and spherical harmonics against independent quadrature, and against closed forms.

mod azimuth;
mod glsl;
mod harmonics;
mod key;
mod legendre;
mod light;
mod product;
mod reflected;
mod slice;
mod triangles;
mod wedge;
mod window;
mod zonal;

use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::basis::quadrature::points;
use ridgelight_cpu::basis::nlp;
use std::f64::consts::{PI, TAU};

pub(crate) const ORDERS: std::ops::RangeInclusive<usize> = 1..=6;

/// Numbers found by quadrature to 15 digits and more, independently of this crate.
pub(crate) fn reference(name: &str) -> serde_json::Value {
    let all: serde_json::Value =
        serde_json::from_str(include_str!("reference_numbers.json")).expect("JSON");
    all[name].clone()
}

pub(crate) fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(number).collect()
}

pub(crate) fn number(value: &serde_json::Value) -> f64 {
    value.as_f64().expect("a number")
}

/// Every number to 1e-12 of itself, or of 1e-3 where it is smaller: near 0 the error counts as it is.
#[track_caller]
pub(crate) fn same(got: &[f64], expected: &[f64]) {
    assert_eq!(got.len(), expected.len());
    for (i, (g, e)) in got.iter().zip(expected).enumerate() {
        assert!((g - e).abs() <= 1e-12 * e.abs().max(1e-3), "{i}: {g:e}, expected {e:e}");
    }
}

/// Every number within `tolerance`.
#[track_caller]
pub(crate) fn within(got: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(got.len(), expected.len());
    for (i, (g, e)) in got.iter().zip(expected).enumerate() {
        assert!((g - e).abs() <= tolerance, "{i}: {g:e}, expected {e:e} ± {tolerance:e}");
    }
}

pub(crate) fn direction(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

/// Evenly spaced directions on the sphere (a Fibonacci spiral).
pub(crate) fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |i| {
        let z: f64 = 1.0 - (2 * i + 1) as f64 / count as f64;
        direction(z.acos(), i as f64 * PI * (3.0 - 5.0_f64.sqrt()))
    })
}

/// ∫ f(θ, φ) Y over a patch of the sphere, by 32 × 32 points: smooth functions only.
pub(crate) fn project(
    order: usize,
    theta: [f64; 2],
    phi: [f64; 2],
    f: impl Fn(f64, f64) -> f64,
) -> Vec<f64> {
    let mut sums = vec![0.0; order * order];
    for (p, weight_p) in points(phi[0], phi[1]) {
        for (t, weight_t) in points(theta[0], theta[1]) {
            let part = f(t, p) * t.sin() * weight_p * weight_t;
            for (sum, y) in sums.iter_mut().zip(evaluate(order, direction(t, p))) {
                *sum += part * y;
            }
        }
    }
    sums
}

/// The NLP reconstruction of a function of elevation at z (NS09 eq. 13).
pub(crate) fn nlp_value(coefficients: &[f64], z: f64) -> f64 {
    coefficients.iter().zip(nlp(coefficients.len(), z)).map(|(c, p)| c * p).sum()
}

/// [`project`] over the whole sphere, in two halves of azimuth.
pub(crate) fn project_whole(order: usize, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    let (near, far) =
        (project(order, [0.0, PI], [0.0, PI], &f), project(order, [0.0, PI], [PI, TAU], &f));
    near.iter().zip(far).map(|(a, b)| a + b).collect()
}

/// Uneven numbers from -1 to 1.
pub(crate) fn noise(seed: u64, count: usize) -> Vec<f64> {
    let mut x = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
    (0..count)
        .map(|_| {
            x = (x ^ (x >> 27)).wrapping_mul(0x2545_F491_4F6C_DD1D);
            x ^= x >> 31;
            (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
        .collect()
}

/// The comparison fails for an error of 2e-12 of a number, and for 2e-15 in place of 0.
#[test]
fn comparators_fail() {
    for (got, expected) in [(1.0 + 2e-12, 1.0), (2e-15, 0.0), (f64::NAN, 0.0)] {
        assert!(std::panic::catch_unwind(|| same(&[got], &[expected])).is_err(), "{got}");
    }
    assert!(std::panic::catch_unwind(|| within(&[f64::NAN], &[0.0], 1.0)).is_err());
    assert!(std::panic::catch_unwind(|| within(&[0.0], &[0.0, 0.0], 1.0)).is_err());
}

//! A function of elevation along one azimuth, as its integrals with every Θ_lm.
//!
//! A slice holds ∫ f Θ_lm dz at [`slice_index`], m ≥ 0. NS09 keeps n NLP coefficients instead, which lose part of f for odd
//! m, as sinᵐθ is not a polynomial in z there. Slices of visibility above a horizon have a closed form without that loss.

use std::f64::consts::FRAC_PI_2;

use super::check_order;
use super::legendre::{Polynomial, associated, product, value};

/// Index of (l, m), 0 ≤ m ≤ l, in a slice: l(l+1)/2 + m.
pub fn slice_index(l: usize, m: usize) -> usize {
    l * (l + 1) / 2 + m
}

/// (l, m) of every number of a slice, in order.
pub fn parts(order: usize) -> impl Iterator<Item = (usize, usize)> {
    check_order(order);
    (0..order).flat_map(|l| (0..=l).map(move |m| (l, m)))
}

/// Closed forms of slices of visibility above an elevation.
#[derive(Clone, Debug, PartialEq)]
pub struct Slices {
    order: usize,
    parts: Vec<Above>,
}

/// ∫ of Θ_lm from elevation ω up to the zenith, dz = cos ω dω.
///
/// Even m: `whole` + U(sin ω). Odd m: `whole` · (π/2 - ω) + cos ω · U(sin ω).
#[derive(Clone, Debug, PartialEq)]
pub struct Above {
    /// Whether m is odd.
    pub odd: bool,
    /// The constant, or the factor of the angle from the zenith.
    pub whole: f64,
    /// U.
    pub polynomial: Polynomial,
}

impl Above {
    fn new(l: usize, m: usize) -> Self {
        // With sinᵐθ = cosᵐω: ∫ q(sin ω) cos^(m+1) ω dω = ∫ F dω for odd m, ∫ F ds for even m.
        let squared = [1.0, 0.0, -1.0];
        let mut f = associated(l, m).to_vec();
        for _ in 0..m.div_ceil(2) {
            f = product(&f, &squared);
        }
        if m.is_multiple_of(2) {
            let mut below = vec![0.0];
            below.extend(f.iter().enumerate().map(|(k, c)| -c / (k + 1) as f64));
            return Self { odd: false, whole: -value(&below, 1.0), polynomial: below };
        }
        // d(cos ω U)/dω = (1 - s²) U' - s U. Equal to a - F, by powers of s from the highest down:
        // (k+1) u_{k+1} - k u_{k-1} = -F_k for k ≥ 1, and a = F_0 + u_1.
        let degree = f.len() - 1;
        let mut u = vec![0.0; degree + 2];
        for k in (1..=degree).rev() {
            u[k - 1] = ((k + 1) as f64 * u[k + 1] + f[k]) / k as f64;
        }
        let whole = f[0] + u[1];
        u.truncate(degree);
        Self { odd: true, whole, polynomial: u }
    }

    fn at(&self, elevation_rad: f64, sin: f64, cos: f64) -> f64 {
        let rest = value(&self.polynomial, sin);
        if self.odd {
            self.whole * (FRAC_PI_2 - elevation_rad) + cos * rest
        } else {
            self.whole + rest
        }
    }
}

impl Slices {
    /// The closed forms of an order.
    pub fn new(order: usize) -> Self {
        Self { order, parts: parts(order).map(|(l, m)| Above::new(l, m)).collect() }
    }

    /// The order.
    pub fn order(&self) -> usize {
        self.order
    }

    /// The closed form of every part, at [`slice_index`].
    pub fn parts(&self) -> &[Above] {
        &self.parts
    }

    /// The slice of a step: 1 above `elevation_rad`, [-π/2..π/2], and 0 below.
    pub fn above(&self, elevation_rad: f64) -> Vec<f64> {
        let (sin, cos) = elevation_rad.sin_cos();
        self.parts.iter().map(|part| part.at(elevation_rad, sin, cos)).collect()
    }

    /// The slice of a function that is 1 between two elevations; all 0 unless `high_rad` is above `low_rad`.
    pub fn between(&self, low_rad: f64, high_rad: f64) -> Vec<f64> {
        if high_rad <= low_rad {
            return vec![0.0; self.parts.len()];
        }
        let (low, high) = (self.above(low_rad), self.above(high_rad));
        low.iter().zip(high).map(|(l, h)| l - h).collect()
    }
}

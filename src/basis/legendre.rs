//! Normalised Legendre polynomials, the associated functions, and the occlusion function in them
//! (NS09 §4).

use std::sync::LazyLock;

use super::MAX_ORDER;

/// Coefficients of z⁰, z¹, … of a polynomial.
pub(crate) type Polynomial = Vec<f64>;

/// A polynomial at `x` (Horner).
pub fn value(polynomial: &[f64], x: f64) -> f64 {
    polynomial.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

/// The derivative.
pub(crate) fn derivative(polynomial: &[f64]) -> Polynomial {
    polynomial.iter().enumerate().skip(1).map(|(k, c)| k as f64 * c).collect()
}

/// The product of two.
pub(crate) fn product(a: &[f64], b: &[f64]) -> Polynomial {
    let mut out = vec![0.0; (a.len() + b.len()).saturating_sub(1)];
    for (i, x) in a.iter().enumerate() {
        for (j, y) in b.iter().enumerate() {
            out[i + j] += x * y;
        }
    }
    out
}

/// P_l, unnormalised: (l+1) P_{l+1} = (2l+1) z P_l - l P_{l-1} (Bonnet).
pub fn legendre(degree: usize) -> Polynomial {
    let (mut before, mut current) = (vec![], vec![1.0]);
    for l in 0..degree {
        let mut next = product(&current, &[0.0, (2 * l + 1) as f64 / (l + 1) as f64]);
        for (n, b) in next.iter_mut().zip(&before) {
            *n -= l as f64 / (l + 1) as f64 * b;
        }
        (before, current) = (current, next);
    }
    current
}

/// The polynomial q of Θ_lm(cos θ) = sinᵐθ q(cos θ), for 0 ≤ m ≤ l < [`MAX_ORDER`].
///
/// q = √((2l+1)/2 · (l-m)!/(l+m)!) dᵐP_l/dzᵐ, so that ∫ Θ_lm² dz = 1 on [-1, 1].
///
/// # Panics
/// If l and m are out of range.
pub fn associated(l: usize, m: usize) -> &'static [f64] {
    static ALL: LazyLock<Vec<Vec<Polynomial>>> = LazyLock::new(|| {
        (0..MAX_ORDER).map(|l| (0..=l).map(|m| associated_of(l, m)).collect()).collect()
    });
    &ALL[l][m]
}

fn associated_of(l: usize, m: usize) -> Polynomial {
    let mut q = legendre(l);
    for _ in 0..m {
        q = derivative(&q);
    }
    let ratio: f64 = (l - m + 1..=l + m).map(|k| k as f64).product();
    let scale = ((2 * l + 1) as f64 / 2.0 / ratio).sqrt();
    q.iter().map(|c| scale * c).collect()
}

//! Normalised Legendre polynomials, the associated functions, and the occlusion function in them
//! (NS09 §4).

use std::sync::LazyLock;

use super::{MAX_ORDER, check_order};

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
pub fn product(a: &[f64], b: &[f64]) -> Polynomial {
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

/// D_l in v̂_l(σ) = cos²σ · D_l(sin σ), for 1 ≤ l < `order`; v̂_0 = (1 + sin σ)/√2.
///
/// By Legendre's equation ((1 - z²) P_l')' = -l(l+1) P_l, so ∫ from -1 to s of P̂_l is
/// -(1 - s²) √((2l+1)/2)/(l(l+1)) P_l'(s). These are NS09's coefficients after eq. 13, for any order.
/// With a horizon's slope t, sin σ = t/√(1+t²) and cos²σ = 1/(1+t²): no angle is needed.
pub fn occlusion_polynomials(order: usize) -> Vec<Polynomial> {
    check_order(order);
    (1..order)
        .map(|l| {
            let scale = -((2 * l + 1) as f64 / 2.0).sqrt() / (l * (l + 1)) as f64;
            derivative(&legendre(l)).iter().map(|c| scale * c).collect()
        })
        .collect()
}

/// NLP coefficients of the part below elevation σ: v̂_l(σ) = ∫ from -1 to sin σ of P̂_l dz (NS09 eq. 10).
///
/// Takes sin σ and cos σ ≥ 0, σ in [-π/2..π/2]. The part above is v̂(π/2) - v̂(σ), v̂(π/2) = (√2, 0, …).
pub fn occlusion(order: usize, sin: f64, cos: f64) -> Vec<f64> {
    let squared = cos * cos;
    // 1 + sin σ without cancellation near the nadir.
    let below = if sin < 0.0 { squared / (1.0 - sin) } else { 1.0 + sin };
    let first = below * std::f64::consts::FRAC_1_SQRT_2;
    let rest = occlusion_polynomials(order);
    std::iter::once(first).chain(rest.iter().map(|d| squared * value(d, sin))).collect()
}

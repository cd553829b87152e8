//! Legendre polynomials and spherical harmonics in f64. Tables and constants are computed from them.
//!
//! A function of direction is a product of a function of elevation and one of azimuth, and so is its
//! basis: Y_lm(θ, φ) = Θ_l|m|(cos θ) Φ_m(φ), each factor orthonormal in its own variable.
//!
//! - Θ_lm, m ≥ 0, are the normalised associated Legendre functions, Θ_l0 = P̂_l the normalised Legendre
//!   polynomials (NLP): [`legendre`].
//! - Φ_0 = 1/√2π, Φ_m = cos mφ/√π, Φ_-m = sin mφ/√π: [`azimuth`].
//!
//! Visibility along one azimuth is a [slice](mod@slice) of n(n+1)/2 numbers ∫ f Θ_lm dz, or the n numbers of the NLP.
//! Spherical harmonics are sums of slices times weights of Φ: `assemble` in the CPU reference.
//!
//! Order n means bands l < n: n² coefficients at [`index`]. n is 1 to [`MAX_ORDER`]; functions panic on any other. A zonal
//! function about the z axis is its n coefficients of Y_l0. Directions have z up; elevation ω = π/2 - θ, so z = sin ω. No
//! Condon-Shortley phase.

pub mod azimuth;
pub mod harmonics;
pub mod legendre;
pub mod light;
pub mod product;
pub mod quadrature;
pub mod random;
pub mod slice;
pub mod triangles;
pub mod wedge;
pub mod window;
pub mod zonal;

/// The highest supported order: bands 0 to 5, 36 coefficients.
pub const MAX_ORDER: usize = 6;

/// Index of Y_lm among the coefficients: l(l+1) + m, for -l ≤ m ≤ l.
pub fn index(l: usize, m: isize) -> usize {
    (l * (l + 1)).wrapping_add_signed(m)
}

/// (l, m) of every coefficient of an order, in order.
pub fn bands(order: usize) -> impl Iterator<Item = (usize, isize)> {
    check_order(order);
    (0..order as isize).flat_map(|l| (-l..=l).map(move |m| (l as usize, m)))
}

fn check_order(order: usize) {
    assert!((1..=MAX_ORDER).contains(&order), "order {order}: 1 to {MAX_ORDER}");
}

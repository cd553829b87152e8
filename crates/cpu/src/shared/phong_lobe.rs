//! `phong_lobe.glsl`: the normalised Phong lobe.

use crate::tolerance::EPSILON;
use crate::tolerance::near::{Near, Near3, dot};
use std::f64::consts::TAU;

/// Value of a Phong lobe of unit integral, (n + 1) / 2π cosⁿ of the angle to its axis, in a direction that differs by
/// `apart` from the axis.
///
/// It decreases with m = 1 - cos: its range lies between its values at the ends of m; an exponent error of δ changes
/// it by (δ + δ |ln(1 - m)|) of itself. Its power n ln(1 - m) errs by the series' 1e-7 and 12 roundings of itself, or
/// by a logarithm's 3 ulp; the exponential by (3 + 2 |x|) ulp; the rest by 8 ε. f32 ends at 1e-37.
pub fn phong_lobe(apart: Near3, n: Near) -> Near {
    let m = Near::of(0.5) * dot(apart, apart);
    let logarithm = |m: f64| (-m.clamp(0.0, 1.0)).ln_1p();
    let at = |m: f64| if m < 1.0 { (n.v + 1.0) / TAU * (n.v * logarithm(m)).exp() } else { 0.0 };
    let [low, v, high] = [m.v + m.off, m.v, m.v - m.off].map(at);
    let steep = logarithm(m.v.min(1.0 - 1e-12)).abs();
    let x = n.v * steep;
    let own = x * (1e-7 + 12.0 * EPSILON) + (3.0 + 2.0 * x) * 2.0 * EPSILON + 8.0 * EPSILON;
    let off = (high - v).max(v - low) + high * (own + n.off * (1.0 + steep));
    Near { v, off: off + 1e-37 }
}

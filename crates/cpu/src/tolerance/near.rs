//! Running error analysis (Higham 2002, "Accuracy and Stability of Numerical Algorithms", §3.3): every f64 value
//! carries a bound on its f32 error. It shows for each branch whether f32 takes the same one.

use super::{ARC_TANGENT, EPSILON};
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The smallest number that every device keeps; what is smaller may be taken for 0.
const SMALLEST: f64 = 1.0 / (1_u128 << 126) as f64;
/// Vulkan's precision of a quotient, 2.5 ulp, of a square root (`inversesqrt`, 2 ulp, and its reciprocal), and of normalising
/// besides (a product by that or a quotient), in ε.
const QUOTIENT: f64 = 5.0;
const ROOT: f64 = 9.0;

/// A value in f64, and a bound on a device's error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Near {
    /// The value.
    pub v: f64,
    /// The error bound, 0 or more.
    pub off: f64,
}

/// A vector, or a colour.
pub type Near3 = [Near; 3];

impl Near {
    /// Nothing, without error.
    pub const ZERO: Self = Self { v: 0.0, off: 0.0 };

    /// A constant, which a shader has as f32.
    pub fn of(v: f64) -> Self {
        Self { v, off: (v - f64::from(v as f32)).abs() }
    }

    /// A number that a device is given.
    pub fn given(v: f32) -> Self {
        Self { v: v.into(), off: 0.0 }
    }

    /// The result of an operation that rounds by so many ε, of operands that move it by `passed_on`. A sum or product
    /// of exact numbers that fits f32 is exact.
    fn rounded(v: f64, passed_on: f64, roundings: f64) -> Self {
        if v.is_nan() || passed_on.is_nan() {
            return Self { v: 0.0, off: f64::INFINITY };
        }
        if passed_on == 0.0 && (v == 0.0 || (roundings <= 1.0 && f64::from(v as f32) == v)) {
            return Self { v, off: 0.0 };
        }
        Self { v, off: passed_on + roundings * EPSILON * (v.abs() + passed_on) + SMALLEST }
    }

    /// The same with a larger error bound.
    #[must_use]
    pub fn wider(self, by: f64) -> Self {
        Self { off: self.off + by, ..self }
    }

    /// The largest possible magnitude.
    pub fn most(self) -> f64 {
        self.v.abs() + self.off
    }

    /// Whether it is more than another, unless the error decides that.
    pub fn above(self, other: Self) -> Option<bool> {
        let (apart, off) = (self.v - other.v, self.off + other.off);
        (off == 0.0 || apart.abs() > off).then_some(apart > 0.0)
    }

    /// Whether it is not more than another, unless the error decides that.
    pub fn at_most(self, other: Self) -> Option<bool> {
        self.above(other).map(|is_above| !is_above)
    }

    /// The larger of two.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        match self.above(other) {
            Some(true) => self,
            Some(false) => other,
            None => Self { v: self.v.max(other.v), off: self.off.max(other.off) },
        }
    }

    /// The smaller of two.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        match self.above(other) {
            Some(true) => other,
            Some(false) => self,
            None => Self { v: self.v.min(other.v), off: self.off.max(other.off) },
        }
    }

    /// Clamped to 0 .. 1; the error is never larger than that.
    #[must_use]
    pub fn within_one(self) -> Self {
        Self { v: self.v.clamp(0.0, 1.0), off: self.off.min(1.0) }
    }

    /// Without its sign.
    #[must_use]
    pub fn abs(self) -> Self {
        Self { v: self.v.abs(), ..self }
    }

    /// Of a value that only error makes negative.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let root = self.v.max(0.0).sqrt();
        let [low, high] = [self.v - self.off, self.v + self.off].map(|v| v.max(0.0).sqrt());
        Self::rounded(root, (high - root).max(root - low), ROOT)
    }

    /// The built-in power of a positive number: 2 to the power of the product with its binary logarithm, which has an error of 3 ulp,
    /// or 2^-21 from a half to two, and changes by no more than where the number is least.
    #[must_use]
    pub fn powf(self, power: Self) -> Self {
        let least = self.v - self.off;
        let own = if least <= 2.0 && self.most() >= 0.5 { 0.5_f64.powi(21) } else { 0.0 };
        let passed_on = match self.off {
            0.0 => 0.0,
            off if least > 0.0 => off / (least * std::f64::consts::LN_2),
            _ => f64::INFINITY,
        };
        let bits = Self::rounded(self.v.log2(), own + passed_on, 6.0) * power;
        let v = bits.v.exp2();
        let passed_on = v * (bits.off * std::f64::consts::LN_2).exp_m1();
        Self::rounded(v, passed_on, 6.0 + 4.0 * bits.most())
    }
}

impl Add for Near {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::rounded(self.v + other.v, self.off + other.off, 1.0)
    }
}

impl Sub for Near {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::rounded(self.v - other.v, self.off + other.off, 1.0)
    }
}

impl Mul for Near {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let times =
            |value: f64, off: f64| if value == 0.0 || off == 0.0 { 0.0 } else { value * off };
        let passed_on = times(self.v.abs(), other.off)
            + times(other.v.abs(), self.off)
            + times(self.off, other.off);
        Self::rounded(self.v * other.v, passed_on, 1.0)
    }
}

impl Div for Near {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let least = other.v.abs() - other.off;
        if least <= 0.0 || least.is_nan() {
            return Self { v: 0.0, off: f64::INFINITY };
        }
        let v = self.v / other.v;
        Self::rounded(v, (self.off + v.abs() * other.off) / least, QUOTIENT)
    }
}

impl Neg for Near {
    type Output = Self;

    fn neg(self) -> Self {
        Self { v: -self.v, ..self }
    }
}

/// The angle from the direction of x to that of (x, y), -π .. π, by `arc_tangent` of a quotient put into its quadrant: a place
/// r away that has an error of d is turned by asin(d / r) at most; π and a difference from it round.
pub fn angle(y: Near, x: Near) -> Near {
    let (r, d) = (x.v.hypot(y.v), x.off + y.off);
    let turned = if r > d { d / (r - d) } else { std::f64::consts::PI };
    Near { v: y.v.atan2(x.v), off: turned + ARC_TANGENT + 13.0 * EPSILON }
}

/// A scalar product.
pub fn dot(a: Near3, b: Near3) -> Near {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Component by component.
pub fn plus(a: Near3, b: Near3) -> Near3 {
    [0, 1, 2].map(|i| a[i] + b[i])
}

/// Component by component.
pub fn minus(a: Near3, b: Near3) -> Near3 {
    [0, 1, 2].map(|i| a[i] - b[i])
}

/// Component by component.
pub fn product(a: Near3, b: Near3) -> Near3 {
    [0, 1, 2].map(|i| a[i] * b[i])
}

/// A vector so many times.
pub fn times(a: Near, b: Near3) -> Near3 {
    b.map(|b| a * b)
}

/// A vector's direction.
pub fn normalize(a: Near3) -> Near3 {
    let length = dot(a, a).sqrt();
    a.map(|a| a / length)
}

/// Whether all of these hold, unless the doubt of one decides that.
pub fn all<const N: usize>(of: [Option<bool>; N]) -> Option<bool> {
    if of.contains(&Some(false)) {
        Some(false)
    } else if of.contains(&None) {
        None
    } else {
        Some(true)
    }
}

/// Whether one of these holds, unless the doubt of one decides that.
pub fn any<const N: usize>(of: [Option<bool>; N]) -> Option<bool> {
    all(of.map(|of| of.map(|is| !is))).map(|none| !none)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A few thousand chains of f32 operations stay within the bound carried along in f64, and the bound is at most
    /// 200 times the worst actual error.
    #[test]
    fn f32_stays_within_what_is_carried_along() {
        let mut state = 5_u64;
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f32 / 16_777_216.0 + 0.01
        };
        let mut worst = 0.0_f64;
        for _ in 0..4000 {
            let [a, b, c] = [next(), next(), next()];
            let got = ((a / b - c) * (a + 3.1 * c)).abs().sqrt() + (a * b).powf(a + c);
            let [a, b, c] = [a, b, c].map(Near::given);
            let want = ((a / b - c) * (a + Near::of(3.1) * c)).abs().sqrt() + (a * b).powf(a + c);
            let ratio = (f64::from(got) - want.v).abs() / want.off;
            worst = worst.max(ratio);
            assert!(ratio <= 1.0, "{got} {want:?}");
        }
        assert!(worst > 1.0 / 200.0, "{worst}");
    }

    /// Integers and dyadic fractions are exact; what compares unlike within its error is in doubt.
    #[test]
    fn what_is_exact_is_decided_and_what_is_not_is_in_doubt() {
        let [a, b] = [1.5_f32, 0.25].map(Near::given);
        assert_eq!((a * b + a).off, 0.0);
        assert_eq!((a - a).above(Near::ZERO), Some(false));
        assert_eq!(a.at_most(b), Some(false));
        let third = a / Near::given(4.5);
        assert_eq!(third.above(Near::of(1.0 / 3.0)), None);
        assert_eq!((third * Near::ZERO).off, 0.0);
        assert!((a / (third - third)).off.is_infinite());
        assert_eq!(all([Some(true), None]), None);
        assert_eq!(all([Some(false), None]), Some(false));
        assert_eq!(any([Some(true), None]), Some(true));
        assert_eq!(any([Some(false), None]), None);
    }

    /// A quarter to the power of 2 that has an error of a hundredth: between 0.24² and 0.26² lies all of it, 0.0051 apart from the
    /// middle, and the bound is no more than a few hundredths above; of what may be nothing it is none.
    #[test]
    fn a_power_is_off_by_what_its_base_is() {
        let two = Near::given(2.0);
        let power = Near::given(0.25).wider(0.01).powf(two);
        assert!((0.0051..0.006).contains(&power.off), "{power:?}");
        assert!(Near::given(0.25).wider(0.25).powf(two).off.is_infinite());
    }
}

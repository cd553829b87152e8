//! Integral of the Phong lobe over the elevations of one azimuth.
//!
//! With a cos ω + b sin ω = R cos t and t = ω - ω₀, ∫cosⁿt cos ω dω is
//! (a ∫cosⁿ⁺¹t dt + b cosⁿ⁺¹t / (n + 1)) / R. The integral over t depends on n alone: one table serves all azimuths,
//! where Gauss' rule ([`Slice::light`]) evaluates powers at each of some hundred points.

use crate::light::{LOBE, Slice};
use std::sync::Arc;

/// Steps of the table per width of the lobe, 1/√(n + 1).
///
/// Cubic interpolation from values and slopes has an error of h⁴/384 times the fourth derivative. For exponents of 1 or
/// more that is 8e-9 of the peak for cosⁿ⁺¹, and 4e-9 of the width times the peak for its integral. Below 1, cosⁿ⁺¹
/// reaches 0 at the rim with a power below 2: for a horizon in the last step the error is 1e-3.
const STEPS: f64 = 32.0;

/// The table of an exponent. Clones share it.
#[derive(Clone, Debug)]
pub(crate) struct PhongIntegral {
    exponent: f64,
    /// Cosine below which the lobe is negligible, and its angle.
    least: f64,
    end_rad: f64,
    step_rad: f64,
    steps_per_rad: f64,
    /// At equal steps from -`end_rad` to `end_rad`: ∫cosⁿ⁺¹ from the first, cosⁿ⁺¹ and its slope.
    nodes: Arc<[[f64; 3]]>,
}

impl PhongIntegral {
    pub(crate) fn of(exponent: f64) -> Self {
        let power = exponent + 1.0;
        let least = LOBE.powf(1.0 / power);
        let end_rad = least.acos();
        let steps = (2.0 * end_rad * STEPS * power.sqrt()).ceil();
        let step_rad = 2.0 * end_rad / steps;
        let mut nodes: Vec<[f64; 3]> = Vec::with_capacity(steps as usize + 1);
        for i in 0..=steps as usize {
            let (sin, cos) = (step_rad * i as f64 - end_rad).sin_cos();
            let shared = cos.powf(exponent);
            let (value, slope) = (cos * shared, -power * sin * shared);
            let integral = nodes.last().map_or(0.0, |[integral, last, last_slope]| {
                // The trapezoidal rule, corrected by the slopes at its ends (Euler-Maclaurin).
                let curved = step_rad / 12.0 * (last_slope - slope);
                integral + step_rad * (0.5 * (last + value) + curved)
            });
            nodes.push([integral, value, slope]);
        }
        // A product takes less time than a quotient, once for each texel of a lobe.
        let steps_per_rad = 1.0 / step_rad;
        Self { exponent, least, end_rad, step_rad, steps_per_rad, nodes: nodes.into() }
    }

    /// The lobe in the azimuth of a slice, which must have this exponent.
    pub(crate) fn along(&self, slice: &Slice) -> PhongArc<'_> {
        let reach = slice.a.hypot(slice.b);
        // 0 where the azimuth is at right angles to a level lobe.
        let scale = 0.5 * reach.powf(self.exponent) / reach.max(f64::MIN_POSITIVE);
        PhongArc {
            integral: self,
            middle_rad: slice.b.atan2(slice.a),
            half_rad: (self.least / reach).min(1.0).acos(),
            a: scale * (self.exponent + 1.0) * slice.a,
            b: scale * slice.b,
        }
    }

    /// As [`Slice::light`], without powers.
    pub(crate) fn light(&self, slice: &Slice, [low, high]: [f64; 2]) -> f64 {
        let low = low.max(slice.low);
        if high <= low {
            return 0.0;
        }
        let arc = self.along(slice);
        arc.up_to(high) - arc.up_to(low)
    }

    /// ∫cosⁿ⁺¹ up to an angle, and cosⁿ⁺¹ there.
    fn at(&self, angle_rad: f64) -> [f64; 2] {
        let from_end_rad = angle_rad.clamp(-self.end_rad, self.end_rad) + self.end_rad;
        let place = from_end_rad * self.steps_per_rad;
        let node = (place as usize).min(self.nodes.len() - 2);
        let x = place - node as f64;
        let [first, second] = [self.nodes[node], self.nodes[node + 1]];
        // Hermite's cubic.
        let rest = 1.0 - x;
        let (across, from, to) = (x * x * (3.0 - 2.0 * x), x * rest * rest, -x * x * rest);
        [0, 1].map(|i| {
            let slopes = from * first[i + 1] + to * second[i + 1];
            first[i] + across * (second[i] - first[i]) + self.step_rad * slopes
        })
    }
}

/// A lobe in one azimuth.
pub(crate) struct PhongArc<'a> {
    integral: &'a PhongIntegral,
    middle_rad: f64,
    half_rad: f64,
    a: f64,
    b: f64,
}

impl PhongArc<'_> {
    /// Elevations beyond which the lobe is negligible.
    pub(crate) fn range(&self) -> [f64; 2] {
        [self.middle_rad - self.half_rad, self.middle_rad + self.half_rad]
    }

    /// π times the weights' integral from below the lobe up to an elevation; the slice's `low` is ignored.
    pub(crate) fn up_to(&self, elevation_rad: f64) -> f64 {
        let [integral, value] = self.integral.at(elevation_rad - self.middle_rad);
        self.a * integral + self.b * value
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::Receiver;
    use glam::DVec3;
    use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2, FRAC_PI_4, PI};

    /// Gauss' rule over the lobe itself shares nothing with the table but the rim that both leave out. The table errs as
    /// [`STEPS`] states, times (n + 1) / 2 for the integral of a width of 1/√(n + 1): 4e-9 √(n + 1). Beside a rim of a low
    /// power that is not whole Gauss' rule errs more, by 8e-8 at 2.5.
    #[test]
    fn the_table_agrees_with_gauss_rule() {
        for exponent in [0.0_f64, 0.1, 0.5, 1.0, 2.5, 20.0, 1000.0, 1e4] {
            let is_steep = exponent > 0.0 && exponent < 1.0;
            let most = if is_steep { 2e-3 } else { 1e-7 * (exponent + 1.0).sqrt() };
            let table = PhongIntegral::of(exponent);
            for tilt in 0..6 {
                let (sin, cos) = (0.22 * f64::from(tilt)).sin_cos();
                let receiver = Receiver {
                    normal: DVec3::Z,
                    phong_lobe: Some((DVec3::new(sin, 0.0, cos), exponent)),
                };
                for azimuth in 0..12 {
                    for horizon in 0..16 {
                        let horizon = 0.1 * f64::from(horizon) - 0.05;
                        let slice = receiver.slice(0.53 * f64::from(azimuth)).above(horizon);
                        for high in [FRAC_PI_2, horizon + 0.03] {
                            let wanted = slice.light(-FRAC_PI_2, high);
                            let found = table.light(&slice, [-FRAC_PI_2, high]);
                            assert!(
                                (found - wanted).abs() < most,
                                "{exponent} {tilt} {azimuth} {horizon} {high}: {found} {wanted}"
                            );
                        }
                    }
                }
            }
        }
    }

    /// The whole lobe about the zenith: (n + 1) / 2 · ∫cosⁿt cos ω with ω₀ = π/2 is 1/2 on either side.
    #[test]
    fn a_lobe_about_the_zenith_is_a_half() {
        for exponent in [0.0, 0.3, 1.0, 20.0, 1e4] {
            let lobe = Receiver { normal: DVec3::Z, phong_lobe: Some((DVec3::Z, exponent)) };
            let slice = lobe.slice(0.7);
            let light = PhongIntegral::of(exponent).light(&slice, [-FRAC_PI_2, FRAC_PI_2]);
            assert!((light - 0.5).abs() < 1e-8, "{exponent}: {light}");
        }
    }

    /// A wall that faces east has N = r = (1, 0, 0). In azimuth 0 this gives a = 1, b = 0, low = atan2(-1, 0) = -π/2,
    /// so every elevation counts: the light is (n + 1)/2 · ∫cosⁿ⁺¹ω dω. The antiderivatives of cos, cos² and cos³ are
    /// sin ω, ω/2 + sin 2ω/4 and sin ω - sin³ω/3. The light of the elevations is:
    ///
    /// - -π/2 to π/2: ½ · 2 = 1, 1 · π/2, 3/2 · 4/3 = 2;
    /// - 0 to π/2: half of these, as cosⁿ⁺¹ is even;
    /// - -π/2 to π/6: ½ (½ + 1) = 3/4, π/12 + √3/8 + π/4 = π/3 + √3/8, 3/2 (½ - 1/24 + 2/3) = 27/16.
    ///
    /// Tolerance: [`STEPS`], with steps of 1/(32 √(n + 1)).
    #[test]
    fn a_level_lobe_has_the_integrals_of_powers_of_the_cosine() {
        let lobe = |exponent| Receiver { normal: DVec3::X, phong_lobe: Some((DVec3::X, exponent)) };
        let cut = PI / 3.0 + 3_f64.sqrt() / 8.0;
        for (exponent, whole, cut) in [(0.0, 1.0, 0.75), (1.0, FRAC_PI_2, cut), (2.0, 2.0, 1.6875)]
        {
            let slice = lobe(exponent).slice(0.0);
            assert_eq!([slice.a, slice.b, slice.low], [1.0, 0.0, -FRAC_PI_2]);
            let table = PhongIntegral::of(exponent);
            for (low, high, wanted) in [
                (-FRAC_PI_2, FRAC_PI_2, whole),
                (0.0, FRAC_PI_2, 0.5 * whole),
                (-FRAC_PI_2, PI / 6.0, cut),
            ] {
                let light = table.light(&slice, [low, high]);
                let above = table.light(&slice.above(low), [-FRAC_PI_2, high]);
                assert!((light - wanted).abs() < 1e-8, "{exponent} {low} {high}: {light}");
                assert_eq!(above, light, "{exponent} {low} {high}");
            }
        }
    }

    /// A slope of 45° to the east has N = r = (1, 0, 1)/√2. In azimuth 0 this gives a = b = 1/√2 and low = -π/4; both
    /// parts of the integral count. (n + 1)/2 · ∫(a cos ω + b sin ω)ⁿ cos ω dω from -π/4 to π/2, by elementary
    /// antiderivatives in ω:
    ///
    /// - n = 0: ½ [sin ω] = ½ (1 + 1/√2);
    /// - n = 1: 1/√2 [ω/2 + sin 2ω/4 + sin²ω/2] = 1/√2 (3π/8 + ½);
    /// - n = 2: ¾ [sin ω - ⅔ cos³ω] = ¾ (1 + 4/(3√2)) = ¾ + 1/√2.
    #[test]
    fn a_tilted_lobe_has_its_closed_form() {
        let along = DVec3::new(FRAC_1_SQRT_2, 0.0, FRAC_1_SQRT_2);
        let expected =
            [0.5 * (1.0 + FRAC_1_SQRT_2), FRAC_1_SQRT_2 * (0.375 * PI + 0.5), 0.75 + FRAC_1_SQRT_2];
        for (exponent, expected) in [0.0, 1.0, 2.0].into_iter().zip(expected) {
            let lobe = Receiver { normal: along, phong_lobe: Some((along, exponent)) };
            let slice = lobe.slice(0.0);
            assert!((slice.low + FRAC_PI_4).abs() < 1e-15);
            let light = PhongIntegral::of(exponent).light(&slice, [-FRAC_PI_2, FRAC_PI_2]);
            assert!((light - expected).abs() < 1e-8, "{exponent}: {light} {expected}");
        }
    }
}

//! Incident light of a key light's wedge as a series, by the four nodes of the shader.

use crate::tolerance::EPSILON;
use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::plan::Azimuth;

/// Nodes and weights of Gauss and Legendre on [0, 1].
const NODES: [[f64; 2]; 4] = [
    [0.069_431_844_202_973_71, 0.173_927_422_568_726_93],
    [0.330_009_478_207_571_87, 0.326_072_577_431_273_07],
    [0.669_990_521_792_428_1, 0.326_072_577_431_273_07],
    [0.930_568_155_797_026_3, 0.173_927_422_568_726_93],
];

/// The series of a wedge of radiance 1 above the slope `lowest`, and the tolerance of its coefficients, up to order 6, where that slope errs by
/// `off_slope`.
///
/// The nodes are in the sine of elevation, which changes by no more than the slope. Where its lower end moves, the sum changes by
/// |Y_lm| ≤ 1, and by what the nodes move: Y_lm changes by 5 per radian of elevation. A node at x of an interval of sines moves by 1 - x of the
/// end, and the interval times that over the cosine of elevation is at most √2 (1 - x) / √x below horizontal and √(2 - 2x) above: a mean of
/// 1.74. That is 10 in all. Y_lm errs by 100 ε, the ends of the interval by 6 ε.
/// The cosine of elevation is a root whose square errs by 6 ε: times 5 and the width, by 114 ε of the width's root.
pub fn key_arriving(
    order: usize,
    azimuth: &Azimuth,
    lowest: f64,
    off_slope: f64,
) -> (Vec<f64>, f64) {
    let sine = |slope: f64| slope / slope.hypot(1.0);
    let low = sine(lowest.max(azimuth.low_slope.into()));
    let width = sine(azimuth.high_slope.into()) - low;
    let wedge = f64::from(azimuth.wedge_rad);
    let mut series = vec![0.0; order * order];
    if width > 0.0 {
        for [node, weight] in NODES {
            let up = low + node * width;
            let along = (1.0 - up * up).max(0.0).sqrt();
            let e = DVec3::new(
                along * f64::from(azimuth.cos_phi),
                along * f64::from(azimuth.sin_phi),
                up,
            );
            let weight = weight * width * wedge;
            series.iter_mut().zip(evaluate(order, e)).for_each(|(sum, y)| *sum += weight * y);
        }
    }
    let off = 10.0 * (off_slope + 12.0 * EPSILON) + 320.0 * EPSILON * width.max(0.0).sqrt();
    (series, wedge * off)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::plan::azimuths::even;
    use std::f64::consts::FRAC_PI_2;

    /// Against the midpoint rule over 20,000 elevations. Even m: exact, but for the slopes' f32 and the midpoint rule. Odd m: within the
    /// 1 % of the wedge's solid angle that the shader states, 4 % from nadir to zenith.
    #[test]
    fn four_nodes_hold_a_wedge() {
        const ORDER: usize = 6;
        let one = even(16, [1.0; 2])[3];
        let wedge = f64::from(one.wedge_rad);
        let (cos, sin) = (f64::from(one.cos_phi), f64::from(one.sin_phi));
        let mut odd_differs = false;
        for ([low, high], stated) in [
            ([-FRAC_PI_2, FRAC_PI_2], 0.04),
            ([0.0, FRAC_PI_2], 0.01),
            ([0.3, 1.2], 0.01),
            ([-0.4, 0.1], 0.01),
        ] {
            let of = Azimuth {
                low_slope: low.tan().max(-1e9) as f32,
                high_slope: high.tan().min(1e9) as f32,
                ..one
            };
            let (found, _) = key_arriving(ORDER, &of, -1e9, 0.0);
            let steps = 20_000;
            let width = (high - low) / f64::from(steps);
            let mut want = vec![0.0; ORDER * ORDER];
            for i in 0..steps {
                let (up, along) = (low + width * (f64::from(i) + 0.5)).sin_cos();
                let y = evaluate(ORDER, DVec3::new(along * cos, along * sin, up));
                want.iter_mut().zip(y).for_each(|(sum, y)| *sum += wedge * width * along * y);
            }
            let solid = wedge * (high.sin() - low.sin());
            for l in 0..ORDER as i32 {
                for m in -l..=l {
                    let k = (l * l + l + m) as usize;
                    let off = (found[k] - want[k]).abs();
                    let bound = if m % 2 == 0 { 2e-7 } else { stated * solid };
                    assert!(off <= bound, "{low} {high} {l} {m}: {off} of {bound}");
                    odd_differs |= m % 2 != 0 && off > 2e-7;
                }
            }
        }
        assert!(odd_differs);
    }
}

//! The visual model of ꟻLIP: filtered colours, features, and the difference of a pixel.
//!
//! "§" is a section of the paper cited in [`super`].

use glam::{DMat3, DVec3};
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// Weight and b (square degrees) of the Gaussians e^(-b f²), f in cycles per degree. Their sum is
/// the contrast sensitivity of a channel (§4.1.1, table 1).
const ACHROMATIC: &[[f64; 2]] = &[[1.0, 0.0047]];
const RED_GREEN: &[[f64; 2]] = &[[1.0, 0.0053]];
const BLUE_YELLOW: &[[f64; 2]] = &[[34.1, 0.04], [13.5, 0.025]];
/// The largest b above: the widest filter.
const WIDEST: f64 = 0.04;
/// Exponent of the colour difference (§4.1.4).
const COLOUR_EXPONENT: f64 = 0.7;
/// Share of the largest colour difference that is mapped to [`KNEE_ERROR`] (§4.1.4).
const KNEE: f64 = 0.4;
const KNEE_ERROR: f64 = 0.95;
/// Width of the most visible feature, degrees (§4.2.1).
const FEATURE_WIDTH_DEG: f64 = 0.082;
/// Exponent of the feature difference (§4.2.2).
const FEATURE_EXPONENT: f64 = 0.5;
/// Filtered values of one pixel.
pub(super) struct Filtered {
    /// L*, a*, b* after filtering, a* and b* adjusted to lightness.
    colour: DVec3,
    /// Strength of an edge and of a point, in units of white.
    edge: f64,
    point: f64,
}

/// One-dimensional filters; the two-dimensional ones are products of them.
pub(super) struct Eye {
    to_xyz: DMat3,
    to_rgb: DMat3,
    white: DVec3,
    largest: f64,
    /// Radius of the widest filter, pixels.
    reach: usize,
    /// Per channel of YCxCz: the weight of each Gaussian and the Gaussian, of sum 1.
    sensitivity: [Vec<(f64, Vec<f64>)>; 3],
    feature_gaussian: Vec<f64>,
    feature_edge: Vec<f64>,
    feature_point: Vec<f64>,
}

impl Eye {
    pub fn new(pixels_per_degree: f64) -> Self {
        let [to_xyz, to_rgb] = srgb_xyz();
        // e^(-b f²) is the transform of a Gaussian of variance b/(2π²) square degrees (§4.1.1).
        let sigma = |b: f64| (b / 2.0).sqrt() / PI * pixels_per_degree;
        let reach = (3.0 * sigma(WIDEST)).ceil() as usize;
        // §4.1.1 uses the one-dimensional weights, a √(π/b), in two dimensions.
        let filter = |parts: &[[f64; 2]]| {
            let raw: Vec<_> = parts
                .iter()
                .map(|[a, b]| {
                    let line = gaussian(sigma(*b), reach);
                    let sum: f64 = line.iter().sum();
                    (a * (PI / b).sqrt() * sum * sum, scaled(&line, 1.0 / sum))
                })
                .collect();
            let total: f64 = raw.iter().map(|(weight, _)| weight).sum();
            raw.into_iter().map(|(weight, line)| (weight / total, line)).collect()
        };
        // §4.2.1: derivatives of a Gaussian; positive and negative weights each sum to 1.
        let sigma = 0.5 * FEATURE_WIDTH_DEG * pixels_per_degree;
        let radius = (3.0 * sigma).ceil() as usize;
        let gaussian = gaussian(sigma, radius);
        let weighted = |factor: &dyn Fn(f64) -> f64| {
            let at = |(i, g): (usize, &f64)| factor(i as f64 - radius as f64) * g;
            balanced(gaussian.iter().enumerate().map(at).collect())
        };
        let mut eye = Self {
            to_xyz,
            to_rgb,
            white: to_xyz * DVec3::ONE,
            largest: 0.0,
            reach: reach.max(radius),
            sensitivity: [filter(ACHROMATIC), filter(RED_GREEN), filter(BLUE_YELLOW)],
            feature_edge: weighted(&|x| -x),
            feature_point: weighted(&|x| (x / sigma).powi(2) - 1.0),
            feature_gaussian: scaled(&gaussian, 1.0 / gaussian.iter().sum::<f64>()),
        };
        // §4.1.4: green and blue have the largest colour distance in sRGB.
        eye.largest = hyab(eye.colour(DVec3::Y), eye.colour(DVec3::Z)).powf(COLOUR_EXPONENT);
        eye
    }

    /// `rows` is the first row and the number of rows.
    pub fn filtered(
        &self,
        picture: &[[f32; 3]],
        voids: &[bool],
        cols: usize,
        rows: (usize, usize),
    ) -> Vec<Filtered> {
        let (height, reach) = (picture.len() / cols, self.reach);
        let opponent = |i: usize| {
            let shown = |v: f32| if voids[i] { 0.0 } else { f64::from(v).clamp(0.0, 1.0) };
            let xyz = self.to_xyz * DVec3::from(picture[i].map(shown)) / self.white;
            // YCxCz, a linear relative of L*a*b* (§4.1.1).
            [116.0 * xyz.y - 16.0, 500.0 * (xyz.x - xyz.y), 200.0 * (xyz.y - xyz.z)]
        };
        let inside = |i: usize, side: usize| i.saturating_sub(reach).min(side - 1);
        let width = cols + 2 * reach;
        let mut window: [Vec<f64>; 3] = Default::default();
        for row in (rows.0..rows.0 + rows.1 + 2 * reach).map(|r| inside(r, height)) {
            for col in (0..width).map(|c| inside(c, cols)) {
                for (plane, v) in window.iter_mut().zip(opponent(row * cols + col)) {
                    plane.push(v);
                }
            }
        }
        let filtered = |channel: usize| {
            let mut sum = vec![0.0; rows.1 * cols];
            for (weight, line) in &self.sensitivity[channel] {
                let part = convolved(&window[channel], width, reach, line, line);
                sum.iter_mut().zip(part).for_each(|(s, p)| *s += weight * p);
            }
            sum
        };
        let colour = [0, 1, 2].map(filtered);
        // §4.2.1 detects features in the unfiltered Y, of 0 to 1.
        let mut grey = std::mem::take(&mut window[0]);
        grey.iter_mut().for_each(|y| *y = (*y + 16.0) / 116.0);
        let strength = |line: &[f64]| -> Vec<f64> {
            let across = convolved(&grey, width, reach, line, &self.feature_gaussian);
            let down = convolved(&grey, width, reach, &self.feature_gaussian, line);
            across.iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
        };
        let (edges, points) = (strength(&self.feature_edge), strength(&self.feature_point));
        (0..rows.1 * cols)
            .map(|i| {
                let y = (colour[0][i] + 16.0) / 116.0;
                let xyz = DVec3::new(y + colour[1][i] / 500.0, y, y - colour[2][i] / 200.0);
                let rgb = (self.to_rgb * (xyz * self.white)).clamp(DVec3::ZERO, DVec3::ONE);
                Filtered { colour: self.colour(rgb), edge: edges[i], point: points[i] }
            })
            .collect()
    }

    /// CIE L*a*b* of linear sRGB, with the Hunt effect: a* and b* fade with lightness (§4.1.2).
    fn colour(&self, rgb: DVec3) -> DVec3 {
        const KINK: f64 = 6.0 / 29.0;
        let xyz = self.to_xyz * rgb / self.white;
        let root = |t: f64| {
            if t > KINK.powi(3) { t.cbrt() } else { t / (3.0 * KINK * KINK) + 4.0 / 29.0 }
        };
        let [x, y, z] = xyz.to_array().map(root);
        let lightness = 116.0 * y - 16.0;
        let chroma = 0.01 * lightness;
        DVec3::new(lightness, chroma * 500.0 * (x - y), chroma * 200.0 * (y - z))
    }

    pub fn difference(&self, a: &Filtered, b: &Filtered) -> f64 {
        // §4.1.4: compresses large differences into the last twentieth.
        let apart = hyab(a.colour, b.colour).powf(COLOUR_EXPONENT);
        let knee = KNEE * self.largest;
        let colour = if apart < knee {
            KNEE_ERROR / knee * apart
        } else {
            KNEE_ERROR + (apart - knee) / (self.largest - knee) * (1.0 - KNEE_ERROR)
        };
        // §4.2.2, §4.3.
        let feature = (a.edge - b.edge).abs().max((a.point - b.point).abs());
        let feature = (FRAC_1_SQRT_2 * feature).powf(FEATURE_EXPONENT);
        colour.powf(1.0 - feature).min(1.0)
    }
}

/// Linear sRGB to XYZ and back: primaries of IEC 61966-2-1, white D65 of CIE 15:2004.
fn srgb_xyz() -> [DMat3; 2] {
    let xyz = |x: f64, y: f64| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let primaries = DMat3::from_cols(xyz(0.64, 0.33), xyz(0.30, 0.60), xyz(0.15, 0.06));
    let luminance = primaries.inverse() * xyz(0.31271, 0.32902);
    let to_xyz = primaries * DMat3::from_diagonal(luminance);
    [to_xyz, to_xyz.inverse()]
}

/// City-block distance in lightness, Euclidean in chroma (§4.1.3).
fn hyab(a: DVec3, b: DVec3) -> f64 {
    (a.x - b.x).abs() + (a.y - b.y).hypot(a.z - b.z)
}

/// e^(-x²/2σ²) at whole x from -radius to radius.
fn gaussian(sigma: f64, radius: usize) -> Vec<f64> {
    let at = |i: usize| (-((i as f64 - radius as f64) / sigma).powi(2) / 2.0).exp();
    (0..=2 * radius).map(at).collect()
}

fn scaled(line: &[f64], factor: f64) -> Vec<f64> {
    line.iter().map(|v| factor * v).collect()
}

/// Scales positive weights to a sum of 1 and negative ones to -1.
fn balanced(mut line: Vec<f64>) -> Vec<f64> {
    let [above, below] = [1.0, -1.0].map(|s| line.iter().map(|v| (s * v).max(0.0)).sum::<f64>());
    line.iter_mut().for_each(|v| *v /= if *v > 0.0 { above } else { below });
    line
}

/// Filters a window of `width` columns by `across` · `down`. The result is smaller by `reach` on
/// every side.
fn convolved(window: &[f64], width: usize, reach: usize, across: &[f64], down: &[f64]) -> Vec<f64> {
    let cols = width - 2 * reach;
    let start = reach - across.len() / 2;
    let mut narrow = vec![0.0; window.len() / width * cols];
    for (to, from) in narrow.chunks_mut(cols).zip(window.chunks(width)) {
        for (i, weight) in across.iter().enumerate() {
            to.iter_mut().zip(&from[start + i..]).for_each(|(t, f)| *t += weight * f);
        }
    }
    let start = reach - down.len() / 2;
    let mut all = vec![0.0; narrow.len() - 2 * reach * cols];
    for (row, to) in all.chunks_mut(cols).enumerate() {
        for (i, weight) in down.iter().enumerate() {
            let from = &narrow[(row + start + i) * cols..];
            to.iter_mut().zip(from).for_each(|(t, f)| *t += weight * f);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::super::{PIXELS_PER_DEGREE, map};
    use super::*;

    /// Error of two uniform pictures: filters do not change them, and there are no features.
    fn flat(a: [f32; 3], b: [f32; 3]) -> f64 {
        let errors = map(&[a; 35], &[b; 35], 7, PIXELS_PER_DEGREE).unwrap();
        assert!(errors.iter().all(|e| (e - errors[0]).abs() < 1e-6), "{errors:?}");
        errors[0].into()
    }

    /// §4.1.4 of a distance, with the largest from L*a*b* of sRGB's green and blue in published
    /// tables: (87.735, -86.183, 83.179) and (32.297, 79.188, -107.860); Hunt: a*, b* · L*/100.
    fn mapped(hyab: f64) -> f64 {
        let (green, blue) = ([87.735, -86.183, 83.179], [32.297, 79.188, -107.860]);
        let hunt = |c: [f64; 3]| [c[0], c[1] * c[0] / 100.0, c[2] * c[0] / 100.0];
        let ([l, a, b], [m, c, d]) = (hunt(green), hunt(blue));
        let largest = (l - m + ((a - c).powi(2) + (b - d).powi(2)).sqrt()).powf(0.7);
        let share = hyab.powf(0.7) / largest;
        if share < 0.4 { 0.95 * share / 0.4 } else { 0.95 + 0.05 * (share - 0.4) / 0.6 }
    }

    /// Tables round L*a*b* to 0.001 and their white to 1e-4, which changes a* and b* by at most
    /// 500e-4/3: 1e-4 of a distance of 203, times an error of at most 1.
    const TABLES: f64 = 1e-4;

    #[test]
    fn colours_have_their_known_errors() {
        // The maximum by definition.
        assert!((flat([0.0, 1.0, 0.0], [0.0, 0.0, 1.0]) - 1.0).abs() < 1e-7);
        // L* 100 and 0.
        assert!((flat([1.0; 3], [0.0; 3]) - mapped(100.0)).abs() < TABLES);
        // Luminance t³ has L* 116 t - 16: 53.6 and 42, below the knee; 100 and 42 above it.
        let grey = |t: f32| [t.powi(3); 3];
        assert!((flat(grey(0.6), grey(0.5)) - mapped(11.6)).abs() < TABLES);
        assert!((flat(grey(1.0), grey(0.5)) - mapped(58.0)).abs() < TABLES);
        assert!(
            (mapped(11.6) - 0.32).abs() < 0.01 && mapped(58.0) > 0.95,
            "both sides of the knee"
        );
        // Below (6/29)³, L* is linear, 903.3 times luminance: 0.9033 at 0.001.
        assert!((flat([0.001; 3], [0.0; 3]) - mapped(0.9033)).abs() < TABLES);
        // sRGB's red in tables: (53.241, 80.092, 67.203); Hunt: 0.53241 of a* and b*.
        let red = (53.241 - 42.0) + 0.53241 * f64::hypot(80.092, 67.203);
        assert!((flat([1.0, 0.0, 0.0], grey(0.5)) - mapped(red)).abs() < TABLES);
    }

    /// A grating of f cycles per degree keeps S(f) of its contrast. In two dimensions the weights a
    /// √(π/b) multiply Gaussians of area b/π: shares a √b. Filters end at three deviations of the
    /// widest Gaussian, an error of at most erfc(3/√2) = 0.0027 of it.
    #[test]
    fn contrast_sensitivity_is_that_of_the_formula() {
        let eye = Eye::new(PIXELS_PER_DEGREE);
        let cols = 200;
        let width = cols + 2 * eye.reach;
        for f in [0.0, 2.0, 4.0, 8.0, 16.0] {
            let wave = |c: usize| (2.0 * PI * f * c as f64 / PIXELS_PER_DEGREE).cos();
            let row: Vec<f64> = (0..width).map(wave).collect();
            let window = row.repeat(2 * eye.reach + 1);
            for (channel, parts) in [ACHROMATIC, RED_GREEN, BLUE_YELLOW].iter().enumerate() {
                let shares: f64 = parts.iter().map(|[a, b]| a * b.sqrt()).sum();
                let s: f64 =
                    parts.iter().map(|[a, b]| a * b.sqrt() * (-b * f * f).exp()).sum::<f64>()
                        / shares;
                let mut through = vec![0.0; cols];
                for (share, line) in &eye.sensitivity[channel] {
                    let part = convolved(&window, width, eye.reach, line, line);
                    through.iter_mut().zip(part).for_each(|(t, p)| *t += share * p);
                }
                for (c, t) in through.iter().enumerate() {
                    let expected = s * wave(c + eye.reach);
                    assert!((t - expected).abs() < 2.0 * 0.0027, "{f} {channel} {t} {expected}");
                }
            }
        }
    }

    /// Black left of column 20 and white from there on: the weights on one side sum to 1, so both
    /// columns at the step have an edge of 1. A black band in white where the point filter is
    /// negative (|x| < σ = 2.75): the rest sum to 1, and its centre has no edge.
    #[test]
    fn features_have_their_known_strength() {
        let eye = Eye::new(PIXELS_PER_DEGREE);
        let filtered = |white: &dyn Fn(usize) -> bool| {
            let picture: Vec<[f32; 3]> =
                (0..40 * 5).map(|i| [f32::from(white(i % 40)); 3]).collect();
            eye.filtered(&picture, &[false; 200], 40, (0, 5))
        };
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        let step = filtered(&|col| col >= 20);
        for row in 0..5 {
            assert!(near(step[row * 40 + 19].edge, 1.0) && near(step[row * 40 + 20].edge, 1.0));
            for far in [0, 39] {
                let s = &step[row * 40 + far];
                assert!(near(s.edge, 0.0) && near(s.point, 0.0), "{} {}", s.edge, s.point);
            }
        }
        let band = filtered(&|col: usize| col.abs_diff(20) > 2);
        assert!(near(band[60].point, 1.0) && near(band[60].edge, 0.0));
        // Against uniform white, an edge or point of 1 is a difference of (1/√2)^0.5 (§4.2.2), so
        // the colour difference has the exponent 1 - 0.8409; the colour is the same here.
        let plain = |edge| Filtered { colour: DVec3::new(50.0, 0.0, 0.0), edge, point: 0.0 };
        let dark = |edge| Filtered { colour: DVec3::new(40.0, 0.0, 0.0), edge, point: 0.0 };
        let (without, with) =
            (eye.difference(&plain(0.0), &dark(0.0)), eye.difference(&plain(1.0), &dark(0.0)));
        assert!(near(with, without.powf(1.0 - 0.5_f64.powf(0.25))), "{without} {with}");
        assert!(near(with, eye.difference(&plain(0.0), &dark(1.0))) && with > without);
    }
}

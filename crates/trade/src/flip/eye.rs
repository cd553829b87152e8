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

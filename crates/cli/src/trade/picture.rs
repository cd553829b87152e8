//! Pictures of a setting: its light, its difference from the ground truth, and ꟻLIP.

use ridgelight::Result;
use ridgelight::scene::HeightField;
use ridgelight::scene::Tone;
use ridgelight_io as files;
use ridgelight_trade::flip::{self, FlipError, PIXELS_PER_DEGREE};
use ridgelight_trade::statistics::quantiles;

use super::ground_truth::GroundTruth;

/// Longest side of a picture in the report, pixels.
const PICTURE_SIDE: usize = 240;

/// Radiances at the ends of the grey scale, from the ground truth. The lower end keeps a faint
/// relief under an even sky from being white on white.
pub struct Tones {
    pub black: f32,
    pub white: f32,
    /// The ground truth's mean radiance.
    pub mean: f64,
}

impl Tones {
    pub fn of(planes: &[Vec<f32>]) -> Self {
        let mut known: Vec<f64> =
            planes.iter().flatten().map(|v| f64::from(*v)).filter(|v| v.is_finite()).collect();
        let mean = known.iter().sum::<f64>() / known.len().max(1) as f64;
        let [low, high] = quantiles(&mut known, [0.005, 0.99]).unwrap_or([0.0, 1.0]);
        let white = if high > 0.0 { high } else { 1.0 };
        // A field of one radiance keeps its range.
        let black = if low < 0.999 * white { low } else { 0.0 };
        Self { black: black as f32, white: white as f32, mean }
    }

    /// The grey scale, in words.
    pub fn text(&self) -> String {
        let share = |v: f32| {
            crate::setup::terminal::digits(f64::from(v) / self.mean.max(f64::MIN_POSITIVE))
        };
        format!(
            "Light: black at {} and white at {} of the ground truth's mean radiance, its 0.5th \
                and 99th percentiles.",
            share(self.black),
            share(self.white)
        )
    }
}

/// Downsized PNGs, and ꟻLIP.
pub struct Pictures {
    pub light: Vec<u8>,
    pub difference: Vec<u8>,
    /// The difference at full saturation, over the ground truth's mean.
    pub scale: f64,
    /// At full size, at an exposure where the ground truth's 99th percentile is white, 67 pixels
    /// per degree.
    pub flip: FlipError,
}

/// `p99`: the 99th percentile of the differences over the ground truth's mean.
pub fn pictures(
    field: &HeightField,
    planes: &[Vec<f32>],
    ground_truth: &GroundTruth,
    p99: f64,
) -> Result<Pictures> {
    let tones = &ground_truth.tones;
    let scale = round_up(p99);
    let mean = |planes: &[Vec<f32>], i: usize| {
        planes.iter().map(|p| f64::from(p[i])).sum::<f64>() / planes.len() as f64
    };
    let texels = downsized(field, |grid_points| {
        // The largest of either sign: a mean would hide single texels.
        let largest = grid_points
            .map(|i| mean(planes, i) - mean(&ground_truth.planes, i))
            .fold(0.0, |m: f64, d| if d.abs() > m.abs() { d } else { m });
        let share = largest / tones.mean.abs().max(f64::MIN_POSITIVE) / scale;
        let full = if share > 0.0 { [1.0, 0.35, 0.02] } else { [0.05, 0.3, 1.0] };
        full.map(|c: f64| (0.02 + share.abs().min(1.0) * (c - 0.02)) as f32)
    });
    let difference = encode(field, &texels, 1.0)?;
    let toned = |planes: &[Vec<f32>]| -> Vec<[f32; 3]> {
        let last = planes.len() - 1;
        (0..planes[0].len())
            .map(|i| [0, 1, 2].map(|c| planes[c.min(last)][i] / tones.white))
            .collect()
    };
    let map =
        flip::map(&toned(planes), &toned(&ground_truth.planes), field.cols(), PIXELS_PER_DEGREE)?;
    let flip = FlipError::of(&map, field.cols())?;
    Ok(Pictures { light: light_png(field, planes, ground_truth)?, difference, scale, flip })
}

/// The least of 1, 2 and 5 times a power of ten that is no less, so that scales are comparable.
fn round_up(value: f64) -> f64 {
    if !(value > 0.0 && value.is_finite()) {
        return 1.0;
    }
    let decade = 10_f64.powf(value.log10().floor());
    // 10 as well, because the logarithm rounds.
    [1.0, 2.0, 5.0, 10.0].map(|m| m * decade).into_iter().find(|s| *s >= value).unwrap_or(value)
}

/// Sides of the downsized picture, and texels per pixel.
fn small(field: &HeightField) -> ([usize; 2], usize) {
    let factor = field.rows().max(field.cols()).div_ceil(PICTURE_SIDE).max(1);
    ([field.rows().div_ceil(factor), field.cols().div_ceil(factor)], factor)
}

/// One value per pixel of the downsized picture, from the texels under it that hold data.
fn downsized<T>(
    field: &HeightField,
    each: impl Fn(&mut dyn Iterator<Item = usize>) -> T,
) -> Vec<T> {
    let ([rows, cols], factor) = small(field);
    let range = |i: usize, side: usize| i * factor..((i + 1) * factor).min(side);
    (0..rows * cols)
        .map(|i| {
            let columns = range(i % cols, field.cols());
            let rows = range(i / cols, field.rows());
            let mut all = rows
                .flat_map(move |r| columns.clone().map(move |c| r * field.cols() + c))
                .filter(|i| field.voids().is_none_or(|v| !v[*i]));
            each(&mut all)
        })
        .collect()
}

/// A PNG of radiance between the tones' black and white.
pub fn light_png(
    field: &HeightField,
    planes: &[Vec<f32>],
    ground_truth: &GroundTruth,
) -> Result<Vec<u8>> {
    let tones = &ground_truth.tones;
    let last = planes.len() - 1;
    let texels = downsized(field, |grid_points| {
        let (mut sum, mut count) = ([0.0_f64; 3], 0.0_f64);
        for i in grid_points {
            (0..3).for_each(|c| sum[c] += f64::from(planes[c.min(last)][i]));
            count += 1.0;
        }
        sum.map(|s| ((s / count.max(1.0)) as f32 - tones.black).max(0.0))
    });
    encode(field, &texels, (tones.white - tones.black).recip().min(f32::MAX))
}

fn encode(field: &HeightField, texels: &[[f32; 3]], exposure: f32) -> Result<Vec<u8>> {
    let [rows, cols] = small(field).0;
    let empty = downsized(field, |grid_points| grid_points.next().is_none());
    let transparent = empty.contains(&true).then_some(&empty[..]);
    files::encode_png(rows, cols, texels, transparent, Tone { exposure, ..Tone::default() }, &[])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scales_are_round() {
        let found = [0.011, 0.02, 0.021, 0.3, 0.6, 1.0, 9.9, 0.0, f64::NAN].map(round_up);
        for (found, expected) in
            found.into_iter().zip([0.02, 0.02, 0.05, 0.5, 1.0, 1.0, 10.0, 1.0, 1.0])
        {
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
        }
    }
}

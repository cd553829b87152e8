//! One setting measured: its time, its error, its picture.

use std::time::Instant;

use ridgelight::files::{self, Tone};
use ridgelight::gpu::{Frame, Timing};
use ridgelight::measure::statistics::Summary;
use ridgelight::measure::trade::Value;
use ridgelight::scene::{HeightField, Quality};
use ridgelight::{Error, Result};

use super::rig::Rig;
use super::truth::{Distance, Truth};

/// Draws after one that warms up: fewer, which is said, once they take this share of the budget.
const DRAWS: usize = 7;
const FEWEST: usize = 3;
const TIMING: f64 = 0.005;
const COMPILING_S: f64 = 20.0;
/// Longest side of a picture in the report, pixels.
const PICTURE_SIDE: usize = 240;

pub struct Point {
    /// Its number among the places of the walk.
    pub place: usize,
    /// Nanoseconds of all passes of a frame.
    pub total_ns: Summary,
    /// How often it was drawn.
    pub draws: usize,
    /// Median nanoseconds of each pass.
    pub passes: Vec<(String, f64)>,
    pub distance: Distance,
    /// Bytes on the device.
    pub bytes: u64,
    pub settings: Vec<(String, String)>,
    /// When it was begun and done, seconds from the start.
    pub at_s: [f64; 2],
    /// Median of each draw's time over that of the baseline drawn right after it: what a busy machine
    /// or a changing clock does to both falls out. 1 for the baseline itself.
    pub ratio: f64,
    /// Nanoseconds of those draws of the baseline.
    pub baseline_ns: Vec<f64>,
    /// Kept while it is on the frontier.
    pub pictures: Option<Pictures>,
}

/// PNGs, downsized.
pub struct Pictures {
    pub light: Vec<u8>,
    pub difference: Vec<u8>,
    /// The relative difference that has the full colour.
    pub scale: f64,
}

impl Point {
    /// Median nanoseconds of the baseline's frame beside its own draws.
    pub fn baseline_median(&self) -> f64 {
        Summary::of(&self.baseline_ns).map_or(0.0, |s| s.median)
    }

    /// Its cost in frames of the baseline.
    pub fn value(&self) -> Value {
        Value { cost: self.ratio, error: self.distance.rmse }
    }
}

/// Measures a quality beside the baseline, none for the baseline itself; its frame, too.
pub fn measure(
    rig: &mut Rig,
    truth: &Truth,
    place: usize,
    quality: &Quality,
    baseline: Option<&mut Frame>,
) -> Result<(Point, Frame)> {
    let begun_s = rig.spent();
    let mut frame = rig.frame(quality)?;
    match fill(rig, truth, place, begun_s, &mut frame, baseline) {
        Ok(point) => Ok((point, frame)),
        Err(error) => {
            rig.gpu.end(frame);
            Err(error)
        }
    }
}

fn fill(
    rig: &mut Rig,
    truth: &Truth,
    place: usize,
    begun_s: f64,
    frame: &mut Frame,
    mut baseline: Option<&mut Frame>,
) -> Result<Point> {
    let first = rig.gpu.draw(frame)?;
    let planes = rig.radiance(frame)?;
    let distance = truth.distance(&planes)?;
    let begun = Instant::now();
    let most = TIMING * rig.budget.as_secs_f64();
    let sum = |times: &[Timing]| times.iter().map(|t| t.ns).sum::<f64>();
    // The first compiles, up to seconds: only a frame much longer than that, and than what is left,
    // is timed by it.
    let long = sum(&first) * 1e-9 > rig.left().max(COMPILING_S);
    let mut runs: Vec<Vec<Timing>> = if long { vec![first] } else { Vec::new() };
    let mut baseline_ns = Vec::new();
    while runs.len() < DRAWS {
        let seconds = begun.elapsed().as_secs_f64();
        let enough = most * if runs.len() < FEWEST { 5.0 } else { 1.0 };
        if !runs.is_empty() && (long || seconds > enough) {
            break;
        }
        runs.push(rig.gpu.draw(frame)?);
        if let Some(baseline) = baseline.as_deref_mut() {
            baseline_ns.push(sum(&rig.gpu.draw(baseline)?));
        }
    }
    if let Some(baseline) = baseline.filter(|_| long) {
        baseline_ns.push(sum(&rig.gpu.draw(baseline)?));
    }
    let totals: Vec<f64> = runs.iter().map(|r| sum(r)).collect();
    let total_ns = Summary::of(&totals).filter(|s| s.min > 0.0).ok_or_else(|| Error::Device {
        doing: "timing a frame".into(),
        reason: "the device has no timestamps".into(),
    })?;
    let ratios: Vec<f64> = totals.iter().zip(&baseline_ns).map(|(ns, b)| ns / b).collect();
    let ratio = Summary::of(&ratios).map_or(1.0, |s| s.median);
    if baseline_ns.is_empty() {
        baseline_ns.clone_from(&totals);
    }
    let passes = (0..runs[0].len())
        .map(|i| {
            let times: Vec<f64> = runs.iter().map(|r| r[i].ns).collect();
            (runs[0][i].label.clone(), Summary::of(&times).map_or(0.0, |s| s.median))
        })
        .collect();
    let plan = frame.plan();
    let (bytes, settings) = (plan.bytes(), plan.settings.clone());
    let field = &rig.scene.field;
    let pictures = Some(pictures(field, &planes, truth, distance.p99.max(truth.own_error))?);
    Ok(Point {
        place,
        total_ns,
        draws: runs.len(),
        passes,
        distance,
        bytes,
        settings,
        at_s: [begun_s, rig.spent()],
        ratio,
        baseline_ns,
        pictures,
    })
}

/// Sides of the downsized picture, and samples a pixel.
fn small(field: &HeightField) -> ([usize; 2], usize) {
    let factor = field.rows().max(field.cols()).div_ceil(PICTURE_SIDE).max(1);
    ([field.rows().div_ceil(factor), field.cols().div_ceil(factor)], factor)
}

/// One value a pixel of the downsized picture, from the samples under it that hold data.
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

/// A PNG of radiance at an exposure where the truth's 99th percentile is white.
pub fn light_png(field: &HeightField, planes: &[Vec<f32>], truth: &Truth) -> Result<Vec<u8>> {
    let mut known: Vec<f32> =
        truth.planes.iter().flatten().copied().filter(|v| v.is_finite()).collect();
    known.sort_unstable_by(f32::total_cmp);
    let white = known.get(known.len() * 99 / 100).copied().unwrap_or(1.0);
    let last = planes.len() - 1;
    let texels = downsized(field, |samples| {
        let (mut sum, mut count) = ([0.0_f64; 3], 0.0_f64);
        for i in samples {
            (0..3).for_each(|c| sum[c] += f64::from(planes[c.min(last)][i]));
            count += 1.0;
        }
        sum.map(|s| (s / count.max(1.0)) as f32)
    });
    let exposure = if white > 0.0 && white.is_finite() { white.recip() } else { 1.0 };
    encode(field, &texels, exposure.min(f32::MAX))
}

fn pictures(
    field: &HeightField,
    planes: &[Vec<f32>],
    truth: &Truth,
    scale: f64,
) -> Result<Pictures> {
    let mean = |planes: &[Vec<f32>], i: usize| {
        planes.iter().map(|p| f64::from(p[i])).sum::<f64>() / planes.len() as f64
    };
    let known = || (0..planes[0].len()).filter(|i| field.voids().is_none_or(|v| !v[*i]));
    let brightness = known().map(|i| mean(&truth.planes, i)).sum::<f64>() / known().count() as f64;
    let scale = if scale > 0.0 { scale } else { 1.0 };
    let texels = downsized(field, |samples| {
        // The largest of either sign: a mean would hide what one texel has too much.
        let largest = samples
            .map(|i| mean(planes, i) - mean(&truth.planes, i))
            .fold(0.0, |m: f64, d| if d.abs() > m.abs() { d } else { m });
        let share = largest / brightness.abs().max(f64::MIN_POSITIVE) / scale;
        let full = if share > 0.0 { [1.0, 0.35, 0.02] } else { [0.05, 0.3, 1.0] };
        full.map(|c: f64| (0.02 + share.abs().min(1.0) * (c - 0.02)) as f32)
    });
    let difference = encode(field, &texels, 1.0)?;
    Ok(Pictures { light: light_png(field, planes, truth)?, difference, scale })
}

fn encode(field: &HeightField, texels: &[[f32; 3]], exposure: f32) -> Result<Vec<u8>> {
    let [rows, cols] = small(field).0;
    let empty = downsized(field, |samples| samples.next().is_none());
    let transparent = empty.contains(&true).then_some(&empty[..]);
    files::encode_png(rows, cols, texels, transparent, Tone { exposure })
}

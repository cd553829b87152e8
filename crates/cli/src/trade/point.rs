//! One measured setting: its time, its error, its picture.

use std::time::Instant;

use ridgelight::gpu::{Frame, Timing};
use ridgelight::scene::Quality;
use ridgelight::{Error, Result};
use ridgelight_trade::statistics::Summary;
use ridgelight_trade::trade::Value;

use super::ground_truth::{Distance, GroundTruth};
use super::picture::Pictures;
use super::rig::Rig;

/// Timed draws after one to warm up. There are fewer, as the report states, once they take this
/// share of the budget.
const DRAWS: usize = 7;
const FEWEST: usize = 3;
const TIMING: f64 = 0.005;
const COMPILING_S: f64 = 20.0;

pub struct Point {
    /// Its index among the places of the search.
    pub place: usize,
    /// Nanoseconds of all passes of each frame, and their statistics.
    pub totals_ns: Vec<f64>,
    pub total_ns: Summary,
    /// Median nanoseconds of each pass.
    pub passes: Vec<(String, f64)>,
    pub distance: Distance,
    /// Bytes on the device.
    pub bytes: u64,
    pub settings: Vec<(String, String)>,
    /// Begin and end of the measurement, seconds from the start.
    pub at_s: [f64; 2],
    /// Median of each draw's time over that of the baseline drawn right after it, which cancels a
    /// busy machine or a changing clock. 1 for the baseline itself.
    pub ratio: f64,
    ratios: Vec<f64>,
    /// Nanoseconds of those draws of the baseline.
    pub baseline_ns: Vec<f64>,
    /// Kept while it is on the frontier.
    pub pictures: Option<Pictures>,
}

impl Point {
    /// Median nanoseconds of the paired draws of the baseline.
    pub fn baseline_median(&self) -> f64 {
        Summary::of(&self.baseline_ns).map_or(0.0, |s| s.median)
    }

    /// Adds the times of a repeated measurement.
    pub fn add(&mut self, again: Point) {
        self.totals_ns.extend(again.totals_ns);
        self.total_ns = Summary::of(&self.totals_ns).unwrap_or(self.total_ns);
        self.ratios.extend(again.ratios);
        self.ratio = Summary::of(&self.ratios).map_or(self.ratio, |s| s.median);
        self.baseline_ns.extend(again.baseline_ns);
    }

    /// Its cost in frames of the baseline.
    pub fn value(&self) -> Value {
        Value { cost: self.ratio, error: self.distance.rmse }
    }
}

/// A measurement: a point without pictures yet, its frame and its radiance.
pub type Measured = (Point, Frame, Vec<Vec<f32>>);

/// Measures a quality paired with the baseline; without one for the baseline itself.
pub fn measure(
    rig: &mut Rig,
    ground_truth: &GroundTruth,
    place: usize,
    quality: &Quality,
    baseline: Option<&mut Frame>,
) -> Result<Measured> {
    let begun_s = rig.spent();
    let mut frame = rig.frame(quality)?;
    match fill(rig, ground_truth, place, begun_s, &mut frame, baseline) {
        Ok((point, planes)) => Ok((point, frame, planes)),
        Err(error) => {
            rig.gpu.end(frame);
            Err(error)
        }
    }
}

fn fill(
    rig: &mut Rig,
    ground_truth: &GroundTruth,
    place: usize,
    begun_s: f64,
    frame: &mut Frame,
    mut baseline: Option<&mut Frame>,
) -> Result<(Point, Vec<Vec<f32>>)> {
    let first = rig.gpu.draw(frame)?;
    let planes = rig.radiance(frame)?;
    let distance = ground_truth.distance(&planes)?;
    let begun = Instant::now();
    let most = rig.share(TIMING);
    let sum = |times: &[Timing]| times.iter().map(|t| t.ns).sum::<f64>();
    // The first draw compiles, for up to seconds. It is only timed if it takes far longer than that
    // and than the time left.
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
    let point = Point {
        place,
        totals_ns: totals,
        total_ns,
        passes,
        distance,
        bytes,
        settings,
        at_s: [begun_s, rig.spent()],
        ratio,
        ratios,
        baseline_ns,
        pictures: None,
    };
    Ok((point, planes))
}

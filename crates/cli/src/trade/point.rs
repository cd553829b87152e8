//! One measured setting: its time, its error, its picture.

use std::time::Instant;

use ridgelight::Result;
use ridgelight::gpu::{Frame, Timing};
use ridgelight::scene::Quality;
use ridgelight_trade::error::ImageError;
use ridgelight_trade::statistics::{Summary, median};
use ridgelight_trade::trade::Value;

use super::ground_truth::GroundTruth;
use super::picture::Pictures;
use super::rig::Rig;
use crate::setup::{self, total_ns};

/// Timed draws after one to warm up. There are fewer, as the report states, once they take this
/// share of the budget.
const DRAWS: usize = 7;
const FEWEST: usize = 3;
const TIMING: f64 = 0.005;
const COMPILING_S: f64 = 20.0;

pub struct Point {
    /// Its index among the places of the search.
    pub place: usize,
    /// Nanoseconds of all passes of each frame, one or more.
    pub totals_ns: Vec<f64>,
    /// Median nanoseconds of each pass.
    pub passes: Vec<(String, f64)>,
    pub distance: ImageError,
    /// Bytes on the device.
    pub bytes: u64,
    pub settings: Vec<(String, String)>,
    /// Begin and end of the measurement, seconds from the start.
    pub at_s: [f64; 2],
    /// Each draw's time over that of the baseline drawn right after it, which cancels a busy
    /// machine or a changing clock. None for the baseline itself.
    ratios: Vec<f64>,
    /// Nanoseconds of those draws of the baseline.
    pub baseline_ns: Vec<f64>,
    /// Kept while it is on the frontier.
    pub pictures: Option<Pictures>,
}

impl Point {
    pub fn total_ns(&self) -> Summary {
        Summary::of(&self.totals_ns).expect("one or more draws")
    }

    /// Median of the time over the baseline's.
    pub fn ratio(&self) -> f64 {
        median(&self.ratios).unwrap_or(1.0)
    }

    /// Median nanoseconds of the paired draws of the baseline.
    pub fn baseline_median(&self) -> f64 {
        median(&self.baseline_ns).unwrap_or(0.0)
    }

    /// Adds the times of a repeated measurement.
    pub fn add(&mut self, again: Point) {
        self.totals_ns.extend(again.totals_ns);
        self.ratios.extend(again.ratios);
        self.baseline_ns.extend(again.baseline_ns);
    }

    /// Its cost in frames of the baseline.
    pub fn value(&self) -> Value {
        Value { cost: self.ratio(), error: self.distance.relative_rmse }
    }
}

/// A point without pictures yet, and its radiance.
pub type Measured = (Point, Vec<Vec<f32>>);

/// Measures a quality paired with the baseline.
pub fn measure(
    rig: &mut Rig,
    ground_truth: &GroundTruth,
    place: usize,
    quality: &Quality,
    baseline: &mut Frame,
) -> Result<Measured> {
    let begun_s = rig.spent();
    rig.with_frame(quality, |rig, frame| {
        time(rig, ground_truth, (place, begun_s), frame, Some(baseline))
    })
}

/// Measures a frame; without a baseline that of the baseline itself.
pub fn time(
    rig: &mut Rig,
    ground_truth: &GroundTruth,
    (place, begun_s): (usize, f64),
    frame: &mut Frame,
    mut baseline: Option<&mut Frame>,
) -> Result<Measured> {
    let first = rig.gpu.draw(frame)?;
    let planes = rig.radiance(frame)?;
    let distance = ground_truth.distance(&planes)?;
    let begun = Instant::now();
    let most = rig.share(TIMING);
    // The first draw compiles, for up to seconds. It is only timed if it takes far longer than that
    // and than the time left.
    let long = total_ns(&first) * 1e-9 > rig.left().max(COMPILING_S);
    let mut runs: Vec<Vec<Timing>> = if long { vec![first] } else { Vec::new() };
    let mut baseline_ns = Vec::new();
    while runs.len() < DRAWS {
        let seconds = begun.elapsed().as_secs_f64();
        let enough = most * if runs.len() < FEWEST { 5.0 } else { 1.0 };
        if !runs.is_empty() && (long || seconds > enough) {
            break;
        }
        runs.push(rig.gpu.draw(frame)?);
        if let Some(baseline) = &mut baseline {
            baseline_ns.push(rig.draw_ns(baseline)?);
        }
    }
    if let Some(baseline) = baseline.filter(|_| long) {
        baseline_ns.push(rig.draw_ns(baseline)?);
    }
    let totals_ns: Vec<f64> = runs.iter().map(|r| total_ns(r)).collect();
    if !totals_ns.iter().all(|ns| *ns > 0.0) {
        return Err(setup::no_timestamps());
    }
    let ratios: Vec<f64> = totals_ns.iter().zip(&baseline_ns).map(|(ns, b)| ns / b).collect();
    if baseline_ns.is_empty() {
        baseline_ns.clone_from(&totals_ns);
    }
    let pass = |(i, timing): (usize, &Timing)| {
        let times: Vec<f64> = runs.iter().map(|r| r[i].ns).collect();
        (timing.label.clone(), median(&times).unwrap_or(0.0))
    };
    let passes = runs[0].iter().enumerate().map(pass).collect();
    let (bytes, settings) = (frame.plan().bytes(), frame.plan().settings.clone());
    let at_s = [begun_s, rig.spent()];
    let pictures = None;
    let point = Point {
        place,
        totals_ns,
        passes,
        distance,
        bytes,
        settings,
        at_s,
        ratios,
        baseline_ns,
        pictures,
    };
    Ok((point, planes))
}

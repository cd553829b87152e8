//! The search: which settings are measured, in which order, until the budget ends; then the
//! recommended ones are timed again.

use ridgelight::gpu::Frame;
use ridgelight::scene::{Lines, Method, Quality};
use ridgelight::{Error, Result};
use ridgelight_trade::statistics::Summary;
use ridgelight_trade::trade::{Ladder, Place, Recommendation, Rule, Search, recommend};

use super::ground_truth::GroundTruth;
use super::picture::{self, Tones};
use super::point::{self, Point};
use super::rig::{Budget, Rig};
use crate::setup;

/// Share of the budget that one setting may take.
const SLOWEST: f64 = 0.1;
/// Share reserved for timing the recommended settings again, and their hull storage.
pub const KEPT: f64 = 0.15;

/// Results of a search.
pub struct Walk {
    pub search: Search,
    /// In the order of measurement.
    pub points: Vec<Point>,
    /// Places that could not be measured, and why.
    pub given_up: Vec<(usize, String)>,
    /// The place whose frame is redrawn between others.
    pub baseline: usize,
    /// Whether the budget ended it.
    pub out_of_time: bool,
}

impl Walk {
    /// Median nanoseconds of the baseline's frame over the whole run: the unit of costs.
    pub fn baseline_ns(&self) -> f64 {
        self.drift().map_or(0.0, |s| s.median)
    }

    /// Converts a rule's nanoseconds into the unit of costs.
    pub fn in_baselines(&self, rule: Rule) -> Rule {
        match rule {
            Rule::MaxCost(ns) => Rule::MaxCost(ns / self.baseline_ns()),
            other => other,
        }
    }

    /// The recommendation among the points so far.
    fn recommended(&self, rule: Rule) -> Result<Recommendation> {
        let values: Vec<_> =
            self.points.iter().filter_map(|p| self.search.value(p.place)).collect();
        recommend(&values, self.in_baselines(rule)).ok_or_else(|| Error::Device {
            doing: "trading".into(),
            reason: "no settings could be measured".into(),
        })
    }

    /// The baseline's frame times during the run, nanoseconds.
    pub fn drift(&self) -> Option<Summary> {
        let all: Vec<f64> =
            self.points.iter().flat_map(|p| p.baseline_ns.iter().copied()).collect();
        Summary::of(&all)
    }
}

/// Searches from `start`, skipping refused places, and recommends by `rule`, whose times are
/// nanoseconds.
pub fn walk(
    rig: &mut Rig,
    (ground_truth, tones): (&GroundTruth, &Tones),
    (ladders, places, refused): (&[Ladder], &[Place], Vec<(usize, String)>),
    (start, rule): (&Quality, Rule),
    bar: &indicatif::ProgressBar,
) -> Result<(Walk, Recommendation)> {
    let baseline =
        places.iter().position(|p| p.quality == *start).expect("the defaults are on the ladders");
    let steps = places.iter().map(|p| p.steps.clone()).collect();
    let mut walk = Walk {
        search: Search::new(steps, baseline, ground_truth.floor()),
        points: Vec::new(),
        given_up: Vec::new(),
        baseline,
        out_of_time: false,
    };
    for (place, why) in refused {
        walk.search.give_up(place, false);
        walk.given_up.push((place, why));
    }
    let mut frame: Option<Frame> = None;
    let mut slow = Vec::new();
    let walked = loop {
        let Some(place) = walk.search.next() else { break Ok(()) };
        walk.out_of_time |= frame.is_some() && rig.is_spent(walk.points.len(), KEPT);
        if walk.out_of_time {
            break Ok(());
        }
        bar.set_message(format!(
            "{} measured, {} on the frontier, {}: {}",
            walk.points.len(),
            walk.search.frontier().len(),
            match rig.budget {
                Budget::Seconds(_) => format!("{:.0} s left", rig.left().max(0.0)),
                Budget::Evaluations(most) => format!("{} left", most - walk.points.len()),
            },
            places[place].flags(ladders)
        ));
        let reference = (ground_truth, tones);
        if let Err(error) = visit(rig, reference, place, places, &mut walk, &mut frame, &mut slow) {
            break Err(error);
        }
    };
    bar.set_message("timing the recommended settings again");
    let recommended = walked.and_then(|()| match &mut frame {
        Some(baseline) => confirm(rig, (ground_truth, tones), places, &mut walk, rule, baseline),
        None => walk.recommended(rule),
    });
    if let Some(frame) = frame {
        rig.gpu.end(frame);
    }
    Ok((walk, recommended?))
}

/// Times the recommended settings again until they stay recommended: the least of many noisy times
/// is too low. New points of the frontier get a picture even if the time is up.
fn confirm(
    rig: &mut Rig,
    (ground_truth, tones): (&GroundTruth, &Tones),
    places: &[Place],
    walk: &mut Walk,
    rule: Rule,
    baseline: &mut Frame,
) -> Result<Recommendation> {
    // The baseline's cost is 1 by definition.
    let mut sure = vec![walk.baseline];
    loop {
        let recommended = walk.recommended(rule)?;
        let best = walk.points[recommended.point].place;
        let is_due = |p: &&Point| {
            let is_best = p.place == best && rig.left() > 0.0;
            let is_bare = p.pictures.is_none() && walk.search.frontier().contains(&p.place);
            !sure.contains(&p.place) && (is_best || is_bare)
        };
        let Some(at) = walk.points.iter().position(|p| is_due(&p)) else {
            return Ok(recommended);
        };
        let place = walk.points[at].place;
        sure.push(place);
        let quality = &places[place].quality;
        let (again, frame, planes) =
            point::measure(rig, ground_truth, place, quality, Some(baseline))?;
        rig.gpu.end(frame);
        let point = &mut walk.points[at];
        point.add(again);
        if point.pictures.is_none() {
            let p99 = point.distance.p99.max(ground_truth.floor());
            point.pictures =
                Some(picture::pictures(&rig.scene.field, &planes, ground_truth, tones, p99)?);
        }
        walk.search.measured_again(place, point.value());
    }
}

/// Measures one place, or records why it cannot be measured.
fn visit(
    rig: &mut Rig,
    (ground_truth, tones): (&GroundTruth, &Tones),
    place: usize,
    places: &[Place],
    walk: &mut Walk,
    baseline: &mut Option<Frame>,
    slow: &mut Vec<((Method, Lines), f64)>,
) -> Result<()> {
    let quality = &places[place].quality;
    let give_up = |walk: &mut Walk, why: String, too_slow| {
        walk.search.give_up(place, too_slow);
        walk.given_up.push((place, why));
    };
    let plan = match rig.plan(rig.scene, quality) {
        Ok(plan) => plan,
        Err(error) if baseline.is_some() => {
            give_up(walk, setup::in_flags(error).to_string(), false);
            return Ok(());
        }
        Err(error) => return Err(error),
    };
    if baseline.is_some() {
        // At least two draws: one to warm up, one timed.
        let needs = 2.0 * expected_s(rig, walk, place, quality, plan.azimuths.len(), slow)?;
        let most = rig.share(SLOWEST);
        if needs > most {
            let why = format!(
                "would take about {} s, more than a tenth of the budget ({} s)",
                crate::terminal::digits(needs),
                crate::terminal::digits(most)
            );
            give_up(walk, why, true);
            return Ok(());
        }
        if needs > rig.left() {
            walk.out_of_time = true;
            return Ok(());
        }
    }
    let (mut point, frame, planes) =
        match point::measure(rig, ground_truth, place, quality, baseline.as_mut()) {
            Ok(measured) => measured,
            Err(error @ Error::Device { .. }) if baseline.is_some() => {
                give_up(walk, error.to_string(), false);
                return Ok(());
            }
            Err(error) => return Err(error),
        };
    match baseline {
        None => *baseline = Some(frame),
        Some(_) => rig.gpu.end(frame),
    }
    walk.search.measured(place, point.value());
    let front = walk.search.frontier();
    if front.contains(&place) {
        let p99 = point.distance.p99.max(ground_truth.floor());
        point.pictures =
            Some(picture::pictures(&rig.scene.field, &planes, ground_truth, tones, p99)?);
    }
    walk.points.push(point);
    // The baseline keeps its own time.
    let baseline = walk.baseline;
    let is_off = |p: &&mut Point| !front.contains(&p.place) && p.place != baseline;
    for point in walk.points.iter_mut().filter(is_off) {
        point.pictures = None;
    }
    Ok(())
}

/// Expected seconds per draw: for line sweeps from earlier measurements; for exact and brute-force
/// ones from a piece of the field.
fn expected_s(
    rig: &mut Rig,
    walk: &Walk,
    place: usize,
    quality: &Quality,
    azimuths: usize,
    slow: &mut Vec<((Method, Lines), f64)>,
) -> Result<f64> {
    if quality.method != Method::BruteForce && quality.lines != Lines::Exact {
        return Ok(walk.search.predicted(place).cost * walk.baseline_ns() * 1e-9);
    }
    let form = match quality.method {
        Method::BruteForce => (Method::BruteForce, Lines::Exact),
        method => (method, quality.lines),
    };
    let each = match slow.iter().find(|(known, _)| *known == form) {
        Some((_, each)) => *each,
        None => {
            let each = rig.seconds_per_azimuth(rig.scene, quality)?;
            slow.push((form, each));
            each
        }
    };
    Ok(each * azimuths as f64)
}

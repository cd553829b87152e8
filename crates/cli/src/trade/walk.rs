//! The search: which settings are measured, in which order, until the budget ends; then the
//! recommended ones are timed again.

use ridgelight::gpu::Frame;
use ridgelight::scene::{Lines, Method, Quality};
use ridgelight::{Error, Result};
use ridgelight_trade::statistics::Summary;
use ridgelight_trade::trade::{Goal, Ladder, Place, Recommendation, Search, recommend};

use super::ground_truth::GroundTruth;
use super::picture;
use super::point::{self, Point};
use super::rig::{Budget, Rig};
use crate::setup;
use crate::setup::terminal::digits;

/// Share of the budget that one setting may take.
const SLOWEST: f64 = 0.1;
/// Share reserved for timing the recommended settings again, and their hull storage.
pub const KEPT: f64 = 0.15;

/// A search and its results.
pub struct Walk<'a> {
    pub ladders: &'a [Ladder],
    pub places: &'a [Place],
    pub search: Search,
    /// In the order of measurement.
    pub points: Vec<Point>,
    /// Places that could not be measured, and why.
    pub given_up: Vec<(usize, String)>,
    /// The place whose frame is redrawn between others.
    pub baseline: usize,
    /// Whether the budget ended it.
    pub out_of_time: bool,
    /// Seconds per azimuth of methods whose time no measured settings predict.
    slow: Vec<(Method, f64)>,
}

impl<'a> Walk<'a> {
    /// A search from `start` that resolves errors above `floor`.
    pub fn new(ladders: &'a [Ladder], places: &'a [Place], start: &Quality, floor: f64) -> Self {
        let baseline = places.iter().position(|p| p.quality == *start);
        let baseline = baseline.expect("the defaults are on the ladders");
        let steps = places.iter().map(|p| p.steps.clone()).collect();
        Self {
            ladders,
            places,
            search: Search::new(steps, baseline, floor),
            points: Vec::new(),
            given_up: Vec::new(),
            baseline,
            out_of_time: false,
            slow: Vec::new(),
        }
    }

    /// Median nanoseconds of the baseline's frame over the whole run: the unit of costs.
    pub fn baseline_ns(&self) -> f64 {
        self.drift().map_or(0.0, |s| s.median)
    }

    /// The baseline's frame times during the run, nanoseconds.
    pub fn drift(&self) -> Option<Summary> {
        let all: Vec<f64> =
            self.points.iter().flat_map(|p| p.baseline_ns.iter().copied()).collect();
        Summary::of(&all)
    }

    /// The recommendation among the points so far; times of the goal are nanoseconds.
    fn recommended(&self, goal: Option<Goal>) -> Result<Recommendation> {
        let goal = goal.map(|goal| match goal {
            Goal::MaxCost(ns) => Goal::MaxCost(ns / self.baseline_ns()),
            error => error,
        });
        let values: Vec<_> =
            self.points.iter().filter_map(|p| self.search.value(p.place)).collect();
        recommend(&values, goal).ok_or_else(|| Error::Device {
            doing: "trading".into(),
            reason: "no settings could be measured".into(),
        })
    }

    pub fn give_up(&mut self, place: usize, why: String, is_too_slow: bool) {
        self.search.give_up(place, is_too_slow);
        self.given_up.push((place, why));
    }

    /// Searches, and recommends for the goal.
    pub fn run(
        &mut self,
        rig: &mut Rig,
        ground_truth: &GroundTruth,
        goal: Option<Goal>,
        bar: &indicatif::ProgressBar,
    ) -> Result<Recommendation> {
        let (begun_s, baseline) = (rig.spent(), self.baseline);
        rig.with_frame(&self.places[baseline].quality, |rig, frame| {
            let measured = point::time(rig, ground_truth, (baseline, begun_s), frame, None)?;
            self.add(rig, ground_truth, measured)?;
            while let Some(place) = self.search.next() {
                self.out_of_time |= rig.is_spent(self.points.len(), KEPT);
                if self.out_of_time {
                    break;
                }
                bar.set_message(format!(
                    "{} measured, {} on the frontier, {}: {}",
                    self.points.len(),
                    self.search.frontier().len(),
                    match rig.budget {
                        Budget::Seconds(_) => format!("{:.0} s left", rig.left().max(0.0)),
                        Budget::Evaluations(most) => format!("{} left", most - self.points.len()),
                    },
                    self.flags(place)
                ));
                self.visit(rig, ground_truth, place, frame)?;
            }
            bar.set_message("timing the recommended settings again");
            self.confirm(rig, ground_truth, goal, frame)
        })
    }

    /// Times the recommended settings again until they stay recommended: the least of many noisy
    /// times is too low. New points of the frontier get a picture even if the time is up.
    fn confirm(
        &mut self,
        rig: &mut Rig,
        ground_truth: &GroundTruth,
        goal: Option<Goal>,
        baseline: &mut Frame,
    ) -> Result<Recommendation> {
        // The baseline's cost is 1 by definition.
        let mut sure = vec![self.baseline];
        loop {
            let recommended = self.recommended(goal)?;
            let best = self.points[recommended.point].place;
            let is_due = |p: &Point| {
                let is_best = p.place == best && rig.left() > 0.0;
                let is_bare = p.pictures.is_none() && self.search.frontier().contains(&p.place);
                !sure.contains(&p.place) && (is_best || is_bare)
            };
            let Some(at) = self.points.iter().position(is_due) else { return Ok(recommended) };
            let place = self.points[at].place;
            sure.push(place);
            let quality = &self.places[place].quality;
            let (again, planes) = point::measure(rig, ground_truth, place, quality, baseline)?;
            let point = &mut self.points[at];
            point.add(again);
            if point.pictures.is_none() {
                picture(rig, ground_truth, point, &planes)?;
            }
            self.search.measured_again(place, point.value());
        }
    }

    /// Measures one place, or records why it cannot be measured.
    fn visit(
        &mut self,
        rig: &mut Rig,
        ground_truth: &GroundTruth,
        place: usize,
        baseline: &mut Frame,
    ) -> Result<()> {
        let quality = &self.places[place].quality;
        let plan = match rig.plan(rig.scene, quality) {
            Ok(plan) => plan,
            Err(error) => {
                self.give_up(place, setup::in_flags(error).to_string(), false);
                return Ok(());
            }
        };
        // At least two draws: one to warm up, one timed.
        let needs = 2.0 * self.expected_s(rig, place, quality, plan.azimuths.len())?;
        let most = rig.share(SLOWEST);
        if needs > most {
            let why = format!(
                "would take about {} s, more than a tenth of the budget ({} s)",
                digits(needs),
                digits(most)
            );
            self.give_up(place, why, true);
            return Ok(());
        }
        if needs > rig.left() {
            self.out_of_time = true;
            return Ok(());
        }
        match point::measure(rig, ground_truth, place, quality, baseline) {
            Err(error @ Error::Device { .. }) => {
                self.give_up(place, error.to_string(), false);
                Ok(())
            }
            measured => self.add(rig, ground_truth, measured?),
        }
    }

    /// Adds a measured point. Only points of the frontier keep their pictures, and the baseline.
    fn add(
        &mut self,
        rig: &Rig,
        ground_truth: &GroundTruth,
        (mut point, planes): point::Measured,
    ) -> Result<()> {
        self.search.measured(point.place, point.value());
        let front = self.search.frontier();
        if front.contains(&point.place) {
            picture(rig, ground_truth, &mut point, &planes)?;
        }
        self.points.push(point);
        for point in &mut self.points {
            if !front.contains(&point.place) && point.place != self.baseline {
                point.pictures = None;
            }
        }
        Ok(())
    }

    /// Expected seconds per draw: for line sweeps from earlier measurements; for exact and
    /// brute-force ones from a piece of the field.
    fn expected_s(
        &mut self,
        rig: &mut Rig,
        place: usize,
        quality: &Quality,
        azimuths: usize,
    ) -> Result<f64> {
        if quality.method != Method::BruteForce && quality.lines != Lines::Exact {
            return Ok(self.search.predicted(place).cost * self.baseline_ns() * 1e-9);
        }
        let known = self.slow.iter().find(|(method, _)| *method == quality.method);
        let each = match known {
            Some((_, each)) => *each,
            None => {
                let each = rig.seconds_per_azimuth(rig.scene, quality)?;
                self.slow.push((quality.method, each));
                each
            }
        };
        Ok(each * azimuths as f64)
    }
}

fn picture(
    rig: &Rig,
    ground_truth: &GroundTruth,
    point: &mut Point,
    planes: &[Vec<f32>],
) -> Result<()> {
    let p99 = point.distance.relative_p99.max(ground_truth.floor());
    point.pictures = Some(picture::pictures(&rig.scene.field, planes, ground_truth, p99)?);
    Ok(())
}

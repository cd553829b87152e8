//! The results as text, CSV and JSON.

use ridgelight_trade::trade::{Break, Goal, Ladder, Recommendation, SLACK, Side};
use serde_json::{Value, json};

use super::baked::Tried;
use super::ground_truth::GroundTruth;
use super::hull;
use super::point::Point;
use super::rig::Budget;
use super::walk::Walk;
use crate::setup;
use crate::setup::terminal::{digits, percent};

pub struct Report<'a> {
    /// Device, driver, field and lights, as (name, value).
    pub about: Vec<(String, String)>,
    pub ground_truth: GroundTruth,
    pub ground_truth_s: f64,
    pub ground_truth_png: Vec<u8>,
    pub hulls: Vec<hull::Place>,
    pub baked: Tried,
    pub walk: Walk<'a>,
    pub goal: Option<Goal>,
    /// Its point is a position in the walk's points.
    pub recommended: Recommendation,
    pub budget: Budget,
    pub spent_s: f64,
}

pub fn ms(ns: f64) -> String {
    format!("{} ms", digits(ns * 1e-6))
}

impl Report<'_> {
    pub fn flags(&self, place: usize) -> String {
        self.walk.flags(place)
    }

    /// Points of the frontier, from fast to slow.
    pub fn frontier(&self) -> Vec<&Point> {
        let front = self.walk.search.frontier().iter();
        front.filter_map(|f| self.walk.points.iter().find(|p| p.place == *f)).collect()
    }

    pub fn recommended(&self) -> &Point {
        &self.walk.points[self.recommended.point]
    }

    /// Whether the ground truth cannot distinguish a point's error from none.
    pub fn is_at_most(&self, point: &Point) -> bool {
        point.distance.relative_rmse <= self.ground_truth.floor()
    }

    /// Nanoseconds of a frame at the machine's median speed of the run.
    pub fn time_ns(&self, point: &Point) -> f64 {
        point.ratio() * self.walk.baseline_ns()
    }

    pub fn time_text(&self, point: &Point) -> String {
        ms(self.time_ns(point))
    }

    /// A point's error, at least the ground truth's own.
    pub fn error(&self, point: &Point) -> f64 {
        point.distance.relative_rmse.max(self.ground_truth.floor())
    }

    pub fn error_text(&self, point: &Point) -> String {
        let sign =
            if self.is_at_most(point) && self.ground_truth.floor() > 0.0 { "≤ " } else { "" };
        format!("{sign}{}", percent(self.error(point)))
    }

    /// The baseline's drift, in a sentence.
    pub fn drift_text(&self) -> String {
        let Some(s) = self.walk.drift() else { return String::new() };
        let spread = s.p90 / s.p10.max(f64::MIN_POSITIVE) - 1.0;
        let meaning = if spread > 0.1 {
            "the machine was busy or changed its clock, so times are ratios to paired draws of \
                the baseline"
        } else {
            "the machine was steady"
        };
        format!(
            "The baseline ({}), drawn in turn with every point, had a median of {}, {} to {} \
                between its 10th and 90th percentile and {} to {} in all; {meaning}.",
            self.flags(self.walk.baseline),
            ms(s.median),
            ms(s.p10),
            ms(s.p90),
            ms(s.min),
            ms(s.max)
        )
    }

    /// Ladders that broke their order, in words.
    pub fn breaks(&self) -> Vec<String> {
        self.walk.search.breaks().iter().map(|found| self.break_text(found)).collect()
    }

    fn break_text(&self, found: &Break) -> String {
        let names: Vec<&str> = found.ladders.iter().map(|k| self.walk.ladders[*k].name).collect();
        let value = |i: usize| {
            let value = self.walk.search.value(i);
            value.map_or_else(String::new, |v| match found.side {
                Side::Cost => ms(v.cost * self.walk.baseline_ns()),
                Side::Error => percent(v.error),
            })
        };
        let what = match found.side {
            Side::Cost => "slower steps were faster",
            Side::Error => "slower steps were less accurate",
        };
        let of = |i: usize| format!("{} ({})", self.flags(i), value(i));
        let (names, lower, higher) = (names.join(", "), of(found.lower), of(found.higher));
        format!("{names}: {what}: {lower} against {higher}")
    }

    pub fn summary(&self) -> String {
        let skipped: usize = self.walk.skipped().iter().map(|g| g.1.len()).sum();
        let open = self.walk.not_tried().len();
        let of = match self.budget {
            Budget::Seconds(all) => format!(" of {all:.1} s"),
            Budget::Evaluations(_) => String::new(),
        };
        let end = if self.walk.out_of_time { "the budget ended" } else { "none were left" };
        format!(
            "{} settings measured, {skipped} ruled out or given up, {open} not tried when {end}; \
                {:.1} s{of}, of which the ground truth took {:.1} s.",
            self.walk.points.len(),
            self.spent_s,
            self.ground_truth_s
        )
    }

    pub fn ground_truth_text(&self) -> String {
        format!(
            "Ground truth: {}. Its own error (relative RMSE): {}: {}.",
            self.ground_truth.about,
            self.ground_truth.own_text(),
            self.ground_truth.quality_of
        )
    }

    pub fn assumption() -> String {
        format!(
            "A setting is ruled out if a measured point is both faster and more accurate than \
                its bounds. The bounds assume that a slower step of a ladder never takes less \
                time and never has a larger error. Every measured pair tests this; a ladder that \
                violates it by more than {} rules nothing out.",
            percent(SLACK)
        )
    }

    pub fn print(&self) {
        crate::say!("{}", self.ground_truth_text());
        crate::say!("{:>12}  {:>12}  settings", "time", "error");
        for point in self.frontier() {
            let mark = if point.place == self.recommended().place { " <- recommended" } else { "" };
            crate::say!(
                "{:>12}  {:>12}  {}{mark}",
                self.time_text(point),
                self.error_text(point),
                self.flags(point.place)
            );
        }
        self.why().iter().for_each(|line| crate::say!("{line}"));
        crate::say!("{}", self.drift_text());
        crate::say!("{}", self.summary());
    }

    pub fn csv(&self) -> String {
        let names = self.walk.ladders.iter().map(|k| k.name.replace(' ', "_")).collect::<Vec<_>>();
        let mut text = format!(
            "settings,{},time_ms,median_ms,p10_ms,p90_ms,min_ms,draws,relative_rmse,at_most,mean_shift,p99,\
             worst,worst_row,worst_col,flip_mean,flip_p99,bytes,baseline_ms,frontier,recommended\n",
            names.join(",")
        );
        let front = self.walk.search.frontier();
        for point in &self.walk.points {
            let (t, d) = (point.total_ns(), &point.distance);
            let place = &self.walk.places[point.place];
            let steps = self.walk.ladders.iter().zip(&place.steps).map(|(ladder, step)| {
                let spelt = step.map_or("", |s| ladder.steps[s].as_str());
                spelt.split(' ').next_back().unwrap_or_default()
            });
            let mut row = vec![self.flags(point.place)];
            row.extend(steps.map(str::to_owned));
            row.extend(
                [self.time_ns(point), t.median, t.p10, t.p90, t.min]
                    .map(|ns| format!("{:.6}", ns * 1e-6)),
            );
            row.push(point.totals_ns.len().to_string());
            row.push(format!("{:e}", self.error(point)));
            row.push(self.is_at_most(point).to_string());
            row.extend(
                [d.relative_mean_shift, d.relative_p99, d.relative_worst].map(|x| format!("{x:e}")),
            );
            row.extend([d.worst_row, d.worst_col].map(|x| x.to_string()));
            let flip = point.pictures.as_ref().map(|p| [p.flip.mean, p.flip.p99]);
            row.extend(flip.map_or([const { String::new() }; 2], |f| f.map(|x| format!("{x:e}"))));
            row.push(point.bytes.to_string());
            row.push(format!("{:.6}", point.baseline_median() * 1e-6));
            row.push(front.contains(&point.place).to_string());
            row.push((point.place == self.recommended().place).to_string());
            text += &row.join(",");
            text.push('\n');
        }
        text
    }

    fn point_json(&self, point: &Point) -> Value {
        let (t, d) = (point.total_ns(), &point.distance);
        let pass = |(pass, ns): &(String, f64)| json!({ "pass": pass, "median_ns": ns });
        let passes: Vec<Value> = point.passes.iter().map(pass).collect();
        json!({
            "flags": self.flags(point.place), "settings": setup::typed(&point.settings),
            "time_ns": self.time_ns(point), "median_ns": t.median, "p10_ns": t.p10, "p90_ns": t.p90, "min_ns": t.min,
            "draws": point.totals_ns.len(), "passes": passes, "bytes": point.bytes,
            "relative_rmse": self.error(point), "at_most": self.is_at_most(point),
            "mean_shift": d.relative_mean_shift, "p99": d.relative_p99, "worst": d.relative_worst,
            "worst_row": d.worst_row, "worst_col": d.worst_col,
            "flip": point.pictures.as_ref().map(|p| json!({
                "mean": p.flip.mean, "weighted_quartiles": p.flip.weighted_quartiles, "p99": p.flip.p99,
                "worst": p.flip.worst, "worst_row": p.flip.worst_row, "worst_col": p.flip.worst_col,
            })),
            "begun_s": point.at_s[0], "done_s": point.at_s[1], "baseline_ns": point.baseline_median(),
        })
    }

    pub fn json(&self) -> Value {
        let position = |place: usize| self.walk.points.iter().position(|p| p.place == place);
        let front: Vec<usize> =
            self.walk.search.frontier().iter().filter_map(|f| position(*f)).collect();
        let ladder = |k: &Ladder| {
            json!({
                "name": k.name, "fast_to_slow": k.steps, "default": k.steps[k.default],
                "range": k.range.as_ref().map(|r| [r.start(), r.end()]), "slower": k.slower,
            })
        };
        let hull = |h: &hull::Place| {
            let (ratio, why) = (h.ratio.as_ref().ok(), h.ratio.as_ref().err());
            json!({ "hull": h.hull.to_string(), "time_ratio": ratio, "why_none": why })
        };
        let (budget_s, evaluations) = match self.budget {
            Budget::Seconds(seconds) => (Some(seconds), None),
            Budget::Evaluations(most) => (None, Some(most)),
        };
        json!({
            "ridgelight": env!("CARGO_PKG_VERSION"), "about": setup::typed(&self.about),
            "ground_truth": {
                "what": self.ground_truth.about, "own_relative_rmse": self.ground_truth.own_error,
                "how": self.ground_truth.quality_of, "seconds": self.ground_truth_s,
            },
            "budget_s": budget_s, "evaluations": evaluations, "spent_s": self.spent_s,
            "settings": self.walk.ladders.iter().map(ladder).collect::<Vec<_>>(),
            "points": self.walk.points.iter().map(|p| self.point_json(p)).collect::<Vec<_>>(),
            "frontier": front,
            "recommendation": {
                "point": self.recommended.point, "flags": self.flags(self.recommended().place),
                "holds": self.recommended.holds, "why": self.why(),
            },
            "hulls": self.hulls.iter().map(hull).collect::<Vec<_>>(), "baked": self.baked_json(), "baked_refused": self.baked.refused, "drift": self.drift_text(), "ladders_broken": self.breaks(),
            "left_out": self.walk.counts_json(), "ruled_out": self.walk.ruled_out_json(), "not_tried": self.walk.not_tried_json(),
        })
    }
}

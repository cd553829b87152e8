//! Sentences about the recommendation: what others would save or cost, its risks, what was left
//! out.

use ridgelight_trade::trade::Goal;

use super::hull;
use super::point::Point;
use super::report::{Report, ms};
use crate::setup::terminal::{digits, percent};

/// Alternatives that change error or time by less than this factor are not mentioned.
const WORTH: f64 = 0.9;

impl Report<'_> {
    /// The recommendation in sentences.
    pub fn why(&self) -> Vec<String> {
        let point = self.recommended();
        let (front, mut all) = (self.frontier(), Vec::new());
        let holds = self.recommended.holds;
        all.push(match self.goal {
            None => "Recommended: it has the least product of time and error on the frontier. \
                From here, twice the time at best halves the error, and half the time at least \
                doubles it. --max-error or --time-budget choose otherwise."
                .to_owned(),
            Some(Goal::MaxError(most)) => match (holds, percent(most)) {
                (true, most) => format!(
                    "The fastest measured settings with an error of at most {most} (--max-error)."
                ),
                (false, most) => format!(
                    "No measured settings meet --max-error {most}: these are the most accurate."
                ),
            },
            Some(Goal::MaxCost(most)) => match (holds, ms(most)) {
                (true, most) => {
                    format!("The most accurate measured settings within {most} (--time-budget).")
                }
                (false, most) => format!(
                    "No measured settings meet --time-budget {most}: these are the fastest."
                ),
            },
        });
        let here = front.iter().position(|p| p.place == point.place).unwrap_or(0);
        let ratio = |of: f64, to: f64| if to > 0.0 { digits(of / to) } else { "∞".into() };
        let is_faster = |p: &&&Point| p.ratio() <= WORTH * point.ratio();
        if let Some(faster) = front[..here].iter().rev().find(is_faster) {
            all.push(format!(
                "The next faster ones on the frontier, {}, save {} of the time and have {} × the \
                    error.",
                self.flags(faster.place),
                percent(1.0 - faster.ratio() / point.ratio()),
                ratio(self.error(faster), self.error(point))
            ));
        }
        let is_better = |p: &&&Point| self.error(p) <= WORTH * self.error(point);
        if let Some(slower) = front[here + 1..].iter().find(is_better) {
            all.push(format!(
                "The next more accurate ones, {}, take {} × the time and have {} × the error: \
                    the recommended ones save {} of their time.",
                self.flags(slower.place),
                ratio(slower.ratio(), point.ratio()),
                ratio(self.error(slower), self.error(point)),
                percent(1.0 - point.ratio() / slower.ratio())
            ));
        }
        all.push(self.risk(point));
        let own = self.ground_truth.floor();
        all.push(if self.ground_truth.own_error.is_none() {
            "The ground truth's own error is unknown, so the errors here are relative to it."
                .to_owned()
        } else if self.is_at_most(point) {
            let own = percent(own);
            format!(
                "The ground truth's own error may be {own}. Errors of these and slower settings may be \
                    below it. To resolve them, use `--reference FILE` with a file of `ridgelight \
                    reference --until-error E`, with E below {own}."
            )
        } else {
            format!(
                "The ground truth's own error may be {}, {} of that of these settings.",
                percent(own),
                percent(own / self.error(point))
            )
        });
        all.push(self.left_out());
        all.extend(self.baked_text(point));
        all.extend(hull::text(&self.hulls));
        all
    }

    /// Error statistics that a mean hides.
    fn risk(&self, point: &Point) -> String {
        let d = &point.distance;
        let flip = point.pictures.as_ref().map_or_else(String::new, |p| {
            let (mean, worst) = (digits(p.flip.mean), digits(p.flip.worst));
            format!(" Perceived: mean ꟻLIP {mean}, worst {worst}, of at most 1.")
        });
        format!(
            "Risk: one texel in a hundred has an error of more than {} of the mean, the worst {} \
                at row {}, column {}; the mean is {} by {}.{flip}",
            percent(d.relative_p99),
            percent(d.relative_worst),
            d.worst_row,
            d.worst_col,
            if d.relative_mean_shift < 0.0 { "too dark" } else { "too bright" },
            percent(d.relative_mean_shift.abs()),
        )
    }

    /// What was not measured, why, and what it could have changed.
    fn left_out(&self) -> String {
        let (open, groups) = (self.walk.not_tried(), self.walk.skipped());
        let skipped: usize = groups.iter().map(|g| g.1.len()).sum();
        let mut text = format!(
            "Of {} settings, {} were measured, {skipped} ruled out or given up",
            self.walk.places.len(),
            self.walk.points.len()
        );
        if let Some((why, largest)) = groups.first() {
            let more = largest.len() - 1;
            let others = if more > 0 { format!(" and {more} more") } else { String::new() };
            text += &format!(" ({}{others}: {why})", self.flags(largest[0]));
        }
        let promising = open.iter().filter(|i| self.walk.search.merit(**i) > 0.0).count();
        let Some(best) = open.first() else { return text + "; none were left." };
        text += &format!(", {} not tried for lack of time. ", open.len());
        if promising == 0 {
            return text + "None of these is expected to beat the frontier.";
        }
        let (best, expected) = (self.flags(*best), self.walk.expected_text(*best));
        text + &format!(
            "{promising} of these are expected to beat the frontier, most of all {best} \
                ({expected}): a larger --budget may find better ones."
        )
    }
}

//! Why what is recommended is: what others would save or cost, what it risks, what was left out.

use ridgelight_trade::trade::Rule;

use super::hull;
use super::point::Point;
use super::report::{Report, ms};
use crate::terminal::{digits, percent};

/// What is dearer or cheaper, and changes error or time by less than this share, is not worth a sentence.
const WORTH: f64 = 0.9;

impl Report<'_> {
    /// The recommendation in sentences.
    pub fn why(&self) -> Vec<String> {
        let point = self.recommended();
        let (front, mut all) = (self.frontier(), Vec::new());
        let time = |cost: f64| ms(cost * self.walk.baseline_ns());
        all.push(match (self.rule, self.recommended.holds) {
            (Rule::Knee, _) => "Recommended because it has the least product of time and error of \
                 all on the frontier: from here, twice the time at best halves the error, and half \
                 the time at least doubles it. --max-error or --time-budget pick otherwise."
                .to_owned(),
            (Rule::MaxError(most), true) => {
                format!("The cheapest measured of at most {}, as --max-error asks.", percent(most))
            }
            (Rule::MaxError(most), false) => format!(
                "Nothing measured is within the {} of --max-error: this is the most accurate.",
                percent(most)
            ),
            (Rule::MaxCost(most), true) => {
                format!("The most accurate measured within {}, as --time-budget asks.", time(most))
            }
            (Rule::MaxCost(most), false) => {
                format!(
                    "Nothing measured is within the {} of --time-budget: this is the fastest.",
                    time(most)
                )
            }
        });
        let here = front.iter().position(|p| p.place == point.place).unwrap_or(0);
        let ratio = |of: f64, to: f64| if to > 0.0 { digits(of / to) } else { "∞".into() };
        let is_cheaper = |p: &&&Point| p.ratio <= WORTH * point.ratio;
        if let Some(cheaper) = front[..here].iter().rev().find(is_cheaper) {
            all.push(format!(
                "The next on the frontier that saves a tenth of the time, {}, saves {} and errs {} × as \
                 much.",
                self.flags(cheaper.place),
                percent(1.0 - cheaper.ratio / point.ratio),
                ratio(self.error(cheaper), self.error(point))
            ));
        }
        let is_better = |p: &&&Point| self.error(p) <= WORTH * self.error(point);
        if let Some(dearer) = front[here + 1..].iter().find(is_better) {
            all.push(format!(
                "The next that errs a tenth less, {}, takes {} × the time and errs {} × as much: this saves \
                 {} of its time.",
                self.flags(dearer.place),
                ratio(dearer.ratio, point.ratio),
                ratio(self.error(dearer), self.error(point)),
                percent(1.0 - point.ratio / dearer.ratio)
            ));
        }
        all.push(self.risk(point));
        let own = self.truth.floor();
        all.push(if self.truth.own_error.is_none() {
            "How far the truth itself is off is unknown, and so how far the errors here are.".to_owned()
        } else if self.is_at_most(point) {
            format!(
                "The truth itself may be {} off, which hides its error: how much less than that it is \
                 cannot be told, nor whether anything dearer does better. A truth from `ridgelight \
                 reference` (--reference), or a larger --budget, may tell.",
                percent(own)
            )
        } else {
            format!(
                "The truth itself may be {} off, {} of that error.",
                percent(own),
                percent(own / self.error(point))
            )
        });
        all.push(self.left_out());
        all.extend(self.baked_text(point));
        all.extend(hull::text(self.hulls));
        all
    }

    /// What a mean over all texels does not tell.
    fn risk(&self, point: &Point) -> String {
        let d = &point.distance;
        let flip = point.pictures.as_ref().map_or_else(String::new, |p| {
            let (mean, worst) = (digits(p.flip.mean), digits(p.flip.worst));
            format!(" To the eye: ꟻLIP {mean} in the mean, {worst} at worst, of 1.")
        });
        format!(
            "It risks: one texel in a hundred off by more than {} of the mean, the worst by {} at row {}, \
             column {}; all together {} by {}.{flip}",
            percent(d.p99),
            percent(d.worst),
            d.worst_row,
            d.worst_col,
            if d.mean_shift < 0.0 { "too dark" } else { "too bright" },
            percent(d.mean_shift.abs()),
        )
    }

    /// What was not measured, why, and what it might have changed.
    fn left_out(&self) -> String {
        let others = self.others();
        let (open, groups) = (others.not_tried(), others.skipped());
        let skipped: usize = groups.iter().map(|g| g.places.len()).sum();
        let mut text = format!(
            "Of {} settings {} were measured, {skipped} ruled out or given up",
            self.places.len(),
            self.walk.points.len()
        );
        if let Some(largest) = groups.first() {
            let [count, first] = [largest.places.len(), largest.places[0]];
            let others = if count > 1 { format!(" and {} more", count - 1) } else { String::new() };
            text += &format!(" ({}{others}: {})", self.flags(first), largest.why);
        }
        let promising = open.iter().filter(|i| self.walk.search.merit(**i) > 0.0).count();
        text += &match open.first() {
            None => "; none were left.".to_owned(),
            Some(best) if promising > 0 => format!(
                ", {} not tried for want of time, {promising} of which are expected beyond the \
                 frontier, farthest {} ({}): a larger --budget may find better.",
                open.len(),
                self.flags(*best),
                others.expected_text(*best)
            ),
            Some(_) => format!(
                ", {} not tried for want of time, none of which is expected beyond the frontier.",
                open.len()
            ),
        };
        text
    }
}

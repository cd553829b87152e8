//! Settings that were not measured, and why: some spelt out, all counted.

use std::collections::BTreeMap;

use ridgelight_trade::trade::{Ladder, Place, Skip};
use serde_json::{Value, json};

use super::report::ms;
use super::walk::Walk;
use crate::setup::terminal::percent;

/// Limits of a report: reasons and untried settings that it spells out; settings per reason.
pub const GROUPS: usize = 40;
pub const EXAMPLES: usize = 6;

impl Walk<'_> {
    pub fn flags(&self, place: usize) -> String {
        self.places[place].flags(self.ladders)
    }

    fn skip_text(&self, skip: &Skip) -> String {
        match skip {
            Skip::Covered { by, slower_than, worse_than } => {
                let error = match worse_than {
                    Some(worse) => format!("no more accurate than {}", self.flags(*worse)),
                    None => "no error that the ground truth can resolve".to_owned(),
                };
                let (slower, by) = (self.flags(*slower_than), self.flags(*by));
                format!("not faster than {slower} and {error}: {by} is better in both")
            }
            Skip::TooSlow { than } => {
                format!("slower than {}, which was too slow", self.flags(*than))
            }
        }
    }

    /// Reasons and the places that each rules out, the largest groups first.
    pub fn skipped(&self) -> Vec<(String, Vec<usize>)> {
        let mut groups: BTreeMap<String, Vec<usize>> = BTreeMap::new();
        for place in 0..self.places.len() {
            if let Some(skip) = self.search.skip(place) {
                groups.entry(self.skip_text(&skip)).or_default().push(place);
            }
        }
        for (place, why) in &self.given_up {
            groups.entry(why.clone()).or_default().push(*place);
        }
        let mut all: Vec<_> = groups.into_iter().collect();
        all.sort_by_key(|(_, places)| std::cmp::Reverse(places.len()));
        all
    }

    /// Places that the budget left open, the most promising first.
    pub fn not_tried(&self) -> Vec<usize> {
        let search = &self.search;
        let open = (0..self.places.len()).filter(|i| search.is_open(*i));
        let mut open: Vec<(f64, usize)> = open.map(|i| (search.merit(i), i)).collect();
        open.sort_by(|a, b| b.0.total_cmp(&a.0));
        open.into_iter().map(|(_, i)| i).collect()
    }

    pub fn expected_text(&self, place: usize) -> String {
        let value = self.search.predicted(place);
        let time = ms(value.cost * self.baseline_ns());
        format!("{time}, {}", percent(value.error))
    }

    /// The largest groups of ruled-out settings, some of each spelt out.
    pub fn ruled_out_json(&self) -> Vec<Value> {
        let of = |(why, places): &(String, Vec<usize>)| {
            let some: Vec<String> = places.iter().take(EXAMPLES).map(|i| self.flags(*i)).collect();
            json!({ "why": why, "count": places.len(), "settings": some })
        };
        self.skipped().iter().take(GROUPS).map(of).collect()
    }

    /// The most promising untried settings.
    pub fn not_tried_json(&self) -> Vec<Value> {
        let of = |place: &usize| {
            let expected = self.search.predicted(*place);
            json!({
                "flags": self.flags(*place), "expected_ns": expected.cost * self.baseline_ns(),
                "expected_relative_rmse": expected.error,
            })
        };
        self.not_tried().iter().take(GROUPS).map(of).collect()
    }

    /// Counts of settings by outcome: in total, and for each step of each setting where it matters.
    pub fn counts_json(&self) -> Value {
        const KINDS: [&str; 3] = ["measured", "ruled_out", "not_tried"];
        let kind = |place: usize| match self.search.value(place) {
            Some(_) => KINDS[0],
            None if self.search.is_open(place) => KINDS[2],
            None => KINDS[1],
        };
        let kinds: Vec<&str> = (0..self.places.len()).map(kind).collect();
        let counted = |has: &dyn Fn(&Place) -> bool| -> Value {
            let all = || self.places.iter().zip(&kinds).filter(|(place, _)| has(place));
            let count = |of: &str| all().filter(|(_, kind)| **kind == of).count();
            KINDS.iter().map(|of| ((*of).to_owned(), json!(count(of)))).collect()
        };
        let by_step = |(k, ladder): (usize, &Ladder)| {
            let steps = ladder.steps.iter().enumerate().map(|(s, spelt)| {
                let mut of = counted(&|place| place.steps[k] == Some(s));
                of["step"] = json!(spelt);
                of
            });
            json!({ "name": ladder.name, "steps": steps.collect::<Vec<_>>() })
        };
        let mut all = counted(&|_| true);
        all["settings"] = json!(self.places.len());
        all["reasons"] = json!(self.skipped().len());
        all["by_setting"] = self.ladders.iter().enumerate().map(by_step).collect();
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{Bounces, HeightField, Lights, Quality, Scene, Sun, Surface};
    use ridgelight_trade::trade::{Value as Measured, ladders, places, start};

    /// A sky and a sun with bounces have over a hundred thousand settings. With four measured,
    /// nearly all are ruled out or open. The report stays below 64 KiB (40 settings and 40 reasons
    /// with 6 each of 250 letters, and 12 KiB of counts) and accounts for every setting once.
    #[test]
    fn unmeasured_settings_are_counted_not_listed() {
        let sun =
            Sun { azimuth_rad: 0.0, elevation_rad: 0.5, diameter_rad: 0.01, irradiance: [1.0; 3] };
        let scene = Scene {
            field: HeightField::new(2, 2, &[0.0; 4], [1.0; 2], None).unwrap(),
            surface: Surface::default(),
            lights: Lights { sky: Some([1.0; 3]), suns: vec![sun], ..Lights::default() },
        };
        let ladders = ladders(&scene, 3);
        let bounces = Bounces { count: 3, ..Bounces::default() };
        let start = Quality { bounces, ..start() };
        let places = places(&ladders, &start);
        assert!(places.len() > 100_000, "{}", places.len());
        let mut walk = Walk::new(&ladders, &places, &start, 1e-4);
        let baseline = walk.baseline;
        for (i, place) in [baseline, 0, places.len() / 2, 7].into_iter().enumerate() {
            let (cost, error) = (1.0 + i as f64, 0.1 / (1.0 + i as f64));
            walk.search.measured(place, Measured { cost, error });
        }
        walk.give_up(9, "refused".to_owned(), false);
        let counts = walk.counts_json();
        let number = |of: &Value, name: &str| of[name].as_u64().unwrap() as usize;
        let kinds = ["measured", "ruled_out", "not_tried"];
        let sum = |of: &Value| kinds.iter().map(|kind| number(of, kind)).sum::<usize>();
        assert_eq!((sum(&counts), number(&counts, "measured")), (places.len(), 4));
        for (k, ladder) in counts["by_setting"].as_array().unwrap().iter().enumerate() {
            let busy = places.iter().filter(|p| p.steps[k].is_some()).count();
            let steps = ladder["steps"].as_array().unwrap();
            assert_eq!(steps.iter().map(sum).sum::<usize>(), busy, "{}", ladder["name"]);
        }
        let (out, open) = (walk.ruled_out_json(), walk.not_tried_json());
        assert_eq!(open.len(), GROUPS);
        let given_up = out.iter().find(|g| g["why"] == "refused").unwrap();
        assert_eq!(number(given_up, "count"), 1);
        let text = json!({ "left_out": counts, "ruled_out": out, "not_tried": open }).to_string();
        assert!(text.len() < 1 << 16, "{} bytes", text.len());
    }
}

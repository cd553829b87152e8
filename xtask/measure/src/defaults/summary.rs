//! Errors of the default: a row for each light, over all terrains and borders and over those of each ground.

use super::light::{Kind, Light};
use super::{Errors, Row};
use crate::common::terrains::Ground;
use crate::common::{head, median};

/// The default over one terrain, with one border, under one light.
struct Case {
    light: &'static str,
    kind: Kind,
    ground: Ground,
    errors: Errors,
    /// The fastest setting that is faster and at least as accurate, and its time over the default's.
    faster: Option<(&'static str, f64)>,
}

#[derive(Default)]
pub struct Summary {
    cases: Vec<Case>,
}

/// Errors with their unit.
fn text(kind: Kind, [error, high]: [String; 2]) -> String {
    match kind {
        Kind::Horizons => format!("{error}° and {high}°"),
        _ => format!("{error} %"),
    }
}

fn measured(kind: Kind, errors: Errors) -> String {
    text(kind, errors.map(|e| format!("{e:.3}")))
}

/// The goal on some ground, or on all.
fn goal(kind: Kind, ground: Option<Ground>) -> String {
    let of = |ground| text(kind, kind.goal(ground).map(|e| e.to_string()));
    match (kind, ground) {
        (Kind::Sky, None) => {
            format!("{}; {}: {}", of(Ground::Real), Ground::Steeper.name(), of(Ground::Steeper))
        }
        (_, ground) => of(ground.unwrap_or(Ground::Real)),
    }
}

impl Case {
    fn meets_goal(&self) -> bool {
        let goal = self.kind.goal(self.ground);
        self.errors.iter().zip(goal).all(|(error, goal)| *error <= goal)
    }
}

impl Summary {
    /// Adds the rows of one comparison, the default first.
    pub fn add(&mut self, light: &Light, ground: Ground, rows: &[Row]) {
        let faster = rows.iter().filter(|row| row.beats(&rows[0]));
        let faster = faster.min_by(|a, b| a.time.total_cmp(&b.time));
        self.cases.push(Case {
            light: light.name,
            kind: light.kind,
            ground,
            errors: rows[0].errors,
            faster: faster.map(|row| (row.flags, row.time)),
        });
    }

    /// Prints the table.
    pub fn print(&self) {
        head(
            "| light | ground | goal | median error | worst error | rows | meet the goal | on the frontier | fastest setting that is as accurate, over the default's time |",
        );
        let mut lights: Vec<&str> = Vec::new();
        for case in &self.cases {
            if !lights.contains(&case.light) {
                lights.push(case.light);
            }
        }
        for light in lights {
            for ground in std::iter::once(None).chain(Ground::ALL.map(Some)) {
                let is_of = |case: &&Case| {
                    case.light == light && ground.is_none_or(|ground| case.ground == ground)
                };
                let cases: Vec<&Case> = self.cases.iter().filter(is_of).collect();
                if !cases.is_empty() {
                    row(ground, &cases);
                }
            }
        }
    }
}

/// A row for cases of one light.
fn row(ground: Option<Ground>, cases: &[&Case]) {
    let Case { light, kind, .. } = *cases[0];
    let of = |i: usize| cases.iter().map(move |case| case.errors[i]);
    let middle = [0, 1].map(|i| median(of(i).collect()));
    let worst = [0, 1].map(|i| of(i).fold(0.0, f64::max));
    let met = cases.iter().filter(|case| case.meets_goal()).count();
    let best = cases.iter().filter(|case| case.faster.is_none()).count();
    let faster = cases.iter().filter_map(|case| case.faster);
    let faster = faster.min_by(|a, b| a.1.total_cmp(&b.1));
    println!(
        "| {light} | {} | {} | {} | {} | {} | {met} | {best} | {} |",
        ground.map_or("all", Ground::name),
        goal(kind, ground),
        measured(kind, middle),
        measured(kind, worst),
        cases.len(),
        faster.map_or("-".to_owned(), |(flags, time)| format!("{time:.2} ({flags})"))
    );
}

//! The stages of a bake: their work and their times.

use std::cell::{Cell, RefCell};
use std::time::Instant;

use indicatif::ProgressBar;

/// The stage in which files are finished.
pub const FILES: &str = "files";

/// A part of a bake. Its time is about proportional to its work.
#[derive(Clone)]
pub struct Stage {
    pub name: String,
    /// What its work counts.
    pub unit: &'static str,
    pub work: f64,
    /// How long it ran.
    pub seconds: f64,
}

impl Stage {
    pub fn new(name: impl Into<String>, work: f64, unit: &'static str) -> Self {
        Self { name: name.into(), unit, work, seconds: 0.0 }
    }
}

/// Times planned stages, one at a time, and shows them on a progress bar.
pub struct Stages {
    bar: ProgressBar,
    /// What the names of stages of one kind begin with.
    kind: Cell<&'static str>,
    all: RefCell<Vec<Stage>>,
    running: Cell<Option<usize>>,
    begun: Cell<Instant>,
}

impl Stages {
    pub fn new(bar: ProgressBar, planned: Vec<Stage>) -> Self {
        let begun = Cell::new(Instant::now());
        Self { bar, kind: Cell::default(), all: planned.into(), running: Cell::default(), begun }
    }

    /// Ends the stage that runs. Names of later stages begin with this kind.
    pub fn of_kind(&self, kind: &'static str) {
        self.end();
        self.kind.set(kind);
    }

    /// Ends the stage that runs and begins another: "scattered light" of the kind `scatter` was
    /// planned as "scatter: scattered light". An empty name is the kind's one stage.
    pub fn begin(&self, name: &str) {
        self.end();
        let words = [self.kind.get(), name].into_iter().filter(|word| !word.is_empty());
        let name = words.collect::<Vec<_>>().join(": ");
        let at = self.all.borrow().iter().position(|stage| stage.name == name);
        debug_assert!(at.is_some(), "{name} is not planned");
        self.running.set(at);
        self.bar.set_message(format!("baking: {name}"));
    }

    /// Shows how far the stage is.
    pub fn show(&self, what: &str) {
        if let Some(at) = self.running.get() {
            self.bar.set_message(format!("baking: {}, {what}", self.all.borrow()[at].name));
        }
    }

    fn end(&self) {
        let now = Instant::now();
        if let Some(at) = self.running.take() {
            self.all.borrow_mut()[at].seconds += (now - self.begun.get()).as_secs_f64();
        }
        self.begun.set(now);
    }

    /// Ends the stage that runs, and returns all.
    pub fn finish(self) -> Vec<Stage> {
        self.end();
        self.all.into_inner()
    }
}

pub fn total(stages: &[Stage]) -> f64 {
    stages.iter().map(|stage| stage.seconds).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_stage_has_its_own_time() {
        let planned = ["horizons", "scatter: direct light", FILES].map(|n| Stage::new(n, 2.0, ""));
        let stages = Stages::new(ProgressBar::hidden(), planned.into());
        stages.begin("horizons");
        stages.of_kind("scatter");
        stages.begin("direct light");
        let ran: Vec<bool> = stages.finish().iter().map(|stage| stage.seconds > 0.0).collect();
        assert_eq!(ran, [true, true, false]);
    }
}

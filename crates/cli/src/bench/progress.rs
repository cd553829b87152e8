//! Rows done and the time that the others may take, on the progress bar.

use std::time::Duration;

use indicatif::ProgressBar;

use super::{FEWEST, ROW_TIME};

/// The rows of a table, measured one after the other.
pub struct Progress<'a> {
    bar: &'a ProgressBar,
    /// Name of each row and seconds that it takes at most.
    rows: Vec<(String, f64)>,
    /// Number of the row that is measured, from 1; 0 before the first.
    at: usize,
    /// Runs of a row at most.
    most: usize,
    /// Rows of later tables.
    later: usize,
}

impl<'a> Progress<'a> {
    /// Until [`runs_take`](Self::runs_take), every row is expected to use up its time limit. `later` rows of other tables follow.
    pub fn new(
        bar: &'a ProgressBar,
        names: impl IntoIterator<Item = String>,
        most: usize,
        later: usize,
    ) -> Self {
        let limit = ROW_TIME.as_secs_f64();
        let rows = names.into_iter().map(|name| (name, limit)).collect();
        Self { bar, rows, at: 0, most, later }
    }

    /// Sets the measured seconds of one run of each row, in the order of the names.
    pub fn runs_take(&mut self, run_s: impl IntoIterator<Item = f64>) {
        let (runs, limit) = ((self.most, FEWEST), ROW_TIME);
        self.rows
            .iter_mut()
            .zip(run_s)
            .for_each(|((_, most_s), run_s)| *most_s = at_most_s(run_s, runs, limit));
    }

    /// Begins the next row.
    pub fn begin_next(&mut self) {
        self.at += 1;
        self.bar.set_message(self.text(None));
    }

    /// Shows how far the row is.
    pub fn show(&self, what: &str) {
        self.bar.set_message(self.text(Some(what)));
    }

    /// Seconds that the row that is measured and all later ones take at most.
    fn left_s(&self) -> f64 {
        let left = self.rows.iter().skip(self.at.saturating_sub(1));
        left.map(|(_, most_s)| most_s).sum::<f64>() + self.later as f64 * ROW_TIME.as_secs_f64()
    }

    fn text(&self, what: Option<&str>) -> String {
        let name = self.rows.get(self.at.saturating_sub(1)).map_or("", |(name, _)| name.as_str());
        let what = what.map(|what| format!(", {what}")).unwrap_or_default();
        let (at, all) = (self.at, self.rows.len() + self.later);
        format!("row {at} of {all}: {name}{what}; up to {:.0} s left", self.left_s())
    }
}

/// Seconds that a row of runs of `run_s` takes at most: `most` runs, or fewer in its time limit, but at least `fewest`. One run
/// warms up, and the limit may end within a run.
pub fn at_most_s(run_s: f64, (most, fewest): (usize, usize), limit: Duration) -> f64 {
    let within = (limit.as_secs_f64() + run_s).max(fewest as f64 * run_s);
    run_s + within.min(most as f64 * run_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Short runs end by their number, longer ones by the time limit, the longest after the fewest runs; one more warms up.
    #[test]
    fn a_row_takes_at_most_its_runs_or_its_time() {
        let of = |run_s| at_most_s(run_s, (100, 6), Duration::from_secs(10));
        assert_eq!([0.0, 0.01, 0.5, 4.0].map(of), [0.0, 1.01, 11.0, 28.0]);
        assert_eq!(at_most_s(4.0, (2, 6), Duration::from_secs(10)), 12.0);
    }

    /// Unmeasured rows count with their limit of 10 s, measured ones with their runs. Rows that are done do not count.
    #[test]
    fn the_time_left_falls_with_each_row() {
        let bar = ProgressBar::hidden();
        let names = ["a", "b", "c"].map(str::to_owned);
        let mut progress = Progress::new(&bar, names, 4, 2);
        assert_eq!(progress.left_s(), 50.0);
        progress.begin_next();
        assert_eq!(bar.message(), "row 1 of 5: a; up to 50 s left");
        progress.runs_take([1.0, 1.0, 0.6]);
        progress.begin_next();
        assert_eq!(bar.message(), "row 2 of 5: b; up to 28 s left");
        progress.show("2 of 4");
        assert_eq!(bar.message(), "row 2 of 5: b, 2 of 4; up to 28 s left");
        progress.begin_next();
        assert_eq!(bar.message(), "row 3 of 5: c; up to 23 s left");
    }
}

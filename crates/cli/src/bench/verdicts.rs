//! Verdicts against earlier reports of `bench --json`.

mod earlier;
#[cfg(test)]
mod tests;

use std::fmt;

use ridgelight_trade::statistics::median;
use serde_json::{Value, json};

use super::rows::{Row, figure};
pub use earlier::Earlier;
use earlier::{EarlierRow, Key, range};

/// Changes of up to this share count as none. Four processes of one program on a quiet machine had medians within 1 to
/// 6 % of each other for passes of 1 ms and more (llvmpipe), which the runs inside a process do not show; passes of
/// 0.2 ms 14 %. Several earlier reports widen the interval to what processes differ by.
const SAME: f64 = 0.05;
/// A row counts as disturbed by load if its 10th and 90th percentiles differ by more than this share of the median.
const UNSTEADY: f64 = 0.2;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    Faster,
    Slower,
    Same,
    Unsure,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&format!("{self:?}").to_uppercase())
    }
}

/// One row beside its earlier ones.
struct Change<'a> {
    row: &'a Row,
    /// That of the last report.
    earlier: &'a EarlierRow,
    /// The median of the earlier medians.
    earlier_ns: Option<f64>,
    /// New over earlier median.
    ratio: Option<f64>,
    /// Bounds of the part of the ratio that the program causes.
    bounds: Option<[f64; 2]>,
    /// Factor by which load may have changed times, 1 or more.
    swing: f64,
    verdict: Verdict,
}

/// Rows of this run that an earlier report has, too.
pub struct Changes<'a> {
    changes: Vec<Change<'a>>,
    earlier: &'a Earlier,
    /// Least and largest factor by which the machine changed times.
    machine: [f64; 2],
    /// Peak passes that did other work in an earlier report.
    other_peaks: usize,
    /// Rows of this run alone.
    new: usize,
}

fn key(row: &Row) -> Key<'_> {
    (row.pass_and_part(), row.mode, row.size, row.azimuths)
}

impl Earlier {
    /// The rows that both have; `peaks` are the peak rates of this run.
    pub fn against<'a>(&'a self, rows: &'a [Row], peaks: &[Row]) -> Changes<'a> {
        let (machine, other_peaks) = machine(self, peaks);
        let of = |row| Change::of(row, &self.same(key(row), |report| &report.rows), machine);
        let changes: Vec<_> = rows.iter().filter_map(of).collect();
        let new = rows.len() - changes.len();
        Changes { changes, earlier: self, machine, other_peaks, new }
    }
}

/// Least and largest factor by which the state of the machine, such as clock or load, changed times since the earlier
/// reports. Also the number of peak passes that did other work in an earlier report.
///
/// 10th percentiles of peak passes of equal `bytes` are compared: the memory budget sets their invocations and with
/// them their bytes, and an invocation does the same work in every version. Rates of unequal work are not compared,
/// because a smaller copy is faster if it fits into a cache. Let t be the percentile now and t' the nearest of the
/// earlier ones: the time changed by t / t'. Up to 5 % counts as no change. It is unknown which unit of the device limits
/// another pass, and how much. That pass may have changed by any factor from min(1, t / t') to max(1, t / t') over all
/// peaks.
fn machine(earlier: &Earlier, peaks: &[Row]) -> ([f64; 2], usize) {
    let (mut factors, mut other) = ([1.0_f64; 2], 0);
    for peak in peaks {
        let mut then = earlier.same(key(peak), |report| &report.peaks);
        let count = then.len();
        then.retain(|row| row.bytes == peak.bytes);
        other += usize::from(then.len() < count);
        let then = range(&then, |row| row.p10_ns);
        let Some(([p10, _], [least, most])) = peak.percentiles().zip(then) else { continue };
        let factor = p10 / p10.clamp(least, most);
        if (factor - 1.0).abs() > SAME {
            factors = [factors[0].min(factor), factors[1].max(factor)];
        }
    }
    (factors, other)
}

/// Factor by which load may have changed the times of a row: p90 / p10 if they differ by more than [`UNSTEADY`] of the
/// median, else 1. Another process may run under the load of either percentile.
fn swing(p10: f64, p90: f64, median: f64) -> f64 {
    if p90 - p10 > UNSTEADY * median { p90 / p10 } else { 1.0 }
}

impl<'a> Change<'a> {
    /// Compares a row with the same one of earlier reports; none without any.
    ///
    /// The ratio of medians lies between the ends of both 95 % confidence intervals, low / high' and high / low'. These
    /// bounds are divided by the largest and the least factor of the [`machine`], and widened by the largest [`swing`] of
    /// all reports: both can change a median without a change of the program.
    fn of(row: &'a Row, same: &[&'a EarlierRow], [least, most]: [f64; 2]) -> Option<Self> {
        let earlier = *same.last()?;
        let medians: Option<Vec<f64>> = same.iter().map(|row| row.median_ns).collect();
        let earlier_ns = medians.and_then(|all| median(&all));
        let ratio = row.times.zip(earlier_ns).map(|(now, then)| now.median / then);
        let earlier_swing =
            |row: &&EarlierRow| Some(swing(row.p10_ns?, row.p90_ns?, row.median_ns?));
        let now_swing =
            row.percentiles().zip(row.times).map(|([p10, p90], t)| swing(p10, p90, t.median));
        let swing = same.iter().filter_map(earlier_swing).chain(now_swing).fold(1.0, f64::max);
        let ends = range(same, |row| row.median_low_ns).zip(range(same, |row| row.median_high_ns));
        let bounds =
            row.interval.zip(ends).map(|([low, high], ([then_low, _], [_, then_high]))| {
                [low / then_high / most / swing, high / then_low / least * swing]
            });
        let p10 = row.percentiles().zip(range(same, |row| row.p10_ns));
        let p10 = p10.map(|([p10, _], then)| [p10 / then[1] / most, p10 / then[0] / least]);
        let verdict = verdict(bounds, p10);
        Some(Self { row, earlier, earlier_ns, ratio, bounds, swing, verdict })
    }
}

/// The verdict from the bounds of the ratios of medians and of 10th percentiles. Other work on a machine moves a median
/// more than the 10th percentile, so both must have changed.
fn verdict(median: Option<[f64; 2]>, p10: Option<[f64; 2]>) -> Verdict {
    let (Some([low, high]), Some([p10_low, p10_high])) = (median, p10) else {
        return Verdict::Unsure;
    };
    if high < 1.0 - SAME && p10_high < 1.0 - SAME {
        Verdict::Faster
    } else if low > 1.0 + SAME && p10_low > 1.0 + SAME {
        Verdict::Slower
    } else if low >= 1.0 - SAME && high <= 1.0 + SAME {
        Verdict::Same
    } else {
        Verdict::Unsure
    }
}

impl Changes<'_> {
    /// Whether no row could be compared.
    pub fn is_empty(&self) -> bool {
        self.changes.is_empty()
    }

    /// Whether a row became slower.
    pub fn any_slower(&self) -> bool {
        self.changes.iter().any(|change| change.verdict == Verdict::Slower)
    }

    pub fn json(&self) -> Value {
        let last = self.earlier.last();
        let row = |change: &Change| {
            let (pass, part) = change.row.pass_and_part();
            json!({
                "pass": pass, "part": part, "mode": change.row.mode, "cols": change.row.size[0],
                "rows": change.row.size[1], "azimuths": change.row.azimuths, "ratio": change.ratio,
                "low": change.bounds.map(|b| b[0]), "high": change.bounds.map(|b| b[1]),
                "verdict": change.verdict.to_string(),
            })
        };
        json!({
            "device": last.device, "driver": last.driver, "commit": last.commit,
            "rows": self.changes.iter().map(row).collect::<Vec<_>>(),
        })
    }

    /// What limits the comparison, then the table.
    pub fn print(&self, warnings: &[String]) {
        crate::say!("\ncompared with {}", self.earlier.text());
        warnings.iter().for_each(|warning| crate::say!("{warning}"));
        crate::say!(
            "{:<34} {:<10} {:>11} {:>8} {:>10} {:>10} {:>7} {:>15}  verdict",
            "pass",
            "mode",
            "texels",
            "azimuths",
            "earlier ms",
            "now ms",
            "ratio",
            "interval"
        );
        for Change { row, earlier_ns, ratio, bounds, verdict, .. } in &self.changes {
            let bounds = bounds.map(|[low, high]| format!("{low:.3} to {high:.3}"));
            let [cols, rows] = row.size;
            crate::say!(
                "{:<34} {:<10} {:>11} {:>8} {:>10} {:>10} {:>7} {:>15}  {verdict}",
                row.pass,
                row.mode,
                format!("{cols}x{rows}"),
                row.azimuths,
                figure(earlier_ns.map(|ns| ns * 1e-6), 3),
                figure(row.times.map(|t| t.median * 1e-6), 3),
                figure(*ratio, 3),
                bounds.as_deref().unwrap_or("unavailable"),
            );
        }
    }

    /// What limits the comparison; `device` and `driver` are those of this run.
    pub fn warnings(&self, device: &str, driver: &str) -> Vec<String> {
        let mut lines = Vec::new();
        let last = self.earlier.last();
        for (what, then, now) in
            [("device", &*last.device, device), ("driver", &*last.driver, driver)]
        {
            if then != now {
                lines.push(format!("different {what}: earlier {then}, now {now}"));
            }
        }
        lines.extend(self.differences());
        if self.earlier.has_unknown_scene() {
            lines.push("unknown scene: an earlier report does not state its scene".to_owned());
        }
        if self.machine != [1.0; 2] {
            let [least, most] = self.machine;
            lines.push(format!(
                "different peak rates: the same work takes {least:.2} to {most:.2} times as long as before; the intervals are wider because of this"
            ));
        }
        if self.other_peaks > 0 {
            lines.push(format!(
                "not compared: {} peak rates, measured with other work in an earlier report; use its --memory-budget",
                self.other_peaks
            ));
        }
        let unsteady = self.changes.iter().filter(|change| change.swing > 1.0).count();
        if unsteady > 0 {
            lines.push(format!(
                "unsteady rows: {unsteady}, whose 10th and 90th percentiles differ by more than 20 % of the median; their intervals are wider because of this"
            ));
        }
        if self.earlier.0.len() == 1 {
            lines.push(
                "one earlier report cannot show how much processes differ: give --against three files"
                    .to_owned(),
            );
        }
        let is_compared = |row: &&EarlierRow| self.changes.iter().any(|c| key(c.row) == row.key());
        let missing = last.rows.iter().filter(|row| !is_compared(row)).count();
        for (count, which) in [(self.new, "this run"), (missing, "the earlier report")] {
            if count > 0 {
                lines.push(format!("rows not compared, found only in {which}: {count}"));
            }
        }
        lines
    }

    /// Settings that differ in any row, each pair once.
    fn differences(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for Change { row, earlier, .. } in &self.changes {
            let now = crate::setup::typed(&row.settings);
            let names: std::collections::BTreeSet<_> =
                now.keys().chain(earlier.settings.keys()).collect();
            for name in names {
                let [then, now] = [earlier.settings.get(name), now.get(name)]
                    .map(|value| value.map_or("none".to_owned(), Value::to_string));
                // A result, and a name of a row.
                let is_setting = !["light_error", "scalar_beside"].contains(&&name[..]);
                let line = format!("different setting: {name}: earlier {then}, now {now}");
                if then != now && is_setting && !lines.contains(&line) {
                    lines.push(line);
                }
            }
        }
        lines
    }
}

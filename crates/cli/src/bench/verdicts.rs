//! Verdicts against earlier reports of `bench --json`.

use std::fmt;
use std::path::{Path, PathBuf};

use ridgelight::{Error, Result};
use ridgelight_trade::statistics::median;
use serde::Deserialize;
use serde_json::{Value, json};

use super::rows::{Row, figure};

/// Changes of up to this share count as none. Four processes of one program on a quiet machine had medians within 1 to
/// 6 % of each other for passes of 1 ms and more (llvmpipe), which the runs inside a process do not show; passes of
/// 0.2 ms 14 %. Several earlier reports widen the interval to what processes differ by.
const SAME: f64 = 0.05;

/// An earlier report.
#[derive(Deserialize)]
pub struct Earlier {
    device: String,
    driver: String,
    #[serde(default)]
    commit: String,
    rows: Vec<EarlierRow>,
}

#[derive(Deserialize)]
struct EarlierRow {
    pass: String,
    #[serde(default)]
    part: String,
    mode: String,
    cols: u32,
    rows: u32,
    azimuths: u32,
    settings: serde_json::Map<String, Value>,
    median_ns: Option<f64>,
    /// Of several reports, the range of theirs.
    p10_ns: Ends,
    median_low_ns: Option<f64>,
    median_high_ns: Option<f64>,
}

/// One number, or the least and the largest of several.
#[derive(Clone, Copy, Deserialize)]
#[serde(from = "Option<f64>")]
struct Ends(Option<[f64; 2]>);

impl From<Option<f64>> for Ends {
    fn from(one: Option<f64>) -> Self {
        Self(one.map(|one| [one; 2]))
    }
}

/// Pass and part, mode, columns and rows, azimuths.
type Key<'a> = ((&'a str, &'a str), &'a str, [u32; 2], u32);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict {
    Faster,
    Slower,
    Same,
    Unsure,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Faster => "FASTER",
            Self::Slower => "SLOWER",
            Self::Same => "SAME",
            Self::Unsure => "UNSURE",
        })
    }
}

/// One row beside its earlier one.
struct Change<'a> {
    row: &'a Row,
    earlier: &'a EarlierRow,
    /// New over earlier median.
    ratio: Option<f64>,
    /// Bounds of the ratio: the ends of both intervals against each other.
    bounds: Option<[f64; 2]>,
    verdict: Verdict,
}

/// Rows of this run that an earlier report has, too.
pub struct Changes<'a> {
    changes: Vec<Change<'a>>,
    earlier: &'a Earlier,
    /// Rows of this run alone.
    new: usize,
}

impl Earlier {
    /// Reads a report before anything is timed.
    ///
    /// # Errors
    /// A file that cannot be read, or is no report of `bench --json`.
    pub fn read(path: &Path) -> Result<Self> {
        let text = std::fs::read(path).map_err(|e| Error::io(path, e))?;
        serde_json::from_slice(&text).map_err(|e| {
            let place = format!("line {}, column {}", e.line(), e.column());
            Error::file(path, place, e.to_string(), "a report of bench --json")
        })
    }

    /// Reads several, whose rows become one with the median of their medians and an interval that holds all of theirs.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_all(paths: &[PathBuf]) -> Result<Option<Self>> {
        let mut reports = paths.iter().map(|path| Self::read(path)).collect::<Result<Vec<_>>>()?;
        let Some(mut all) = reports.pop() else { return Ok(None) };
        if let Some((other, path)) = reports.iter().zip(paths).find(|(r, _)| r.device != all.device)
        {
            return Err(Error::file(
                path,
                "device",
                &other.device,
                format!("{}, as in the last file", all.device),
            ));
        }
        for row in &mut all.rows {
            let same: Vec<_> = reports
                .iter()
                .filter_map(|report| report.rows.iter().find(|r| r.key() == row.key()))
                .collect();
            let of = |get: fn(&EarlierRow) -> Option<f64>| {
                same.iter().map(|r| get(r)).chain([get(row)]).collect::<Option<Vec<f64>>>()
            };
            let [low, high, medians] =
                [of(|r| r.median_low_ns), of(|r| r.median_high_ns), of(|r| r.median_ns)];
            row.median_low_ns = low.map(|all| all.into_iter().fold(f64::INFINITY, f64::min));
            row.median_high_ns = high.map(|all| all.into_iter().fold(0.0, f64::max));
            row.median_ns = medians.and_then(|all| median(&all));
            for other in same {
                let both = row.p10_ns.0.zip(other.p10_ns.0);
                row.p10_ns.0 = both.map(|(a, b)| [a[0].min(b[0]), a[1].max(b[1])]);
            }
        }
        Ok(Some(all))
    }

    /// The rows that both have.
    pub fn against<'a>(&'a self, rows: &'a [Row]) -> Changes<'a> {
        let change = |row: &'a Row| {
            let key = (row.pass_and_part(), row.mode, row.size, row.azimuths);
            let earlier = self.rows.iter().find(|earlier| earlier.key() == key)?;
            let ratio = row.times.zip(earlier.median_ns).map(|(now, then)| now.median / then);
            let bounds = match (row.interval, earlier.median_low_ns, earlier.median_high_ns) {
                (Some([low, high]), Some(then_low), Some(then_high)) => {
                    Some([low / then_high, high / then_low])
                }
                _ => None,
            };
            let p10 = row
                .times
                .zip(earlier.p10_ns.0)
                .map(|(now, [least, most])| [now.p10 / most, now.p10 / least]);
            Some(Change { row, earlier, ratio, bounds, verdict: verdict(bounds, p10) })
        };
        let changes: Vec<_> = rows.iter().filter_map(change).collect();
        let new = rows.len() - changes.len();
        Changes { changes, earlier: self, new }
    }
}

impl EarlierRow {
    fn key(&self) -> Key<'_> {
        ((&self.pass, &self.part), &self.mode, [self.cols, self.rows], self.azimuths)
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
            "device": self.earlier.device, "driver": self.earlier.driver,
            "commit": self.earlier.commit, "rows": self.changes.iter().map(row).collect::<Vec<_>>(),
        })
    }

    /// The table; `device` and `driver` are today's.
    pub fn print(&self, device: &str, driver: &str) {
        let Earlier { commit, .. } = self.earlier;
        let of = if commit.is_empty() { String::new() } else { format!(", commit {commit}") };
        crate::say!("\ncompared with the earlier report{of}");
        for (what, then, now) in
            [("device", &self.earlier.device, device), ("driver", &self.earlier.driver, driver)]
        {
            if then != now {
                crate::say!("different {what}: earlier {then}, now {now}");
            }
        }
        crate::say!(
            "{:<34} {:<9} {:>10} {:>10} {:>7} {:>15}  verdict",
            "pass",
            "mode",
            "earlier ms",
            "now ms",
            "ratio",
            "95 % interval"
        );
        for Change { row, earlier, ratio, bounds, verdict } in &self.changes {
            let bounds = bounds.map(|[low, high]| format!("{low:.3} to {high:.3}"));
            crate::say!(
                "{:<34} {:<9} {:>10} {:>10} {:>7} {:>15}  {verdict}",
                row.pass,
                row.mode,
                figure(earlier.median_ns.map(|ns| ns * 1e-6), 3),
                figure(row.times.map(|t| t.median * 1e-6), 3),
                figure(*ratio, 3),
                bounds.as_deref().unwrap_or("unavailable"),
            );
        }
        for line in self.differences() {
            crate::say!("{line}");
        }
        let missing = self.earlier.rows.len().saturating_sub(self.changes.len());
        for (count, which) in [(self.new, "this run"), (missing, "the earlier report")] {
            if count > 0 {
                crate::say!("not compared: {count} rows found only in {which}");
            }
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::rows::{self, tests::plan};

    /// Ten runs about `ms`, a hundredth apart on either side.
    fn row(pass: &str, ms: f64) -> Row {
        let times: Vec<f64> =
            (0..10).map(|i| ms * 1e6 * (0.99 + 0.02 * f64::from(i) / 9.0)).collect();
        Row::of(pass, "in_flow", &plan(), &[], 64, (10, &times))
    }

    fn report(rows: &[Row]) -> Earlier {
        serde_json::from_value(rows::file("d", "v", &[], rows, &[])).unwrap()
    }

    /// Intervals from the 2nd to the 9th of ten: ±0.78 %, so that ratios are known to ±1.57 %. 5 % count as the same.
    #[test]
    fn intervals_decide() {
        let earlier = report(&[
            row("a x", 100.0),
            row("b", 100.0),
            row("c", 100.0),
            row("d", 100.0),
            row("gone", 1.0),
        ]);
        let now =
            [row("a x", 93.0), row("b", 107.0), row("c", 103.0), row("d", 105.0), row("new", 1.0)];
        let changes = earlier.against(&now);
        let verdicts: Vec<_> = changes.changes.iter().map(|c| c.verdict).collect();
        use Verdict::{Faster, Same, Slower, Unsure};
        assert_eq!(verdicts, [Faster, Slower, Same, Unsure]);
        assert_eq!((changes.new, changes.any_slower()), (1, true));
        let json = changes.json();
        assert_eq!([&json["rows"][0]["part"], &json["rows"][0]["verdict"]], ["x", "FASTER"]);
        let ratio = json["rows"][1]["ratio"].as_f64().unwrap();
        assert!((ratio - 1.07).abs() < 1e-12, "{ratio}");
        assert!(!earlier.against(&now[2..]).any_slower());
        assert!(earlier.against(&[]).is_empty() && !earlier.against(&now).is_empty());
    }

    /// Four of five runs take twice as long, the others as long as before.
    #[test]
    fn a_busy_machine_is_no_slower_pass() {
        let earlier = report(&[row("a", 100.0)]);
        let times: Vec<f64> = (0..20).map(|i| if i < 4 { 100e6 } else { 200e6 }).collect();
        let busy = [Row::of("a", "in_flow", &plan(), &[], 64, (20, &times))];
        let changes = earlier.against(&busy);
        assert!(changes.changes[0].bounds.unwrap()[0] > 1.9);
        assert_eq!(changes.changes[0].verdict, Verdict::Unsure);
    }

    /// 107 beside 100 is slower, and beside 100 and 103 unsure: their interval ends at 103.8.
    #[test]
    fn several_reports_widen_the_interval() {
        let folder = tempfile::tempdir().unwrap();
        let paths = [100.0, 103.0].map(|ms| {
            let path = folder.path().join(format!("{ms}.json"));
            std::fs::write(&path, rows::file("d", "v", &[], &[row("a", ms)], &[]).to_string())
                .unwrap();
            path
        });
        let now = [row("a", 107.0)];
        let verdict = |paths: &[PathBuf]| {
            let earlier = Earlier::read_all(paths).unwrap().unwrap();
            let changes = earlier.against(&now);
            (changes.changes[0].verdict, changes.changes[0].earlier.median_ns.unwrap())
        };
        assert_eq!(verdict(&paths[..1]).0, Verdict::Slower);
        let (both, median) = verdict(&paths);
        assert_eq!(both, Verdict::Unsure);
        assert!((median / 101.5e6 - 1.0).abs() < 1e-9, "{median}");
        assert!(Earlier::read_all(&[]).unwrap().is_none());
    }

    #[test]
    fn reports_of_different_devices_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let paths = ["a", "b"].map(|device| {
            let path = folder.path().join(device);
            std::fs::write(&path, rows::file(device, "v", &[], &[row("a", 1.0)], &[]).to_string())
                .unwrap();
            path
        });
        let message = Earlier::read_all(&paths).err().unwrap().to_string();
        assert!(message.contains("device: found a, expected b"), "{message}");
    }

    #[test]
    fn too_few_runs_and_no_times_are_unsure() {
        let times = [1e6; 5];
        let few = Row::of("a", "in_flow", &plan(), &[], 64, (5, &times));
        let none = Row::of("b", "in_flow", &plan(), &[], 64, (5, &[]));
        let earlier = report(&[row("a", 100.0), row("b", 100.0)]);
        let now = [few, none];
        let changes = earlier.against(&now);
        assert!(changes.changes.iter().all(|c| c.verdict == Verdict::Unsure));
        assert_eq!(changes.changes[1].ratio, None);
    }

    #[test]
    fn differing_settings_are_reported_once() {
        let mut slower = [row("a", 100.0), row("b", 100.0)];
        for row in &mut slower {
            let hull = row.settings.iter_mut().find(|(name, _)| name == "hull").unwrap();
            hull.1 = "shared".to_owned();
        }
        let earlier = report(&[row("a", 100.0), row("b", 100.0)]);
        let lines = earlier.against(&slower).differences();
        assert_eq!(lines, [r#"different setting: hull: earlier "private", now "shared""#]);
    }

    #[test]
    fn what_is_no_report_is_refused_with_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("times.json");
        std::fs::write(&path, "{\n  \"device\": 1\n}").unwrap();
        let message = Earlier::read(&path).err().unwrap().to_string();
        assert!(
            message.contains("line 2") && message.contains("a report of bench --json"),
            "{message}"
        );
        assert!(Earlier::read(&folder.path().join("none.json")).is_err());
    }
}

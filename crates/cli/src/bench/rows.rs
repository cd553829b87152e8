//! Rows of measured times, as text and JSON.

use ridgelight::gpu::Timing;
use ridgelight::plan::{Pass, Plan};
use ridgelight_trade::statistics::{Summary, median_interval};
use serde_json::{Value, json};

use super::{FEWEST, peaks};
use crate::setup;

/// One pass in one mode.
#[derive(Clone)]
pub struct Row {
    pub pass: String,
    pub mode: &'static str,
    pub size: [u32; 2],
    pub azimuths: u32,
    pub settings: Vec<(String, String)>,
    /// Number of timing runs.
    pub runs: usize,
    /// Nanoseconds; none where the device has no timestamps.
    pub times: Option<Summary>,
    /// Nanoseconds between which the median lies, at 95 %; none for fewer than 6 runs.
    pub interval: Option<[f64; 2]>,
    pub bytes: u64,
    /// Texels processed in one run by one pass; 0 for several passes, whose texels are not comparable.
    pub work: u64,
    /// Bytes per second that a copy reaches on this device; none if it was not measured.
    pub copy_rate: Option<f64>,
}

impl Row {
    /// A row of these passes together, run `times_ns.len()` times.
    pub fn of(
        pass: impl Into<String>,
        mode: &'static str,
        plan: &Plan,
        passes: &[&Pass],
        azimuths: u32,
        (runs, times_ns): (usize, &[f64]),
    ) -> Self {
        Self {
            pass: pass.into(),
            mode,
            size: plan.size,
            azimuths,
            settings: plan.settings.clone(),
            runs,
            times: Summary::of(times_ns),
            interval: median_interval(times_ns),
            bytes: passes.iter().map(|p| p.bytes).sum(),
            work: if let [one] = passes { one.texels } else { 0 },
            copy_rate: None,
        }
    }

    fn rate(&self, amount: u64) -> Option<f64> {
        let median = self.times?.median;
        (amount > 0 && median > 0.0).then(|| amount as f64 / (median * 1e-9))
    }

    /// Bytes per second.
    pub fn byte_rate(&self) -> Option<f64> {
        self.rate(self.bytes)
    }

    /// Texels per second.
    pub fn texel_rate(&self) -> Option<f64> {
        self.rate(self.work)
    }

    /// Share of the rate of a copy; above 1 from caches.
    pub fn copy_share(&self) -> Option<f64> {
        Some(self.byte_rate()? / self.copy_rate?)
    }

    /// Milliseconds per azimuth.
    pub fn ms_per_azimuth(&self) -> Option<f64> {
        Some(self.times?.median * 1e-6 / f64::from(self.azimuths.max(1)))
    }

    /// Milliseconds per azimuth and 2^20 texels of the field.
    pub fn ms_per_azimuth_and_mega(&self) -> Option<f64> {
        let mega = f64::from(self.size[0]) * f64::from(self.size[1]) / f64::from(1 << 20);
        Some(self.ms_per_azimuth()? / mega)
    }

    /// The first word of the label, and the rest.
    pub fn pass_and_part(&self) -> (&str, &str) {
        self.pass.split_once(' ').unwrap_or((&self.pass, ""))
    }

    /// Nanoseconds, 10th and 90th percentile; none for fewer than [`FEWEST`] runs, which also give the median no interval.
    pub fn percentiles(&self) -> Option<[f64; 2]> {
        self.times.filter(|_| self.runs >= FEWEST).map(|times| [times.p10, times.p90])
    }

    /// Width of the interval of the median over the median.
    pub fn spread(&self) -> Option<f64> {
        let [low, high] = self.interval?;
        Some((high - low) / self.times?.median)
    }

    pub fn json(&self) -> Value {
        let (pass, part) = self.pass_and_part();
        json!({
            "pass": pass, "part": part, "mode": self.mode, "cols": self.size[0], "rows": self.size[1],
            "azimuths": self.azimuths, "settings": setup::typed(&self.settings), "runs": self.runs,
            "min_ns": self.times.map(|t| t.min), "median_ns": self.times.map(|t| t.median),
            "median_low_ns": self.interval.map(|i| i[0]), "median_high_ns": self.interval.map(|i| i[1]),
            "p10_ns": self.percentiles().map(|p| p[0]), "p90_ns": self.percentiles().map(|p| p[1]),
            "bytes": self.bytes, "gb_per_s": self.byte_rate().map(|r| r * 1e-9),
            "texels_per_s": self.texel_rate(), "copy_share": self.copy_share(),
        })
    }

    pub fn head() -> String {
        format!(
            "{:<34} {:<10} {:>10} {:>10} {:>10} {:>10} {:>7} {:>7} {:>11}",
            "pass", "mode", "median ms", "p10", "p90", "min", "GB/s", "of copy", "Gtexels/s"
        )
    }

    pub fn text(&self) -> String {
        let ms = |ns: fn(&Summary) -> f64| figure(self.times.map(|t| ns(&t) * 1e-6), 3);
        let percentile = |ns: fn(&Summary) -> f64| {
            if self.runs < FEWEST { "-".into() } else { ms(ns) }
        };
        let giga = |amount: u64, digits| match amount {
            0 => "-".into(),
            _ => figure(self.rate(amount).map(|r| r * 1e-9), digits),
        };
        format!(
            "{:<34} {:<10} {:>10} {:>10} {:>10} {:>10} {:>7} {:>7} {:>11}",
            self.pass,
            self.mode,
            ms(|t| t.median),
            percentile(|t| t.p10),
            percentile(|t| t.p90),
            ms(|t| t.min),
            giga(self.bytes, 2),
            self.copy_share().map_or("-".into(), |share| format!("{:.0} %", 100.0 * share)),
            giga(self.work, 3),
        )
    }
}

/// Unknown values are not 0.
pub fn figure(value: Option<f64>, digits: usize) -> String {
    value.map_or_else(|| "unavailable".to_owned(), |v| format!("{v:.digits$}"))
}

/// Sums of each run over the passes that `wanted` selects by position; none where a run has no
/// times.
pub fn sums(runs: &[Vec<Timing>], wanted: impl Fn(usize) -> bool) -> Vec<f64> {
    if runs.iter().any(Vec::is_empty) {
        return Vec::new();
    }
    let sum = |run: &Vec<Timing>| {
        run.iter().enumerate().filter(|(i, _)| wanted(*i)).map(|(_, t)| t.ns).sum()
    };
    runs.iter().map(sum).collect()
}

/// The report of these rows. `argv` are the words after the program's name, `peaks` rows of the device's peak rates.
pub fn file(device: &str, driver: &str, peaks: &[Row], rows: &[Row], argv: &[String]) -> Value {
    json!({
        "device": device, "driver": driver, "ridgelight": env!("CARGO_PKG_VERSION"),
        "commit": env!("RIDGELIGHT_COMMIT"), "argv": argv,
        "time": humantime::format_rfc3339_seconds(std::time::SystemTime::now()).to_string(),
        "peaks": peaks::json(peaks),
        "rows": rows.iter().map(Row::json).collect::<Vec<_>>(),
    })
}

/// Rows as Bencher Metric Format: by benchmark, the measure `latency` in nanoseconds with the interval of its median.
/// Rows without times are left out. The name of a benchmark is that of the row, with its size, its azimuths, and those of its other
/// settings that the user `gives`. Field, lights and surface are not in it.
pub fn bencher(rows: &[Row], gives: impl Fn(&str) -> bool) -> Value {
    let other = |name: &str| gives(name) && !["size", "azimuths"].contains(&name);
    let metric = |row: &Row| {
        let mut latency = json!({ "value": row.times?.median });
        if let Some([low, high]) = row.interval {
            latency["lower_value"] = low.into();
            latency["upper_value"] = high.into();
        }
        let [cols, rows] = row.size;
        let mut name = format!("{} {} {cols}x{rows} {} azimuths", row.pass, row.mode, row.azimuths);
        for (setting, value) in row.settings.iter().filter(|(setting, _)| other(setting)) {
            name += &format!(" {setting}={value}");
        }
        Some((name, json!({ "latency": latency })))
    };
    Value::Object(rows.iter().filter_map(metric).collect())
}

/// A frame as Chrome trace events, which Perfetto also reads: microseconds, in the device's order.
/// Without timestamps it has names only.
pub fn trace(device: &str, driver: &str, plan: &Plan, frame: &[Timing]) -> Value {
    let name = |kind: &str, name: &str| json!({ "name": kind, "ph": "M", "pid": 1, "tid": 1, "args": { "name": name } });
    let mut events = vec![name("process_name", device), name("thread_name", "frame, in flow")];
    let mut start_us = 0.0;
    for (timing, pass) in frame.iter().zip(&plan.passes) {
        let us = timing.ns * 1e-3;
        events.push(json!({
            "name": timing.label, "cat": "pass", "ph": "X", "ts": start_us, "dur": us, "pid": 1, "tid": 1,
            "args": { "why": pass.why, "bytes": pass.bytes, "texels": pass.texels, "groups": pass.groups },
        }));
        start_us += us;
    }
    json!({
        "traceEvents": events, "displayTimeUnit": "ms",
        "otherData": {
            "device": device, "driver": driver, "ridgelight": env!("CARGO_PKG_VERSION"), "commit": env!("RIDGELIGHT_COMMIT"),
            "frame": "the run in flow whose GPU time is nearest the median", "gpu_ms": start_us * 1e-3,
        },
    })
}

#[cfg(test)]
pub mod tests {
    use super::*;
    use ridgelight::plan::{self, Limits, Picture};
    use ridgelight::scene::{Lights, Quality};

    pub fn plan() -> Plan {
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let scene = crate::bench::verify::tests::scene(32, lights);
        plan::picture(&scene, &Quality::default(), &Limits::lavapipe(), Picture::default()).unwrap()
    }

    /// Runs of 0..=6 ms: median 3, p10 0.6, p90 5.4; 6 MB in 3 ms are 2 GB/s. Of 7 values, all are the interval.
    #[test]
    fn runs_become_a_row() {
        let times: Vec<f64> = (0..=6).map(|ms| f64::from(ms) * 1e6).collect();
        let plan = plan();
        let mut row = Row::of("sky_shade sky 0+32", "in_flow", &plan, &[], 64, (7, &times));
        (row.bytes, row.work, row.copy_rate) = (6_000_000, 3_000_000, Some(8e9));
        let json = row.json();
        let keys = "pass part mode cols rows azimuths settings runs min_ns median_ns median_low_ns median_high_ns p10_ns \
                    p90_ns bytes gb_per_s texels_per_s copy_share";
        assert_eq!(json.as_object().unwrap().len(), keys.split(' ').count());
        assert!(keys.split(' ').all(|k| !json[k].is_null()), "{json}");
        let near = |key: &str, x: f64| {
            let found = json[key].as_f64().unwrap();
            assert!((found / x - 1.0).abs() < 1e-12, "{key}: {found}, expected {x}");
        };
        near("median_ns", 3e6);
        near("p10_ns", 0.6e6);
        near("p90_ns", 5.4e6);
        assert_eq!([&json["median_low_ns"], &json["median_high_ns"]], [0.0, 6e6]);
        assert_eq!(row.spread(), Some(2.0));
        near("gb_per_s", 2.0);
        near("copy_share", 0.25);
        near("texels_per_s", 1e9);
        let per = row.ms_per_azimuth_and_mega().unwrap();
        assert!((per - 3.0 / 64.0 * 1024.0).abs() < 1e-9, "32² is a 1024th of 2^20: {per}");
        row.settings = [("azimuths", "64"), ("fuse", "aimed"), ("hull", "private")]
            .map(|(n, v)| (n.into(), v.into()))
            .into();
        let gives = |name: &str| ["azimuths", "fuse"].contains(&name);
        let bencher = bencher(std::slice::from_ref(&row), gives);
        let name = "sky_shade sky 0+32 in_flow 32x32 64 azimuths fuse=aimed";
        let latency = &bencher[name]["latency"];
        let metric = json!({ "value": 3e6, "lower_value": 0.0, "upper_value": 6e6 });
        assert_eq!(*latency, metric, "{bencher}");
        let whole = file("d", "v", &[], &[row], &["--size".to_owned()]);
        let row = &whole["rows"][0];
        assert_eq!([&row["pass"], &row["part"]], ["sky_shade", "sky 0+32"]);
        assert_eq!([&whole["device"], &whole["driver"], &whole["argv"][0]], ["d", "v", "--size"]);
        let time = whole["time"].as_str().unwrap();
        let read = humantime::parse_rfc3339(time).unwrap().elapsed().unwrap();
        assert!(read < std::time::Duration::from_secs(3600), "{time}");
    }

    #[test]
    fn no_timestamps_are_unavailable_and_never_zero() {
        let runs = vec![Vec::new(), Vec::new()];
        let none = sums(&runs, |_| true);
        let plan = plan();
        let row = Row::of("total", "in_flow", &plan, &[&plan.passes[0]], 4, (2, &none));
        assert!(row.text().contains("unavailable") && !row.text().contains("0.000"));
        assert!(row.json()["median_ns"].is_null() && row.json()["gb_per_s"].is_null());
    }

    /// Five runs have a median and a minimum, six also percentiles.
    #[test]
    fn few_runs_have_no_percentiles() {
        let plan = plan();
        let row = |count: usize| {
            let times: Vec<f64> = (1..=count).map(|ms| ms as f64 * 1e6).collect();
            Row::of("total", "in_flow", &plan, &[], 4, (count, &times))
        };
        let [five, six] = [row(5), row(6)].map(|row| row.json());
        assert!(five["p10_ns"].is_null() && five["p90_ns"].is_null(), "{five}");
        assert_eq!([&five["median_ns"], &six["p10_ns"]], [3e6, 1.5e6]);
        let columns = |row: Row| -> Vec<String> {
            row.text().split_whitespace().map(str::to_owned).collect()
        };
        assert_eq!(columns(row(5))[2..6], ["3.000", "-", "-", "1.000"]);
        assert_eq!(columns(row(6))[2..6], ["3.500", "1.500", "5.500", "1.000"]);
    }

    /// Texels of a sweep and of a resolve are not comparable, so only a row of one pass has a rate.
    #[test]
    fn a_row_of_several_passes_has_no_texel_rate() {
        let plan = plan();
        let every: Vec<&Pass> = plan.passes.iter().collect();
        let row = |passes: &[&Pass]| Row::of("total", "in_flow", &plan, passes, 4, (6, &[1e6; 6]));
        assert!(every.len() > 1 && row(&every).json()["texels_per_s"].is_null());
        assert!(row(&every).text().ends_with(" -"), "{}", row(&every).text());
        assert!(row(&every[..1]).json()["texels_per_s"].as_f64() > Some(0.0));
    }

    /// Complete events follow each other, and the text parses as JSON.
    #[test]
    fn traces_are_trace_events() {
        let plan = plan();
        let frame: Vec<Timing> =
            plan.passes.iter().map(|p| Timing { label: p.label(), ns: 2000.0 }).collect();
        let text = format!("{:#}", trace("d", "v", &plan, &frame));
        let trace: Value = serde_json::from_str(&text).unwrap();
        let events = trace["traceEvents"].as_array().unwrap();
        let complete: Vec<_> = events.iter().filter(|e| e["ph"] == "X").collect();
        assert_eq!(complete.len(), plan.passes.len());
        for (i, event) in complete.iter().enumerate() {
            assert_eq!(event["name"], plan.passes[i].label());
            assert_eq!([&event["ts"], &event["dur"]], [2.0 * i as f64, 2.0]);
            assert!(event["pid"].is_u64() && event["tid"].is_u64());
        }
        assert_eq!(events.len(), complete.len() + 2);
    }
}

use super::*;
use crate::bench::rows::{self, tests::plan};

/// Ten runs about `ms`, a hundredth apart on either side.
fn row(pass: &str, ms: f64) -> Row {
    let times: Vec<f64> = (0..10).map(|i| ms * 1e6 * (0.99 + 0.02 * f64::from(i) / 9.0)).collect();
    Row::of(pass, "in_flow", &plan(), &[], 64, (10, &times))
}

/// Twenty runs of `low` to `high` ms, evenly spaced.
fn spread(pass: &str, low: f64, high: f64) -> Row {
    let times: Vec<f64> =
        (0..20).map(|i| 1e6 * (low + (high - low) * f64::from(i) / 19.0)).collect();
    Row::of(pass, "in_flow", &plan(), &[], 64, (20, &times))
}

/// A report for each slice of rows, with a peak pass of so many ms.
fn reports(peak_ms: f64, all: &[&[Row]]) -> Earlier {
    let peaks = [row(PEAK, peak_ms)];
    let of =
        |rows: &&[Row]| serde_json::from_value(rows::file("d", "v", &peaks, rows, &[])).unwrap();
    Earlier(all.iter().map(of).collect())
}

fn report(rows: &[Row]) -> Earlier {
    reports(10.0, &[rows])
}

const PEAK: &str = "device_peak fma";

/// The verdict on one row, with a peak pass of so many ms now.
fn judged(earlier: &Earlier, peak_ms: f64, row: Row) -> Verdict {
    earlier.against(&[row], &[self::row(PEAK, peak_ms)]).changes[0].verdict
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
    let changes = earlier.against(&now, &[]);
    let verdicts: Vec<_> = changes.changes.iter().map(|c| c.verdict).collect();
    use Verdict::{Faster, Same, Slower, Unsure};
    assert_eq!(verdicts, [Faster, Slower, Same, Unsure]);
    assert_eq!((changes.new, changes.any_slower()), (1, true));
    let json = changes.json();
    assert_eq!([&json["rows"][0]["part"], &json["rows"][0]["verdict"]], ["x", "FASTER"]);
    let ratio = json["rows"][1]["ratio"].as_f64().unwrap();
    assert!((ratio - 1.07).abs() < 1e-12, "{ratio}");
    assert!(!earlier.against(&now[2..], &[]).any_slower());
    assert!(earlier.against(&[], &[]).is_empty() && !changes.is_empty());
}

/// Four of five runs take twice as long, the others as long as before: the 10th percentile alone decides.
#[test]
fn a_busy_machine_is_no_slower_pass() {
    assert_eq!(verdict(Some([1.9, 2.1]), Some([1.0; 2])), Verdict::Unsure);
    assert_eq!(verdict(Some([1.9, 2.1]), Some([1.1; 2])), Verdict::Slower);
    let times: Vec<f64> = (0..20).map(|i| if i < 4 { 100e6 } else { 200e6 }).collect();
    let busy = Row::of("a", "in_flow", &plan(), &[], 64, (20, &times));
    assert_eq!(judged(&report(&[row("a", 100.0)]), 10.0, busy), Verdict::Unsure);
}

/// The peak pass takes 1.3 times as long: a row that does, too, is not slower, but one of 1.5 times is. A slower
/// machine makes no pass faster. 4 % of the peak pass count as none.
#[test]
fn another_state_of_the_machine_widens_the_interval() {
    use Verdict::{Faster, Slower, Unsure};
    let earlier = report(&[row("a", 100.0)]);
    for (peak_ms, ms, expected) in [
        (10.0, 125.0, Slower),
        (10.4, 107.0, Slower),
        (13.0, 125.0, Unsure),
        (13.0, 150.0, Slower),
        (13.0, 90.0, Faster),
        (13.0, 100.0, Unsure),
        (7.5, 80.0, Unsure),
        (7.5, 65.0, Faster),
        (7.5, 110.0, Slower),
    ] {
        assert_eq!(judged(&earlier, peak_ms, row("a", ms)), expected, "{peak_ms} {ms}");
    }
    let now = [row("a", 100.0)];
    let warnings = |ms| earlier.against(&now, &[row(PEAK, ms)]).warnings("d", "v").concat();
    assert!(warnings(13.0).contains("1.00 to 1.30 times"), "{}", warnings(13.0));
    assert!(!warnings(10.4).contains("peak rates"), "{}", warnings(10.4));
}

/// With another memory budget the peak pass takes 1.3 times as long for more work, so 125 ms are slower than 100. Of two
/// reports, the one of the same work counts: the other's 20 ms would hide the change from 10 to 13 ms.
#[test]
fn peaks_of_other_work_are_not_compared() {
    let slow = [row("a", 125.0)];
    let judged = |earlier: &Earlier, bytes: u64| {
        let changes = earlier.against(&slow, &[Row { bytes, ..row(PEAK, 13.0) }]);
        let warnings = changes.warnings("d", "v").concat();
        let of = |text: &str| warnings.contains(text);
        let warned = [of("not compared: 1 peak rates"), of("different peak rates")];
        (changes.changes[0].verdict, warned)
    };
    let rows = [row("a", 100.0)];
    let mut earlier = reports(10.0, &[&rows[..], &rows[..]]);
    assert_eq!(judged(&earlier, 0), (Verdict::Unsure, [false, true]));
    assert_eq!(judged(&earlier, 1 << 20), (Verdict::Slower, [true, false]));
    let other = &mut earlier.0[0].peaks[0];
    (other.bytes, other.p10_ns) = (1 << 20, Some(20e6));
    assert_eq!(judged(&earlier, 0), (Verdict::Unsure, [true, true]));
}

/// 110 to 150 ms spread by 25 % of their median: their interval of 120 to 140 could be that of 100 ms under load.
#[test]
fn unsteady_times_widen_the_interval() {
    let earlier = report(&[row("a", 100.0)]);
    for (low, high, expected) in [
        (110.0, 150.0, Verdict::Unsure),
        (122.0, 138.0, Verdict::Slower),
        (220.0, 300.0, Verdict::Slower),
    ] {
        assert_eq!(judged(&earlier, 10.0, spread("a", low, high)), expected, "{low} {high}");
    }
    // The earlier run was the unsteady one.
    let unsteady = report(&[spread("a", 110.0, 150.0)]);
    assert_eq!(judged(&unsteady, 10.0, row("a", 105.0)), Verdict::Unsure);
    assert_eq!(
        judged(&report(&[spread("a", 122.0, 138.0)]), 10.0, row("a", 105.0)),
        Verdict::Faster
    );
    let now = [row("a", 105.0)];
    let warnings = unsteady.against(&now, &[]).warnings("d", "v").concat();
    assert!(warnings.contains("unsteady rows: 1,"), "{warnings}");
}

/// 107 beside 100 is slower, and beside 100 and 103 unsure: their interval ends at 103.8. One report
/// alone gives a warning.
#[test]
fn several_reports_widen_the_interval() {
    let earlier = [row("a", 100.0), row("a", 103.0)];
    let both = earlier.each_ref().map(std::slice::from_ref);
    let now = [row("a", 107.0)];
    for (count, verdict, ms) in [(1, Verdict::Slower, 100.0), (2, Verdict::Unsure, 101.5)] {
        let earlier = reports(10.0, &both[..count]);
        let changes = earlier.against(&now, &[]);
        assert_eq!(changes.changes[0].verdict, verdict);
        let median = changes.changes[0].earlier_ns.unwrap();
        assert!((median / (ms * 1e6) - 1.0).abs() < 1e-9, "{median}");
        let warnings = changes.warnings("d", "v").concat();
        assert_eq!(warnings.contains("one earlier report"), count == 1, "{warnings}");
    }
}

#[test]
fn what_differs_is_a_warning() {
    let earlier = report(&[row("a", 100.0), row("gone", 1.0)]);
    let now = [row("a", 100.0), row("new", 1.0), row("newer", 1.0)];
    let warnings = earlier.against(&now, &[]).warnings("d", "w");
    for expected in [
        "different driver: earlier v, now w",
        "unknown scene: an earlier report does not state its scene",
        "rows not compared, found only in this run: 2",
        "rows not compared, found only in the earlier report: 1",
    ] {
        assert!(warnings.iter().any(|line| line == expected), "{expected}: {warnings:#?}");
    }
    assert!(!warnings.iter().any(|line| line.contains("device")), "{warnings:#?}");
}

#[test]
fn too_few_runs_and_no_times_are_unsure() {
    let times = [1e6; 5];
    let few = Row::of("a", "in_flow", &plan(), &[], 64, (5, &times));
    let none = Row::of("b", "in_flow", &plan(), &[], 64, (5, &[]));
    let earlier = report(&[row("a", 100.0), row("b", 100.0)]);
    let now = [few, none];
    let changes = earlier.against(&now, &[]);
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
    let lines = earlier.against(&slower, &[]).differences();
    assert_eq!(lines, [r#"different setting: hull: earlier "private", now "shared""#]);
}

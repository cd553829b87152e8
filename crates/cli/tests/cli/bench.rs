//! `ridgelight bench`: reports and verdicts.

use serde_json::Value;

use crate::Folder;

/// Before the verification.
#[test]
fn gpu_an_unknown_pass_is_reported_first() {
    let folder = Folder::new();
    let run = folder.run(&["bench", "--size", "32", "--passes", "sky_shade,none"]);
    assert_eq!((run.status, run.out.as_str()), (Some(2), ""), "{}", run.err);
    assert!(run.err.contains("--passes: found none, expected"), "{}", run.err);
}

/// Reports with a thousandth of the times make a run SLOWER, with status 1; with a thousand times the times FASTER.
#[test]
fn gpu_an_earlier_report_gives_verdicts() {
    let folder = Folder::new();
    let base = ["bench", "--size", "32", "--azimuths", "8", "--runs", "10"];
    let base = [&base[..], &["--passes", "sky_shade"]].concat();
    let run =
        folder.run(&[&base[..], &["--json", "now.json", "--bencher", "metrics.json"]].concat());
    assert_eq!(run.status, Some(0), "{}", run.err);
    let report: Value =
        serde_json::from_slice(&std::fs::read(folder.path("now.json")).unwrap()).unwrap();
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(report["argv"][2], "32");
    let metrics: Value =
        serde_json::from_slice(&std::fs::read(folder.path("metrics.json")).unwrap()).unwrap();
    assert_eq!(metrics.as_object().unwrap().len(), rows.len());
    for (name, factor, word, status) in [("fast", 1e-3, "SLOWER", 1), ("slow", 1e3, "FASTER", 0)] {
        let mut changed = report.clone();
        for row in changed["rows"].as_array_mut().unwrap() {
            for key in
                ["min_ns", "p10_ns", "median_low_ns", "median_ns", "median_high_ns", "p90_ns"]
            {
                row[key] = (row[key].as_f64().unwrap() * factor).into();
            }
        }
        let file = format!("{name}.json");
        std::fs::write(folder.path(&file), changed.to_string()).unwrap();
        let run =
            folder.run(&[&base[..], &["--against", &file, "--json", "verdicts.json"]].concat());
        assert_eq!(run.status, Some(status), "{}{}", run.out, run.err);
        assert_eq!(run.out.matches(word).count(), rows.len(), "{}", run.out);
        let found: Value =
            serde_json::from_slice(&std::fs::read(folder.path("verdicts.json")).unwrap()).unwrap();
        assert_eq!(found["against"]["rows"][0]["verdict"], word);
    }
    std::fs::write(folder.path("field.json"), "[]").unwrap();
    let run = folder.run(&[&base[..], &["--against", "field.json"]].concat());
    assert_eq!((run.status, run.out.as_str()), (Some(1), ""), "{}", run.err);
    assert!(
        run.err.contains("field.json") && run.err.contains("a report of bench --json"),
        "{}",
        run.err
    );
}

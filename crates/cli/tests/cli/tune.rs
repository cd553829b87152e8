use serde_json::Value;

use super::Folder;

/// Every form has the untuned picture's bits. What is kept, later commands use, until `--reset`.
#[test]
fn gpu_a_device_is_tuned_until_reset() {
    let folder = Folder::new();
    let run = folder.run_str("tune --size 40 --azimuths 8 --json tune.json");
    assert_eq!(run.status, Some(0), "{}{}", run.out, run.err);
    let report: Value =
        serde_json::from_slice(&std::fs::read(folder.path("tune.json")).unwrap()).unwrap();
    let trials = report["trials"].as_array().unwrap();
    assert_eq!(trials.len(), 23);
    assert!(trials.iter().all(|trial| trial["same_bits"] == true), "{report:#}");
    assert!(trials.iter().all(|trial| trial["ratio"].as_f64().unwrap() > 0.0), "{report:#}");
    let kept = std::fs::read_dir(folder.path("cache/ridgelight/tuned")).unwrap();
    let [kept] = &kept.map(|file| file.unwrap().path()).collect::<Vec<_>>()[..] else {
        panic!("one device, one file")
    };
    let found: Value = serde_json::from_slice(&std::fs::read(kept).unwrap()).unwrap();
    let expected = if report["kept"].is_null() { &report["untuned"] } else { &report["kept"] };
    assert_eq!(found, *expected);
    let is_one = report["untuned"]["lines_each"] == 1;
    let mut other = report["untuned"].clone();
    other["group_size"] = (if is_one { 128 } else { 16 }).into();
    std::fs::write(kept, other.to_string()).unwrap();
    let plan = |folder: &Folder| folder.run_str("plan a.npy --azimuths 8");
    let words = if is_one { "128 invocations" } else { "16 invocations" };
    let run = plan(&folder);
    assert!(run.out.contains("tuned sweep: ") && run.out.contains(words), "{}{}", run.out, run.err);
    let run = folder.run_str("tune --reset");
    assert!(run.status == Some(0) && run.out.contains("no longer tuned"), "{}{}", run.out, run.err);
    let run = plan(&folder);
    assert!(run.status == Some(0) && !run.out.contains("tuned sweep"), "{}", run.out);
    let run = folder.run_str("tune --reset");
    assert!(run.out.contains("was not tuned"), "{}", run.out);
}

//! `trade`: refusals, and the report of a small field.

use std::path::Path;

use crate::formats::npy;
use crate::{Folder, refused, specular_map, succeeded};

#[test]
fn wrong_trades_are_refused() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("taken")).unwrap();
    folder.write("taken/trade.csv", b"an earlier report's");
    folder.write("taken/notes.txt", b"mine");
    refused(
        &folder,
        &[
            ("trade a.asc", 2, &["--output"]),
            ("trade a.asc -o a.npy", 2, &["-o: found the file a.npy", "a folder"]),
            ("trade a.asc -o taken", 2, &["taken with notes.txt in it", "an earlier report"]),
            ("trade a.asc -o no/such", 2, &["-o: found no/such", "a folder no that exists"]),
            ("trade a.asc -o out --budget 0", 2, &["--budget: found 0", "1 to 1000000"]),
            ("trade a.asc -o out --budget -5", 2, &["--budget: found -5"]),
            ("trade a.asc -o out --budget nan", 2, &["--budget: found NaN"]),
            (
                "trade a.asc -o out --budget soon",
                2,
                &["--budget: found soon", "1 to 1000000 seconds"],
            ),
            ("trade a.asc -o out --evaluations 0", 2, &["--evaluations: found 0", "1 or more"]),
            ("trade a.asc -o out --max-error 0", 2, &["--max-error: found 0", "above 0"]),
            ("trade a.asc -o out --max-error inf", 2, &["--max-error: found inf"]),
            ("trade a.asc -o out --time-budget -1", 2, &["--time-budget: found -1"]),
            ("trade a.asc -o out --max-error 1 --time-budget 1", 2, &["cannot be used"]),
            ("trade a.asc -o out --azimuths 8", 2, &["--azimuths"]),
            ("trade a.asc -o out --json out.txt", 2, &["--json: found out.txt", ".json"]),
            ("trade a.asc -o out --json a.asc", 2, &["--json"]),
            ("trade a.asc -o out --sky -1", 2, &["--sky"]),
            ("trade none.asc -o out", 1, &["none.asc"]),
            ("trade a.asc -o out --reference none.exr", 1, &["none.exr"]),
            ("trade a.asc -o out --reference a.npy", 2, &["--reference: found a.npy", "an .exr"]),
            ("trade a.asc -o out", 1, &["driver"]),
        ],
    );
    // No folder can be made in /proc, not even by root.
    #[cfg(target_os = "linux")]
    refused(&folder, &[("trade a.asc -o /proc/out", 1, &["/proc/out"])]);
}

/// A field of 16² with two peaks.
fn write_peaks(folder: &Folder) {
    let height = |i: usize| {
        let (r, c) = ((i / 16) as f32, (i % 16) as f32);
        let peak = |y: f32, x: f32, h: f32| (h - (r - y).hypot(c - x)).max(0.0);
        peak(4.0, 5.0, 6.0).max(peak(11.0, 10.0, 4.5))
    };
    let data: Vec<u8> = (0..256).flat_map(|i| height(i).to_le_bytes()).collect();
    folder.write("field.npy", &npy("<f4", false, "(16, 16)", &data));
}

fn text(path: &Path) -> String {
    String::from_utf8(std::fs::read(path).unwrap()).unwrap()
}

fn json(path: &Path) -> serde_json::Value {
    serde_json::from_str(&text(path)).unwrap()
}

/// Whether x rises and y falls from each point to the next.
fn falls(points: &[(f64, f64)]) -> bool {
    points.windows(2).all(|two| two[0].0 < two[1].0 && two[0].1 > two[1].1)
}

/// Time and error of the frontier, in order: time rises, error falls.
fn monotone(report: &serde_json::Value) -> Vec<(f64, f64)> {
    let points = report["points"].as_array().unwrap();
    let of = |i: &serde_json::Value| {
        let point = &points[i.as_u64().unwrap() as usize];
        (point["time_ns"].as_f64().unwrap(), point["relative_rmse"].as_f64().unwrap())
    };
    let front: Vec<_> = report["frontier"].as_array().unwrap().iter().map(of).collect();
    assert!(!front.is_empty());
    assert!(falls(&front), "{front:?}");
    for point in points {
        let (time, error) =
            (point["time_ns"].as_f64().unwrap(), point["relative_rmse"].as_f64().unwrap());
        assert!(front.iter().any(|f| f.0 <= time && f.1 <= error), "{point}");
    }
    front
}

/// The frontier of the table, from fast to slow.
fn table_frontier(csv: &str) -> Vec<(f64, f64)> {
    let mut lines = csv.lines().map(|l| l.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let [time, error, front] = ["time_ms", "relative_rmse", "frontier"]
        .map(|n| names.iter().position(|name| *name == n).unwrap());
    let number = |text: &str| text.parse::<f64>().unwrap();
    let on = lines.filter(|row| row[front] == "true");
    let mut all: Vec<_> = on.map(|row| (number(row[time]), number(row[error]))).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// The corners of the page's frontier, as (to the right, up): `M x y` and then `H x V y` each.
fn plotted_frontier(page: &str) -> Vec<(f64, f64)> {
    let path = page.split_once("class=front d=\"M").unwrap().1.split_once('"').unwrap().0;
    path.replace('H', ";")
        .replace('V', " ")
        .split(';')
        .map(|corner| {
            let (x, y) = corner.split_once(' ').unwrap();
            (x.parse::<f64>().unwrap(), -y.parse::<f64>().unwrap())
        })
        .collect()
}

/// A dominated point fails the check, in any of the files.
#[test]
fn a_dominated_point_fails() {
    let csv = "settings,time_ms,relative_rmse,frontier\na,2.0,1e-2,true\nb,1.0,2e-2,true\nc,3.0,9e-2,false\n";
    assert_eq!(table_frontier(csv), [(1.0, 0.02), (2.0, 0.01)]);
    assert!(falls(&table_frontier(csv)));
    assert!(!falls(&table_frontier(&csv.replace("9e-2,false", "9e-2,true"))));
    let page = "<path class=front d=\"M80.0 10.0H90.0V20.5H95.0V30.0\" />";
    assert_eq!(plotted_frontier(page), [(80.0, -10.0), (90.0, -20.5), (95.0, -30.0)]);
    assert!(falls(&plotted_frontier(page)));
    assert!(!falls(&plotted_frontier(&page.replace("20.5", "9.5"))));
}

/// The frontiers of the published tables fall; their other rows are dominated.
#[test]
fn kept_tables_have_frontiers() {
    for scene in ["mountain_sky", "mountain_sun", "moss_windows"] {
        let name = format!("benches/results/trade_{scene}.csv");
        let csv = text(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(&name));
        let front = table_frontier(&csv);
        assert!(front.len() > 2 && falls(&front), "{name}: {front:?}");
        // All rows taken as a frontier hold a dominated point.
        assert!(!falls(&table_frontier(&csv.replace(",false", ",true"))), "{name}");
    }
}

#[test]
fn gpu_trade_of_a_small_field() {
    let folder = Folder::new();
    write_peaks(&folder);
    let args = "trade field.npy --sky 1 -o report --json copy.json --evaluations 4";
    let run = succeeded(&folder, args);
    let report = json(&folder.path("report/trade.json"));
    assert_eq!(
        (&report["evaluations"], &report["budget_s"]),
        (&4.into(), &serde_json::Value::Null)
    );
    assert_eq!(run.out.matches("<- recommended").count(), 1, "{}", run.out);
    let names: Vec<_> = std::fs::read_dir(folder.path("report"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(names.len(), 3, "{names:?}");

    assert_eq!(report, json(&folder.path("copy.json")));
    let points = report["points"].as_array().unwrap();
    assert_eq!(points.len(), 4);
    let front = monotone(&report);
    let own = report["ground_truth"]["own_relative_rmse"].as_f64().unwrap();
    assert!(own > 0.0 && own < 0.02, "{own}");
    assert!(report["ground_truth"]["what"].as_str().unwrap().contains("sky by method brute-force"));
    let how = report["ground_truth"]["how"].as_str().unwrap();
    let is_sure = ["95 % confidence", "at every grid point"].iter().any(|said| how.contains(said));
    assert!(is_sure && how.contains("against the f64 oracle"), "{how}");
    for point in points {
        let error = point["relative_rmse"].as_f64().unwrap();
        assert!(error >= own && (error == own) == point["at_most"].as_bool().unwrap(), "{point}");
        assert!(!point["passes"].as_array().unwrap().is_empty());
    }
    // The report counts every setting once; it lists some that were not measured.
    let left = |name: &str| report["left_out"][name].as_u64().unwrap() as usize;
    let all = (5 * (2 * 3 + 4 * 2) + 2 + 5 * 5) * 6;
    assert_eq!((left("settings"), left("measured")), (all, points.len()));
    assert_eq!(left("measured") + left("ruled_out") + left("not_tried"), all);
    let groups = report["ruled_out"].as_array().unwrap();
    let count = |g: &serde_json::Value| g["count"].as_u64().unwrap() as usize;
    let spelt: usize = groups.iter().map(count).sum();
    assert_eq!(groups.len(), left("reasons").min(40));
    assert!(if left("reasons") <= 40 {
        spelt == left("ruled_out")
    } else {
        spelt < left("ruled_out")
    });
    assert!(groups.iter().all(|g| g["settings"].as_array().unwrap().len() == count(g).min(6)));
    assert_eq!(report["not_tried"].as_array().unwrap().len(), left("not_tried").min(40));
    let recommended = report["recommendation"]["point"].as_u64().unwrap();
    assert!(report["frontier"].as_array().unwrap().iter().any(|i| i.as_u64() == Some(recommended)));
    // The knee: no other has a smaller product of time and error.
    let product = |f: &(f64, f64)| f.0 * f.1;
    let point = &points[recommended as usize];
    let best = point["time_ns"].as_f64().unwrap() * point["relative_rmse"].as_f64().unwrap();
    assert!(front.iter().all(|f| product(f) >= best * (1.0 - 1e-9)), "{front:?}");

    let csv = text(&folder.path("report/trade.csv"));
    let columns = csv.lines().next().unwrap().split(',').count();
    assert_eq!(csv.lines().count(), points.len() + 1);
    assert!(csv.lines().all(|l| l.split(',').count() == columns), "{csv}");
    let table = table_frontier(&csv);
    assert!(table.len() == front.len() && falls(&table), "{csv}");

    let page = text(&folder.path("report/trade.html"));
    for none in ["http", "src=\"/", "<link", "url(", "@import", "{{"] {
        assert!(!page.contains(none), "{none}");
    }
    assert_eq!(page.matches("<circle class=\"point").count(), points.len());
    assert_eq!(page.matches("<figure").count(), front.len() + 1);
    // The plot resolves a tenth of a pixel: closer points may share a corner.
    let plotted = plotted_frontier(&page);
    let falls_or_stays = plotted.windows(2).all(|two| two[0].0 <= two[1].0 && two[0].1 >= two[1].1);
    assert!(plotted.len() == front.len() && falls_or_stays, "{plotted:?}");
    // The perceived difference of each, and the reason for the recommendation.
    for point in points {
        let on = front.iter().any(|f| Some(f.0) == point["time_ns"].as_f64());
        let flip = point["flip"]["mean"].as_f64();
        assert!(!on || flip.is_some_and(|f| (0.0..=1.0).contains(&f)), "{point}");
    }
    let why = report["recommendation"]["why"].as_array().unwrap();
    let why: Vec<&str> = why.iter().map(|w| w.as_str().unwrap()).collect();
    for word in ["least product", "Risk: ", "ꟻLIP", "The ground truth's own", "were measured"] {
        assert!(why.iter().any(|w| w.contains(word)), "{word} in {why:?}");
    }
    // On so small a field brute force may win; it has no hull, nor has an exact sweep or a pyramid.
    let hulls = report["hulls"].as_array().unwrap();
    let has_hull = point["settings"]["hull"].is_string();
    assert_eq!(hulls.len(), if has_hull { 3 } else { 0 }, "{hulls:?}");
    assert_eq!(hulls.iter().any(|h| h["time_ratio"].is_number()), has_hull, "{hulls:?}");
    assert_eq!(why.iter().any(|w| w.contains("Hull storage changes")), has_hull, "{why:?}");
    for ladder in report["settings"].as_array().unwrap() {
        let steps = ladder["fast_to_slow"].as_array().unwrap();
        assert!(
            steps.contains(&ladder["default"]) && !ladder["slower"].as_str().unwrap().is_empty()
        );
    }
    assert!(page.contains("data:image/png;base64,iVBORw0KGgo"));
    let flags = point["flags"].as_str().unwrap();
    assert!(run.out.contains(flags), "{flags}");
    assert!(flags.split(" --").all(|flag| page.contains(flag)), "{flags}");
}

/// Ground truth from a file. A bound that no settings reach is reported and gives exit status 1; the report still replaces
/// the earlier one.
#[test]
fn gpu_trade_against_a_reference() {
    let folder = Folder::new();
    write_peaks(&folder);
    let expected_light =
        "render field.npy --sky 1 -o ground_truth.exr --method brute-force --azimuths 256 --quiet";
    succeeded(&folder, expected_light);
    let trade = |more: &str| {
        let args = format!(
            "trade field.npy --sky 1 -o out --evaluations 2 --reference ground_truth.exr {more}"
        );
        let run = folder.run_str(&args);
        assert_eq!(run.err, "", "{args}");
        (run, json(&folder.path("out/trade.json")))
    };
    let (run, report) = trade("--max-error 0.5");
    assert_eq!(run.status, Some(0));
    monotone(&report);
    assert!(report["ground_truth"]["what"].as_str().unwrap().contains("truth.exr"));
    // A picture has no standard error.
    assert!(report["ground_truth"]["own_relative_rmse"].is_null(), "{}", report["ground_truth"]);
    assert!(run.out.contains("Its own error (relative RMSE): unknown: it has no"), "{}", run.out);
    // The fastest settings have an error below one half.
    assert_eq!(report["recommendation"]["point"], report["frontier"][0]);
    let (run, report) = trade("--max-error 1e-9 --quiet");
    assert_eq!((run.status, run.out.as_str()), (Some(1), ""));
    assert_eq!(report["recommendation"]["holds"], false);
    let why = report["recommendation"]["why"][0].as_str().unwrap();
    assert!(why.contains("--max-error"), "{why}");
    let (run, report) = trade("--time-budget 1e-6");
    assert_eq!((run.status, &report["recommendation"]["holds"]), (Some(1), &false.into()));
    let why = report["recommendation"]["why"][0].as_str().unwrap();
    let stated = why.split(" ms: these").next().and_then(|w| w.rsplit(' ').next());
    let stated: f64 = stated.unwrap().parse().expect(why);
    assert!((stated / 1e-6 - 1.0).abs() < 0.01, "{why}");
    // The ground truth of another scene is refused, and nothing is written.
    succeeded(&folder, "render field.npy --sky 1 --tint land -o tinted.exr --quiet");
    let trace =
        "reference field.npy -o traced.exr --spp 1 --sky 0.5 --sun 90,20 --bounces 2 --quiet";
    succeeded(&folder, trace);
    let flat = trace.replace("traced.exr", "flat.exr") + " --normals flat";
    succeeded(&folder, &flat);
    let viewed = "reference field.npy -o viewed.exr --spp 1 --sky 1 --albedo 0.5 --specular 9,0.25 --camera 180,30,9 \
        --look-at 1,1,0 --quiet";
    succeeded(&folder, viewed);
    let before = folder.contents();
    for (args, said) in [
        (
            "ground_truth.exr --sun 90,20",
            "ground_truth.exr: header: sky: found 1,1,1, expected none (in this scene)",
        ),
        (
            "ground_truth.exr --sky 0.5",
            "ground_truth.exr: header: sky: found 1,1,1, expected 0.5,0.5,0.5",
        ),
        ("ground_truth.exr --cell 2", "ground_truth.exr: header: cell_m: found 1,1, expected 2,2"),
        ("ground_truth.exr --z-scale 2", "ground_truth.exr: header: base_m: found 0.89"),
        (
            "ground_truth.exr --border open",
            "ground_truth.exr: header: border: found plane, expected open",
        ),
        ("ground_truth.exr --sky 1 --tint slope", "ground_truth.exr: header: "),
        ("tinted.exr --sky 1 --tint slope", "tinted.exr: header: tint: found land, expected slope"),
        (
            "ground_truth.exr --sky 1 --albedo 0.5",
            "ground_truth.exr: header: albedo: found 1, expected 0.5",
        ),
        (
            "traced.exr --sky 0.5 --sun 90,20",
            "traced.exr: header: bounces: found 2, expected 0 (--bounces here)",
        ),
        ("traced.exr --sky 0.5 --sun 180,20", "traced.exr: header: "),
        (
            "traced.exr --sky 0.5 --sun 90,20 --bounces 1",
            "traced.exr: header: bounces: found 2, expected 1",
        ),
        (
            "flat.exr --sky 0.5 --sun 90,20 --bounces 2",
            "flat.exr: header: normals: found flat, expected smooth",
        ),
        (
            "viewed.exr --sky 1 --albedo 0.5 --specular 9,0.25",
            "expected none: `trade` views specular from straight above",
        ),
    ] {
        let args = format!("trade field.npy -o other --evaluations 1 --reference {args}");
        let run = folder.run_str(&args);
        assert_eq!((run.status, run.err.lines().count()), (Some(1), 1), "{args}: {}", run.err);
        assert!(run.err.contains(said), "{args}: {}", run.err);
    }
    assert!(folder.contents() == before);
    let args = "trade a.asc -o other --reference ground_truth.exr";
    let run = folder.run_str(args);
    assert!(
        run.status == Some(1) && run.err.contains("ground_truth.exr: size: found 16 × 16"),
        "{}",
        run.err
    );
    assert!(folder.contents() == before);
}

/// Per-texel specular with two bounces, against path tracing: the walk covers SH orders and storage of specular light, and
/// leaves out settings that specular refuses. Without such a ground truth bounces are refused.
#[test]
fn gpu_trade_takes_specular() {
    let folder = Folder::new();
    write_peaks(&folder);
    folder.write("specular.npy", &specular_map(16));
    let scene = "--sky 1 --sun 100,40 --albedo 0.5 --specular specular.npy --bounces 2";
    let trace = format!("reference field.npy -o ground_truth.exr --spp 512 --quiet {scene}");
    succeeded(&folder, &trace);
    let bare = format!("trade field.npy -o out --evaluations 2 {scene}");
    let run = folder.run_str(&bare);
    assert_eq!(run.status, Some(2), "{}", run.err);
    let expected = "--bounces: found 2, expected --reference with as many bounces";
    assert!(run.err.contains(expected), "{}", run.err);
    succeeded(&folder, &format!("{bare} --reference ground_truth.exr"));
    let report = json(&folder.path("out/trade.json"));
    let flags = |list: &str| -> Vec<String> {
        let all = report[list].as_array().unwrap().iter();
        all.map(|p| p["flags"].as_str().unwrap().to_owned()).collect()
    };
    let tried: Vec<String> = flags("points");
    assert!(tried.iter().all(|f| f.contains("--sh-order")), "{tried:?}");
    assert!(tried.iter().all(|f| f.contains("--bounce-specular")), "{tried:?}");
    // Exact lines have no azimuth for the sun.
    let open = flags("not_tried");
    assert!(!open.iter().chain(&tried).any(|f| f.contains("--lines exact")), "{open:?}");
    let out = report["ruled_out"].as_array().unwrap();
    let exact =
        out.iter().find(|g| g["why"].as_str().unwrap().contains("--lines exact with --sun"));
    let count = exact.expect("a reason")["count"].as_u64().unwrap();
    // Azimuths, sun slices, bounces, basis, SH order and specular storage: each step is tried with all or none.
    assert!(count > 0 && count % (6 * 6 * 5 * 2 * 3 * 4) == 0, "{count}");
}

/// A specular map without bounces needs no reference, and `render` chooses settings for it.
#[test]
fn gpu_a_specular_map_takes_choices() {
    let folder = Folder::new();
    write_peaks(&folder);
    folder.write("specular.npy", &specular_map(16));
    let scene = "--sky 1 --albedo 0.5 --specular specular.npy --quiet";
    succeeded(&folder, &format!("trade field.npy -o out --evaluations 2 {scene}"));
    let report = json(&folder.path("out/trade.json"));
    assert!(!report["points"].as_array().unwrap().is_empty());
    succeeded(&folder, &format!("render field.npy -o light.exr --max-error 0.1 {scene}"));
}

/// Specular without bounces needs no reference: the ground truth that is drawn has lobes, as probes confirm.
#[test]
fn gpu_trade_draws_the_ground_truth_of_specular() {
    let folder = Folder::new();
    write_peaks(&folder);
    let scene = "--sky 1 --albedo 0.5 --specular 20,0.4";
    succeeded(&folder, &format!("trade field.npy -o out --evaluations 3 {scene}"));
    let report = json(&folder.path("out/trade.json"));
    let own = report["ground_truth"]["own_relative_rmse"].as_f64().expect("its error");
    // Without lobes the probes would find 0.4 / 0.9 of all light missing.
    assert!(0.0 < own && own < 0.02, "{own}");
}

/// Peaks and their ground truth with two bounces; returns the flags of that scene.
fn write_bounced(folder: &Folder) -> &'static str {
    const SCENE: &str = "--sun 100,40 --albedo 0.8 --bounces 2";
    write_peaks(folder);
    let expected_light = format!(
        "render field.npy -o ground_truth.exr --method brute-force --bounce-engine brute-force --quiet {SCENE}"
    );
    succeeded(folder, &expected_light);
    SCENE
}

/// With bounces, the report lists bakes over visible points, from few directions and paths on; without bounces it lists none.
#[test]
fn gpu_trade_lists_bakes() {
    let folder = Folder::new();
    let scene = write_bounced(&folder);
    let args = format!(
        "trade field.npy -o out --evaluations 2 --max-error 1 --reference ground_truth.exr {scene}"
    );
    let run = succeeded(&folder, &args);
    assert!(run.out.contains("visible points can be found once"), "{}", run.out);
    let rows: Vec<&str> = run.out.lines().filter(|line| line.contains(" paths: ")).collect();
    assert_eq!(rows.len(), 9, "{}", run.out);
    assert!(rows[0].starts_with("64 directions, 40 paths: "), "{rows:?}");
    let report = text(&folder.path("out/trade.json"));
    assert!(report.len() < 1 << 18, "{} bytes", report.len());
    assert_eq!(report.matches("\"found_once_ns\"").count(), rows.len());
    for row in rows {
        let number = |after: &str, unit: &str| -> f64 {
            let rest = row.split_once(after).expect(row).1;
            rest.split_once(unit).expect(row).0.parse().expect(row)
        };
        let directions: f64 = row.split(' ').next().and_then(|n| n.parse().ok()).expect(row);
        assert!(number("paths: ", " ms") > 0.0 && number("take ", " ms") > 0.0, "{row}");
        // On so flat a field at most a third of all light is scattered, and the bake holds most of it.
        assert!((0.0..20.0).contains(&number("error ", " %")), "{row}");
        // Two bytes per texel and direction, to three digits.
        let megabytes = 2e-6 * 256.0 * directions;
        assert!((number("once, ", " MB") / megabytes - 1.0).abs() < 0.01, "{row}");
    }
    let none = folder.run(&["trade", "field.npy", "-o", "none", "--evaluations", "1"]);
    let report = text(&folder.path("none/trade.json"));
    assert!(!report.contains("found_once_ns") && !none.out.contains("visible points"));
}

/// A bake above half of the memory budget (the baseline has the other half) is listed as refused, in the text and in the file;
/// the trade continues.
#[test]
fn gpu_trade_lists_refused_bakes() {
    let folder = Folder::new();
    let scene = write_bounced(&folder);
    let args = format!(
        "trade field.npy -o out --evaluations 2 --max-error 1 --reference ground_truth.exr --memory-budget 300000 {scene}"
    );
    let run = succeeded(&folder, &args);
    let rows: Vec<&str> = run.out.lines().filter(|line| line.contains(": refused: ")).collect();
    assert!(rows[0].starts_with("64 directions, 40 paths: refused: "), "{rows:?}");
    // Half of 300,000 bytes is 146.5 KiB.
    let said = "the limit is 146.5 KiB of --memory-budget";
    assert!(rows.iter().all(|row| row.contains("needs") && row.ends_with(said)), "{rows:?}");
    let report = json(&folder.path("out/trade.json"));
    assert_eq!(report["baked_refused"].as_array().unwrap().len(), rows.len());
    assert_eq!(report["baked"], serde_json::json!([]));
    assert!(run.out.contains("<- recommended"), "{}", run.out);
}

//! GPU times by timestamps: verification first, then each pass alone and all passes in a frame.

mod forms;
mod noise;
mod peaks;
mod progress;
mod rows;
mod sizes;
pub mod tune;
mod verdicts;
pub mod verify;

use std::time::{Duration, Instant};

use ridgelight::gpu::{Frame, Headless, Timing};
use ridgelight::plan::{self, Pass, Picture, Plan};
use ridgelight::scene::fractal;
use ridgelight::scene::{Quality, Scene};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use serde_json::{Value, json};

use crate::args::BenchArgs;
use crate::idle;
use crate::setup::{self, Outcome, after_new_heights, scene_hash, tuned};
use noise::{busy, noise};
use progress::Progress;
use ridgelight_trade::statistics::{median, median_interval};
use rows::{Row, sums};
use verdicts::Earlier;
use verify::Verifier;

/// Rows that would take longer do fewer runs, as reported, but at least [`FEWEST`], which give the median an interval.
const ROW_TIME: Duration = Duration::from_secs(10);
const FEWEST: usize = 6;
/// Rows end once the interval of their median is at most [`STABLE`] of it on both sides together. That is asked after this
/// many runs, twice as many and so on: tested after every run, an interval would end rows whenever it happened to be narrow.
const ENOUGH: usize = 10;
const STABLE: f64 = 0.02;
/// Runs of the peak rates at most.
const PEAK_RUNS: usize = 20;

pub fn run(args: &BenchArgs) -> Result<Outcome> {
    let outputs =
        [("--json", &args.global.json), ("--trace", &args.trace), ("--bencher", &args.bencher)];
    for (flag, path) in outputs {
        path.as_ref().map_or(Ok(()), |path| setup::check_output(flag, path, &["json"]))?;
    }
    let mut quality = args.quality.quality()?;
    let field = match &args.input {
        Some(path) => setup::field(std::slice::from_ref(path), &args.scene.field, &args.global)?,
        None => fractal(*args.sizes.first().unwrap_or(&args.size), 1)?,
    };
    let scene = setup::scene(field, &args.scene, setup::Unlit::Sky, args.global.quiet)?;
    setup::suit(&mut quality, &args.quality, (&scene, None));
    let counts =
        if args.azimuth_list.is_empty() { &[quality.azimuths][..] } else { &args.azimuth_list };
    check_specular(&scene, &quality, args)?;
    let identity = identity(&scene, args.input.is_some());
    let busy = busy();
    let earlier = Earlier::read_all(&args.against, &identity)?;
    let (mut gpu, limits) = setup::device(&args.global)?;
    let plan = plan::picture(&scene, &quality, &limits, Picture::default())?;
    // Verification is slow.
    if let Some(earlier) = earlier.as_ref().filter(|_| !args.forms) {
        let sides = args.sizes.iter().map(|side| [*side as u32; 2]);
        let all: Vec<_> = sides.flat_map(|size| counts.iter().map(move |n| (size, *n))).collect();
        let one = [(plan.size, quality.azimuths)];
        earlier.check_any(&args.against, if args.sizes.is_empty() { &one } else { &all })?;
    }
    if args.sizes.is_empty() {
        check_names(&args.passes, &plan, args.forms.then_some(&quality))?;
    }
    idle(args, &plan);
    let (device, driver) = (gpu.report().name.clone(), gpu.report().driver.clone());
    let bar = crate::setup::terminal::progress(args.global.quiet, "verifying against the oracle");
    let verifier = Verifier::new(&scene)?;
    let found = verifier.check(&mut gpu, &quality, &limits)?;
    let quiet = args.global.quiet;
    let none: [Vec<f32>; 0] = [];
    let peak_plan = plan::device_peak(&limits)?;
    let peaks = gpu.with_frame(peak_plan.clone(), &none, |gpu, frame| {
        bar.set_message("peak rates of the device");
        peaks::measure(gpu, frame, args.runs.min(PEAK_RUNS))
    })?;
    if !quiet {
        crate::say!("{device}, {driver}");
        setup::say_light(&args.scene.lights, &scene, None);
        crate::say!("verified: {found}");
        crate::say!("peak rates: {}", peaks::text(&peaks));
        plan.notes
            .iter()
            .filter(|note| note.starts_with("tuned sweep"))
            .for_each(|note| crate::say!("{note}"));
    }
    let (mut all, mut warnings) = (Vec::new(), Vec::from_iter(busy));
    let later = if args.forms { forms::count(&quality, &args.passes) } else { 0 };
    if !args.sizes.is_empty() {
        for &azimuths in counts {
            verifier.check(&mut gpu, &Quality { azimuths, ..quality }, &limits)?;
        }
        let shown = (&bar, later);
        let mut table = sizes::run(&mut gpu, &scene, &quality, &limits, (args, counts), shown)?;
        table.iter_mut().for_each(|row| row.copy_rate = peaks::copy_rate(&peaks));
        all.extend(table);
    } else {
        let inputs = plan::picture_inputs(&scene);
        let flush_s = peaks::copy_s(&peaks);
        let (mut table, shown) = gpu.with_frame(peak_plan, &none, |gpu, flushes| {
            peaks::fill(gpu, flushes)?;
            gpu.with_frame(plan.clone(), &inputs, |gpu, frame| {
                time(gpu, frame, (&mut *flushes, flush_s), args, quality.azimuths, (&bar, later))
            })
        })?;
        table.iter_mut().for_each(|row| row.copy_rate = peaks::copy_rate(&peaks));
        if let Some(path) = &args.trace {
            files::write_json(path, &rows::trace(&device, &driver, &plan, &shown))?;
        }
        if !quiet {
            bar.suspend(|| {
                crate::say!("{}", Row::head());
                table.iter().for_each(|row| crate::say!("{}", row.text()));
            });
        }
        all.extend(table);
    }
    if args.forms {
        let sky = ridgelight::scene::Lights { sky: Some([1.0; 3]), ..Default::default() };
        let surface = ridgelight::scene::Surface { specular: None, ..scene.surface };
        let scene = Scene { lights: sky, surface, ..scene };
        let verifier = Verifier::new(&scene)?;
        let wanted = (args.runs, &args.passes[..]);
        let (table, left_out) =
            forms::run(&mut gpu, &scene, &quality, &limits, &verifier, wanted, &bar)?;
        warnings.extend(left_out);
        bar.finish_and_clear();
        if !quiet {
            forms::print(&table);
        }
        all.extend(table.into_iter().flatten());
    }
    bar.finish_and_clear();
    warnings.extend(noise(&all));
    let changes = earlier.as_ref().map(|earlier| earlier.against(&all, &peaks));
    let limits_of_verdicts = changes.as_ref().map(|changes| changes.warnings(&device, &driver));
    let limits_of_verdicts = limits_of_verdicts.unwrap_or_default();
    if !quiet {
        warnings.iter().for_each(|warning| crate::say!("{warning}"));
        changes.iter().for_each(|changes| changes.print(&limits_of_verdicts));
    }
    warnings.extend(limits_of_verdicts);
    if quiet {
        warnings.iter().for_each(|text| setup::warning(text));
    }
    if let Some(path) = &args.bencher {
        files::write_json(path, &rows::bencher(&all, |name| args.quality.gives(name)))?;
    }
    if let Some(path) = &args.global.json {
        let argv: Vec<_> =
            std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
        let mut report = rows::file(&device, &driver, &peaks, &all, &argv);
        report["sweep"] = tuned::json(&limits.sweep);
        report["scene"] = identity;
        report["warnings"] = warnings.into();
        if let Some(changes) = &changes {
            report["against"] = changes.json();
        }
        files::write_json(path, &report)?;
    }
    if changes.as_ref().is_some_and(|changes| changes.is_empty()) {
        let expected = "a report with a row of the same pass, mode, size and azimuths";
        let files: Vec<_> = args.against.iter().map(|path| path.display().to_string()).collect();
        let found = format!("no row of this run in {}", files.join(", "));
        return Err(Error::setting("--against", found, expected));
    }
    let slower = changes.is_some_and(|changes| changes.any_slower());
    Ok(if slower { Outcome::Beyond } else { Outcome::Done })
}

/// Hashes of what `--against` compares; `--size` and `--sizes` are in the rows.
fn identity(scene: &Scene, is_input: bool) -> Value {
    let text = |hash: u64| format!("{hash:016x}");
    let Scene { field, surface, lights } = scene;
    // A fractal is known by its size; its base depends on that.
    let lights = text(scene_hash::lights(lights, is_input.then_some(field.base_m())));
    let field = if is_input { text(scene_hash::field(field)) } else { "fractal".to_owned() };
    json!({ "field": field, "lights": lights, "surface": text(scene_hash::surface(surface)) })
}

/// Refuses specular light where no reference computes it.
fn check_specular(scene: &Scene, quality: &Quality, args: &BenchArgs) -> Result<()> {
    if scene.surface.specular.is_none() {
        return Ok(());
    }
    let (with, expected) = if quality.bounces.count > 0 {
        ("--bounces", "none: check bounces of specular light with `reference` and `compare`")
    } else if !args.sizes.is_empty() {
        ("--sizes", "none: its errors cover diffuse light only")
    } else {
        return Ok(());
    };
    Err(Error::setting(format!("--specular with bench {with}"), "Phong specular", expected))
}

/// Notes flags that change nothing, also those of the field.
fn idle(args: &BenchArgs, plan: &Plan) {
    let (quiet, written) = (args.global.quiet, &args.quality.written);
    idle::say(quiet, written, &plan.settings);
    let reason = match (&args.input, args.sizes.as_slice()) {
        (None, []) => return,
        (Some(_), _) => "with an INPUT",
        (None, _) => "with --sizes",
    };
    if let Some((setting, value)) = written.iter().find(|(s, _)| s == "size").filter(|_| !quiet) {
        idle::note(setting, value, reason);
    }
}

/// Whether a label is selected: by its first word, the pass, or in full.
fn named(label: &str, wanted: &str) -> bool {
    label == wanted || label.split(' ').next() == Some(wanted)
}

fn check_names(wanted: &[String], plan: &Plan, of_forms: Option<&Quality>) -> Result<()> {
    let mut known: Vec<&str> = plan.passes.iter().map(Pass::name).collect();
    known.dedup();
    let forms = of_forms.map(forms::names).unwrap_or_default();
    if of_forms.is_some() {
        known.extend(["horizon_sweep", "sky_shade", "surface_sweep"]);
        known.extend(["pyramid_march", "horizon_march"]);
    }
    known.sort_unstable();
    known.dedup();
    let is_label = |w: &str| {
        plan.passes.iter().any(|p| named(&p.label(), w)) || forms.iter().any(|form| form == w)
    };
    match wanted.iter().find(|w| !known.contains(&w.as_str()) && !is_label(w)) {
        Some(none) => Err(Error::setting("--passes", none.as_str(), known.join(", "))),
        None => Ok(()),
    }
}

/// Whether a row has used up its time.
fn late(begun: Instant, runs: usize) -> bool {
    runs >= FEWEST && begun.elapsed() > ROW_TIME
}

/// Whether further runs would hardly move the median.
fn stable(times_ns: &[f64]) -> bool {
    let known = median_interval(times_ns).zip(median(times_ns));
    let is_asked =
        times_ns.len().is_multiple_of(ENOUGH) && (times_ns.len() / ENOUGH).is_power_of_two();
    is_asked && known.is_some_and(|([low, high], median)| high - low <= STABLE * median)
}

/// A GPU's clocks take some tenths of a second to rise.
const GPU_WARM_UP: Duration = Duration::from_millis(300);

/// Runs something on a GPU until its clocks have risen.
fn warm_up<T>(gpu: &Headless, mut run: impl FnMut() -> Result<T>) -> Result<()> {
    let begun = Instant::now();
    while !gpu.report().limits.is_cpu && begun.elapsed() < GPU_WARM_UP {
        run()?;
    }
    Ok(())
}

/// Runs of these passes, after one to warm up, or as many as a GPU's clocks need; each after a flush of the caches by the
/// frame `flushes`, if any.
fn repeated(
    gpu: &Headless,
    frame: &mut Frame,
    passes: &[usize],
    most: usize,
    mut flushes: Option<&mut Frame>,
) -> Result<Vec<Vec<Timing>>> {
    gpu.draw_passes(frame, passes)?;
    warm_up(gpu, || gpu.draw_passes(frame, passes))?;
    let flush = || flushes.as_mut().map_or(Ok(()), |flushes| peaks::flush(gpu, flushes));
    timed(most, flush, || gpu.draw_passes(frame, passes))
}

/// Runs until the median is known. A flush precedes each run, and the times exclude it.
fn timed(
    most: usize,
    mut flush: impl FnMut() -> Result<()>,
    mut run: impl FnMut() -> Result<Vec<Timing>>,
) -> Result<Vec<Vec<Timing>>> {
    let begun = Instant::now();
    let (mut runs, mut times_ns) = (Vec::new(), Vec::new());
    while runs.len() < most && !late(begun, runs.len()) && !stable(&times_ns) {
        flush()?;
        let run = run()?;
        times_ns.push(run.iter().map(|timing| timing.ns).sum());
        runs.push(run);
    }
    Ok(runs)
}

/// Whole frames.
fn flow(gpu: &Headless, frame: &mut Frame, most: usize) -> Result<Vec<Vec<Timing>>> {
    let all: Vec<usize> = (0..frame.plan().passes.len()).collect();
    repeated(gpu, frame, &all, most, None)
}

/// Runs of whole frames without timestamps between passes, and their times, ns: a GPU can overlap passes.
fn overlapped(gpu: &Headless, frame: &mut Frame, most: usize) -> Result<(usize, Vec<f64>)> {
    frame.time_passes(false);
    let runs = flow(gpu, frame, most);
    frame.time_passes(true);
    let runs = runs?;
    Ok((runs.len(), sums(&runs, |_| true)))
}

/// Rows of a frame in flow and overlapped, and of its passes isolated, warm and cold; also its last run in flow. A flush takes
/// `flush_s`; `later` rows of other tables follow.
fn time(
    gpu: &Headless,
    frame: &mut Frame,
    (flushes, flush_s): (&mut Frame, f64),
    args: &BenchArgs,
    azimuths: u32,
    (bar, later): (&indicatif::ProgressBar, usize),
) -> Result<(Vec<Row>, Vec<Timing>)> {
    let plan = frame.plan().clone();
    let is_wanted = |i: &usize| {
        let label = plan.passes[*i].label();
        args.passes.is_empty() || args.passes.iter().any(|w| named(&label, w))
    };
    let wanted: Vec<usize> = (0..plan.passes.len()).filter(is_wanted).collect();
    let every: Vec<&Pass> = plan.passes.iter().collect();
    let needed = after_new_heights(&plan);
    let has_tables = needed.len() < plan.passes.len();
    let (names, _) = measured(&plan, &wanted, has_tables, &[], [0.0; 2]);
    let mut progress = Progress::new(bar, names, args.runs, later);
    let mut rows = Vec::new();
    progress.begin_next();
    let begun = Instant::now();
    let runs = flow(gpu, frame, args.runs)?;
    // One run warms up.
    let frame_s = begun.elapsed().as_secs_f64() / (runs.len() + 1) as f64;
    let of_passes = runs.last().map_or(&[][..], Vec::as_slice);
    progress.runs_take(measured(&plan, &wanted, has_tables, of_passes, [frame_s, flush_s]).1);
    let row = |pass: String, mode, passes: &[&Pass], runs: usize, times: &[f64]| {
        Row::of(pass, mode, &plan, passes, azimuths, (runs, times))
    };
    for &i in &wanted {
        let pass = &plan.passes[i];
        let times = sums(&runs, |p| p == i);
        rows.push(row(pass.label(), "in_flow", &[pass], runs.len(), &times));
    }
    rows.push(row("total".into(), "in_flow", &every, runs.len(), &sums(&runs, |_| true)));
    progress.begin_next();
    let (count, whole) = overlapped(gpu, frame, args.runs)?;
    rows.push(row("total".into(), "overlapped", &every, count, &whole));
    if has_tables {
        progress.begin_next();
        let runs = repeated(gpu, frame, &needed, args.runs, None)?;
        let passes: Vec<&Pass> = needed.iter().map(|i| &plan.passes[*i]).collect();
        let times = sums(&runs, |_| true);
        rows.push(row("total".into(), "new_heights", &passes, runs.len(), &times));
    }
    progress.begin_next();
    let all: Vec<usize> = (0..plan.passes.len()).collect();
    let cold = repeated(gpu, frame, &all, args.runs, Some(&mut *flushes))?;
    rows.push(row("total".into(), "cold", &every, cold.len(), &sums(&cold, |_| true)));
    let (mut totals, mut fewest) = (vec![0.0; args.runs], args.runs);
    for &i in &wanted {
        let pass = &plan.passes[i];
        progress.begin_next();
        let alone = repeated(gpu, frame, &[i], args.runs, None)?;
        let times = sums(&alone, |_| true);
        fewest = fewest.min(times.len());
        totals.iter_mut().zip(&times).for_each(|(total, ns)| *total += ns);
        rows.push(row(pass.label(), "isolated", &[pass], alone.len(), &times));
        progress.begin_next();
        let cold = repeated(gpu, frame, &[i], args.runs, Some(&mut *flushes))?;
        rows.push(row(pass.label(), "cold", &[pass], cold.len(), &sums(&cold, |_| true)));
    }
    if wanted.len() == plan.passes.len() {
        rows.push(row("total".into(), "isolated", &every, fewest, &totals[..fewest]));
    }
    Ok((rows, nearest_to_median(runs)))
}

/// The run whose sum is nearest the median.
fn nearest_to_median(runs: Vec<Vec<Timing>>) -> Vec<Timing> {
    let all = sums(&runs, |_| true);
    let median = median(&all).unwrap_or_default();
    let distance = |at: &usize| (all[*at] - median).abs();
    let nearest = (0..all.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.and_then(|at| runs.into_iter().nth(at)).unwrap_or_default()
}

/// Names of what [`time`] measures, in its order, and seconds of one run of each, from the times of a frame, of a flush, and of the
/// passes in flow. Without timestamps `of_passes` is empty, and a pass counts as a whole frame.
fn measured(
    plan: &Plan,
    wanted: &[usize],
    has_tables: bool,
    of_passes: &[Timing],
    [frame_s, flush_s]: [f64; 2],
) -> (Vec<String>, Vec<f64>) {
    let frames = [
        Some(("frames in flow", frame_s)),
        Some(("frames without timestamps between passes", frame_s)),
        has_tables.then_some(("frames of new heights", frame_s)),
        Some(("frames with cold caches", frame_s + flush_s)),
    ];
    let of_pass = |i: &usize| {
        let label = plan.passes[*i].label();
        let pass_s = of_passes.get(*i).map_or(frame_s, |timing| timing.ns / 1e9);
        [("alone", pass_s), ("with cold caches", pass_s + flush_s)]
            .map(|(how, run_s)| (format!("{label} {how}"), run_s))
    };
    let frames = frames.into_iter().flatten().map(|(name, run_s)| (name.to_owned(), run_s));
    frames.chain(wanted.iter().flat_map(of_pass)).unzip()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 10 values about 100, whose interval goes from the 2nd to the 9th: `step` apart, it is 7 steps wide.
    fn spread(count: usize, step: f64) -> Vec<f64> {
        (0..count).map(|i| 100.0 + step * i as f64).collect()
    }

    /// Reports of fractals of two sizes are of one scene, also with a sphere light, whose height is absolute. The border
    /// differs in one part.
    #[test]
    fn the_size_of_a_fractal_is_no_part_of_its_identity() {
        use ridgelight::scene::{Border, Lights, SphereLight, Surface};
        let sphere =
            SphereLight { position_m: [4.0, 4.0, 99.0], radius_m: 1.0, radiance: [1.0; 3] };
        let lights = Lights { sphere_lights: vec![sphere], ..Lights::default() };
        let [small, large] = [16, 48].map(|size| verify::tests::scene(size, lights.clone()));
        assert_ne!(small.field.base_m(), large.field.base_m());
        assert_eq!(identity(&small, false), identity(&large, false));
        assert_ne!(identity(&small, true)["lights"], identity(&large, true)["lights"]);
        let surface = Surface { border: Border::Open, ..Surface::default() };
        let open = Scene { surface, ..small.clone() };
        for (part, is_same) in [("field", true), ("lights", true), ("surface", false)] {
            let [a, b] = [&small, &open].map(|scene| identity(scene, true)[part].clone());
            assert_eq!(a == b, is_same, "{part}");
        }
    }

    /// Tables of an environment do not depend on the heights; a sky has none.
    #[test]
    fn frames_of_new_heights_compute_no_tables_again() {
        use ridgelight::plan::Limits;
        use ridgelight::scene::{Environment, Lights};
        let of = |lights| {
            let scene = verify::tests::scene(32, lights);
            let quality = Quality::default();
            let limits = Limits::lavapipe();
            let plan = plan::picture(&scene, &quality, &limits, Picture::default()).unwrap();
            let needed = after_new_heights(&plan);
            let left = (0..plan.passes.len()).filter(|i| !needed.contains(i));
            left.map(|i| plan.passes[i].name().to_owned()).collect::<Vec<_>>()
        };
        let white = Environment::new(4, 2, vec![[1.0; 3]; 8], 0.0).unwrap();
        let left = of(Lights { environment: Some(white), ..Lights::default() });
        assert!(!left.is_empty() && left.iter().all(|name| name.starts_with("env_")), "{left:?}");
        assert_eq!(of(Lights { sky: Some([1.0; 3]), ..Lights::default() }), [""; 0]);
    }

    /// Each measured thing has a name and a time, in the same order. A cold run also takes a flush.
    #[test]
    fn every_row_has_a_name_and_a_time() {
        let plan = rows::tests::plan();
        let timing = |i: usize| Timing { label: String::new(), ns: 1e9 * (1 + i) as f64 };
        let of_passes: Vec<Timing> = (0..plan.passes.len()).map(timing).collect();
        for has_tables in [false, true] {
            let (names, run_s) = measured(&plan, &[0, 2], has_tables, &of_passes, [50.0, 0.5]);
            assert_eq!(names.len(), run_s.len());
            assert_eq!(names.len(), 7 + usize::from(has_tables));
            for (name, run_s) in names.iter().zip(&run_s) {
                let is_cold = name.ends_with("with cold caches");
                assert_eq!(run_s.fract() == 0.5, is_cold, "{name}: {run_s}");
                assert_eq!(*run_s >= 50.0, name.starts_with("frames "), "{name}: {run_s}");
            }
            assert_eq!(run_s[run_s.len() - 2..], [3.0, 3.5]);
        }
        let (_, untimed) = measured(&plan, &[0], false, &[], [50.0, 0.5]);
        assert_eq!(untimed, [50.0, 50.0, 50.5, 50.0, 50.5]);
    }

    /// Caches are flushed before every run, also before the first, and the times are the run's own.
    #[test]
    fn every_cold_run_follows_a_flush() {
        let log = std::cell::RefCell::new(Vec::new());
        let flush = || {
            log.borrow_mut().push("flush");
            Ok(())
        };
        let run = || {
            log.borrow_mut().push("run");
            Ok(vec![Timing { label: "sky_shade".into(), ns: 7.0 }])
        };
        // So few runs that neither the time limit nor the median's interval ends them.
        let runs = timed(3, flush, run).unwrap();
        assert_eq!(*log.borrow(), ["flush", "run", "flush", "run", "flush", "run"]);
        assert_eq!(sums(&runs, |_| true), [7.0; 3]);
    }

    /// A width of 2 % ends a row, after 10, 20 and 40 runs and not in between.
    #[test]
    fn rows_end_once_their_median_is_known() {
        assert!(stable(&spread(10, 0.28)) && !stable(&spread(10, 0.30)));
        for (count, is_asked) in
            [(0, false), (9, false), (11, false), (20, true), (30, false), (40, true)]
        {
            assert_eq!(stable(&vec![1.0; count]), is_asked, "{count} runs");
        }
        assert!(!stable(&[]) && !stable(&[0.0; 10].map(|_: f64| f64::NAN)));
    }

    /// Sums of 1, 5 and 3: the median is the last run's.
    #[test]
    fn a_trace_is_of_the_run_nearest_the_median() {
        let run = |ns: f64| vec![Timing { label: "pass".into(), ns }];
        assert_eq!(nearest_to_median(vec![run(1.0), run(5.0), run(3.0)])[0].ns, 3.0);
        assert!(nearest_to_median(Vec::new()).is_empty());
    }
}

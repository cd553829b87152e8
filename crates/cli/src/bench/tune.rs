//! Finds the form of the sweep that is fastest on a device. Forms change no bit of a picture, which is checked.

use std::time::{Duration, Instant};

use ridgelight::gpu::{Frame, Headless};
use ridgelight::plan::{self, Limits, Picture, Plan, SweepForm};
use ridgelight::scene::{Fuse, Lights, Quality, Scene, Surface, fractal};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_trade::statistics::{median, median_interval};
use serde_json::{Value, json};

use super::progress::at_most_s;
use super::warm_up;
use crate::args::TuneArgs;
use crate::setup::{self, Outcome, tuned};

/// Pairs of one frame of the untuned form and one of another, alternately first: at most so many, in about this time, but not
/// fewer than [`FEWEST`], which give the median an interval.
type Extent = (usize, Duration);
const EXTENT: Extent = (40, Duration::from_secs(2));
/// Of the best form, which is paired again.
const LAST: Extent = (400, Duration::from_secs(20));
const FEWEST: usize = 6;
/// A form whose first two pairs are slower than this is not paired again.
const HOPELESS: f64 = 1.25;
/// The upper end of the ratio's interval that a form must reach to be kept. Two processes of one build differ by several per
/// cent, but here both frames are in one.
const FASTER: f64 = 0.98;
/// Azimuths swept together, beside all of them.
const TOGETHER: [u32; 3] = [8, 16, 32];

/// A form and its time over that of the untuned one.
struct Trial {
    form: SweepForm,
    ratio: f64,
    /// At 95 %; none for fewer than 6 pairs.
    interval: Option<[f64; 2]>,
    is_same: bool,
    /// Why it could not be drawn, if it could not.
    failed: Option<String>,
}

impl Trial {
    /// From the ratios of its times to those of the untuned form, pair by pair.
    fn of(form: SweepForm, is_same: bool, ratios: &[f64]) -> Self {
        let ratio = median(ratios).unwrap_or(f64::NAN);
        Self { form, ratio, interval: median_interval(ratios), is_same, failed: None }
    }

    /// Whether it is faster with 95 % confidence.
    fn is_faster(&self) -> bool {
        self.is_same && self.interval.is_some_and(|[_, high]| high < FASTER)
    }
}

/// What every trial shares.
struct Search<'a> {
    scene: &'a Scene,
    quality: &'a Quality,
    limits: Limits,
    inputs: &'a [Vec<f32>],
    /// Bits of the untuned picture.
    want: Vec<u32>,
}

impl Search<'_> {
    fn plan(&self, form: SweepForm) -> Result<Plan> {
        let limits = Limits { sweep: form, ..self.limits };
        plan::picture(self.scene, self.quality, &limits, Picture::default())
    }

    /// Pairs frames of a form with those of the untuned one, `base`. A form that the device cannot draw is no error.
    fn trial(
        &self,
        gpu: &mut Headless,
        base: &mut Frame,
        form: SweepForm,
        extent: Extent,
    ) -> Trial {
        let found = self.plan(form).and_then(|plan| {
            gpu.with_frame(plan, self.inputs, |gpu, frame| {
                frame.time_passes(false);
                gpu.draw(frame)?;
                let is_same = bits(gpu, frame)? == self.want;
                let ratios = if is_same { pairs(gpu, base, frame, extent)? } else { Vec::new() };
                Ok((is_same, ratios))
            })
        });
        let failed = found.as_ref().err().map(Error::to_string);
        let (is_same, ratios) = found.unwrap_or((true, Vec::new()));
        Trial { failed, ..Trial::of(form, is_same, &ratios) }
    }
}

pub fn run(args: &TuneArgs) -> Result<Outcome> {
    let global = &args.global;
    global.json.as_ref().map_or(Ok(()), |path| setup::check_output("--json", path, &["json"]))?;
    // aimed-nearest shades fast, so the sweep is a larger share of the time.
    let fuse = Fuse::AimedNearest;
    let quality = Quality { azimuths: args.azimuths, fuse, ..Quality::default() };
    quality.check()?;
    let (mut gpu, mut limits) = setup::device(global)?;
    let device = gpu.report().clone();
    if args.reset {
        let text = if tuned::forget(&device)? { "no longer tuned" } else { "was not tuned" };
        crate::say!("{}, {}: {text}", device.name, device.driver);
        return Ok(Outcome::Done);
    }
    if device.timestamp_period_ns == 0.0 {
        let found = format!("{}, without timestamps", device.name);
        return Err(Error::setting("tune", found, "a device with timestamps"));
    }
    let untuned = device.limits.sweep;
    limits.sweep = untuned;
    // Two frames are there at once.
    limits.memory_budget /= 2;
    let field = match args.input.as_slice() {
        [] => fractal(args.size, 1)?,
        paths => setup::field(paths, &args.surface, global)?,
    };
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let surface = Surface { border: setup::border(&args.surface), ..Surface::default() };
    let scene = Scene { field, surface, lights };
    let inputs = plan::picture_inputs(&scene);
    let (scene, quality, want) = (&scene, &quality, Vec::new());
    let mut search = Search { scene, quality, limits, inputs: &inputs, want };
    let bar = setup::terminal::progress(global.quiet, "the untuned sweep");
    let (trials, last) = gpu.with_frame(search.plan(untuned)?, &inputs, |gpu, base| {
        base.time_passes(false);
        gpu.draw(base)?;
        search.want = bits(gpu, base)?;
        let begun = Instant::now();
        gpu.draw(base)?;
        // A pair also draws the untuned frame, which takes about as long.
        let pair_s = 2.0 * begun.elapsed().as_secs_f64();
        let forms = forms(untuned);
        let together: Vec<u32> =
            TOGETHER.into_iter().filter(|count| *count < args.azimuths).collect();
        let all = forms.len() + together.len();
        let show = |done: usize, form: &SweepForm| {
            let left_s = left_s(pair_s, all - done);
            let (at, form) = (done + 1, text(form));
            bar.set_message(format!("{at} of {all}: {form}; up to {left_s:.0} s left"));
        };
        let mut trials = Vec::new();
        for form in &forms {
            show(trials.len(), form);
            trials.push(search.trial(gpu, base, *form, EXTENT));
        }
        let best = fastest(&trials).unwrap_or(untuned);
        for azimuths in together {
            let form = SweepForm { azimuths, ..best };
            show(trials.len(), &form);
            trials.push(search.trial(gpu, base, form, EXTENT));
        }
        let left_s = left_s(pair_s, 0);
        bar.set_message(format!("the fastest form again; up to {left_s:.0} s left"));
        let last = fastest(&trials).map(|form| search.trial(gpu, base, form, LAST));
        Ok((trials, last))
    })?;
    bar.finish_and_clear();
    let kept = last.as_ref().filter(|trial| trial.is_faster());
    tuned::keep(&device, &kept.map_or(untuned, |trial| trial.form))?;
    if !global.quiet {
        crate::say!("{}, {}", device.name, device.driver);
        let (cols, rows, base) = (scene.field.cols(), scene.field.rows(), text(&untuned));
        crate::say!(
            "time of a frame of {cols} × {rows}, {} azimuths, relative to the untuned form ({base}), with the 95 % interval:",
            args.azimuths
        );
        trials.iter().for_each(|trial| crate::say!("{}", line(trial)));
        let again = last.as_ref().map(|trial| format!("again:\n{}\n", line(trial)));
        crate::say!("{}{}", again.unwrap_or_default(), verdict(kept));
    }
    if let Some(path) = &global.json {
        let rows: Vec<Value> = trials.iter().map(row).collect();
        let report = json!({
            "device": device.name, "driver": device.driver, "ridgelight": env!("CARGO_PKG_VERSION"),
            "commit": env!("RIDGELIGHT_COMMIT"), "untuned": tuned::json(&untuned), "trials": rows,
            "again": last.as_ref().map(row), "kept": kept.map(|trial| tuned::json(&trial.form)),
        });
        files::write_json(path, &report)?;
    }
    // A form with other bits is a defect, of the driver or of this program.
    let is_same = trials.iter().chain(&last).all(|trial| trial.is_same);
    Ok(if is_same { Outcome::Done } else { Outcome::Beyond })
}

/// Seconds that so many forms, and the best of them again, take at most.
fn left_s(pair_s: f64, forms: usize) -> f64 {
    let of = |(most, time): Extent| at_most_s(pair_s, (most, FEWEST), time);
    forms as f64 * of(EXTENT) + of(LAST)
}

/// Every form but the untuned one.
fn forms(untuned: SweepForm) -> Vec<SweepForm> {
    let mut all = Vec::new();
    for (lines_each, hulls) in [
        (4, [(false, 32), (false, 128), (true, 16), (true, 64)]),
        (1, [(true, 8), (true, 16), (true, 32), (false, 64)]),
    ] {
        for group_size in [32, 64, 128].map(|lines| lines / lines_each) {
            for (shares_hull, hull_depth) in hulls {
                let private_depth = if lines_each == 1 && shares_hull { 64 } else { 1 };
                let form = SweepForm { lines_each, group_size, private_depth, ..untuned };
                all.push(SweepForm { shares_hull, hull_depth, azimuths: u32::MAX, ..form });
            }
        }
    }
    all.retain(|form| text(form) != text(&untuned));
    all
}

/// Whether a form is one that this program tries, so that a file of another version is not taken.
pub fn is_tried(form: SweepForm, untuned: SweepForm) -> bool {
    let is_together = form.azimuths == u32::MAX || TOGETHER.contains(&form.azimuths);
    let alone = text(&SweepForm { azimuths: u32::MAX, ..form });
    is_together && forms(untuned).iter().chain([&untuned]).any(|known| text(known) == alone)
}

/// The form with the smallest ratio, below 1.
fn fastest(trials: &[Trial]) -> Option<SweepForm> {
    let all = trials.iter().filter(|trial| trial.is_same && trial.ratio < 1.0);
    all.min_by(|a, b| a.ratio.total_cmp(&b.ratio)).map(|trial| trial.form)
}

/// Times of `frame` over those of `base`, pair by pair.
fn pairs(
    gpu: &Headless,
    base: &mut Frame,
    frame: &mut Frame,
    (most, time): Extent,
) -> Result<Vec<f64>> {
    let one = |frame: &mut Frame| -> Result<f64> {
        Ok(gpu.draw(frame)?.iter().map(|timing| timing.ns).sum())
    };
    warm_up(gpu, || Ok((one(base)?, one(frame)?)))?;
    let begun = Instant::now();
    let mut ratios = Vec::new();
    while ratios.len() < most && (ratios.len() < FEWEST || begun.elapsed() < time) {
        let (base_ns, ns) = if ratios.len() % 2 == 0 {
            let first = one(base)?;
            (first, one(frame)?)
        } else {
            let first = one(frame)?;
            (one(base)?, first)
        };
        ratios.push(ns / base_ns);
        if ratios.len() == 2 && ratios.iter().all(|ratio| *ratio > HOPELESS) {
            break;
        }
    }
    Ok(ratios)
}

fn bits(gpu: &mut Headless, frame: &Frame) -> Result<Vec<u32>> {
    Ok(gpu.pixels(frame, 0)?.values.into_iter().map(f32::to_bits).collect())
}

fn text(form: &SweepForm) -> String {
    let SweepForm { lines_each, group_size, shares_hull, hull_depth, private_depth, azimuths } =
        form;
    let lines = if *lines_each == 1 { "one line" } else { "four lines" };
    let place = if *shares_hull { "shared" } else { "private" };
    let older = match (shares_hull, lines_each) {
        (true, 1) => format!(" and {private_depth} in private"),
        _ => String::new(),
    };
    let together = match azimuths {
        &u32::MAX => String::new(),
        count => format!(", {count} azimuths together"),
    };
    format!(
        "{lines} per invocation, workgroups of {group_size}, {hull_depth} hull entries in {place}{older} memory{together}"
    )
}

fn line(trial: &Trial) -> String {
    let found = match trial {
        Trial { failed: Some(why), .. } => format!("failed: {why}"),
        Trial { is_same: false, .. } => "different bits: rejected".into(),
        Trial { interval: Some(_), .. } => ratio_text(trial),
        Trial { ratio, .. } if *ratio > HOPELESS => {
            format!("{ratio:.2} (slower: timed for few pairs only)")
        }
        Trial { ratio, .. } => format!("{ratio:.2} (too few pairs for an interval)"),
    };
    format!("  {:<98} {found}", text(&trial.form))
}

fn ratio_text(trial: &Trial) -> String {
    let [low, high] = trial.interval.unwrap_or([f64::NAN; 2]);
    format!("{:.3} ({low:.3} to {high:.3})", trial.ratio)
}

fn verdict(kept: Option<&Trial>) -> String {
    match kept {
        Some(trial) => format!(
            "kept for this device, driver and commit: {} of the untuned time; `ridgelight tune --reset` undoes it",
            ratio_text(trial)
        ),
        None => format!(
            "the untuned form stays: no form takes less than {FASTER} of its time with 95 % confidence"
        ),
    }
}

fn row(trial: &Trial) -> Value {
    json!({
        "form": tuned::json(&trial.form), "ratio": trial.ratio, "low": trial.interval.map(|i| i[0]),
        "high": trial.interval.map(|i| i[1]), "same_bits": trial.is_same, "failed": trial.failed,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each is another one, the untuned ones are left out, and a plan takes all of them.
    #[test]
    fn forms_are_planned() {
        for is_cpu in [true, false] {
            let limits = Limits::boundless(is_cpu, 1 << 30);
            let all = forms(limits.sweep);
            assert_eq!(all.len(), 23);
            let mut texts: Vec<String> = all.iter().map(text).collect();
            texts.sort();
            texts.dedup();
            assert_eq!(texts.len(), 23, "{texts:#?}");
            assert!(!texts.contains(&text(&limits.sweep)));
            let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
            let field = fractal(64, 1).unwrap();
            let scene = Scene { field, surface: Surface::default(), lights };
            assert!(is_tried(limits.sweep, limits.sweep));
            let odd = SweepForm { group_size: 48, ..limits.sweep };
            let seven = SweepForm { azimuths: 7, ..limits.sweep };
            assert!(!is_tried(odd, limits.sweep) && !is_tried(seven, limits.sweep));
            for sweep in all {
                assert!(is_tried(sweep, limits.sweep));
                let limits = Limits { sweep, ..limits };
                let plan = plan::picture(&scene, &Quality::default(), &limits, Picture::default());
                assert!(plan.unwrap().notes.iter().any(|note| note.starts_with("tuned sweep")));
            }
        }
    }

    /// A form is kept if the upper end of the interval of its ratio is below 0.98, whatever the median. Of 20 pairs, the 95 %
    /// interval of the median goes from the 6th to the 15th.
    #[test]
    fn a_form_is_kept_only_if_its_interval_is_faster() {
        let form = Limits::lavapipe().sweep;
        let is_kept = |ratios: &[f64]| Trial::of(form, true, ratios).is_faster();
        let of = |fast: usize, slow: usize, slowest: f64| {
            let ratios = [vec![0.9; fast], vec![slowest; slow]].concat();
            let trial = Trial::of(form, true, &ratios);
            assert_eq!((ratios.len(), trial.ratio), (20, 0.9), "{ratios:?}");
            is_kept(&ratios)
        };
        assert!(of(20, 0, 0.0) && of(15, 5, 1.3), "the 15th is fast");
        assert!(!of(14, 6, 1.3) && !of(14, 6, 0.98), "the 15th is slow");
        assert!(of(14, 6, 0.979));
        assert!(!is_kept(&[0.97; 5]), "too few pairs for an interval");
        assert!(is_kept(&[0.97; 6]) && !is_kept(&[0.98; 6]) && !is_kept(&[1.0; 20]));
        assert!(!is_kept(&[0.9, 0.9, f64::NAN, 0.9, 0.9, 0.9, 0.9]) && !is_kept(&[]));
        assert!(!Trial::of(form, false, &[0.5; 20]).is_faster(), "other bits");
    }

    /// Fast frames: 40 pairs and one to warm up of each form, 400 and one of the last. Slow ones: 6 pairs and one of each.
    #[test]
    fn the_time_left_is_that_of_all_pairs() {
        let near = |found: f64, expected: f64| assert!((found / expected - 1.0).abs() < 1e-12);
        near(left_s(0.01, 3), 3.0 * 0.41 + 4.01);
        near(left_s(10.0, 2), 2.0 * 70.0 + 70.0);
    }

    /// A form with other bits is never the fastest, nor is one without pairs.
    #[test]
    fn the_fastest_form_has_the_same_bits() {
        let form = |azimuths| SweepForm { azimuths, ..Limits::lavapipe().sweep };
        let trial = |azimuths, ratio, is_same| Trial {
            form: form(azimuths),
            ratio,
            interval: None,
            is_same,
            failed: None,
        };
        let trials = [trial(1, 0.9, true), trial(2, 0.5, false), trial(3, f64::NAN, true)];
        assert_eq!(fastest(&trials), Some(form(1)));
        assert_eq!(fastest(&trials[1..]), None);
        assert!(line(&trials[1]).contains("different bits"));
        let failed = Trial { failed: Some("no memory".into()), ..trial(1, f64::NAN, true) };
        assert!(line(&failed).contains("failed: no memory") && fastest(&[failed]).is_none());
        let timed = Trial { interval: Some([0.8, 0.95]), ..trial(1, 0.9, true) };
        assert!(line(&timed).ends_with("0.900 (0.800 to 0.950)"));
        assert!(verdict(Some(&timed)).contains("commit: 0.900 (0.800 to 0.950) of the untuned"));
        assert!(line(&trials[0]).ends_with("0.90 (too few pairs for an interval)"));
    }
}

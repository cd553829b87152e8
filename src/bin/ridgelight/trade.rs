//! Speed against accuracy: settings timed on the device and held against the truth, the frontier of
//! both, and a recommendation.

mod html;
mod plot;
mod point;
mod report;
mod rig;
mod truth;

use std::path::Path;
use std::time::Duration;

use ridgelight::files;
use ridgelight::gpu::Frame;
use ridgelight::measure::statistics::Summary;
use ridgelight::measure::trade::{Knob, Place, Rule, Search, knobs, places, recommend};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{Lines, Method, Quality};
use ridgelight::{Error, Result};

use crate::args::TradeArgs;
use crate::setup::{self, Outcome};
use point::Point;
use report::Report;
use rig::Rig;
use truth::Truth;

pub use truth::{digits, percent};

/// Share of the budget that one setting may take.
const DEAREST: f64 = 0.1;

const FILES: [&str; 3] = ["trade.html", "trade.json", "trade.csv"];

pub fn run(args: &TradeArgs) -> Result<Outcome> {
    let rule = rule(args)?;
    if !(args.budget.is_finite() && (1.0..=1e6).contains(&args.budget)) {
        let found = args.budget.to_string();
        return Err(Error::setting("--budget", found, "1 to 1000000 seconds"));
    }
    check_folder(&args.output)?;
    if let Some(json) = &args.global.json {
        setup::check_output("--json", json, &["json"])?;
    }
    let mut inputs = setup::inputs(&args.input.path, &args.lights, &args.surface);
    inputs.extend(args.reference.as_deref());
    let written = FILES.map(|name| args.output.join(name));
    let mut outputs: Vec<(&str, Option<&Path>)> =
        written.iter().map(|path| ("-o", Some(path.as_path()))).collect();
    outputs.push(("--json", args.global.json.as_deref()));
    setup::check_distinct(&outputs, &inputs)?;
    let field = setup::field(&args.input.path, &args.surface.field)?;
    let scene = setup::scene(field, &args.surface, &args.lights)?;
    let start = Quality { method: Method::Sweep, ..Quality::default() };
    let planned = |limits: &plan::Limits| plan::picture(&scene, &start, limits, Picture::default());
    setup::check_plan(&args.global, planned)?;
    if let Some(path) = args.reference.as_deref().filter(|p| setup::extension(p) != "exr") {
        let found = path.display().to_string();
        return Err(Error::setting("--reference", found, "an .exr: others clip what is bright"));
    }
    let given = args.reference.as_deref().map(|p| Truth::read(p, &scene.field)).transpose()?;
    let (gpu, limits) = setup::device(&args.global)?;

    let bar = crate::render::progress(args.global.quiet, "drawing the truth");
    let budget = Duration::from_secs_f64(args.budget);
    let mut rig = Rig::new(gpu, limits, &scene, budget);
    let truth = match given {
        Some(truth) => truth,
        None => Truth::draw(&mut rig)?,
    };
    let truth_s = rig.spent();
    let knobs = knobs(&scene);
    let places = places(&knobs, &start);
    let walk = walk(&mut rig, &truth, (&knobs, &places), &start, &bar)?;
    bar.finish_and_clear();
    // In the units of the walk's costs, frames of the baseline.
    let rule = match rule {
        Rule::MaxCost(ns) => Rule::MaxCost(ns / walk.baseline_ns()),
        other => other,
    };
    let values: Vec<_> = walk.points.iter().filter_map(|p| walk.search.value(p.place)).collect();
    let Some(recommended) = recommend(&values, rule) else {
        return Err(Error::Device {
            doing: "trading".into(),
            reason: "no settings could be measured".into(),
        });
    };
    let mut about = vec![
        ("device".to_owned(), rig.gpu.report().name.clone()),
        ("driver".to_owned(), rig.gpu.report().driver.clone()),
        ("rows".to_owned(), scene.field.rows().to_string()),
        ("cols".to_owned(), scene.field.cols().to_string()),
        ("cell_m".to_owned(), format!("{},{}", scene.field.cell_m()[0], scene.field.cell_m()[1])),
    ];
    about.extend(setup::asked(
        &args.input.path,
        &args.surface.field,
        Some((&args.lights, &args.surface, &scene)),
    ));
    let report = Report {
        about,
        truth: &truth,
        truth_s,
        truth_png: point::light_png(&scene.field, &truth.planes, &truth)?,
        knobs: &knobs,
        places: &places,
        walk: &walk,
        rule,
        recommended,
        budget_s: args.budget,
        spent_s: rig.spent(),
    };
    write(args, &report)?;
    if !args.global.quiet {
        report.print();
        crate::say!("{}", args.output.join(FILES[0]).display());
    }
    Ok(if recommended.holds { Outcome::Done } else { Outcome::Beyond })
}

fn rule(args: &TradeArgs) -> Result<Rule> {
    let positive = |flag: &str, value: Option<f64>| match value {
        Some(x) if !(x.is_finite() && x > 0.0) => {
            Err(Error::setting(flag, x.to_string(), "a number above 0"))
        }
        other => Ok(other),
    };
    let most = positive("--max-error", args.max_error)?.map(Rule::MaxError);
    let longest = positive("--time-budget", args.time_budget)?.map(|ms| Rule::MaxCost(ms * 1e6));
    Ok(most.or(longest).unwrap_or(Rule::Knee))
}

/// A folder that is ours to write into: missing, empty, or with an earlier report.
fn check_folder(path: &Path) -> Result<()> {
    let shown = || path.display().to_string();
    if !path.is_dir() {
        if path.exists() {
            return Err(Error::setting("-o", format!("the file {}", shown()), "a folder"));
        }
        let parent = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !parent.is_dir() {
            let expected = format!("a folder {} that exists", parent.display());
            return Err(Error::setting("-o", shown(), expected));
        }
        return files::check_writable(path);
    }
    let wrong = |source| Error::Io { path: path.to_owned(), source };
    for entry in std::fs::read_dir(path).map_err(wrong)? {
        let name = entry.map_err(wrong)?.file_name();
        if !FILES.iter().any(|f| name == *f) {
            let found = format!("{} with {} in it", shown(), name.to_string_lossy());
            let expected = "a folder that is missing, empty, or holds an earlier report";
            return Err(Error::setting("-o", found, expected));
        }
    }
    files::check_writable(&path.join(FILES[0]))
}

fn write(args: &TradeArgs, report: &Report) -> Result<()> {
    let (json, csv, page) = (report.json(), report.csv(), html::page(report));
    if let Err(source) = std::fs::create_dir(&args.output)
        && source.kind() != std::io::ErrorKind::AlreadyExists
    {
        return Err(Error::Io { path: args.output.clone(), source });
    }
    files::write_text(&args.output.join(FILES[2]), &csv)?;
    files::write_json(&args.output.join(FILES[1]), &json)?;
    files::write_text(&args.output.join(FILES[0]), &page)?;
    match &args.global.json {
        Some(path) => files::write_json(path, &json),
        None => Ok(()),
    }
}

/// What a walk has found.
pub struct Walk {
    pub search: Search,
    /// In the order in which they were measured.
    pub points: Vec<Point>,
    /// Places that could not be measured, and why.
    pub given_up: Vec<(usize, String)>,
    /// The place whose frame is drawn again between others.
    pub baseline: usize,
    /// Whether the budget ended it.
    pub out_of_time: bool,
}

impl Walk {
    /// Median nanoseconds of the baseline's frame over the whole run: the unit of costs.
    pub fn baseline_ns(&self) -> f64 {
        self.drift().map_or(0.0, |s| s.median)
    }

    /// The baseline's frame through the run, nanoseconds.
    pub fn drift(&self) -> Option<Summary> {
        let all: Vec<f64> =
            self.points.iter().flat_map(|p| p.baseline_ns.iter().copied()).collect();
        Summary::of(&all)
    }
}

fn walk(
    rig: &mut Rig,
    truth: &Truth,
    (knobs, places): (&[Knob], &[Place]),
    start: &Quality,
    bar: &indicatif::ProgressBar,
) -> Result<Walk> {
    let baseline =
        places.iter().position(|p| p.quality == *start).expect("the defaults are on the ladders");
    let steps = places.iter().map(|p| p.steps.clone()).collect();
    let mut walk = Walk {
        search: Search::new(steps, baseline, truth.own_error),
        points: Vec::new(),
        given_up: Vec::new(),
        baseline,
        out_of_time: false,
    };
    let mut frame: Option<Frame> = None;
    let mut slow = Vec::new();
    let walked = loop {
        let Some(place) = walk.search.next() else { break Ok(()) };
        walk.out_of_time |= frame.is_some() && rig.left() <= 0.0;
        if walk.out_of_time {
            break Ok(());
        }
        bar.set_message(format!(
            "{} measured, {} on the frontier, {:.0} s left: {}",
            walk.points.len(),
            walk.search.frontier().len(),
            rig.left().max(0.0),
            places[place].flags(knobs)
        ));
        if let Err(error) = visit(rig, truth, place, places, &mut walk, &mut frame, &mut slow) {
            break Err(error);
        }
    };
    if let Some(frame) = frame {
        rig.gpu.end(frame);
    }
    walked.map(|()| walk)
}

/// Measures one place, or finds that it cannot be.
fn visit(
    rig: &mut Rig,
    truth: &Truth,
    place: usize,
    places: &[Place],
    walk: &mut Walk,
    baseline: &mut Option<Frame>,
    slow: &mut Vec<((Method, Lines), f64)>,
) -> Result<()> {
    let quality = &places[place].quality;
    let give_up = |walk: &mut Walk, why: String, too_dear| {
        walk.search.give_up(place, too_dear);
        walk.given_up.push((place, why));
    };
    let plan = match rig.plan(rig.scene, quality) {
        Ok(plan) => plan,
        Err(error) if baseline.is_some() => {
            give_up(walk, setup::in_flags(error).to_string(), false);
            return Ok(());
        }
        Err(error) => return Err(error),
    };
    if baseline.is_some() {
        // Two draws at least: one to warm up, one that counts.
        let needs = 2.0 * expected_s(rig, walk, place, quality, plan.azimuths.len(), slow)?;
        let most = DEAREST * rig.budget.as_secs_f64();
        if needs > most {
            let why = format!(
                "would take about {} s, more than {} s, a tenth of the budget",
                truth::digits(needs),
                truth::digits(most)
            );
            give_up(walk, why, true);
            return Ok(());
        }
        if needs > rig.left() {
            walk.out_of_time = true;
            return Ok(());
        }
    }
    let (point, frame) = match point::measure(rig, truth, place, quality, baseline.as_mut()) {
        Ok(measured) => measured,
        Err(error @ Error::Device { .. }) if baseline.is_some() => {
            give_up(walk, error.to_string(), false);
            return Ok(());
        }
        Err(error) => return Err(error),
    };
    match baseline {
        None => *baseline = Some(frame),
        Some(_) => rig.gpu.end(frame),
    }
    walk.search.measured(place, point.value());
    walk.points.push(point);
    let front = walk.search.frontier();
    for point in walk.points.iter_mut().filter(|p| !front.contains(&p.place)) {
        point.pictures = None;
    }
    Ok(())
}

/// Seconds that a draw is expected to take: of sweeps along lines by what was measured, of exact and
/// brute ones, which nothing measured is like, by a piece of the field.
fn expected_s(
    rig: &mut Rig,
    walk: &Walk,
    place: usize,
    quality: &Quality,
    azimuths: usize,
    slow: &mut Vec<((Method, Lines), f64)>,
) -> Result<f64> {
    if quality.method != Method::Brute && quality.lines != Lines::Exact {
        return Ok(walk.search.predicted(place).cost * walk.baseline_ns() * 1e-9);
    }
    let form = match quality.method {
        Method::Brute => (Method::Brute, Lines::Exact),
        method => (method, quality.lines),
    };
    let each = match slow.iter().find(|(known, _)| *known == form) {
        Some((_, each)) => *each,
        None => {
            let each = rig.seconds_per_azimuth(rig.scene, quality)?;
            slow.push((form, each));
            each
        }
    };
    Ok(each * azimuths as f64)
}

//! Chooses settings for an error or a time.

use std::cell::RefCell;
use std::time::{Duration, Instant};

use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless, Timing};
use ridgelight::plan::{self, Limits, Picture};
use ridgelight::scene::{Hull, Normals, Quality, Scene};
use ridgelight_cpu::lit::Lit;
use ridgelight_trade::auto;
use ridgelight_trade::auto::{
    Bounced, Chosen, Drawn, Goal, Measured, OracleThreads, Probes, Traced, Trial,
};

use crate::args::AutoArgs;
use crate::idle;
use crate::reference;
use crate::setup::terminal::{digits, percent};
use crate::setup::{self, after_new_heights, total_ns};

/// Draws of each setting after one that compiles; the median counts. No draw begins after [`TIMING`], so slow settings get
/// fewer.
const DRAWS: usize = 3;
const TIMING: Duration = Duration::from_millis(500);
/// A first draw this long is mostly work, not compilation, and counts itself. On a software driver exact light may take cores
/// from it, so its time can be too long; the choice is timed again during a pause.
const LONG: Duration = Duration::from_secs(10);

/// The requested goal, if any.
pub fn goal(max_error: Option<f64>, time_budget: Option<f64>) -> Result<Option<Goal>> {
    for (flag, value) in [("--max-error", max_error), ("--time-budget", time_budget)] {
        value.map_or(Ok(()), |x| super::check_positive(flag, x))?;
    }
    if let Some(error) = max_error.filter(|error| *error > 1.0) {
        setup::warning(&format!(
            "--max-error {error} is {} % of the mean light; 0.01 is 1 %",
            100.0 * error
        ));
    }
    let cost = time_budget.map(|ms| Goal::MaxCost(ms * 1e6));
    Ok(max_error.map(Goal::MaxError).or(cost))
}

/// Notes that flags of the choice change nothing without a goal.
pub fn say_idle(args: &AutoArgs, quiet: bool) {
    if args.max_error.is_some() || args.time_budget.is_some() || quiet {
        return;
    }
    let without = "without --max-error or --time-budget";
    if let Some(seed) = args.seed {
        idle::note("seed", &seed.to_string(), without);
    }
    if args.no_cache {
        setup::note(&format!("--no-cache changes nothing {without}"));
    }
}

pub fn choose(
    gpu: &mut Headless,
    limits: &Limits,
    scene: &Scene,
    (goal, seed): (Goal, u32),
    (hull, bounces, wanted): (Hull, u32, Picture),
    bar: &indicatif::ProgressBar,
) -> Result<Chosen> {
    let contents = plan::picture_inputs(scene);
    let mut known: Vec<Quality> = Vec::new();
    let lit = Lit::of(scene).viewed_from(wanted.eye_m);
    let probes = (Probes::affordable(&lit), u64::from(seed));
    let gpu = RefCell::new(gpu);
    let mut trace = |places: &[usize], batches: u32, seed: u32| {
        let paths = batches * plan::REFERENCE_BATCH;
        bar.set_message(format!("tracing {paths} paths from each of {} probes", places.len()));
        let of = (scene, bounces, wanted.eye_m);
        trace(&mut gpu.borrow_mut(), limits, of, places, (batches, seed))
    };
    let bounced = (bounces > 0).then_some(Bounced { count: bounces, trace: &mut trace });
    let mut chosen = auto::choose(&lit, goal, probes, bounced, |quality, threads| {
        // Pipelines are kept: the second frame of the same settings compiles nothing.
        let timing = Timed { is_compiled: known.contains(quality), threads };
        known.push(*quality);
        bar.set_message(format!("choosing settings, {}: {}", known.len(), flags(quality, scene)));
        let quality = Quality { hull, ..*quality };
        draw(&mut gpu.borrow_mut(), limits, (scene, wanted), (&quality, timing), &contents)
    })?;
    chosen.trial.quality.hull = hull;
    Ok(chosen)
}

/// How to time a frame.
struct Timed<'a> {
    /// Whether an earlier frame has compiled its passes.
    is_compiled: bool,
    /// The oracle's threads, which pause while the frame is timed.
    threads: &'a OracleThreads,
}

fn draw(
    gpu: &mut Headless,
    limits: &Limits,
    (scene, wanted): (&Scene, Picture),
    (quality, timing): (&Quality, Timed<'_>),
    contents: &[Vec<f32>],
) -> Result<Drawn> {
    let plan = plan::picture(scene, quality, limits, wanted)?;
    let (times, pixels) = gpu.with_frame(plan, contents, |gpu, frame| {
        Ok((timing.of(gpu, frame)?, gpu.pixels(frame, 0)?))
    })?;
    let planes = setup::planes(&pixels, &scene.field);
    Ok(Drawn { planes, passes: times.into_iter().map(|t| (t.label, t.ns)).collect() })
}

impl Timed<'_> {
    /// Times of the passes.
    fn of(&self, gpu: &Headless, frame: &mut Frame) -> Result<Vec<Timing>> {
        let begun = Instant::now();
        let first = if self.is_compiled { None } else { Some(gpu.draw(frame)?) };
        let times = match first.filter(|_| begun.elapsed() >= LONG) {
            Some(times) => times,
            None => self.repeated(gpu, frame)?,
        };
        match total_ns(&times) > 0.0 {
            true => Ok(times),
            false => Err(setup::no_timestamps()),
        }
    }

    /// The same for compiled passes. Those that new heights need are timed by the median of some draws, tables of lights by one
    /// draw. Exact light is not computed meanwhile, as a software driver draws on the same cores.
    fn repeated(&self, gpu: &Headless, frame: &mut Frame) -> Result<Vec<Timing>> {
        let _pause = self.threads.pause();
        let begun = Instant::now();
        let mut times = gpu.draw(frame)?;
        let passes = after_new_heights(frame.plan());
        let mut runs: Vec<Vec<Timing>> =
            vec![passes.iter().filter_map(|i| times.get(*i).cloned()).collect()];
        while runs.len() < DRAWS && begun.elapsed() < TIMING {
            runs.push(gpu.draw_passes(frame, &passes)?);
        }
        runs.sort_by(|a, b| total_ns(a).total_cmp(&total_ns(b)));
        let middle = runs.swap_remove(runs.len() / 2);
        passes.into_iter().zip(middle).for_each(|(i, timing)| times[i] = timing);
        Ok(times)
    }
}

/// Indirect light at some texels by so many batches of paths of a seed.
fn trace(
    gpu: &mut Headless,
    limits: &Limits,
    (scene, bounces, eye_m): (&Scene, u32, Option<[f64; 3]>),
    places: &[usize],
    (batches, seed): (u32, u32),
) -> Result<Vec<Traced>> {
    let (normals, count) = (Normals::Smooth, places.len());
    let plan = plan::reference_at(scene, bounces, normals, eye_m, seed, count, limits)?;
    let is_traced = |i: &usize| plan.passes[*i].name() == "path_trace";
    let passes: Vec<usize> = (0..plan.passes.len()).filter(is_traced).collect();
    let mut contents = plan::reference_inputs(scene);
    contents.push(plan::listed_places(scene, places)?);
    let [means, errors] = gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        for _ in 1..batches {
            for pass in &passes {
                gpu.draw_passes(frame, &[*pass])?;
            }
        }
        if let Some(lost) = frame.plan().find("lost_rays") {
            reference::none_lost(gpu.read(frame, lost)?[0])?;
        }
        Ok([super::rgb(&gpu.pixels(frame, 0)?), super::rgb(&gpu.pixels(frame, 1)?)])
    })?;
    let both = means.iter().zip(&errors).take(places.len());
    let light = |c: &[f32; 3]| c.map(f64::from);
    Ok(both.map(|(m, e)| Traced { mean: light(m), standard_error: light(e) }).collect())
}

/// The settings of a trial as flags.
fn flags(quality: &Quality, scene: &Scene) -> String {
    setup::flags_in(&auto::flags(quality, scene))
}

/// Metadata for files and --json.
pub fn metadata(
    (goal, seed): (Goal, u32),
    chosen: &Chosen,
    scene: &Scene,
) -> Vec<(String, String)> {
    let wanted = match goal {
        Goal::MaxError(most) => ("max_error", most.to_string()),
        Goal::MaxCost(ns) => ("time_budget_ms", (ns / 1e6).to_string()),
    };
    let measured = &chosen.trial.measured;
    let confidence = chosen.confidence.map_or_else(|| "none".to_owned(), |c| c.to_string());
    [
        wanted,
        ("error_expected", chosen.expected.error.to_string()),
        ("error_expected_deviation_factor", chosen.expected.factor.to_string()),
        ("error_measured", measured.error.to_string()),
        ("error_at_most", measured.at_most.to_string()),
        ("error_confidence", confidence),
        ("error_probes", chosen.probes.to_string()),
        ("error_paths", chosen.paths.to_string()),
        ("seed", seed.to_string()),
        ("tried", tried(goal, chosen, scene, false)),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .to_vec()
}

/// The settings that were tried, and what they reached. Times are for `--json` only.
pub fn tried(goal: Goal, chosen: &Chosen, scene: &Scene, has_times: bool) -> String {
    let of = |t: &Trial| {
        let holds = if goal.is_reached(t) { "reached" } else { "missed" };
        let Measured { error, at_most } = t.measured;
        let error = format!("{} (at most {})", percent(error), percent(at_most));
        let time = if has_times { format!(" {:.3} ms,", t.ns / 1e6) } else { String::new() };
        format!("{}: {error},{time} {holds}", flags(&t.quality, scene))
    };
    chosen.trials.iter().map(of).collect::<Vec<_>>().join("; ")
}

/// The choice and its error in words; then how many slower or faster settings missed the goal.
pub fn sentences(goal: Goal, chosen: &Chosen, scene: &Scene) -> Vec<String> {
    let Chosen { trial, expected, probes, paths, confidence, trials } = chosen;
    let by_paths = match paths {
        0 => String::new(),
        _ => format!(", {paths} paths each"),
    };
    let confidence = confidence.map_or_else(
        || "without a confidence level".to_owned(),
        |c| format!("with {:.0} % confidence", 100.0 * c),
    );
    let mut all = vec![format!(
        "{}: expected error {} (one standard deviation: a factor of {}), measured {}, at most {} \
            {confidence} ({probes} probes{by_paths})",
        flags(&trial.quality, scene),
        percent(expected.error),
        digits(expected.factor),
        percent(trial.measured.error),
        percent(trial.measured.at_most),
    )];
    if let Goal::MaxCost(most) = goal {
        let [time, most] = [trial.ns, most].map(|ns| digits(ns / 1e6));
        all.push(format!("a frame takes {time} ms (median), the goal is at most {most} ms; the first frame takes longer"));
    }
    let missed: Vec<_> = trials.iter().filter(|t| !goal.is_reached(t)).collect();
    if let Some(last) = missed.last() {
        let (went, by) = match goal {
            Goal::MaxError(_) => ("slower", format!("at most {}", percent(last.measured.at_most))),
            Goal::MaxCost(_) => ("faster", format!("{} ms", digits(last.ns / 1e6))),
        };
        all.push(format!(
            "chose {went} settings because {} missed the goal, the last {} ({by})",
            missed.len(),
            flags(&last.quality, scene)
        ));
    }
    all
}

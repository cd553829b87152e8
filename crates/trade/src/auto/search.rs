//! The search of `--max-error` and `--time-budget`, for a caller that can render: render, measure, render again.

use super::candidates::pilots;
use super::chooser::{Chooser, Trial};
use super::model::{Expected, PARTS, Part};
use super::oracle_light::{OracleLight, OracleThreads};
use super::picks::usable_sum;
use super::probes::{Measured, Probes, Traced, unsampled_bounce_error, unsure};
use super::statistics::Statistics;
use crate::trade::{Goal, has_specular};
use ridgelight::basis::random::STEP;
use ridgelight::plan::REFERENCE_BATCH;
use ridgelight::scene::{Basis, Lines, Method, Quality, Scene, setting};
use ridgelight::{Error, Result};
use ridgelight_cpu::lit::Lit;

/// A rendered frame.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Radiance: one plane or three, row-major, NaN at voids.
    pub planes: Vec<Vec<f32>>,
    /// Nanoseconds by pass label: of a typical frame, not of one that compiles.
    pub passes: Vec<(String, f64)>,
}

impl Drawn {
    fn ns(&self) -> f64 {
        self.passes.iter().map(|p| p.1).sum()
    }
}

/// Settings that reach a goal, with measurements.
#[derive(Clone, Debug)]
pub struct Chosen {
    /// The settings; their error by probes that did not choose them; the time of a frame rendered
    /// again.
    pub trial: Trial,
    /// The error expected from the scene's statistics alone.
    pub expected: Expected,
    /// Number of probes of that error.
    pub probes: usize,
    /// Paths from each probe, for bounced light; 0 without.
    pub paths: u32,
    /// Of the bound. None where only some texels are probes, and these are uniform, so that they may miss shadow edges: one
    /// of the first two frames did not fit the device or has values beyond f32, or the first three are equal.
    pub confidence: Option<f64>,
    /// All trials, in order, including the chosen one.
    pub trials: Vec<Trial>,
}

/// Bounced light, which the choice must also get right.
pub struct Bounced<'t> {
    /// Number of bounces: [`count`](ridgelight::scene::Bounces::count), above 0.
    pub count: u32,
    /// Traces bounced light of texels, by index, in this many batches of paths
    /// ([`REFERENCE_BATCH`]) of a seed.
    pub trace: &'t mut Trace<'t>,
}

/// See [`Bounced::trace`].
pub type Trace<'t> = dyn FnMut(&[usize], u32, u32) -> Result<Vec<Traced>> + 't;

/// Batches of the first estimate; at most.
const FIRST_BATCHES: u32 = 8;
const MOST_BATCHES: u32 = 256;
/// Monte Carlo noise in the bound of the chosen settings, as a share of the goal
/// ([`Probes::path_noise`]). The target increases the bound of such an error by √(1 + 0.4²), 8 %.
/// Up to the limit, √(1 + 0.8²), 28 %, is accepted where [`MOST_BATCHES`] do no better; beyond it
/// the goal is refused.
const NOISE_TARGET: f64 = 0.4;
const NOISE_LIMIT: f64 = 0.8;
/// Unsampled light, as a share of that target.
const UNSAMPLED_SHARE: f64 = 0.25;
/// The target where the goal is a time.
const TIMED_NOISE_TARGET: f64 = 0.002;

/// Probes of the first estimates of direct light. Where only bounds decide, probes are added up to the affordable number;
/// with bounced light, which begins with that number, up to [`MOST_BOUNCED`] times it.
const FIRST_PROBES: usize = 200;
const MOST_BOUNCED: usize = 4;

/// The choice is measured once more by probes that had no part in it; its bound is theirs. They are at most this many times
/// the affordable number.
const CONFIRMING_PROBES: usize = 3;
/// The fewest of them, unless that limit is lower.
const FEWEST_CONFIRMING: usize = 1000;
/// Choices that are measured so, as long as they miss the goal: twice the fastest settings, then some with a margin, then
/// exact horizons.
const CONFIRMATIONS: u64 = 4;

/// Where the goal is a time: how far the bound of the choice is expected to lie above its error.
const TIMED_BOUND: f64 = 1.1;

/// Probes that measure a choice again, `most` at most. Where even the upper end of the expectation lies below the goal, as many as
/// are expected to bring the bound, at these `deviations`, halfway from the error to the goal, but [`FEWEST_CONFIRMING`] or more.
/// Elsewhere all: a few texels may then have nearly all of the error, and fewer probes can miss all of them.
///
/// The bound of a mean square lies above it in proportion to the deviations and to 1/√n. The number depends on earlier
/// probes alone, so that the bound by fresh ones holds.
fn confirming_count(
    Measured { error, at_most }: Measured,
    count: usize,
    (goal, expected): (Goal, Expected),
    deviations: f64,
    most: usize,
) -> usize {
    let (wanted, highest) = match goal {
        Goal::MaxError(goal) => (0.5 * (error + goal), goal),
        Goal::MaxCost(_) => (TIMED_BOUND * error, at_most),
    };
    if expected.error * expected.factor > highest {
        return most;
    }
    let ratio = (at_most.powi(2) - error.powi(2)) / (wanted.powi(2) - error.powi(2));
    let count = count as f64 * (deviations / Probes::ONE_BOUND * ratio).powi(2);
    // An error of 0 gives NaN, or infinity.
    let count = if count.is_finite() { count.ceil() as usize } else { most };
    count.clamp(FEWEST_CONFIRMING.min(most), most)
}

/// Probes, and the pictures that may still be needed, in the order of rendering.
struct Judge<'a, 't> {
    oracle: &'a OracleLight<'a>,
    bounced: Option<Bounced<'t>>,
    batches: u32,
    /// Where probes concentrate, the affordable number, the number of texels that are not voids, and the next seed.
    unsure: Vec<f64>,
    affordable: usize,
    texels: usize,
    seed: u64,
    probes: Probes,
    pictures: Vec<Option<Vec<Vec<f32>>>>,
    control: usize,
}

/// Texels that confirm the next choice, by number and seed.
#[derive(Clone, Copy)]
struct Requested {
    count: usize,
    seed: u64,
}

/// Number of the first probes. Bounced light begins with all that are affordable, as its number of paths is chosen for them.
fn first_count(affordable: usize, has_bounced: bool) -> usize {
    if has_bounced { affordable } else { affordable.min(FIRST_PROBES) }
}

impl<'a, 't> Judge<'a, 't> {
    fn new(
        oracle: &'a OracleLight<'a>,
        (affordable, seed): (usize, u64),
        unsure: Vec<f64>,
        bounced: Option<Bounced<'t>>,
        goal: Goal,
    ) -> Result<Self> {
        let scene = oracle.scene();
        let texels = scene.field.rows() * scene.field.cols()
            - scene.field.voids().map_or(0, |v| v.iter().filter(|v| **v).count());
        let first = first_count(affordable, bounced.is_some());
        let probes = Probes::by(oracle, first, seed, &unsure)?;
        let direct = probes.clone();
        let mut judge = Self {
            oracle,
            bounced,
            batches: FIRST_BATCHES,
            unsure,
            affordable,
            texels,
            seed,
            probes,
            pictures: vec![],
            control: 0,
        };
        judge.probes = judge.traced(direct.clone())?;
        let (wanted, error) = match goal {
            Goal::MaxError(most) => (NOISE_TARGET * most, most),
            Goal::MaxCost(_) => (TIMED_NOISE_TARGET, 0.0),
        };
        let judging = texels.min(CONFIRMING_PROBES * judge.probes.count());
        let noise = |batches: u32, error: f64| {
            let share = f64::from(FIRST_BATCHES) / f64::from(batches);
            judge.probes.path_noise(error, share, judging, Probes::EIGHT_BOUNDS)
        };
        let least = noise(MOST_BATCHES, error);
        if error > 0.0 && least > NOISE_LIMIT * error {
            // The noise grows at most with the root of the error: each step halves the error of the
            // logarithm.
            let reachable = (0..30).fold(error, |e, _| noise(MOST_BATCHES, e) / NOISE_LIMIT);
            return Err(Error::Limit {
                what: format!("a goal of {}", figures(error)),
                needs: "bounced light of that precision".into(),
                limit: format!(
                    "{}: the standard error of {} paths from each of {judging} texels would be {}",
                    figures(reachable),
                    MOST_BATCHES * REFERENCE_BATCH,
                    figures(least)
                ),
            });
        }
        // Unsampled light falls in proportion to the number of paths.
        let unsampled = judge.probes.unsampled_error(&direct) / (UNSAMPLED_SHARE * wanted)
            * f64::from(FIRST_BATCHES);
        let enough = (FIRST_BATCHES..MOST_BATCHES)
            .find(|b| noise(*b, error) <= wanted && unsampled <= f64::from(*b))
            .unwrap_or(MOST_BATCHES);
        if enough > FIRST_BATCHES {
            judge.batches = enough;
            judge.probes = judge.traced(direct)?;
        }
        Ok(judge)
    }

    fn new_seed(&mut self) -> u64 {
        self.seed = self.seed.wrapping_add(1 << 32);
        self.seed
    }

    /// Probes of a new seed.
    fn fresh(&mut self, wanted: usize) -> Result<Probes> {
        let seed = self.new_seed();
        let probes = Probes::by(self.oracle, wanted, seed, &self.unsure)?;
        self.traced(probes)
    }

    /// Starts to compute the light of `count` texels that confirm the next choice, before it is made. [`Self::confirming`] adds
    /// others where more are wanted.
    fn request(&mut self, count: usize) -> Result<Requested> {
        let seed = self.new_seed();
        Probes::request(self.oracle, count, seed, Some(self.unsure.as_slice()))?;
        Ok(Requested { count, seed })
    }

    /// Probes that confirm a choice: the requested ones, and others of a new seed where more are wanted; or all texels.
    ///
    /// The two sets are independent, and each probe's factor is that of its own set. The mean over each set is unbiased, and
    /// so is the mean over both.
    fn confirming(&mut self, requested: Requested, wanted: usize) -> Result<Probes> {
        let first = if wanted >= self.texels { wanted } else { requested.count };
        let mut probes = Probes::by(self.oracle, first, requested.seed, &self.unsure)?;
        if wanted > first {
            let seed = self.new_seed();
            probes.extend(&Probes::by(self.oracle, wanted - first, seed, &self.unsure)?);
        }
        self.traced(probes)
    }

    /// Adds bounced light, where there is any, by new paths.
    fn traced(&mut self, mut probes: Probes) -> Result<Probes> {
        let Some(bounced) = &mut self.bounced else { return Ok(probes) };
        self.seed = self.seed.wrapping_add(1 << 32);
        // Of both halves, mixed (Steele, Lea & Flood 2014).
        let seed = (self.seed ^ (self.seed >> 32)).wrapping_mul(STEP) >> 32;
        let traced = (bounced.trace)(probes.places(), self.batches, seed as u32)?;
        let of = (self.batches * REFERENCE_BATCH, probes.count());
        let unsampled = unsampled_bounce_error(
            self.oracle.scene(),
            bounced.count,
            of,
            Probes::UNSAMPLED_PROBABILITY,
        );
        probes.add_bounced(&traced, unsampled);
        Ok(probes)
    }

    fn most_probes(&self) -> usize {
        self.affordable * if self.bounced.is_some() { MOST_BOUNCED } else { 1 }
    }

    /// Measures a frame and, where it is the best control or probes were added, all others again.
    /// Takes more probes where they would decide.
    fn take(&mut self, chooser: &mut Chooser<'_>, quality: &Quality, drawn: Drawn) -> Result<()> {
        self.pictures.push(Some(drawn.planes));
        chooser.drawn(quality, &drawn.passes);
        self.judge(chooser);
        while chooser.is_undecided()
            && !self.probes.is_whole()
            && self.probes.count() < self.most_probes()
        {
            let known = self.probes.count();
            let more = self.fresh(known.min(self.most_probes() - known))?;
            self.probes.extend(&more);
            self.judge(chooser);
        }
        Ok(())
    }

    fn judge(&mut self, chooser: &mut Chooser<'_>) {
        let errors = |control: Option<&[Vec<f32>]>| -> Vec<_> {
            let measured = |p: &Vec<Vec<f32>>| self.probes.error(p, control, Probes::ONE_BOUND);
            self.pictures.iter().map(|p| p.as_ref().map(measured)).collect()
        };
        let own = errors(None).into_iter().enumerate().filter_map(|(i, e)| Some((i, e?.error)));
        self.control = own.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(i, _)| i);
        let all = errors(self.control());
        chooser.judged(&all);
        for (i, (picture, trial)) in self.pictures.iter_mut().zip(chooser.trials()).enumerate() {
            if i != self.control && !chooser.may_be_best(trial) {
                *picture = None;
            }
        }
    }

    /// The picture of the least error by the probes alone.
    fn control(&self) -> Option<&[Vec<f32>]> {
        self.pictures.get(self.control)?.as_deref()
    }
}

/// Chooses settings for a goal. `draw` renders the scene with given settings; this many probes, grid
/// points of exact light chosen by `seed`, measure its error.
///
/// The choice is rendered again: its time is that of this frame, and its bound comes from probes
/// that had no part in it. With `bounced`, bounced light is measured and its settings are chosen,
/// too.
///
/// Other threads compute exact light while `draw` runs. It times frames during
/// [`OracleThreads::pause`]. The choice depends on no other times than those that `draw` returns.
///
/// # Errors
/// A goal out of range, or finer than paths can measure; one that nothing reaches, with the nearest
/// result; errors of `draw`, except [`Error::Limit`], which excludes the settings and all slower
/// ones, unless all are refused.
pub fn choose(
    lit: &Lit<'_>,
    goal: Goal,
    probes: (usize, u64),
    bounced: Option<Bounced<'_>>,
    draw: impl FnMut(&Quality, &OracleThreads) -> Result<Drawn>,
) -> Result<Chosen> {
    let (name, bound) = match goal {
        Goal::MaxError(most) => ("max_error", most),
        Goal::MaxCost(ns) => ("time_budget", ns / 1e6),
    };
    if !(bound > 0.0 && bound.is_finite()) {
        return Err(Error::setting(name, bound.to_string(), "a number above 0"));
    }
    OracleLight::with(lit, |oracle| choose_by(oracle, goal, probes, bounced, draw))
}

fn choose_by(
    oracle: &OracleLight<'_>,
    goal: Goal,
    (probes, seed): (usize, u64),
    bounced: Option<Bounced<'_>>,
    mut draw: impl FnMut(&Quality, &OracleThreads) -> Result<Drawn>,
) -> Result<Chosen> {
    // A third of the probes does not depend on the pictures.
    Probes::request(oracle, first_count(probes, bounced.is_some()), seed, None)?;
    let mut draw = |quality: &Quality| draw(quality, oracle.threads());
    let scene = oracle.scene();
    let count = bounced.as_ref().map_or(0, |b| b.count);
    let mut chooser = Chooser::new(scene, &Statistics::of(scene), goal, count);
    let (pilots, mut refused) = (pilots(scene, count), None);
    let mut pictures: [Option<Drawn>; 3] = [const { None }; 3];
    for (k, quality) in pilots.iter().enumerate() {
        let of_defaults = pictures[0].as_ref().map(Drawn::ns);
        let is_affordable = |ns: f64| chooser.is_affordable(quality, (&pilots[0], ns));
        // The finer frame only helps: it is left out where the defaults do not fit or it would take too long.
        if k == 1 && !of_defaults.is_some_and(is_affordable) {
            continue;
        }
        match draw(quality) {
            Err(limit @ Error::Limit { .. }) => {
                chooser.refuse(quality);
                refused = Some(limit);
            }
            drawn => pictures[k] = Some(drawn?),
        }
    }
    let unsure = match pictures.each_ref().map(|p| p.as_ref().map(|p| p.planes.as_slice())) {
        [Some(defaults), fine, Some(coarse)] => unsure(scene, [defaults, coarse], fine),
        _ => Vec::new(),
    };
    // The coarsest do not fit either: no setting is the cause.
    if let Some(limit) = refused.filter(|_| pictures.iter().all(Option::is_none)) {
        return Err(limit);
    }
    let is_aimed = usable_sum(&unsure).is_some();
    let mut judge = Judge::new(oracle, (probes, seed), unsure, bounced, goal)?;
    let own = judge.probes.own_error();
    if let Goal::MaxError(most) = goal
        && own >= most
    {
        return Err(Error::Limit {
            what: format!("`max_error {most}`"),
            needs: "an oracle of that precision".into(),
            limit: format!(
                "{}, the difference to half of its rays{}",
                figures(own),
                if count > 0 { ", or unsampled light" } else { "" }
            ),
        });
    }
    for (quality, drawn) in pilots.iter().zip(pictures) {
        if let Some(drawn) = drawn {
            judge.take(&mut chooser, quality, drawn)?;
        }
    }
    let most = CONFIRMING_PROBES * probes;
    let fewest = if count > 0 { most } else { FEWEST_CONFIRMING.min(most) };
    for attempt in 1..=CONFIRMATIONS {
        let requested = judge.request(fewest)?;
        let is_last = attempt == CONFIRMATIONS;
        while let Some(quality) = chooser.next().or_else(|| chooser.last_resort(is_last)) {
            match draw(&quality) {
                Err(Error::Limit { .. }) => chooser.refuse(&quality),
                drawn => judge.take(&mut chooser, &quality, drawn?)?,
            }
        }
        let best = match CONFIRMATIONS - attempt {
            0 => chooser.exact(),
            1 => chooser.surest(),
            _ => chooser.best(),
        };
        let Some(best) = best else { break };
        let (quality, measured) = (best.quality, best.measured);
        let drawn = draw(&quality)?;
        let (deviations, wanted) = match count {
            0 => {
                let (deviations, known) = (Probes::FOUR_BOUNDS, judge.probes.count());
                let of = (goal, chooser.expected(&quality));
                (deviations, confirming_count(measured, known, of, deviations, most))
            }
            _ => (Probes::EIGHT_BOUNDS, most),
        };
        let fresh = judge.confirming(requested, wanted)?;
        let measured = fresh.error(&drawn.planes, judge.control(), deviations);
        let trial = chooser.confirmed(&quality, measured, drawn.ns()).copied();
        if let Some(trial) = trial.filter(|t| goal.is_reached(t)) {
            return Ok(Chosen {
                trial,
                expected: chooser.expected(&quality),
                probes: fresh.count(),
                paths: if count > 0 { judge.batches * REFERENCE_BATCH } else { 0 },
                confidence: (is_aimed || fresh.is_whole()).then_some(Probes::CONFIDENCE),
                trials: chooser.trials().to_vec(),
            });
        }
        judge.probes.extend(&fresh);
        judge.judge(&mut chooser);
    }
    Err(out_of_reach(goal, &chooser, judge.probes.count(), scene))
}

fn out_of_reach(goal: Goal, chooser: &Chooser, probes: usize, scene: &Scene) -> Error {
    let trials = chooser.trials();
    let miss = |t: &Trial| match goal {
        Goal::MaxError(_) => t.measured.at_most,
        Goal::MaxCost(_) => t.ns,
    };
    // Settings that reached the goal in the search, but not in the confirming frame, are not the nearest.
    let reached = |trial: &Trial| goal.is_reached(trial);
    let Some(nearest) =
        trials.iter().min_by(|a, b| reached(a).cmp(&reached(b)).then(miss(a).total_cmp(&miss(b))))
    else {
        return Error::Limit {
            what: "choosing settings".into(),
            needs: "settings that fit the device".into(),
            limit: "its memory".into(),
        };
    };
    let flags = flags(&nearest.quality, scene);
    match goal {
        Goal::MaxError(most) => Error::Limit {
            what: format!("`max_error {most}`"),
            needs: chooser.lacks(),
            limit: format!(
                "{}, the nearest found ({flags}; measured {}, by {probes} probes)",
                figures(nearest.measured.at_most),
                figures(nearest.measured.error)
            ),
        },
        Goal::MaxCost(ns) => Error::Limit {
            what: format!("`time_budget {}`", ns / 1e6),
            needs: format!("{} ms a frame ({flags})", figures(nearest.ns / 1e6)),
            limit: format!("{} ms", ns / 1e6),
        },
    }
}

/// Three figures, without an exponent.
fn figures(x: f64) -> String {
    let decimals = if x > 0.0 { 2.0 - x.log10().floor() } else { 0.0 };
    format!("{x:.*}", decimals.clamp(0.0, 12.0) as usize)
}

/// Chosen settings that affect the scene, as "`lines 1` `azimuths 64`".
pub fn flags(quality: &Quality, scene: &Scene) -> String {
    let geometry: &[&str] = match (quality.method, quality.lines) {
        (Method::BruteForce, _) => &["method"],
        (Method::Pyramid, _) => &["method", "level_step", "level_offset"],
        (_, Lines::Exact) => &["lines"],
        _ => &["lines", "fuse"],
    };
    let mut names: Vec<&str> = Vec::new();
    for part in PARTS.into_iter().filter(|p| p.is_in(scene)) {
        names.extend(match part {
            Part::Geometry => geometry,
            Part::Azimuths => &["azimuths"],
            Part::Table if quality.basis == Basis::Sh => &["basis", "sh_order"],
            Part::Table => &["table_elevations"],
            Part::Strips => &["sun_azimuths"],
        });
    }
    if quality.bounces.count > 0 {
        let bounces = ["bounces", "bounce_engine", "bounce_azimuths", "bounce_cutoff", "subsample"];
        names.extend(bounces);
        if has_specular(scene) {
            names.push("sh_order");
        }
    }
    let all = names.iter().filter_map(|name| setting(name));
    let all: Vec<_> = all.map(|s| format!("`{} {}`", s.name, s.get(quality))).collect();
    all.join(" ")
}

#[cfg(test)]
mod tests;

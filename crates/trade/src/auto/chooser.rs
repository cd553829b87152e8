//! Which settings to render next, and which to choose.

use std::cmp::Ordering;

use super::candidates::{candidates, is_exact, is_finer};
use super::model::{Costs, Model};
use super::probes::Measured;
use super::statistics::Statistics;
use crate::trade::Goal;
use ridgelight::scene::{BounceEngine, Bounces, Quality, Scene};

/// Most frames to try, and most exact ones beyond them.
const TRIALS: usize = 16;
const RESORTS: usize = 2;
/// Margins within the error after two estimates were too low.
const MARGIN: f64 = 1.5;
/// Factor between two times of the same settings that counts as timing noise.
const TIMING_NOISE: f64 = 1.25;
/// Least expected gain of a further frame, in ln of cost or error.
const WORTH: f64 = 0.05;
/// Accuracy of the control relative to the goal: aimed for, and required, unless this many frames
/// miss it; and its highest cost over that of the settings expected to reach the goal.
const CONTROL: f64 = 3.0;
const COARSEST_CONTROL: f64 = 2.0;
const CONTROLS: usize = 5;
const DEAREST_CONTROL: f64 = 6.0;
/// If nothing is expected to reach the goal: how much less accurate than the best the next frame
/// may be, if it is faster.
const NEARLY: f64 = 2.0;
/// Frames expected to take longer are not rendered: half a minute.
const LONGEST_NS: f64 = 30e9;

impl Goal {
    /// Whether a trial reaches the goal: an error by its bound, not by its estimate.
    pub fn is_reached(&self, trial: &Trial) -> bool {
        match self {
            Goal::MaxError(most) => trial.measured.at_most <= *most,
            Goal::MaxCost(most) => trial.ns <= *most && trial.measured != Measured::UNKNOWN,
        }
    }

    /// Whether a trial certainly misses the goal: an error by a margin below its estimate as large
    /// as its bound's above; a time by more than the timing noise.
    pub fn is_missed(&self, trial: &Trial) -> bool {
        match self {
            Goal::MaxError(most) => 2.0 * trial.measured.error - trial.measured.at_most > *most,
            Goal::MaxCost(most) => trial.ns > TIMING_NOISE * *most,
        }
    }
}

/// Rendered settings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// The settings.
    pub quality: Quality,
    /// Their error at the probes.
    pub measured: Measured,
    /// Nanoseconds per frame.
    pub ns: f64,
}

/// Searches settings for a goal: [`next`](Self::next) returns what to render,
/// [`drawn`](Self::drawn) and [`judged`](Self::judged) take the results.
#[derive(Clone, Debug)]
pub struct Chooser<'a> {
    scene: &'a Scene,
    goal: Goal,
    model: Model,
    first_guess: Model,
    costs: Costs,
    candidates: Vec<Quality>,
    trials: Vec<Trial>,
}

impl<'a> Chooser<'a> {
    /// For a scene with this many bounces and its [`Statistics`].
    pub fn new(scene: &'a Scene, statistics: &Statistics, goal: Goal, bounces: u32) -> Self {
        let model = Model::of(scene, statistics, bounces);
        let grid_points = scene.field.rows() * scene.field.cols();
        Self {
            scene,
            goal,
            first_guess: model.clone(),
            model,
            costs: Costs::guessed(grid_points),
            candidates: candidates(scene, bounces),
            trials: Vec::new(),
        }
    }

    /// Settings to render next; none where nothing is expected to improve on [`best`](Self::best).
    pub fn next(&self) -> Option<Quality> {
        if self.trials.len() >= TRIALS {
            return None;
        }
        match self.goal {
            Goal::MaxError(most) => self.next_within(most),
            Goal::MaxCost(most) => {
                let next = self.least(|q| self.cost(q) <= most, Self::error);
                match self.best().map(|best| (1.0 - WORTH) * best.measured.error) {
                    Some(worth) => next.filter(|q| self.error(q) < worth),
                    None => next.or_else(|| self.least(|_| true, Self::cost)),
                }
            }
        }
    }

    /// First a control for [`Probes::error`](super::Probes::error), finer than the goal; then the
    /// fastest settings expected to reach the goal, or else the most accurate.
    fn next_within(&self, most: f64) -> Option<Quality> {
        let is_controlled = self.trials.iter().any(|t| t.measured.error <= most / COARSEST_CONTROL);
        if !is_controlled && self.trials.len() < CONTROLS {
            return self.control(most);
        }
        let most = most / self.doubt();
        let Some(best) = self.best() else {
            return self.fastest_within(most).or_else(|| self.most_accurate());
        };
        // An error below the noise of its probes hardly changes the model, but its bound holds. Settings that are coarser
        // in every respect are then expected to err in proportion to that bound.
        let most_of_best = (best.measured.at_most / self.error(&best.quality)).min(1.0);
        // Expected saving, in ln, times the probability of reaching the goal.
        let gain = |q: &Quality| {
            let expected = self.model.expected(q);
            let scale = if is_finer(&best.quality, q) { most_of_best } else { 1.0 };
            let deviations =
                (most / (scale * expected.error)).ln() / expected.factor.ln().max(0.05);
            (best.ns / self.cost(q)).ln().max(0.0) * normal(deviations)
        };
        let gains = self.open().map(|q| (gain(q), q));
        let (gain, next) = gains.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (gain > WORTH).then_some(*next)
    }

    /// A control frame: finer than the goal, unless that is too slow.
    fn control(&self, most: f64) -> Option<Quality> {
        let Some(holds) = self.fastest_within(most) else { return self.most_accurate() };
        let affordable = |q: &Quality| self.cost(q) <= DEAREST_CONTROL * self.cost(&holds);
        let fine = self.fastest_within(most / CONTROL).filter(affordable);
        fine.or_else(|| self.least(affordable, Self::error))
    }

    /// Records nanoseconds of a frame by pass label; [`judged`](Self::judged) records its error.
    pub fn drawn(&mut self, quality: &Quality, passes: &[(String, f64)]) {
        let ns = passes.iter().map(|p| p.1).sum();
        self.costs.learn(self.scene, quality, passes);
        self.trials.push(Trial { quality: *quality, measured: Measured::UNKNOWN, ns });
    }

    /// Records errors of all rendered settings, in order; none where one is unchanged.
    pub fn judged(&mut self, measured: &[Option<Measured>]) {
        self.model = self.first_guess.clone();
        for (trial, measured) in self.trials.iter_mut().zip(measured) {
            trial.measured = measured.unwrap_or(trial.measured);
            if trial.measured != Measured::UNKNOWN {
                let Measured { error, at_most } = trial.measured;
                // `at_most` is 2.7 or more standard deviations above, in ln about that much of it.
                let spread = (at_most / error.max(1e-6)).max(1.0).ln() / 2.7;
                self.model.learn(&trial.quality, error, spread);
            }
        }
        self.model.share_residuals();
    }

    /// Records error and nanoseconds of settings rendered again.
    pub fn confirmed(&mut self, quality: &Quality, measured: Measured, ns: f64) -> Option<&Trial> {
        let trial = self.trials.iter_mut().find(|t| t.quality == *quality)?;
        (trial.measured, trial.ns) = (measured, ns);
        Some(trial)
    }

    /// Settings to render where nothing reaches the goal, or all choices were refuted: exact
    /// horizons that are well expected to reach it, since they have no errors confined to few
    /// texels; with bounces, those at every texel with its own visibility. None where one reaches
    /// the goal.
    pub fn last_resort(&self, has_failed: bool) -> Option<Quality> {
        let Goal::MaxError(most) = self.goal else { return None };
        let is_held = |t: &Trial| self.goal.is_reached(t) && (!has_failed || is_surest(&t.quality));
        if self.trials.len() >= TRIALS + RESORTS || self.trials.iter().any(is_held) {
            return None;
        }
        let enough = (most / CONTROL).max(self.error(&self.least(is_surest, Self::error)?));
        self.least(|q| is_surest(q) && self.error(q) <= enough, Self::cost)
    }

    /// The fastest rendered settings well within the error, else those of the least error.
    pub fn surest(&self) -> Option<&Trial> {
        self.surest_of(|_| true)
    }

    /// The same among exact horizons, where any reach the goal.
    pub fn exact(&self) -> Option<&Trial> {
        self.surest_of(|t| is_surest(&t.quality)).or_else(|| self.surest())
    }

    fn surest_of(&self, is_wanted: impl Fn(&Trial) -> bool) -> Option<&Trial> {
        let Goal::MaxError(most) = self.goal else { return self.best() };
        let all = || self.reached().filter(|t| is_wanted(t));
        let well = all().filter(|t| MARGIN * t.measured.at_most <= most);
        well.min_by(|a, b| a.ns.total_cmp(&b.ns)).or_else(|| all().min_by(by_error))
    }

    fn reached(&self) -> impl Iterator<Item = &Trial> {
        self.trials.iter().filter(|t| self.goal.is_reached(t))
    }

    /// Whether some rendered settings may improve on [`best`](Self::best), by their estimate: more
    /// probes would decide.
    pub fn is_undecided(&self) -> bool {
        let Goal::MaxError(most) = self.goal else { return false };
        let best_ns = self.best().map_or(f64::INFINITY, |b| b.ns);
        let may = |t: &Trial| t.measured.error <= most && most < t.measured.at_most;
        self.trials.iter().any(|t| may(t) && t.ns < best_ns)
    }

    /// Whether a trial's picture may still be needed: it is the best so far, or may become it.
    pub fn may_be_best(&self, trial: &Trial) -> bool {
        let Some(best) = self.best() else { return !self.goal.is_missed(trial) };
        let is_better = match self.goal {
            Goal::MaxError(_) => trial.ns <= best.ns,
            Goal::MaxCost(_) => trial.measured.at_most <= best.measured.at_most,
        };
        is_better && !self.goal.is_missed(trial)
    }

    /// Excludes settings that cannot be rendered, and all that are at least as slow in every
    /// setting.
    pub fn refuse(&mut self, quality: &Quality) {
        self.candidates.retain(|q| !is_finer(q, quality));
    }

    /// The best rendered settings that reach the goal; none where nothing does.
    pub fn best(&self) -> Option<&Trial> {
        match self.goal {
            Goal::MaxError(_) => self.reached().min_by(|a, b| a.ns.total_cmp(&b.ns)),
            Goal::MaxCost(_) => self.reached().min_by(by_error),
        }
    }

    /// For a refusal: what ended the search.
    pub fn lacks(&self) -> String {
        let is_drawn = |q: &Quality| self.trials.iter().any(|t| t.quality == *q);
        if self.trials.len() >= TRIALS {
            format!("more than {} frames, the most that are tried", self.trials.len())
        } else if self.candidates.iter().any(|q| !is_drawn(q) && self.cost(q) > LONGEST_NS) {
            format!("frames that are expected to take more than {} s each", LONGEST_NS / 1e9)
        } else {
            "finer settings than are chosen among".into()
        }
    }

    /// All trials, in order.
    pub fn trials(&self) -> &[Trial] {
        &self.trials
    }

    /// Expected error of settings before anything was rendered.
    pub fn expected(&self, quality: &Quality) -> super::Expected {
        self.first_guess.expected(quality)
    }

    /// Expected nanoseconds of a frame.
    pub fn cost(&self, quality: &Quality) -> f64 {
        self.costs.expected_ns(self.scene, quality)
    }

    /// Whether a frame is rendered at all: not if it is expected to take too long, by the time of another.
    pub fn is_affordable(&self, quality: &Quality, (other, ns): (&Quality, f64)) -> bool {
        ns * self.cost(quality) / self.cost(other) <= LONGEST_NS
    }

    fn error(&self, quality: &Quality) -> f64 {
        self.model.expected(quality).error
    }

    /// How far bounds lie above estimates, by the last frame that was not its own control. Frames with values beyond f32
    /// have neither and are left out.
    fn doubt(&self) -> f64 {
        let mut last = self.trials.iter().skip(1).rev();
        let last = last.find(|t| t.measured != Measured::UNKNOWN);
        last.map_or(1.05, |t| t.measured.at_most / t.measured.error.max(1e-12)).clamp(1.0, 1.5)
    }

    /// Not rendered, and not known to miss the goal: settings no finer in any respect than some
    /// with an estimate beyond the error, or no coarser than some beyond the time.
    fn open(&self) -> impl Iterator<Item = &Quality> {
        self.candidates.iter().filter(|q| {
            let is_open = |t: &Trial| {
                let misses_too = match self.goal {
                    Goal::MaxError(_) => is_finer(&t.quality, q),
                    Goal::MaxCost(_) => is_finer(q, &t.quality),
                };
                t.quality != **q && !(self.goal.is_missed(t) && misses_too)
            };
            self.cost(q) <= LONGEST_NS && self.trials.iter().all(is_open)
        })
    }

    fn fastest_within(&self, most: f64) -> Option<Quality> {
        self.least(|q| self.error(q) <= most, Self::cost)
    }

    /// Open settings with the least cost or error of some.
    fn least(
        &self,
        is_wanted: impl Fn(&Quality) -> bool,
        of: fn(&Self, &Quality) -> f64,
    ) -> Option<Quality> {
        let wanted = self.open().filter(|q| is_wanted(q));
        wanted.min_by(|a, b| of(self, a).total_cmp(&of(self, b))).copied()
    }

    /// The fastest of those nearly as accurate as the best.
    fn most_accurate(&self) -> Option<Quality> {
        let best = self.least(|_| true, Self::error)?;
        self.fastest_within(NEARLY * self.error(&best))
    }
}

/// Exact horizons, and bounces at every texel without averages instead of exact visibility.
fn is_surest(quality: &Quality) -> bool {
    let Bounces { count, engine, .. } = quality.bounces;
    is_exact(quality) && (count == 0 || quality.subsample == 1 && engine != BounceEngine::Pyramid)
}

/// The normal distribution, to 0.01, by a logistic one (Bowling et al. 2009).
fn normal(deviations: f64) -> f64 {
    1.0 / (1.0 + (-1.702 * deviations).exp())
}

fn by_error(a: &&Trial, b: &&Trial) -> Ordering {
    a.measured.at_most.total_cmp(&b.measured.at_most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::auto::tests::under_sky;
    use crate::trade::start;
    use ridgelight::scene::Method;

    fn of(azimuths: u32) -> Quality {
        Quality { method: Method::BruteForce, azimuths, ..start() }
    }

    /// Of 512 and 1024 azimuths, for a goal of 2 %. The model expects an error of 0.9 % in 1024.
    fn fresh(scene: &Scene) -> Chooser<'_> {
        let mut fresh = Chooser::new(scene, &Statistics::of(scene), Goal::MaxError(0.02), 0);
        fresh.candidates = vec![of(512), of(1024)];
        (0..20).for_each(|_| fresh.first_guess.learn(&of(1024), 0.009, 0.0));
        fresh
    }

    /// The model expects an error of 0.9 % in 1024 azimuths and of 1.7 % in 512. The frame of 1024 has no error above the
    /// noise and a bound of 0.6 %, so 512 are expected to have 1.1 %. They are rendered for a goal of 2 %, of which doubt
    /// leaves 1.3 %. With a bound of 0.9 % they are not.
    #[test]
    fn a_bound_far_below_the_goal_steps_back() {
        let scene = under_sky(12, 12);
        let fresh = fresh(&scene);
        for (at_most, next) in [(0.006, Some(of(512))), (0.009, None)] {
            let mut chooser = fresh.clone();
            for (quality, ns) in [(start(), 1e6), (of(1024), 1e9)] {
                chooser.drawn(&quality, &[("horizon_march".to_owned(), ns)]);
            }
            let rough = Measured { error: 0.13, at_most: 0.13 };
            chooser.judged(&[Some(rough), Some(Measured { error: 0.0, at_most })]);
            let expected = [512, 1024].map(|azimuths| chooser.error(&of(azimuths)));
            assert!((0.016..0.019).contains(&expected[0]), "{expected:?}");
            assert!((0.0085..0.0095).contains(&expected[1]), "{expected:?}");
            assert_eq!(chooser.next(), next);
        }
    }

    /// As above with a bound of 0.6 %: a later frame with values beyond f32 changes neither the doubt nor what is rendered next.
    #[test]
    fn frames_beyond_f32_do_not_end_the_search() {
        let scene = under_sky(12, 12);
        let mut chooser = fresh(&scene);
        let rough = Measured { error: 0.13, at_most: 0.13 };
        let fine = Measured { error: 0.0, at_most: 0.006 };
        for (quality, ns) in [(start(), 1e6), (of(1024), 1e9), (of(8), 1e9 / 128.0)] {
            chooser.drawn(&quality, &[("horizon_march".to_owned(), ns)]);
        }
        chooser.judged(&[Some(rough), Some(fine), Some(Measured::UNKNOWN)]);
        assert_eq!(chooser.doubt(), 1.5);
        assert_eq!(chooser.next(), Some(of(512)));
    }
}

//! Answers to input: the light of coarse grids on the slopes of a finer one; and the full light in parts once input
//! rests.

use std::ops::Range;
use std::panic::resume_unwind;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use ridgelight::Result;
use ridgelight::gpu::{Frame, Timing, Work};
use ridgelight::plan::{Limits, Plan, Rectangle};
use ridgelight::scene::Scene;
use ridgelight_viewer::Screen;

use super::super::brush::together;
use super::super::smaller::Blocks;
use super::super::state::State;
use super::drawing::{replan, whole};
use super::level::{
    GRIDS, Ground, Level, SKY, SLOPES, SUN, grid_work, plan_levels, plan_next, work,
};
use crate::render;
use crate::setup::total_ns;

/// Intended GPU times of a preview's grids: with drawing and copies, 15 pictures per second.
const INTENDED_MS: [f64; GRIDS] = [6.0, 12.0, 24.0];
/// The part of the slopes' time that is left where a camera draws a mesh.
const WITH_MESH: f64 = 0.4;
/// The parts of those times that do not grow with the grid: tables of the sky, starts of passes.
const FIXED_MS: [f64; GRIDS] = [2.0, 1.0, 0.0];
/// GPU time of a part of the full light.
const PART_MS: f64 = 40.0;
/// Full light that takes no longer needs no preview.
const ANSWER_MS: f64 = 50.0;
/// Shortest side of a coarser grid, grid points.
const LEAST_GRID: usize = 32;
/// Refinement begins when input has rested for so long.
pub(super) const REST: Duration = Duration::from_millis(120);

/// Shares of the time aimed at where a preview keeps its grids: while input goes on, and at rest.
const DRAGGED: Range<f64> = 0.0..3.0;
const RESTED: Range<f64> = 0.4..1.4;

/// What a device does in a millisecond: texels times azimuths of the full light; of the grids' light, and texels of slopes.
#[derive(Clone, Copy)]
struct Rates {
    full: f64,
    grids: [f64; GRIDS],
}

/// Before anything was measured: lavapipe on two cores; a GPU.
const CPU_RATES: Rates = Rates { full: 5e4, grids: [1e5, 1e5, 5.5e4] };
const GPU_RATES: Rates = Rates { full: 1e7, grids: [2e7; GRIDS] };

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// Plans the full light.
    Begin,
    /// Its passes from this one on.
    Passes(usize),
    Nothing,
}

/// Slots whose GPU times are still to be read.
#[derive(Clone, Copy)]
enum Running {
    Preview([Option<usize>; GRIDS]),
    Full(usize),
}

pub struct Preview {
    levels: Option<[Level; GRIDS]>,
    /// Other grids that a thread makes, during a drag or at rest.
    next_grids: Option<JoinHandle<Result<[Ground; GRIDS]>>>,
    /// The thread that computes the error of the last preview.
    next_error: Option<JoinHandle<Option<f64>>>,
    /// Whether the preview is shown.
    is_shown: bool,
    next: Next,
    /// Since when the input rests.
    changed: Instant,
    rates: Rates,
    running: Option<Running>,
    /// Times of the passes of the refinement so far.
    times: Vec<Timing>,
    /// Whether the device gave no times of some part of it.
    lacks_times: bool,
    complete_times: Option<Vec<Timing>>,
    /// Edited since the full light was computed, if nothing else has changed.
    edited: Option<Rectangle>,
    /// Edited while no preview was in use: the levels lack it.
    missed: Option<Rectangle>,
    is_full_stale: bool,
    /// Sides of the grids' blocks where a script gives them. Times then decide nothing.
    fixed: Option<[usize; GRIDS]>,
    /// Seconds from the last input to the full light.
    pub full_s: Option<f64>,
    /// Error against the full light when both were last computed: RMSE over the mean.
    pub error: Option<f64>,
}

impl Preview {
    pub fn new(is_cpu: bool) -> Self {
        Self {
            levels: None,
            next_grids: None,
            next_error: None,
            is_shown: false,
            next: Next::Nothing,
            changed: Instant::now(),
            rates: if is_cpu { CPU_RATES } else { GPU_RATES },
            running: None,
            times: Vec::new(),
            lacks_times: false,
            complete_times: None,
            edited: None,
            missed: None,
            is_full_stale: true,
            fixed: None,
            full_s: None,
            error: None,
        }
    }

    /// Whether full light is too slow to answer input.
    pub fn is_needed(&self, state: &State) -> bool {
        let field = &state.scene.field;
        let ms = work(&state.scene, &state.quality, 1) / self.rates.full;
        let is_slow = self.fixed.is_some() || ms > ANSWER_MS;
        !state.is_split && field.rows().min(field.cols()) >= 2 * LEAST_GRID && is_slow
    }

    /// Fixes the grids by the sides of their blocks: sky, sun, slopes.
    pub fn fix(&mut self, sides: Option<[usize; GRIDS]>) {
        self.fixed = sides;
    }

    /// An edit that no preview shows.
    pub fn miss(&mut self, at: Rectangle) {
        self.missed = Some(self.missed.map_or(at, |all| together(all, at)));
        self.next_grids = None;
    }

    /// Shows the full light from now on. Returns whether it must be computed.
    pub fn leave(&mut self) -> bool {
        (self.is_shown, self.next) = (false, Next::Nothing);
        let is_stale = self.is_full_stale || self.edited.is_some();
        (self.is_full_stale, self.edited) = (false, None);
        is_stale
    }

    /// Whether the full light is not the current one where no preview is shown.
    pub fn is_old(&self) -> bool {
        self.is_shown || self.edited.is_some()
    }

    /// Whether work is left for a picture at rest.
    pub fn is_busy(&self) -> bool {
        self.next != Next::Nothing
    }

    /// Whether work is left for the panel or for the next input.
    pub fn has_more(&self) -> bool {
        self.next_error.is_some() || self.next_grids.is_some() || self.has_new_grids()
    }

    /// Whether grids were made that have not been lit yet.
    fn has_new_grids(&self) -> bool {
        self.levels.iter().flatten().any(|level| level.is_used() && level.runs == 0)
    }

    /// Whether the preview is shown.
    pub fn is_shown(&self) -> bool {
        self.is_shown
    }

    /// The preview, where it is shown.
    pub fn lit(&mut self) -> Option<(&mut Frame, &Scene, Blocks)> {
        let [.., slopes] = self.levels.as_mut().filter(|_| self.is_shown)?;
        let Level { lit, scene, blocks, .. } = slopes;
        lit.as_mut().map(|lit| (lit, &*scene, *blocks))
    }

    /// How the shown light was computed.
    pub fn line(&self) -> Option<String> {
        let levels = self.levels.as_ref().filter(|_| self.is_shown)?;
        let [sky, sun, slopes] = levels
            .each_ref()
            .map(|level| format!("{} x {}", level.scene.field.cols(), level.scene.field.rows()));
        let sun = match levels[SUN].scene.lights.suns.is_empty() {
            true => String::new(),
            false => format!(", sun of {sun}"),
        };
        let error = self
            .error
            .map_or_else(String::new, |e| format!(", RMSE {:.1} % at the last rest", 100.0 * e));
        Some(format!("preview: sky of {sky}{sun}, slopes of {slopes}{error}"))
    }

    /// The share of the full light that is done, where it is being computed.
    pub fn progress(&self, full: Option<&Frame>) -> Option<f32> {
        match self.next {
            Next::Nothing => None,
            Next::Begin => Some(0.0),
            Next::Passes(done) => {
                Some(done as f32 / full.map_or(1, |lit| lit.plan().passes.len().max(1)) as f32)
            }
        }
    }

    /// Lights the preview with the state's lights and heights; the full light follows later.
    pub fn restart(
        &mut self,
        screen: &mut Screen,
        state: &State,
        limits: &Limits,
        (edited, has_new_light): (Option<Rectangle>, bool),
    ) -> Result<()> {
        self.read_times(state, &mut None);
        self.edited = match (edited, self.edited) {
            (Some(a), Some(b)) => Some(together(a, b)),
            (a, b) => a.or(b),
        };
        self.is_full_stale |= has_new_light || state.is_moving();
        self.times.clear();
        self.lacks_times = false;
        if edited.is_some() || state.is_moving() {
            self.next_grids = None;
        }
        self.fit(screen, state, edited.is_some())?;
        self.changed = Instant::now();
        let missed = self.missed.take();
        let edited = edited.zip(missed).map(|(a, b)| together(a, b)).or(edited).or(missed);
        let levels = self.levels.as_mut().expect("made by fit");
        levels.iter_mut().try_for_each(|level| level.take(state, (edited, has_new_light)))?;
        self.running = Some(Running::Preview(run_levels(levels, screen, state, limits)?));
        self.is_shown = true;
        self.next = if state.is_moving() { Next::Nothing } else { Next::Begin };
        Ok(())
    }

    /// Starts a thread that makes the grids of the first preview, if there will be one.
    pub fn prepare(&mut self, state: &State) {
        if self.is_needed(state)
            && let Some(sides) = self.other_grids(state, DRAGGED)
        {
            self.start_grids(state, sides);
        }
    }

    /// Whether the thread that makes grids still runs.
    pub fn makes_grids(&self) -> bool {
        self.next_grids.as_ref().is_some_and(|thread| !thread.is_finished())
    }

    /// Makes the levels if there are none and no thread has made them. If the present ones are too slow for a drag, a thread makes
    /// others, and the first input after it finishes uses them. Edited and animated heights, and sides that a script gives, wait for
    /// new levels.
    fn fit(&mut self, screen: &mut Screen, state: &State, is_edited: bool) -> Result<()> {
        let Some(sides) = self.other_grids(state, DRAGGED) else { return Ok(()) };
        let waits = self.fixed.is_some() || state.is_moving() || is_edited;
        if waits {
            self.next_grids = None;
        }
        if let Some(grounds) = finished(&mut self.next_grids) {
            let grounds = grounds?;
            self.end(screen)?;
            self.levels = Some(levels_of(grounds));
        } else if waits || self.levels.is_none() {
            self.end(screen)?;
            self.next_grids = None;
            self.levels = Some(levels_of(grounds(&state.scene, sides)?));
        } else {
            self.start_grids(state, sides);
        }
        Ok(())
    }

    /// Starts a thread that makes other grids, unless one is running.
    fn start_grids(&mut self, state: &State, sides: [usize; GRIDS]) {
        if self.next_grids.is_none() {
            let scene = state.scene.clone();
            self.next_grids = Some(std::thread::spawn(move || grounds(&scene, sides)));
        }
    }

    /// Sides of the blocks of grids that fit the time, unless those in use are kept.
    fn other_grids(&self, state: &State, kept_at: Range<f64>) -> Option<[usize; GRIDS]> {
        let field = &state.scene.field;
        let most = (field.rows().min(field.cols()) / LEAST_GRID).max(1);
        // Shares of the intended time.
        let share = |of: usize, side: usize| {
            let ms = grid_work(&state.scene, &state.quality, of, side) / self.rates.grids[of];
            let left = if of == SLOPES && state.has_camera() { WITH_MESH } else { 1.0 };
            (FIXED_MS[of] + ms) / (left * INTENDED_MS[of])
        };
        let least = |of: usize| (1..most).find(|side| share(of, *side) <= 1.0).unwrap_or(most);
        let slopes = least(SLOPES);
        let coarse = |of: usize| least(of).max(slopes);
        let wanted = self.fixed.unwrap_or_else(|| [coarse(SKY), coarse(SUN), slopes]);
        let kept = self.levels.as_ref().map(|levels| levels.each_ref().map(|l| l.blocks.side));
        // Other grids take a third of a second of the host, so the present ones are kept while they roughly fit, longest in a drag.
        let is_kept = kept.is_some_and(|kept| {
            let fits = |of: usize| kept[of] <= most && kept_at.contains(&share(of, kept[of]));
            kept == wanted || self.fixed.is_none() && (0..GRIDS).all(fits)
        });
        (!is_kept).then_some(wanted)
    }

    /// Continues the change to other grids: takes them once they are made, then plans one at a time and lights each once, as a
    /// driver may compile the shaders only then.
    fn change_grids(&mut self, screen: &mut Screen, state: &State, limits: &Limits) -> Result<()> {
        if let Some(grounds) = finished(&mut self.next_grids) {
            let grounds = grounds?;
            self.end(screen)?;
            let levels = self.levels.insert(levels_of(grounds));
            return levels.iter_mut().try_for_each(|level| level.take(state, (None, true)));
        }
        let is_new = self.has_new_grids();
        if let Some(levels) = self.levels.as_mut().filter(|_| is_new)
            && !plan_next(levels, screen, state, limits)?
        {
            run_levels(levels, screen, state, limits)?;
        }
        Ok(())
    }

    /// Goes on with the full light, by a part that keeps the device busy for about [`PART_MS`]. The device is idle.
    /// Returns whether the full light is complete.
    pub fn refine(
        &mut self,
        screen: &mut Screen,
        state: &State,
        (full, limits): (&mut Option<Frame>, &Limits),
    ) -> Result<bool> {
        self.read_times(state, full);
        self.error = finished(&mut self.next_error).unwrap_or(self.error);
        match self.next {
            Next::Nothing => self.change_grids(screen, state, limits).map(|()| false),
            Next::Begin if self.changed.elapsed() < REST => Ok(false),
            Next::Begin => self.begin_full(screen, state, (full, limits)).map(|()| false),
            Next::Passes(done) => {
                let lit = full.as_mut().expect("planned");
                if done < lit.plan().passes.len() {
                    return self.run_part(screen, state, (lit, done)).map(|()| false);
                }
                self.complete(screen, state, lit).map(|()| true)
            }
        }
    }

    /// Plans the full light, or edits it at once.
    fn begin_full(
        &mut self,
        screen: &mut Screen,
        state: &State,
        (full, limits): (&mut Option<Frame>, &Limits),
    ) -> Result<()> {
        let plan = in_parts(state, limits, self.rates.full)?;
        let is_new = replan(screen, full, plan, &state.scene)?;
        let lit = full.as_mut().expect("made by replan");
        let field = &state.scene.field;
        let can_edit = !is_new && !self.is_full_stale && !lit.plan().edit_passes.is_empty();
        if let (Some(at), true) = (self.edited, can_edit) {
            let heights = Some((field.heights_m(), at));
            self.running =
                Some(Running::Full(screen.light(lit, heights, (Work::Edit(at), &[]))?));
            self.next = Next::Passes(lit.plan().passes.len());
            return Ok(());
        }
        self.is_full_stale = true;
        self.next = Next::Passes(0);
        Ok(())
    }

    fn run_part(
        &mut self,
        screen: &mut Screen,
        state: &State,
        (lit, done): (&mut Frame, usize),
    ) -> Result<()> {
        let passes = lit.plan().passes.len();
        let ms = work(&state.scene, &state.quality, 1) / self.rates.full / passes as f64;
        let count = (PART_MS / ms).clamp(1.0, passes as f64) as usize;
        let part: Vec<usize> = (done..(done + count).min(passes)).collect();
        let field = &state.scene.field;
        let heights = (done == 0).then(|| (field.heights_m(), whole(field)));
        let slot = screen.light(lit, heights, (Work::Passes(&part), &[]))?;
        self.running = Some(Running::Full(slot));
        self.next = Next::Passes(done + part.len());
        Ok(())
    }

    /// Shows the full light. Threads measure the preview against it and make other grids.
    fn complete(&mut self, screen: &mut Screen, state: &State, lit: &Frame) -> Result<()> {
        (self.is_shown, self.next) = (false, Next::Nothing);
        (self.edited, self.is_full_stale) = (None, false);
        self.full_s = Some(self.changed.elapsed().as_secs_f64());
        if let Some([.., Level { blocks, lit: Some(fine), .. }]) = &self.levels {
            let full = screen.gpu().pixels(lit, 0)?;
            let ours = screen.gpu().pixels(fine, 0)?;
            let (blocks, voids) = (*blocks, state.scene.field.voids().map(<[bool]>::to_vec));
            self.next_error = Some(std::thread::spawn(move || {
                error(&blocks, voids.as_deref(), &render::rgb(&ours), &render::rgb(&full))
            }));
        }
        // For the next input, while there is time.
        if let Some(sides) = self.other_grids(state, RESTED) {
            self.start_grids(state, sides);
        }
        Ok(())
    }

    /// Takes the times of the last part, and learns from them how fast the device is.
    fn read_times(&mut self, state: &State, full: &mut Option<Frame>) {
        let learns = self.fixed.is_none();
        let learn = |rate: &mut f64, work: f64, times: &[Timing], fixed_ms: f64| {
            // Devices without timestamps give none.
            if times.is_empty() || !learns {
                return;
            }
            let ms = (total_ns(times) / 1e6 - fixed_ms).max(0.2 * fixed_ms);
            if ms > 0.0 {
                *rate = (*rate * (work / ms)).sqrt();
            }
        };
        match self.running.take() {
            None => {}
            Some(Running::Full(slot)) => {
                let Some(lit) = full else { return };
                match lit.renderer().timings(slot) {
                    Some(times) => self.times.extend(times),
                    None => self.lacks_times = true,
                }
                let is_whole = self.next == Next::Passes(lit.plan().passes.len());
                if is_whole {
                    if self.is_full_stale && !self.lacks_times {
                        let work = work(&state.scene, &state.quality, 1);
                        learn(&mut self.rates.full, work, &self.times, 0.0);
                    }
                    self.complete_times = Some(std::mem::take(&mut self.times));
                }
            }
            Some(Running::Preview(slots)) => {
                let levels = self.levels.as_mut().filter(|levels| levels[SLOPES].runs > 1);
                let mut all = Vec::new();
                for (level, slot) in levels.into_iter().flatten().zip(slots) {
                    let lit = level.lit.as_mut().zip(slot);
                    let times = lit.and_then(|(lit, slot)| lit.renderer().timings(slot));
                    let Some(times) = times else { continue };
                    let work = grid_work(&state.scene, &state.quality, level.of, level.blocks.side);
                    // Without tables, all of the time is taken to grow with the grid.
                    let fixed_ms = if level.ran_all { FIXED_MS[level.of] } else { 0.0 };
                    learn(&mut self.rates.grids[level.of], work, &times, fixed_ms);
                    all.extend(times);
                }
                if !all.is_empty() {
                    self.complete_times = Some(all);
                }
            }
        }
    }

    /// Times of the passes of the last complete preview or full light, once.
    pub fn take_times(&mut self) -> Option<Vec<Timing>> {
        self.complete_times.take()
    }

    pub fn end(&mut self, screen: &mut Screen) -> Result<()> {
        self.running = None;
        let frames = self.levels.take().into_iter().flatten().filter_map(|level| level.lit);
        frames.map(|lit| screen.end(lit)).fold(Ok(()), Result::and)
    }
}

/// The result of a thread, once it has one.
fn finished<T>(thread: &mut Option<JoinHandle<T>>) -> Option<T> {
    let ended = thread.take_if(|thread| thread.is_finished())?;
    // Resumes the thread's panic, which has already been reported.
    Some(ended.join().unwrap_or_else(|panic| resume_unwind(panic)))
}

/// The grids of blocks of these sides.
fn grounds(scene: &Scene, sides: [usize; GRIDS]) -> Result<[Ground; GRIDS]> {
    let ground = |of: usize| Ground::new(scene, of, sides[of]);
    Ok([ground(SKY)?, ground(SUN)?, ground(SLOPES)?])
}

/// Lights the grids. Returns the slots that hold their times.
fn run_levels(
    levels: &mut [Level; GRIDS],
    screen: &mut Screen,
    state: &State,
    limits: &Limits,
) -> Result<[Option<usize>; GRIDS]> {
    let borrowed = plan_levels(levels, screen, state, limits)?;
    let mut slots = [None; GRIDS];
    for (level, slot) in levels.iter_mut().zip(&mut slots) {
        if level.is_used() {
            let borrowed = if level.of == SLOPES { borrowed.as_slice() } else { &[] };
            *slot = Some(level.run(screen, borrowed)?);
        }
    }
    Ok(slots)
}

fn levels_of([sky, sun, slopes]: [Ground; GRIDS]) -> [Level; GRIDS] {
    [Level::new(SKY, sky), Level::new(SUN, sun), Level::new(SLOPES, slopes)]
}

/// RMSE over the mean, R, G, B of the means of blocks.
fn error(
    blocks: &Blocks,
    voids: Option<&[bool]>,
    ours: &[[f32; 3]],
    full: &[[f32; 3]],
) -> Option<f64> {
    let full = blocks.means(|i| {
        let is_void = voids.is_some_and(|voids| voids[i]);
        if is_void { [0.0; 4] } else { [full[i][0], full[i][1], full[i][2], 1.0].map(f64::from) }
    });
    let (mut square, mut mean, mut count) = (0.0, 0.0, 0.0);
    for (ours, full) in ours.iter().zip(&full).filter(|(_, full)| full[3] > 0.0) {
        for c in 0..3 {
            let want = full[c] / full[3];
            square += (f64::from(ours[c]) - want).powi(2);
            mean += want;
            count += 1.0;
        }
    }
    (mean > 0.0).then(|| (square / count).sqrt() / (mean / count))
}

/// The full light in passes of few azimuths, so that input waits for about [`PART_MS`].
fn in_parts(state: &State, limits: &Limits, rate: f64) -> Result<Plan> {
    let texels = (state.scene.field.rows() * state.scene.field.cols()) as f64;
    // A sweep and its shading share the time.
    let azimuths = (2.0 * PART_MS * rate / texels).clamp(1.0, 1e6) as u32;
    let image_layers = limits.image_layers.min(azimuths.next_power_of_two());
    state.plan(&Limits { image_layers, ..*limits }).or_else(|_| state.plan(limits))
}

//! Answers to input: the light of coarse grids on the slopes of a finer one; and the full light in parts once input
//! rests.

mod grids;

use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use ridgelight::Result;
use ridgelight::gpu::{Frame, Timing, Work};
use ridgelight::plan::{Limits, Plan, Rectangle};
use ridgelight::scene::Scene;
use ridgelight_viewer::Screen;

use super::super::brush::together;
use super::super::opening::joined;
use super::super::smaller::Blocks;
use super::super::state::State;
use super::drawing::{replan, whole};
use super::level::{GRIDS, Ground, Level, SKY, SLOPES, SUN, grid_work, work};
use super::sides::{DRAG, FIXED_MS, KEPT_AT_REST, LEAST_GRID, REST, STAGES, Sides};
use crate::render;
use crate::setup::total_ns;
use grids::run_levels;

/// GPU time of a part of the full light.
const PART_MS: f64 = 40.0;
/// Full light that takes no longer needs no preview.
const ANSWER_MS: f64 = 50.0;
/// Refinement begins when input has rested for so long.
pub(super) const PAUSE: Duration = Duration::from_millis(120);

/// Assumed speeds until measured, in texels times azimuths of the full light per millisecond: lavapipe on two cores; a GPU.
const CPU_RATE: f64 = 5e4;
const GPU_RATE: f64 = 1e7;

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// Lights the rest preview, from this grid on.
    Rest(usize),
    /// Plans the full light.
    Begin,
    /// Its passes from this one on.
    Passes(usize),
    Nothing,
}

/// What a step of the refinement completed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refined {
    Nothing,
    /// The rest preview, or its grids, whose memory the panel counts.
    Grids,
    Full,
}

/// Slots whose GPU times are still to be read.
#[derive(Clone, Copy)]
enum Running {
    Preview([Option<usize>; GRIDS]),
    /// Grid and slot of the rest preview.
    Rest(usize, usize),
    Full(usize),
}

pub struct Preview {
    /// Of the drag preview and of the rest preview.
    levels: [Option<[Level; GRIDS]>; STAGES],
    pub sides: Sides,
    /// Grids of a stage that a thread makes, during a drag or at rest.
    next_grids: Option<(usize, JoinHandle<Result<[Ground; GRIDS]>>)>,
    /// Whether grids of the rest preview must be made.
    needs_rest_grids: bool,
    /// Whether they failed, or took memory that other work needed.
    rest_grids_failed: bool,
    /// The thread that computes the errors of the last previews.
    next_errors: Option<JoinHandle<[Option<f64>; STAGES]>>,
    /// The stage that is shown.
    shown: Option<usize>,
    next: Next,
    /// Since when the input rests.
    changed: Instant,
    /// Speed of the full light.
    rate: f64,
    running: Option<Running>,
    /// Times of the passes of the refinement so far.
    times: Vec<Timing>,
    /// Whether the device gave no times of some part of it.
    lacks_times: bool,
    /// Times of the passes of the last complete preview or full light, until they are taken.
    pub complete_times: Option<Vec<Timing>>,
    /// Edited since the full light was computed, if nothing else has changed.
    edited: Option<Rectangle>,
    /// Edited while no preview was in use: the levels lack it.
    missed: Option<Rectangle>,
    is_full_stale: bool,
    /// Seconds from the last input to the picture of the rest preview, if there was one, and to the full light.
    pub rest_s: Option<f64>,
    pub full_s: Option<f64>,
    /// Errors of the two previews against the full light when both were last computed: RMSE over the mean.
    pub errors: [Option<f64>; STAGES],
}

impl Preview {
    pub fn new(is_cpu: bool) -> Self {
        Self {
            levels: [None, None],
            sides: Sides::new(is_cpu),
            next_grids: None,
            needs_rest_grids: false,
            rest_grids_failed: false,
            next_errors: None,
            shown: None,
            next: Next::Nothing,
            changed: Instant::now(),
            rate: if is_cpu { CPU_RATE } else { GPU_RATE },
            running: None,
            times: Vec::new(),
            lacks_times: false,
            complete_times: None,
            edited: None,
            missed: None,
            is_full_stale: true,
            rest_s: None,
            full_s: None,
            errors: [None; STAGES],
        }
    }

    /// Whether full light is too slow to answer input.
    pub fn is_needed(&self, state: &State) -> bool {
        let field = &state.scene.field;
        let ms = work(&state.scene, &state.quality, 1) / self.rate;
        let is_slow = self.sides.are_fixed() || ms > ANSWER_MS;
        !state.is_split && field.rows().min(field.cols()) >= 2 * LEAST_GRID && is_slow
    }

    /// An edit that no preview shows.
    pub fn miss(&mut self, at: Rectangle) {
        self.missed = together(self.missed, Some(at));
        self.next_grids = None;
    }

    /// Shows the full light from now on, and frees the rest preview. Returns whether the light must be computed.
    pub fn leave(&mut self, screen: &mut Screen) -> Result<bool> {
        (self.shown, self.next) = (None, Next::Nothing);
        self.end_stage(REST, screen)?;
        let is_stale = self.is_full_stale || self.edited.is_some();
        (self.is_full_stale, self.edited) = (false, None);
        Ok(is_stale)
    }

    /// Frees the rest preview until the full light needs other memory, as other work may need it. Returns whether there was one.
    pub fn give_up_rest(&mut self, screen: &mut Screen) -> Result<bool> {
        let had_one = self.levels[REST].is_some();
        self.rest_grids_failed |= had_one;
        self.end_stage(REST, screen)?;
        Ok(had_one)
    }

    /// Whether the full light is not the current one where no preview is shown.
    pub fn is_old(&self) -> bool {
        self.shown.is_some() || self.edited.is_some()
    }

    /// Whether work is left for a picture at rest.
    pub fn is_busy(&self) -> bool {
        self.next != Next::Nothing
    }

    /// Whether work is left for the panel or for the next input.
    pub fn has_more(&self) -> bool {
        let has_grids_to_make = self.next_grids.is_some() || self.needs_rest_grids;
        let is_unlit = self.unlit(DRAG).or(self.unlit(REST)).is_some();
        self.next_errors.is_some() || has_grids_to_make || is_unlit
    }

    /// The first grid of a stage that was made but not lit yet.
    fn unlit(&self, stage: usize) -> Option<usize> {
        let levels = self.levels[stage].as_ref()?;
        levels.iter().position(|level| level.is_used() && level.runs == 0)
    }

    /// Whether a preview is shown.
    pub fn is_shown(&self) -> bool {
        self.shown.is_some()
    }

    /// Whether the rest preview comes next.
    pub fn awaits_rest_preview(&self) -> bool {
        matches!(self.next, Next::Rest(_))
    }

    /// Whether the rest preview is shown.
    pub fn shows_rest_preview(&self) -> bool {
        self.shown == Some(REST)
    }

    /// The preview, where it is shown.
    pub fn lit(&mut self) -> Option<(&mut Frame, &Scene, Blocks)> {
        let [.., slopes] = self.levels[self.shown?].as_mut()?;
        let Level { lit, scene, blocks, .. } = slopes;
        lit.as_mut().map(|lit| (lit, &*scene, *blocks))
    }

    /// Memory of all grids.
    pub fn bytes(&self) -> u64 {
        let levels = self.levels.iter().flatten().flatten();
        levels.filter_map(|level| level.lit.as_ref()).map(|lit| lit.plan().bytes()).sum()
    }

    /// How the shown light was computed.
    pub fn line(&self) -> Option<String> {
        let stage = self.shown?;
        let levels = self.levels[stage].as_ref()?;
        let [sky, sun, slopes] = levels
            .each_ref()
            .map(|level| format!("{} x {}", level.scene.field.cols(), level.scene.field.rows()));
        let sun = match levels[SUN].scene.lights.suns.is_empty() {
            true => String::new(),
            false => format!(", sun {sun}"),
        };
        let error = self.errors[stage]
            .map_or_else(String::new, |e| format!(", last measured RMSE {:.1} %", 100.0 * e));
        Some(format!("preview grids: sky {sky}{sun}, slopes {slopes}{error}"))
    }

    /// The share of the full light that is done, where it is being computed.
    pub fn progress(&self, full: Option<&Frame>) -> Option<f32> {
        match self.next {
            Next::Nothing => None,
            Next::Rest(_) | Next::Begin => Some(0.0),
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
        (self.next, self.rest_s) = (Next::Nothing, None);
        self.edited = together(edited, self.edited);
        self.is_full_stale |= has_new_light || state.is_moving();
        self.times.clear();
        self.lacks_times = false;
        if edited.is_some() || state.is_moving() {
            self.next_grids = None;
        }
        self.fit(screen, state, edited.is_some())?;
        self.changed = Instant::now();
        let missed = self.missed.take();
        if edited.is_some() || missed.is_some() || state.is_moving() {
            // Its heights are stale; it is made again after the full light.
            self.end_stage(REST, screen)?;
        }
        let edited = together(edited, missed);
        let levels = self.levels[DRAG].as_mut().expect("made by fit");
        levels.iter_mut().try_for_each(|level| level.take(state, (edited, has_new_light)))?;
        self.running = Some(Running::Preview(run_levels(levels, screen, state, limits)?));
        self.shown = Some(DRAG);
        let has_rest_preview = self.levels[REST].is_some() && self.unlit(REST).is_none();
        self.next = match has_rest_preview && self.sides.has_rest() {
            _ if state.is_moving() => Next::Nothing,
            true => Next::Rest(SKY),
            false => Next::Begin,
        };
        Ok(())
    }

    /// The next step: a grid of the rest preview, or about [`PART_MS`] of the full light. For when the device is idle. Returns what is
    /// ready to be shown.
    pub fn refine(
        &mut self,
        screen: &mut Screen,
        state: &State,
        (full, limits): (&mut Option<Frame>, &Limits),
    ) -> Result<Refined> {
        self.read_times(state, full);
        if let Some(thread) = self.next_errors.take_if(|thread| thread.is_finished()) {
            self.errors = joined(thread.join());
        }
        match self.next {
            Next::Nothing => {
                let full_bytes = full.as_ref().map_or(0, |lit| lit.plan().bytes());
                if self.change_grids(screen, state, (full_bytes, limits))? {
                    return Ok(Refined::Grids);
                }
            }
            Next::Begin | Next::Rest(_) if self.changed.elapsed() < PAUSE => {}
            Next::Rest(of) => {
                if !self.light_rest_grid(screen, of, (state, limits))? {
                    self.next = Next::Begin;
                } else if of < SLOPES {
                    self.next = Next::Rest(of + 1);
                } else {
                    (self.shown, self.next) = (Some(REST), Next::Begin);
                    return Ok(Refined::Grids);
                }
            }
            Next::Begin => self.begin_full(screen, state, (full, limits))?,
            Next::Passes(done) => {
                let lit = full.as_mut().expect("planned");
                if done == lit.plan().passes.len() {
                    return self.complete(screen, state, lit).map(|()| Refined::Full);
                }
                self.run_part(screen, state, (lit, done))?;
            }
        }
        Ok(Refined::Nothing)
    }

    /// Plans the full light, or edits it at once.
    fn begin_full(
        &mut self,
        screen: &mut Screen,
        state: &State,
        (full, limits): (&mut Option<Frame>, &Limits),
    ) -> Result<()> {
        let plan = in_parts(state, limits, self.rate)?;
        let bytes = |full: &Option<Frame>| full.as_ref().map(|lit| lit.plan().bytes());
        let before = bytes(full);
        let is_new = replan(screen, full, plan, &state.scene)?;
        self.rest_grids_failed &= bytes(full) == before;
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
        let ms = work(&state.scene, &state.quality, 1) / self.rate / passes as f64;
        let count = (PART_MS / ms).clamp(1.0, passes as f64) as usize;
        let part: Vec<usize> = (done..(done + count).min(passes)).collect();
        let field = &state.scene.field;
        let heights = (done == 0).then(|| (field.heights_m(), whole(field)));
        let slot = screen.light(lit, heights, (Work::Passes(&part), &[]))?;
        self.running = Some(Running::Full(slot));
        self.next = Next::Passes(done + part.len());
        Ok(())
    }

    /// Shows the full light. Threads measure the previews against it and make other grids.
    fn complete(&mut self, screen: &mut Screen, state: &State, lit: &Frame) -> Result<()> {
        let shown = self.shown.take();
        self.next = Next::Nothing;
        (self.edited, self.is_full_stale) = (None, false);
        self.full_s = Some(self.changed.elapsed().as_secs_f64());
        let full = screen.gpu().pixels(lit, 0)?;
        let mut ours = [None, None];
        for (stage, ours) in ours.iter_mut().enumerate() {
            let is_lit = shown.is_some_and(|shown| stage <= shown);
            let levels = self.levels[stage].as_ref().filter(|_| is_lit);
            if let Some([.., Level { blocks, lit: Some(lit), .. }]) = levels {
                *ours = Some((*blocks, screen.gpu().pixels(lit, 0)?));
            }
        }
        let voids = state.scene.field.voids().map(<[bool]>::to_vec);
        self.next_errors = Some(std::thread::spawn(move || {
            let full = render::rgb(&full);
            ours.map(|of_stage| {
                let (blocks, ours) = of_stage?;
                error(&blocks, voids.as_deref(), &render::rgb(&ours), &full)
            })
        }));
        // For the next input, while there is time.
        if let Some(sides) = self.other_grids(state, DRAG, KEPT_AT_REST) {
            self.start_grids(state, DRAG, sides);
        }
        self.needs_rest_grids = !self.rest_grids_failed;
        Ok(())
    }

    /// Takes the times of the last part, and learns from them how fast the device is.
    fn read_times(&mut self, state: &State, full: &mut Option<Frame>) {
        let learns = !self.sides.are_fixed();
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
                        learn(&mut self.rate, work, &self.times, 0.0);
                    }
                    self.complete_times = Some(std::mem::take(&mut self.times));
                }
            }
            Some(Running::Rest(of, slot)) => {
                let level = self.levels[REST].as_mut().map(|levels| &mut levels[of]);
                let lit = level.and_then(|level| level.lit.as_mut());
                let times = lit.and_then(|lit| lit.renderer().timings(slot));
                self.times.extend(times.into_iter().flatten());
                if of == SLOPES && self.shows_rest_preview() {
                    self.rest_s = Some(self.changed.elapsed().as_secs_f64());
                    self.complete_times = Some(std::mem::take(&mut self.times));
                }
            }
            Some(Running::Preview(slots)) => {
                let levels = self.levels[DRAG].as_mut().filter(|levels| levels[SLOPES].runs > 1);
                let mut all = Vec::new();
                for (level, slot) in levels.into_iter().flatten().zip(slots) {
                    let lit = level.lit.as_mut().zip(slot);
                    let times = lit.and_then(|(lit, slot)| lit.renderer().timings(slot));
                    let Some(times) = times else { continue };
                    let work = grid_work(&state.scene, &state.quality, level.of, level.blocks.side);
                    // Without tables, all of the time is taken to grow with the grid.
                    let fixed_ms = if level.ran_all { FIXED_MS[level.of] } else { 0.0 };
                    learn(&mut self.sides.rates[level.of], work, &times, fixed_ms);
                    all.extend(times);
                }
                if !all.is_empty() {
                    self.complete_times = Some(all);
                }
            }
        }
    }

    pub fn end(&mut self, screen: &mut Screen) -> Result<()> {
        self.running = None;
        (0..STAGES).map(|stage| self.end_stage(stage, screen)).fold(Ok(()), Result::and)
    }
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

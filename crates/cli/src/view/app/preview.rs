//! Answers to input: the light of coarse grids on the slopes of a finer one; and the full light in parts once input
//! rests.

use std::ops::Range;
use std::time::{Duration, Instant};

use ridgelight::Result;
use ridgelight::gpu::{Frame, ImageArg, Timing, Work};
use ridgelight::plan::{self, Limits, Picture, Plan, Rectangle};
use ridgelight::scene::{
    Albedo, Bounces, HeightField, Lights, Lines, Method, Quality, Scene, Sun, Surface,
};
use ridgelight_viewer::Screen;

use super::super::brush::together;
use super::super::moving::Moving;
use super::super::smaller::Blocks;
use super::super::state::State;
use super::drawing::{refilled, replan, whole};
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
/// Azimuths of a preview's sky. On a smooth field 8 change its light by 0.1 to 0.3 %, a coarser grid by some percent.
const AZIMUTHS: u32 = 8;
/// Shortest side of a coarser grid, grid points.
const LEAST_GRID: usize = 32;
/// Refinement begins when input has rested for so long.
pub(super) const REST: Duration = Duration::from_millis(120);

/// Shares of the time aimed at where a preview keeps its grids: while input goes on, and at rest.
const DRAGGED: Range<f64> = 0.0..3.0;
const RESTED: Range<f64> = 0.4..1.4;

/// The grids of a preview: of all light, of which the sky is shown; of the sun alone; of the slopes.
const GRIDS: usize = 3;
const SKY: usize = 0;
const SUN: usize = 1;
const SLOPES: usize = 2;

/// What a device does in a millisecond: texels times azimuths of the full light; of the grids' light, and texels of slopes.
#[derive(Clone, Copy)]
struct Rates {
    full: f64,
    grids: [f64; GRIDS],
}

/// Before anything was measured: lavapipe on two cores; a GPU.
const CPU_RATES: Rates = Rates { full: 1e5, grids: [1e5, 1e5, 5.5e4] };
const GPU_RATES: Rates = Rates { full: 2e7, grids: [2e7; GRIDS] };

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    /// Plans the full light.
    Begin,
    /// Its passes from this one on.
    Passes(usize),
    Nothing,
}

/// A scene on a coarser grid.
struct Level {
    /// Which of the grids.
    of: usize,
    blocks: Blocks,
    scene: Scene,
    lit: Option<Frame>,
    /// Texels of the normals that are shaded; whether the device has older ones, and older heights.
    normals: Vec<f32>,
    are_normals_new: bool,
    are_heights_new: bool,
    /// The field without movement, in movement.
    moving: Option<Moving>,
    /// How often it was lit. The time of the first run is not measured, as it does not predict later ones.
    runs: u32,
}

/// Slots whose GPU times are still to be read.
#[derive(Clone, Copy)]
enum Running {
    Preview([Option<usize>; GRIDS]),
    Full(usize),
}

pub struct Preview {
    levels: Option<[Level; GRIDS]>,
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
        let error =
            self.error.map_or_else(String::new, |e| format!(", RMSE about {:.1} %", 100.0 * e));
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
        (edited, relights): (Option<Rectangle>, bool),
    ) -> Result<()> {
        self.read_times(state, &mut None);
        self.edited = match (edited, self.edited) {
            (Some(a), Some(b)) => Some(together(a, b)),
            (a, b) => a.or(b),
        };
        self.is_full_stale |= relights;
        self.times.clear();
        self.lacks_times = false;
        self.fit(screen, state, DRAGGED)?;
        self.changed = Instant::now();
        let missed = self.missed.take();
        let edited = edited.zip(missed).map(|(a, b)| together(a, b)).or(edited).or(missed);
        let levels = self.levels.as_mut().expect("made by fit");
        levels.iter_mut().try_for_each(|level| level.take(state, edited))?;
        let borrowed = plan_levels(levels, screen, state, limits)?;
        let mut slots = [None; GRIDS];
        for (level, slot) in levels.iter_mut().zip(&mut slots) {
            if level.is_used() {
                let borrowed = if level.of == SLOPES { borrowed.as_slice() } else { &[] };
                *slot = Some(level.run(screen, borrowed)?);
            }
        }
        self.running = Some(Running::Preview(slots));
        self.is_shown = true;
        self.next = if state.is_moving() { Next::Nothing } else { Next::Begin };
        Ok(())
    }

    /// Makes the levels, of a size that fits the time.
    fn fit(&mut self, screen: &mut Screen, state: &State, kept_at: Range<f64>) -> Result<()> {
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
        // Other grids take a third of a second: only where they are worth that, least of all in a drag.
        let is_kept = kept.is_some_and(|kept| {
            let fits = |of: usize| kept[of] <= most && kept_at.contains(&share(of, kept[of]));
            kept == wanted || self.fixed.is_none() && (0..GRIDS).all(fits)
        });
        if !is_kept {
            self.end(screen)?;
            let level = |of: usize| Level::new(state, of, wanted[of]);
            self.levels = Some([level(SKY)?, level(SUN)?, level(SLOPES)?]);
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
        match self.next {
            Next::Nothing => Ok(false),
            Next::Begin if self.changed.elapsed() < REST => Ok(false),
            Next::Begin => self.begin_full(screen, state, (full, limits)).map(|()| false),
            Next::Passes(done) => {
                let lit = full.as_mut().expect("planned");
                if done < lit.plan().passes.len() {
                    return self.run_part(screen, state, (lit, done)).map(|()| false);
                }
                self.complete(screen, state, (lit, limits)).map(|()| true)
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

    /// Shows the full light, and measures the preview against it.
    fn complete(
        &mut self,
        screen: &mut Screen,
        state: &State,
        (lit, limits): (&Frame, &Limits),
    ) -> Result<()> {
        (self.is_shown, self.next) = (false, Next::Nothing);
        (self.edited, self.is_full_stale) = (None, false);
        self.full_s = Some(self.changed.elapsed().as_secs_f64());
        if let Some([.., Level { blocks, lit: Some(fine), .. }]) = &self.levels {
            let full = render::rgb(&screen.gpu().pixels(lit, 0)?);
            let ours = render::rgb(&screen.gpu().pixels(fine, 0)?);
            self.error = error(blocks, state.scene.field.voids(), &ours, &full);
        }
        // For the next input, while there is time.
        self.fit(screen, state, RESTED)?;
        let levels = self.levels.as_mut().expect("made by fit");
        plan_levels(levels, screen, state, limits).map(|_| ())
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
                    learn(&mut self.rates.grids[level.of], work, &times, FIXED_MS[level.of]);
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

impl Level {
    fn new(state: &State, of: usize, side: usize) -> Result<Self> {
        let blocks = Blocks::of(&state.scene.field, side);
        let mut scene = blocks.scene(&state.scene)?;
        if of == SUN {
            scene.surface = Surface { border: scene.surface.border, ..Surface::default() };
        }
        let mut level = Self {
            of,
            blocks,
            scene,
            lit: None,
            normals: Vec::new(),
            are_normals_new: true,
            are_heights_new: true,
            moving: None,
            runs: 0,
        };
        level.take_normals(Some(&state.scene.field));
        Ok(level)
    }

    /// Whether it has light to show.
    fn is_used(&self) -> bool {
        self.of != SUN || !self.scene.lights.suns.is_empty()
    }

    /// Takes the state's lights and heights.
    fn take(&mut self, state: &State, edited: Option<Rectangle>) -> Result<()> {
        self.blocks.take_lights(&state.scene, &mut self.scene);
        if self.of == SUN {
            let suns = first_sun(&self.scene).map(|(_, sun)| *sun).into_iter().collect();
            self.scene.lights = Lights { suns, ..Lights::default() };
        }
        self.are_heights_new |= state.is_moving() || self.moving.is_some() || edited.is_some();
        match (state.moving(), &mut self.moving) {
            (Some(full), moving) => {
                if edited.is_some() || moving.as_ref().is_none_or(|moving| moving.kind != full.kind)
                {
                    let still = self.blocks.field(full.still())?;
                    *moving = Some(full.over_other(still));
                }
                let moving = moving.as_mut().expect("made above");
                moving.follow(full);
                self.scene.field = moving.field()?;
                self.take_normals(None);
            }
            (None, moving) if moving.is_some() => {
                *moving = None;
                self.scene.field = self.blocks.field(&state.scene.field)?;
                self.take_normals(Some(&state.scene.field));
            }
            (None, _) => {
                if let Some(at) = edited {
                    let (field, border) = (&state.scene.field, self.scene.surface.border);
                    self.blocks.edit(field, &mut self.scene.field, at)?;
                    if self.of == SLOPES {
                        self.blocks.edit_normals((field, border), &mut self.normals, at);
                    } else {
                        let (own, at) = (&self.scene.field, self.blocks.within_blocks(at));
                        Blocks::of(own, 1).edit_normals((own, border), &mut self.normals, at);
                    }
                    self.are_normals_new = true;
                }
            }
        }
        Ok(())
    }

    /// The normals of this grid's heights; of slopes the means of the full field's, unless that moves.
    fn take_normals(&mut self, full: Option<&HeightField>) {
        let border = self.scene.surface.border;
        self.normals = match full.filter(|_| self.of == SLOPES) {
            Some(field) => self.blocks.normals(field, border),
            None => Blocks::of(&self.scene.field, 1).normals(&self.scene.field, border),
        };
        self.are_normals_new = true;
    }

    /// Runs all passes. The slot holds their times.
    fn run(&mut self, screen: &mut Screen, borrowed: &[ImageArg]) -> Result<usize> {
        self.runs += 1;
        let lit = self.lit.as_mut().expect("planned");
        let all: Vec<usize> = (0..lit.plan().passes.len()).collect();
        let field = &self.scene.field;
        let heights = self.are_heights_new.then(|| (field.heights_m(), whole(field)));
        let slot = screen.light(lit, heights, (Work::Passes(&all), borrowed))?;
        self.are_heights_new = false;
        Ok(slot)
    }

    /// Plans the light of a coarse grid.
    fn plan_light(&mut self, screen: &mut Screen, state: &State, limits: &Limits) -> Result<()> {
        let wanted = Picture { light_layers: self.of == SKY, ..Picture::default() };
        let plan = plan::picture(&self.scene, &coarser(&state.quality, self.of), limits, wanted)?;
        replan(screen, &mut self.lit, plan, &self.scene).map(|_| ())
    }

    /// The image of the plan's input or output of a name.
    fn image(&self, name: &str) -> Option<ImageArg> {
        let lit = self.lit.as_ref()?;
        let input = lit.plan().inputs().position(|(_, input)| input.name == name);
        let output = lit.plan().outputs().position(|(_, output)| output.name == name);
        let of_input = input.map(|at| lit.inputs()[at]);
        of_input.or_else(|| output.map(|at| lit.outputs()[at]))
    }

    /// Plans the coarse grids' light on the slopes of this one. Returns the images that it borrows.
    fn plan_slopes(
        &mut self,
        screen: &mut Screen,
        [sky, sun]: [&mut Level; 2],
        has_camera: bool,
        limits: &Limits,
    ) -> Result<Vec<ImageArg>> {
        let plan_of = |level: &Level| level.lit.as_ref().expect("lit before").plan().clone();
        let (of_sky, of_sun) = (plan_of(sky), sun.is_used().then(|| plan_of(sun)));
        let count_of_normals = 2 + usize::from(sun.is_used());
        let suns = of_sun.as_ref().map(|plan| (&sun.scene, plan));
        let plan = plan::preview(&self.scene, (&sky.scene, &of_sky), suns, limits)?;
        let mut borrowed = vec![sky.image("radiance")];
        if let Some((n, _)) = first_sun(&sky.scene) {
            borrowed.push(sky.image(&format!("direct.sun{n}")));
        }
        if matches!(sky.scene.surface.albedo, Albedo::Map(_)) {
            borrowed.push(sky.image("albedo"));
        }
        if sun.is_used() {
            borrowed.push(sun.image("radiance"));
        }
        let borrowed: Vec<ImageArg> = borrowed.into_iter().flatten().collect();
        let fits = self.lit.as_ref().is_some_and(|lit| lit.plan().resources == plan.resources);
        match self.lit.as_mut().filter(|_| fits) {
            Some(lit) => {
                screen.gpu().replace_plan(lit, plan)?;
                // Behind the ground; the light comes from the coarse grid.
                if has_camera {
                    refilled(screen, lit, &self.scene)?;
                }
            }
            None => {
                if let Some(old) = self.lit.take() {
                    screen.end(old)?;
                }
                // Borrowed images need no contents.
                let mut contents = plan::picture_inputs(&self.scene);
                contents.truncate(plan.inputs().count() - borrowed.len() - count_of_normals);
                let rest = plan.inputs().skip(contents.len());
                let empty: Vec<Vec<f32>> =
                    rest.map(|(_, input)| vec![0.0; (input.bytes() / 4) as usize]).collect();
                contents.extend(empty);
                self.lit = Some(screen.frame(plan, &contents)?);
                [sky.are_normals_new, sun.are_normals_new, self.are_normals_new] = [true; 3];
            }
        }
        let lit = self.lit.as_ref().expect("made above");
        let first = lit.plan().inputs().count() - borrowed.len() - count_of_normals;
        let all = [
            (&self.normals, &mut self.are_normals_new),
            (&sky.normals, &mut sky.are_normals_new),
            (&sun.normals, &mut sun.are_normals_new),
        ];
        for (n, (normals, are_new)) in all.into_iter().take(count_of_normals).enumerate() {
            if *are_new {
                screen.gpu().refill(lit, first + n, normals)?;
                *are_new = false;
            }
        }
        Ok(borrowed)
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

/// Plans the light of the coarse grids and the slopes that show it. Returns the images that the slopes borrow.
fn plan_levels(
    [sky, sun, slopes]: &mut [Level; GRIDS],
    screen: &mut Screen,
    state: &State,
    limits: &Limits,
) -> Result<Vec<ImageArg>> {
    // New environments wait for the device.
    sky.plan_light(screen, state, limits)?;
    if sun.is_used() {
        sun.plan_light(screen, state, limits)?;
    }
    slopes.plan_slopes(screen, [sky, sun], state.has_camera(), limits)
}

/// The first sun with irradiance, and its number, from 1.
fn first_sun(scene: &Scene) -> Option<(usize, &Sun)> {
    let mut suns = (1..).zip(&scene.lights.suns);
    suns.find(|(_, sun)| sun.irradiance.iter().any(|e| *e > 0.0))
}

/// The user's settings with fewer azimuths and the default method, as the others are slow, and with the default lines,
/// as some need another method. The sun has one azimuth, and bounces only in the sky's light.
fn coarser(quality: &Quality, of: usize) -> Quality {
    let count = if of == SUN { 0 } else { quality.bounces.count };
    Quality {
        azimuths: quality.azimuths.min(AZIMUTHS),
        sun_azimuths: 1,
        bounces: Bounces { count, ..quality.bounces },
        method: Method::default(),
        lines: Lines::default(),
        ..*quality
    }
}

/// The work of a grid of blocks of `side` grid points, as its rate counts it.
fn grid_work(scene: &Scene, quality: &Quality, of: usize, side: usize) -> f64 {
    let texels = (scene.field.rows() * scene.field.cols()) as f64 / (side * side) as f64;
    match of {
        SKY => work(scene, &coarser(quality, SKY), side),
        // Heights, a sweep and a sun.
        SUN => 3.0 * texels,
        _ => texels,
    }
}

/// Texels times azimuths, with a sun as eight, on blocks of `side` grid points.
fn work(scene: &Scene, quality: &Quality, side: usize) -> f64 {
    let texels = (scene.field.rows() * scene.field.cols()) as f64 / (side * side) as f64;
    let lights = &scene.lights;
    let has_sky = lights.sky.is_some() || lights.environment.is_some() || quality.bounces.count > 0;
    let of_sky = if has_sky { f64::from(quality.azimuths) } else { 0.0 };
    let others = lights.suns.len() + lights.keys.len() + lights.sphere_lights.len() + 1;
    texels * (of_sky * f64::from(1 + 2 * quality.bounces.count) + 8.0 * others as f64)
}

/// The full light in passes of few azimuths, so that input waits for about [`PART_MS`].
fn in_parts(state: &State, limits: &Limits, rate: f64) -> Result<Plan> {
    let texels = (state.scene.field.rows() * state.scene.field.cols()) as f64;
    // A sweep and its shading share the time.
    let azimuths = (2.0 * PART_MS * rate / texels).clamp(1.0, 1e6) as u32;
    let image_layers = limits.image_layers.min(azimuths.next_power_of_two());
    state.plan(&Limits { image_layers, ..*limits }).or_else(|_| state.plan(limits))
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::scene::{HeightField, Lights, SETTINGS, Surface, Values, setting};

    /// With every method: what the full light accepts, previews accept too.
    #[test]
    fn every_valid_setting_has_a_preview() {
        let field = HeightField::new(64, 64, &[0.0; 64 * 64], [1.0; 2], None).unwrap();
        let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
        let scene = Scene { field, surface: Surface::default(), lights };
        let limits = Limits::boundless(true, 1 << 40);
        let words = |values: &Values| -> Vec<String> {
            match values {
                Values::Words(words) => words.iter().map(|word| word.name.to_owned()).collect(),
                Values::OneOf(all) => all.iter().map(u32::to_string).collect(),
                _ => Vec::new(),
            }
        };
        let method = setting("method").expect("a setting");
        let mut count = 0;
        for of_method in words(&method.values) {
            for other in SETTINGS {
                for word in words(&other.values) {
                    let mut quality = Quality::default();
                    method.set(&mut quality, &of_method).unwrap();
                    let is_full = other.set(&mut quality, &word).is_ok()
                        && plan::picture(&scene, &quality, &limits, Picture::default()).is_ok();
                    let wanted = Picture { light_layers: true, ..Picture::default() };
                    let sky = plan::picture(&scene, &coarser(&quality, SKY), &limits, wanted);
                    let sun = coarser(&quality, SUN);
                    let sun = plan::picture(&scene, &sun, &limits, Picture::default());
                    let is_well = sky.is_ok() && sun.is_ok();
                    assert!(!is_full || is_well, "{of_method}, {} {word}", other.name);
                    count += u32::from(is_full);
                }
            }
        }
        assert!(count > 20, "{count}");
    }
}

//! Frames.

use std::time::{Duration, Instant};

use ridgelight::gpu::{Frame, Work};
use ridgelight::plan::{self, Format, Kind, Map, Plan, Rectangle, View};
use ridgelight::scene::{Camera, HeightField, Scene};
use ridgelight::{Error, Result};
use ridgelight_viewer::{Pane, PaneTimes, PresentOptions, Presented, Screen, Viewpoint};

use super::super::brush::together;
use super::super::state::{Light, State, Wish};
use super::compare::Compare;
use super::preview::{PAUSE, Refined};
use super::{App, OpenWindow};
use crate::render;

/// Shortest interval between updates of the window's title.
const TITLE_FRAMES: u64 = 16;

/// Interval between statements of progress.
const PROGRESS: Duration = Duration::from_millis(500);

/// Between pictures side by side, pixels.
const GAP: u32 = 2;

impl App<'_> {
    /// Does what a key requested; false ends.
    pub(super) fn grant(&mut self, wish: Wish, before: Light) -> Result<bool> {
        if wish != Wish::Nothing {
            self.asked.get_or_insert_with(Instant::now);
        }
        match wish {
            Wish::Nothing => {}
            Wish::Show => self.due = self.due.max(1),
            Wish::Heights => self.due = 3,
            Wish::Light => {
                let needs_plan = !self.uses_preview() || !self.state.has_only_turned(&before);
                if let Some(shown) = &mut self.shown {
                    // Also with previews: their coarse plan accepts settings that the full one refuses. On a large field
                    // it takes long.
                    match needs_plan.then(|| self.state.plan(&shown.limits)).transpose() {
                        Ok(_) => (shown.is_stale, shown.has_fallen_back) = (true, false),
                        Err(why) => self.state.go_back(before, why),
                    }
                }
                self.due = 3;
            }
            Wish::Error => self.find_error(),
            Wish::Picture => self.request_picture()?,
            Wish::Scene => self.save_scene(None)?,
            Wish::Copy => self.copy_command(),
            Wish::End => return Ok(false),
        }
        Ok(true)
    }

    fn find_error(&mut self) {
        self.due = self.due.max(1);
        let Some(OpenWindow { screen, lit: Some(lit), compare, .. }) = &mut self.shown else {
            return;
        };
        let Some(compare) = compare else {
            self.state.message = Some("press C first to show the reference".into());
            return;
        };
        if let Err(why) = compare.find_error(screen, lit, &self.state) {
            self.state.message = Some(why.to_string());
        }
    }

    /// Whether slow light is previewed now.
    pub(super) fn uses_preview(&self) -> bool {
        let needs = |shown: &OpenWindow| shown.preview.is_needed(&self.state);
        self.previews && self.shown.as_ref().is_some_and(needs)
    }

    /// Draws what is due, or goes on with the light at rest. With previews it begins only while the device is
    /// idle. It can still wait: a preview is three submissions, of which two are in flight.
    pub(super) fn advance(&mut self) -> Result<()> {
        if !self.uses_preview() {
            return if self.is_due() { self.draw(false).map(|_| ()) } else { Ok(()) };
        }
        if !self.is_ready()? {
            return Ok(());
        }
        if self.shown.as_ref().is_some_and(OpenWindow::has_rested) {
            self.due = self.due.max(1);
        }
        if self.is_due() {
            return self.draw(false).map(|_| ());
        }
        self.refine()
    }

    /// Whether the device has nothing to do; notes how long the last picture took.
    pub(super) fn is_ready(&mut self) -> Result<bool> {
        self.note_answer(None)?;
        self.shown.as_ref().map_or(Ok(false), |shown| shown.screen.is_idle())
    }

    /// Notes the time from input to its picture, once the device has drawn that; `reused` is a slot whose last picture it has
    /// drawn.
    pub(super) fn note_answer(&mut self, reused: Option<usize>) -> Result<()> {
        let (Some((asked, slot)), Some(shown)) = (self.answering, &mut self.shown) else {
            return Ok(());
        };
        if reused == Some(slot) || shown.screen.is_finished(slot)? {
            self.answering = None;
            let ms = asked.elapsed().as_secs_f64() * 1e3;
            shown.figures.answer_ms = Some(ms);
            self.answers.push(ms);
        }
        Ok(())
    }

    /// Goes on with the full light.
    pub(super) fn refine(&mut self) -> Result<()> {
        let Some(shown) = &mut self.shown else { return Ok(()) };
        let OpenWindow { screen, preview, lit, limits, .. } = shown;
        match preview.refine(screen, &self.state, (lit, limits)) {
            // The panel states the progress.
            Ok(Refined::Nothing) => {
                let is_old = self.last.is_some_and(|last| last.elapsed() > PROGRESS);
                if preview.is_busy() && is_old {
                    self.due = self.due.max(1);
                }
            }
            Ok(Refined::Grids) => self.due = self.due.max(1),
            Ok(Refined::Full) => {
                if self.state.has_coarse_exposure
                    && let Err(why) = shown.expose(&mut self.state, false)
                {
                    return self.fall_back(why);
                }
                (shown.good, shown.has_fallen_back) = (Some(self.state.light()), false);
                self.due = self.due.max(1);
                return self.save_requested();
            }
            Err(why) => return self.fall_back(why),
        }
        Ok(())
    }

    /// Draws a frame. Returns its pixels if they are kept; none where the window has no area or is
    /// not ready.
    pub(super) fn draw(&mut self, keeps: bool) -> Result<Option<Vec<[u8; 4]>>> {
        self.note_answer(None)?;
        let uses_preview = self.uses_preview();
        let Some(shown) = &mut self.shown else { return Ok(None) };
        let Some(size) = shown.screen.size(shown.inner)? else {
            return Ok(self.stay_blank("it has no area"));
        };
        shown.size = size;
        let moves = self.state.is_moving();
        self.state.step(!uses_preview)?;
        let mut edited = self.state.edited.take();
        let eye_m = self.state.eye_m();
        shown.is_stale |= std::mem::replace(&mut shown.eye_m, eye_m) != eye_m;
        if uses_preview {
            if shown.is_stale || moves || edited.is_some() {
                let OpenWindow { screen, preview, limits, is_stale, .. } = shown;
                let change = (edited.take(), *is_stale);
                if let Err(why) = preview.restart(screen, &self.state, limits, change) {
                    return self.fall_back(why).map(|()| None);
                }
                // The full light of later settings may be refused before any has been complete.
                shown.good.get_or_insert_with(|| self.state.light());
                (shown.is_stale, shown.has_moved) = (false, false);
            }
        } else {
            let OpenWindow { screen, preview, .. } = shown;
            shown.is_stale |= preview.leave(screen)?;
            edited.into_iter().for_each(|at| shown.preview.miss(at));
        }
        if !uses_preview && (shown.is_stale || moves || edited.is_some()) {
            if let Err(why) = shown.light(&self.state) {
                return self.fall_back(why).map(|()| None);
            }
            shown.has_moved |= moves;
            let has_new_light = shown.is_stale;
            shown.compare.iter_mut().for_each(|compare| compare.scene_changed(has_new_light));
        }
        if self.state.needs_exposure
            && let Err(why) = shown.expose(&mut self.state, edited.is_some())
        {
            return self.fall_back(why).map(|()| None);
        }
        if let Err(why) = shown.show_beside(&self.state) {
            self.state.is_split = false;
            self.state.go_back(self.state.light(), why);
        }
        shown.update_figures(mean(&self.spent));
        let (changes, asks) = shown.run_panel(&self.state);
        let drawn = match shown.draw(&self.state, edited, (keeps, uses_preview)) {
            Ok(drawn) => drawn,
            Err(why) => return self.fall_back(why).map(|()| None),
        };
        let Some(Presented { pixels, slot, is_taken, .. }) = drawn else {
            self.state.edited = together(self.state.edited, edited);
            return Ok(self.stay_blank("it accepts no frames"));
        };
        self.blank = None;
        self.note_answer(Some(slot))?;
        if self.answering.is_none() {
            self.answering = self.asked.take().map(|asked| (asked, slot));
        }
        self.count();
        if !is_taken || asks {
            self.due = self.due.max(1);
        }
        self.change(changes)?;
        self.save_requested()?;
        Ok(Some(pixels.unwrap_or_default()))
    }

    /// Handles a refusal that the plan did not predict: returns to the last light that could be
    /// drawn and recomputes it. A second refusal before any light is complete is an error.
    fn fall_back(&mut self, why: Error) -> Result<()> {
        let Some(shown) = &mut self.shown else { return Err(why) };
        // The rest preview is memory that the light may need.
        if shown.preview.give_up_rest(&mut shown.screen)? {
            shown.is_stale = true;
            self.due = self.due.max(1);
            return Ok(());
        }
        // The comparison pictures restart too.
        let freed = shown.compare.take().map_or(Ok(()), |old| old.end(&mut shown.screen));
        let is_again = std::mem::replace(&mut shown.has_fallen_back, true);
        let good = shown.good.clone().filter(|_| !is_again);
        let (Some(good), Ok(())) = (good, freed) else { return Err(why) };
        self.state.go_back(good, why);
        shown.is_stale = true;
        self.due = self.due.max(1);
        Ok(())
    }

    /// Shows no picture, for a reason.
    fn stay_blank<T>(&mut self, why: &'static str) -> Option<T> {
        let since = self.blank.map_or_else(Instant::now, |(since, _)| since);
        self.blank = Some((since, why));
        None
    }

    fn count(&mut self) {
        let now = Instant::now();
        self.frames += 1;
        self.due = self.due.saturating_sub(1);
        let since = self.last.replace(now).map(|last| (now - last).as_secs_f64() * 1e3);
        // Frames of a still picture are not timed.
        if self.state.is_moving() || self.steps.is_some() {
            self.spent.extend(since);
        } else {
            self.spent.clear();
        }
        if self.frames % TITLE_FRAMES == 1
            && let Some(shown) = &self.shown
        {
            let name = self.args.input.first().file_name().unwrap_or_default().to_string_lossy();
            let ms: f64 = shown.figures.ms();
            shown.window.set_title(&format!("{name} - ridgelight - {ms:.1} ms"));
        }
    }
}

/// Of the last frames, milliseconds each.
fn mean(spent: &[f64]) -> Option<f64> {
    let last = &spent[spent.len().saturating_sub(20)..];
    (!last.is_empty()).then(|| last.iter().sum::<f64>() / last.len() as f64)
}

/// All of a field.
pub(super) fn whole(field: &HeightField) -> Rectangle {
    Rectangle { col: 0, row: 0, cols: field.cols() as u32, rows: field.rows() as u32 }
}

/// The passes that a frame of new heights needs if lights and settings are those of the last frame. All passes if the last frame
/// was not recorded or did not run.
pub(super) fn after_new_heights(lit: &mut Frame) -> Vec<usize> {
    let heights = lit.plan().find("heights");
    lit.renderer().passes_after(heights.as_slice())
}

fn has_colour(plan: &Plan) -> bool {
    let radiance = plan.find("radiance").map(|id| plan.resources[id.0].kind);
    matches!(radiance, Some(Kind::Image { format: Format::Rgba32Float, .. }))
}

/// Columns where the window's pictures begin, and the size of each: three side by side, or one.
pub(super) fn places([width, height]: [u32; 2], is_split: bool) -> (Vec<u32>, [u32; 2]) {
    match width.saturating_sub(2 * GAP) / 3 {
        pane if is_split && pane > 0 => {
            ((0..3).map(|n| n * (pane + GAP)).collect(), [pane, height])
        }
        _ => (vec![0], [width, height]),
    }
}

/// Switches to a plan, reusing images where they fit. Returns whether all of it must run.
pub(super) fn replan(
    screen: &mut Screen,
    place: &mut Option<Frame>,
    plan: Plan,
    scene: &Scene,
) -> Result<bool> {
    if let Some(lit) = place {
        let fits = lit.plan().resources == plan.resources;
        if fits && plan.passes_after(lit.plan(), &[]).is_empty() {
            return Ok(false);
        }
        screen.wait()?;
        match screen.gpu().replace_plan(lit, plan.clone()) {
            Ok(_) => return refilled(screen, lit, scene).map(|()| true),
            Err(Error::Setting { .. }) => {}
            Err(other) => return Err(other),
        }
    }
    if let Some(old) = place.take() {
        screen.end(old)?;
    }
    *place = Some(screen.frame(plan, &plan::picture_inputs(scene))?);
    Ok(true)
}

/// Gives a frame the scene's environment: a clear sky follows its sun.
pub(super) fn refilled(screen: &mut Screen, lit: &Frame, scene: &Scene) -> Result<()> {
    let input = lit.plan().inputs().position(|(_, input)| input.name == "environment");
    let Some((input, environment)) = input.zip(scene.lights.environment.as_ref()) else {
        return Ok(());
    };
    let texels: Vec<f32> =
        environment.texels().iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    screen.gpu().refill(lit, input, &texels)
}

impl OpenWindow {
    /// Switches to the requested light.
    fn light(&mut self, state: &State) -> Result<()> {
        let plan = state.plan(&self.limits)?;
        self.is_stale |= replan(&mut self.screen, &mut self.lit, plan, &state.scene)?;
        Ok(())
    }

    /// Finds the exposure of the light that is shown next, which is computed first if it is stale or its heights are edited.
    fn expose(&mut self, state: &mut State, is_edited: bool) -> Result<()> {
        let Self { screen, preview, lit, .. } = self;
        if let Some((lit, scene, _)) = preview.lit() {
            let pixels = screen.gpu().pixels(lit, 0)?;
            state.expose(&render::rgb(&pixels), scene.field.voids(), true);
            return Ok(());
        }
        let Some(lit) = lit else { return Ok(()) };
        let field = &state.scene.field;
        if self.is_stale || self.has_moved || is_edited {
            let all: Vec<usize> = (0..lit.plan().passes.len()).collect();
            let heights = Some((field.heights_m(), whole(field)));
            let slot = screen.light(lit, heights, (Work::Passes(&all), &[]))?;
            screen.wait()?;
            if let Some(times) = lit.renderer().timings(slot) {
                self.figures.light = times;
            }
        }
        let picture = render::rgb(&screen.gpu().pixels(lit, 0)?);
        let voids = field.voids().map(<[bool]>::to_vec);
        state.expose(&picture, voids.as_deref(), false);
        self.has_moved = false;
        if std::mem::take(&mut self.is_stale) {
            self.has_complete(state);
        }
        Ok(())
    }

    /// The state's light is complete.
    fn has_complete(&mut self, state: &State) {
        self.has_fallen_back = false;
        if !state.is_moving() {
            self.good = Some(state.light());
        }
    }

    /// Makes or frees the comparison pictures.
    fn show_beside(&mut self, state: &State) -> Result<()> {
        if !state.is_split {
            return self.compare.take().map_or(Ok(()), |old| old.end(&mut self.screen));
        }
        let compare = self.compare.get_or_insert_with(Compare::new);
        compare.prepare(&mut self.screen, state, &self.limits)
    }

    /// Takes the values that the panel shows.
    fn update_figures(&mut self, frame_ms: Option<f64>) {
        self.figures.frame_ms = frame_ms;
        self.figures.compared = self.compare.as_ref().and_then(|compare| compare.error.clone());
        let full = self.lit.as_ref().map(Frame::plan);
        self.figures.bytes = full.map_or(0, Plan::bytes) + self.preview.bytes();
        let used = full.filter(|_| !self.preview.is_shown()).map(|plan| &plan.settings);
        if used != self.figures.used.as_ref() {
            self.figures.used = used.cloned();
        }
        self.figures.preview = self.preview.line();
        self.figures.progress = self.preview.progress(self.lit.as_ref());
        self.figures.full_s = self.preview.full_s;
        if let Some(times) = self.preview.complete_times.take() {
            self.figures.light = times;
        }
    }

    /// Whether the camera has turned lately.
    fn turns(&mut self, camera: Option<Camera>) -> bool {
        if camera != self.camera {
            self.turned = self.camera.and(camera).map(|_| Instant::now());
            self.camera = camera;
        }
        self.turned.is_some_and(|turned| turned.elapsed() < PAUSE)
    }

    /// Whether the full light is shown on a mesh that can be finer.
    fn has_rested(&self) -> bool {
        let is_turning = self.turned.is_some_and(|turned| turned.elapsed() < PAUSE);
        self.has_coarse_mesh && !self.preview.is_shown() && !is_turning
    }

    /// None where the window was not ready.
    fn draw(
        &mut self,
        state: &State,
        edited: Option<Rectangle>,
        (keeps, uses_preview): (bool, bool),
    ) -> Result<Option<Presented>> {
        let turns = self.turns(state.camera());
        let swaps = self.screen.swaps();
        let (lefts, pane_size) = places(self.size, self.compare.is_some());
        let smaller = self.preview.lit();
        let is_preview = smaller.is_some();
        // GPUs draw the whole mesh at once.
        let is_coarse = uses_preview && self.limits.is_cpu && (is_preview || turns);
        let (lit, scene, blocks) = match (smaller, &mut self.lit) {
            (Some((lit, scene, blocks)), _) => (lit, scene, Some(blocks)),
            (None, Some(lit)) => (lit, &state.scene, None),
            (None, None) => return Ok(None),
        };
        let field = &scene.field;
        // If only one picture fits, it is the main one.
        let mut compare = self.compare.as_mut().filter(|_| lefts.len() > 1);
        let all_of_it = whole(field);
        let is_all_new = self.is_stale || self.has_moved;
        let has_edits = !is_all_new && !lit.plan().edit_passes.is_empty();
        let edit = edited.filter(|_| has_edits);
        let passes = match self.is_stale {
            _ if is_preview => Vec::new(),
            true => (0..lit.plan().passes.len()).collect(),
            false if is_all_new || edited.is_some() => after_new_heights(lit),
            false => Vec::new(),
        };
        let work = edit.map_or(Work::Passes(&passes), Work::Edit);
        let new = if is_all_new { Some(all_of_it) } else { edited }.filter(|_| !is_preview);
        let heights = new.map(|at| (field.heights_m(), at));

        // From left to right: each with its heights and its passes.
        let [off, path_traced] = compare.as_mut().map_or([None, None], |c| c.frames());
        let mut frames = Vec::new();
        frames.extend(off.map(|(frame, passes)| {
            let heights = (!passes.is_empty()).then_some((field.heights_m(), all_of_it));
            (frame, heights, passes)
        }));
        let at_ours = frames.len();
        frames.push((lit, heights, Vec::new()));
        frames.extend(path_traced.map(|(frame, passes)| (frame, None, passes)));
        let mut viewpoints: Vec<(Map, Option<View>)> = Vec::new();
        for (frame, ..) in &frames {
            let map = state.map(pane_size, swaps, has_colour(frame.plan()));
            let map = blocks.map_or(map, |blocks| blocks.map(&map, field));
            let of = (scene, blocks, is_coarse);
            let view = state.view(of, frame.plan(), pane_size, &self.limits)?;
            viewpoints.push((map, view));
        }
        let mut panes: Vec<Pane<'_>> = Vec::new();
        let of_panes = frames.iter_mut().zip(&viewpoints).zip(&lefts).enumerate();
        for (n, (((frame, heights, passes), (map, view)), left)) in of_panes {
            panes.push(Pane {
                frame,
                heights: *heights,
                work: if n == at_ours { work } else { Work::Passes(passes) },
                viewpoint: view
                    .as_ref()
                    .map_or(Viewpoint::Map(map), |view| Viewpoint::Camera(view, map.tone.exposure)),
                left: *left,
            });
        }
        let overlay = self.gui.overlay();
        let options = PresentOptions { voids: field.voids(), overlay, keeps };
        let Some(mut done) = self.screen.draw(&mut panes, &options)? else { return Ok(None) };
        if let Some(compare) = compare {
            compare.drawn(done.timings.get(2).map_or(&[], |times| times.light.as_slice()));
        }
        self.has_coarse_mesh = is_coarse && state.has_camera();
        self.last_edit = edit.or(self.last_edit);
        self.stated(std::mem::take(&mut done.timings[at_ours]));
        if state.is_moving() {
            self.has_fallen_back = false;
        }
        if !is_preview {
            self.has_moved = false;
            if std::mem::take(&mut self.is_stale) {
                self.has_complete(state);
            }
        }
        Ok(Some(done))
    }

    /// Times of an earlier frame, whose passes tell whether it was an edit.
    fn stated(&mut self, times: PaneTimes) {
        let PaneTimes { light, drawing } = times;
        if light.iter().any(|t| t.label.starts_with("dirty_mark")) {
            let ms = light.iter().map(|t| t.ns).sum::<f64>() / 1e6;
            self.figures.edit = self.last_edit.map(|at| (at, ms));
        } else if !light.is_empty() {
            self.figures.light = light;
        }
        if !drawing.is_empty() {
            self.figures.drawing = drawing;
        }
    }
}

//! Frames.

use std::time::Instant;

use ridgelight::gpu::{Frame, Work};
use ridgelight::plan::{self, Format, Kind, Map, Plan, Rectangle, View};
use ridgelight::scene::Scene;
use ridgelight::{Error, Result};
use ridgelight_viewer::{Pane, PaneTimes, Panel, PresentOptions, Screen, Viewpoint};

use super::super::panel::{self, Drawn};
use super::super::state::{Light, State, Wish};
use super::compare::Compare;
use super::{App, OpenWindow};

/// Shortest interval between updates of the window's title.
const TITLE_FRAMES: u64 = 16;

/// Between pictures side by side, pixels.
const GAP: u32 = 2;

impl App<'_> {
    /// Does what a key requested; false ends.
    pub(super) fn grant(&mut self, wish: Wish, before: Light) -> Result<bool> {
        match wish {
            Wish::Nothing => {}
            Wish::Show => self.due = self.due.max(1),
            Wish::Heights => self.due = 3,
            Wish::Light => {
                if let Some(shown) = &mut self.shown {
                    match self.state.plan(&shown.limits) {
                        Ok(_) => shown.is_stale = true,
                        Err(why) => self.state.go_back(before, why),
                    }
                }
                self.due = 3;
            }
            Wish::Error => self.find_error(),
            Wish::Picture => self.save_picture(None)?,
            Wish::Scene => self.save_scene(None)?,
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

    /// Draws a frame. Returns its pixels if they are kept; none where the window has no area or is
    /// not ready.
    pub(super) fn draw(&mut self, keeps: bool) -> Result<Option<Vec<[u8; 4]>>> {
        let Some(shown) = &mut self.shown else { return Ok(None) };
        let Some(size) = shown.screen.size(shown.inner)? else {
            return Ok(self.stay_blank("it has no area"));
        };
        shown.size = size;
        let moves = self.state.is_moving();
        if moves {
            self.state.step()?;
        }
        let edited = self.state.take_edited();
        if shown.is_stale || moves || edited.is_some() {
            if let Err(why) = shown.light(&self.state) {
                return self.fall_back(why).map(|()| None);
            }
            shown.is_stale |= moves;
            shown.compare.iter_mut().for_each(Compare::scene_changed);
        }
        if let Err(why) = shown.show_beside(&self.state) {
            self.state.is_split = false;
            self.state.go_back(self.state.light(), why);
        }
        let drawn = match shown.draw(&self.state, edited, mean(&self.spent), keeps) {
            Ok(drawn) => drawn,
            Err(why) => return self.fall_back(why).map(|()| None),
        };
        let Some((pixels, is_taken)) = drawn else {
            edited.into_iter().for_each(|at| self.state.give_back_edited(at));
            return Ok(self.stay_blank("it accepts no frames"));
        };
        self.blank = None;
        self.count();
        if !is_taken {
            self.due = self.due.max(1);
        }
        Ok(Some(pixels))
    }

    /// Handles a refusal that the plan did not predict: returns to the last light that could be
    /// drawn and recomputes it, once.
    fn fall_back(&mut self, why: Error) -> Result<()> {
        let Some(shown) = &mut self.shown else { return Err(why) };
        // The comparison pictures restart too.
        let freed = shown.compare.take().map_or(Ok(()), |old| old.end(&mut shown.screen));
        let (Some(good), Ok(())) = (shown.good.take(), freed) else { return Err(why) };
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
            let name = self.args.input.path.file_name().unwrap_or_default().to_string_lossy();
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
            Ok(_) => return Ok(true),
            Err(Error::Setting { .. }) => {}
            Err(other) => return Err(other),
        }
    }
    if let Some(old) = place.take() {
        screen.end(old)?;
    }
    let contents = plan::picture_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    *place = Some(screen.frame(plan, &contents)?);
    Ok(true)
}

impl OpenWindow {
    /// Switches to the requested light.
    fn light(&mut self, state: &State) -> Result<()> {
        let plan = state.plan(&self.limits)?;
        self.is_stale |= replan(&mut self.screen, &mut self.lit, plan, &state.scene)?;
        Ok(())
    }

    /// Makes or frees the comparison pictures.
    fn show_beside(&mut self, state: &State) -> Result<()> {
        if !state.is_split {
            return self.compare.take().map_or(Ok(()), |old| old.end(&mut self.screen));
        }
        let compare = self.compare.get_or_insert_with(Compare::new);
        compare.prepare(&mut self.screen, state, &self.limits)
    }

    /// Pixels if they are kept, and whether the window accepted them; none where it was not ready.
    fn draw(
        &mut self,
        state: &State,
        edited: Option<Rectangle>,
        frame_ms: Option<f64>,
        keeps: bool,
    ) -> Result<Option<(Vec<[u8; 4]>, bool)>> {
        let field = &state.scene.field;
        let (size, swaps) = (self.size, self.screen.swaps());
        let (lefts, pane_size) = places(size, self.compare.is_some());
        self.figures.frame_ms = frame_ms;
        self.figures.compared = self.compare.as_ref().map_or_else(Vec::new, Compare::lines);
        let Some(lit) = &mut self.lit else { return Ok(None) };
        let scale = if self.window.scale_factor() >= 1.5 { 2 } else { 1 };
        let letters = panel::letters(size[0], scale);
        let text = panel::draw(&state.lines(lit.plan(), &self.figures, letters), scale);
        // If only one picture fits, it is the main one.
        let mut compare = self.compare.as_mut().filter(|_| lefts.len() > 1);
        let labels = compare.as_ref().map(|c| c.labels()).filter(|_| text.size[0] > 0);
        let drawn = panels(state, text, (&lefts, pane_size), labels.as_ref(), scale);
        let panels: Vec<Panel<'_>> = drawn
            .iter()
            .map(|(at, d)| Panel { at: *at, size: d.size, pixels: &d.pixels })
            .collect();

        let whole =
            Rectangle { col: 0, row: 0, cols: field.cols() as u32, rows: field.rows() as u32 };
        let has_edits = !self.is_stale && !lit.plan().edit_passes.is_empty();
        let edit = edited.filter(|_| has_edits);
        let all: Vec<usize> = (0..lit.plan().passes.len()).collect();
        let work = match edit {
            Some(at) => Work::Edit(at),
            None if self.is_stale || edited.is_some() => Work::Passes(&all),
            None => Work::Passes(&[]),
        };
        let new = if self.is_stale { Some(whole) } else { edited };
        let heights = new.map(|at| (field.heights_m(), at));

        // From left to right: each with its heights and its passes.
        let [off, path_traced] = compare.as_mut().map_or([None, None], |c| c.frames());
        let mut frames = Vec::new();
        frames.extend(off.map(|(frame, passes)| {
            let heights = (!passes.is_empty()).then_some((field.heights_m(), whole));
            (frame, heights, passes)
        }));
        let at_ours = frames.len();
        frames.push((lit, heights, Vec::new()));
        frames.extend(path_traced.map(|(frame, passes)| (frame, None, passes)));
        let mut viewpoints: Vec<(Map, Option<View>)> = Vec::new();
        for (frame, ..) in &frames {
            let map = state.map(pane_size, swaps, has_colour(frame.plan()));
            viewpoints.push((map, state.view(frame.plan(), pane_size, &self.limits)?));
        }
        let mut panes: Vec<Pane<'_>> = Vec::new();
        let of_panes = frames.iter_mut().zip(&viewpoints).zip(&lefts).enumerate();
        for (n, (((frame, heights, passes), (map, view)), left)) in of_panes {
            panes.push(Pane {
                frame,
                heights: *heights,
                work: if n == at_ours { work } else { Work::Passes(passes) },
                viewpoint: view.as_ref().map_or(Viewpoint::Map(map), Viewpoint::Camera),
                left: *left,
            });
        }
        let options =
            PresentOptions { tone: state.tone(), voids: field.voids(), panels: &panels, keeps };
        let Some(mut done) = self.screen.draw(&mut panes, &options)? else { return Ok(None) };
        if let Some(compare) = compare {
            compare.drawn(done.timings.get(2).map_or(&[], |times| times.light.as_slice()));
        }
        self.last_edit = edit.or(self.last_edit);
        self.stated(std::mem::take(&mut done.timings[at_ours]));
        if std::mem::take(&mut self.is_stale) && !state.is_moving() {
            self.good = Some(state.light());
        }
        Ok(Some((done.pixels.unwrap_or_default(), done.is_taken)))
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

/// What is drawn over the pictures, and where: marks, labels, and the text.
fn panels(
    state: &State,
    text: Drawn,
    (lefts, [width, height]): (&[u32], [u32; 2]),
    labels: Option<&[String; 3]>,
    scale: usize,
) -> Vec<([u32; 2], Drawn)> {
    let mut all = Vec::new();
    for mark in state.marks([width, height]) {
        let drawn = panel::square(mark.half, mark.colour, mark.is_chosen);
        let [x, y] = [0, 1].map(|i| mark.at[i].floor() - f64::from(drawn.size[i] / 2));
        let (right, below) =
            (width.saturating_sub(drawn.size[0]), height.saturating_sub(drawn.size[1]));
        if x < 0.0 || y < 0.0 || x > f64::from(right) || y > f64::from(below) {
            continue;
        }
        all.extend(lefts.iter().map(|left| ([left + x as u32, y as u32], drawn.clone())));
    }
    for (label, left) in labels.into_iter().flatten().zip(lefts) {
        let letters = panel::letters(width, scale);
        let drawn = panel::draw(&[label.chars().take(letters).collect()], scale);
        all.push(([*left, height.saturating_sub(drawn.size[1])], drawn));
    }
    if text.size[0] > 0 {
        all.push(([0, 0], text));
    }
    all
}

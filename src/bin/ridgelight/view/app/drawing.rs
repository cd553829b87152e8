//! Frames.

use std::time::Instant;

use ridgelight::gpu::{Panel, Shot, Sight};
use ridgelight::plan::{self, Format, Kind, Plan};
use ridgelight::{Error, Result};

use super::super::panel;
use super::super::state::{Light, Wish};
use super::{App, Shown};

/// A window's title is not told more often.
const TITLE_FRAMES: u64 = 16;

impl App<'_> {
    /// Does what a key asked for; false ends.
    pub(super) fn grant(&mut self, wish: Wish, before: Light) -> Result<bool> {
        match wish {
            Wish::Nothing => {}
            Wish::Show => self.due = self.due.max(1),
            Wish::Light => {
                if let Some(shown) = &mut self.shown {
                    match self.state.plan(&shown.limits) {
                        Ok(_) => shown.is_stale = true,
                        Err(why) => self.state.go_back(before, &why),
                    }
                }
                self.due = 3;
            }
            Wish::Picture => self.save_picture(None)?,
            Wish::Scene => self.save_scene(None)?,
            Wish::End => return Ok(false),
        }
        Ok(true)
    }

    /// Draws a frame; its pixels where they are kept, none where the window has no area or is not ready.
    pub(super) fn draw(&mut self, keeps: bool) -> Result<Option<Vec<[u8; 4]>>> {
        let Some(shown) = &mut self.shown else { return Ok(None) };
        let inner = shown.window.inner_size();
        let wanted = [inner.width, inner.height];
        let Some(size) = shown.screen.size(wanted)? else { return Ok(None) };
        shown.size = size;
        let moves = self.state.is_moving();
        if moves {
            self.state.step()?;
        }
        if shown.is_stale || moves {
            shown.replan(self.state.plan(&shown.limits)?, &self.state.scene)?;
        }
        let lights_anew = shown.is_stale || moves;
        let Some(lit) = &mut shown.lit else { return Ok(None) };
        let plan = lit.plan();
        let passes: Vec<usize> = (0..plan.passes.len()).filter(|_| lights_anew).collect();
        let lines = self.state.lines(plan, &shown.times, mean(&self.spent));
        let scale = if shown.window.scale_factor() >= 1.5 { 2 } else { 1 };
        let drawn = (!lines.is_empty()).then(|| panel::draw(&lines, scale));
        let map = self.state.map(size, shown.screen.swaps(), has_colour(plan));
        let view = self.state.view(plan, size, &shown.limits)?;
        let field = &self.state.scene.field;
        let shot = Shot {
            heights: lights_anew.then_some(field.heights_m()),
            passes: &passes,
            sight: view.as_ref().map_or(Sight::Map(&map), Sight::Camera),
            tone: self.state.tone(),
            voids: field.voids(),
            panel: drawn.as_ref().map(|d| Panel { size: d.size, pixels: &d.pixels }),
            keeps,
        };
        let Some(done) = shown.screen.draw(lit, &shot)? else { return Ok(None) };
        shown.is_stale = false;
        if !done.timings.is_empty() {
            shown.times = done.timings;
        }
        self.count();
        Ok(Some(done.pixels.unwrap_or_default()))
    }

    fn count(&mut self) {
        let now = Instant::now();
        self.frames += 1;
        self.due = self.due.saturating_sub(1);
        let since = self.last.replace(now).map(|last| (now - last).as_secs_f64() * 1e3);
        // Between frames of a picture that stands still nothing is measured.
        if self.state.is_moving() || self.steps.is_some() {
            self.spent.extend(since);
        } else {
            self.spent.clear();
        }
        if self.frames % TITLE_FRAMES == 1
            && let Some(shown) = &self.shown
        {
            let name = self.args.input.path.file_name().unwrap_or_default().to_string_lossy();
            let ms: f64 = shown.times.iter().map(|t| t.ns).sum::<f64>() / 1e6;
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

impl Shown {
    /// Goes over to a plan, in the same images where they fit.
    fn replan(&mut self, plan: Plan, scene: &ridgelight::scene::Scene) -> Result<()> {
        if let Some(lit) = &mut self.lit {
            let fits = lit.plan().resources == plan.resources;
            if fits && plan.passes_after(lit.plan(), &[]).is_empty() {
                return Ok(());
            }
            self.screen.wait()?;
            match self.screen.gpu().replace_plan(lit, plan.clone()) {
                Ok(_) => return Ok(()),
                Err(Error::Setting { .. }) => {}
                Err(other) => return Err(other),
            }
        }
        if let Some(old) = self.lit.take() {
            self.screen.end(old)?;
        }
        let contents = plan::picture_inputs(scene);
        let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        self.lit = Some(self.screen.frame(plan, &contents)?);
        self.is_stale = true;
        Ok(())
    }
}

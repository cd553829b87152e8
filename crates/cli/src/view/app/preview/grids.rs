//! The grids of the two previews: which there are, how they are made and lit.

use std::ops::Range;

use ridgelight::Result;
use ridgelight::plan::Limits;
use ridgelight::scene::Scene;
use ridgelight_viewer::Screen;

use super::super::super::opening::joined;
use super::super::super::state::State;
use super::super::level::{GRIDS, Ground, Level, SKY, SLOPES, SUN, plan_level, plan_next};
use super::super::sides::{DRAG, KEPT_AT_REST, KEPT_IN_DRAG, REST};
use super::{Preview, Running};

impl Preview {
    /// Starts a thread that makes the grids of the first preview, if there will be one.
    pub fn prepare(&mut self, state: &State) {
        if self.is_needed(state)
            && let Some(sides) = self.other_grids(state, DRAG, KEPT_IN_DRAG)
        {
            self.start_grids(state, DRAG, sides);
        }
    }

    /// Whether the thread that makes grids still runs.
    pub fn makes_grids(&self) -> bool {
        self.next_grids.as_ref().is_some_and(|(_, thread)| !thread.is_finished())
    }

    /// Makes the levels if there are none and no thread has made them. If the present ones are too slow for a drag, a thread makes
    /// others, and the first input after it finishes uses them. Edited and animated heights, and sides that a script gives, wait for
    /// new levels.
    pub(super) fn fit(
        &mut self,
        screen: &mut Screen,
        state: &State,
        is_edited: bool,
    ) -> Result<()> {
        let Some(sides) = self.other_grids(state, DRAG, KEPT_IN_DRAG) else { return Ok(()) };
        let waits = self.sides.are_fixed() || state.is_moving() || is_edited;
        if waits {
            self.next_grids = None;
        }
        if self.take_grids(screen, state)? == Some(DRAG) {
            return Ok(());
        }
        if waits || self.levels[DRAG].is_none() {
            self.end_stage(DRAG, screen)?;
            self.next_grids = None;
            self.levels[DRAG] = Some(levels_of(grounds(&state.scene, sides)?));
        } else {
            self.start_grids(state, DRAG, sides);
        }
        Ok(())
    }

    /// Starts a thread that makes other grids, unless one makes those of a drag.
    pub(super) fn start_grids(&mut self, state: &State, stage: usize, sides: [usize; GRIDS]) {
        if self.next_grids.take_if(|(running, _)| stage == DRAG && *running == REST).is_some() {
            self.needs_rest_grids = true;
        }
        if self.next_grids.is_none() {
            let scene = state.scene.clone();
            let thread = std::thread::spawn(move || grounds(&scene, sides));
            self.next_grids = Some((stage, thread));
        }
    }

    /// Takes the grids that a thread has made, with the present lights. Returns their stage.
    fn take_grids(&mut self, screen: &mut Screen, state: &State) -> Result<Option<usize>> {
        let made = self.next_grids.take_if(|(_, thread)| thread.is_finished());
        let Some((stage, thread)) = made else { return Ok(None) };
        let grounds = joined(thread.join())?;
        self.end_stage(stage, screen)?;
        let levels = self.levels[stage].insert(levels_of(grounds));
        levels.iter_mut().try_for_each(|level| level.take(state, (None, true)))?;
        Ok(Some(stage))
    }

    /// Sides of the blocks of a stage's grids that fit the time, unless those in use are kept.
    pub(super) fn other_grids(
        &self,
        state: &State,
        stage: usize,
        kept_at: Range<f64>,
    ) -> Option<[usize; GRIDS]> {
        let sides = |levels: &[Level; GRIDS]| levels.each_ref().map(|level| level.blocks.side);
        let [drag, rest] = self.levels.each_ref().map(|levels| levels.as_ref().map(sides));
        match stage {
            DRAG => self.sides.for_drag(state, drag, kept_at),
            _ => self.sides.for_rest(state, drag?, rest),
        }
    }

    /// Continues the change to other grids: takes them once they are made, then plans one at a time. Each is lit once, as a driver
    /// may compile the shaders only then. Those of the rest preview come last. Returns whether its memory has changed.
    pub(super) fn change_grids(
        &mut self,
        screen: &mut Screen,
        state: &State,
        (full_bytes, limits): (u64, &Limits),
    ) -> Result<bool> {
        if self.take_grids(screen, state)?.is_some() {
            return Ok(false);
        }
        if self.unlit(DRAG).is_some() {
            let levels = self.levels[DRAG].as_mut().expect("has a grid");
            if !plan_next(levels, screen, state, limits)? {
                run_levels(levels, screen, state, limits)?;
            }
            return Ok(false);
        }
        if let Some(of) = self.unlit(REST) {
            let is_lit = self.light_rest_grid(screen, of, (state, limits))?;
            if is_lit && self.bytes() + full_bytes > limits.memory_budget {
                self.give_up_rest(screen)?;
            }
            return Ok(true);
        }
        if self.needs_rest_grids && self.next_grids.is_none() {
            self.needs_rest_grids = false;
            if let Some(sides) = self.other_grids(state, REST, KEPT_AT_REST) {
                self.start_grids(state, REST, sides);
            }
        }
        Ok(false)
    }

    /// Lights a grid of the rest preview. Where that fails, the rest preview is freed until the full light needs other memory, and the
    /// result is false.
    pub(super) fn light_rest_grid(
        &mut self,
        screen: &mut Screen,
        of: usize,
        (state, limits): (&State, &Limits),
    ) -> Result<bool> {
        let Some(levels) = &mut self.levels[REST] else { return Ok(false) };
        levels[of].take(state, (None, true))?;
        if !levels[of].is_used() {
            return Ok(true);
        }
        let borrowed = plan_level(levels, of, screen, (state, limits));
        match borrowed.and_then(|borrowed| levels[of].run(screen, &borrowed)) {
            Ok(slot) => self.running = slot.map(|slot| Running::Rest(of, slot)),
            Err(_) => {
                self.times.clear();
                self.give_up_rest(screen)?;
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Frees the grids of a stage.
    pub(super) fn end_stage(&mut self, stage: usize, screen: &mut Screen) -> Result<()> {
        self.running.take_if(|running| match running {
            Running::Preview(_) => stage == DRAG,
            Running::Rest(..) => stage == REST,
            Running::Full(_) => false,
        });
        self.shown.take_if(|shown| *shown == stage);
        let frames = self.levels[stage].take().into_iter().flatten().filter_map(|level| level.lit);
        frames.map(|lit| screen.end(lit)).fold(Ok(()), Result::and)
    }
}

/// The grids of blocks of these sides.
fn grounds(scene: &Scene, sides: [usize; GRIDS]) -> Result<[Ground; GRIDS]> {
    let ground = |of: usize| Ground::new(scene, of, sides[of]);
    Ok([ground(SKY)?, ground(SUN)?, ground(SLOPES)?])
}

/// Lights the grids. Returns the slots that hold their times.
pub(super) fn run_levels(
    levels: &mut [Level; GRIDS],
    screen: &mut Screen,
    state: &State,
    limits: &Limits,
) -> Result<[Option<usize>; GRIDS]> {
    // All plans come first, as uploads of normals wait for the device.
    let mut borrowed = Vec::new();
    for of in 0..GRIDS {
        if levels[of].is_used() {
            borrowed = plan_level(levels, of, screen, (state, limits))?;
        }
    }
    let mut slots = [None; GRIDS];
    for (level, slot) in levels.iter_mut().zip(&mut slots).filter(|(level, _)| level.is_used()) {
        let borrowed = if level.of == SLOPES { borrowed.as_slice() } else { &[] };
        *slot = level.run(screen, borrowed)?;
    }
    Ok(slots)
}

fn levels_of([sky, sun, slopes]: [Ground; GRIDS]) -> [Level; GRIDS] {
    [Level::new(SKY, sky), Level::new(SUN, sun), Level::new(SLOPES, slopes)]
}

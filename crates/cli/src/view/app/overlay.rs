//! The panel: its events, its passes, and what it changes.

use ridgelight::Result;
use winit::event::{ElementState, WindowEvent};
use winit::keyboard::{Key, NamedKey};

use super::super::marks::{Labels, paint_over};
use super::super::panel::Panel;
use super::super::state::{Change, State, Text};
use super::drawing::places;
use super::{App, OpenWindow};

impl App<'_> {
    /// Gives an event to the panel. Whether it is for the panel alone.
    pub(super) fn is_for_panel(&mut self, event: &WindowEvent) -> Result<bool> {
        let Some(OpenWindow { gui, window, .. }) = &mut self.shown else { return Ok(false) };
        let is_at = gui.is_at(self.cursor);
        match event {
            WindowEvent::ModifiersChanged(_)
            | WindowEvent::Focused(_)
            | WindowEvent::ScaleFactorChanged { .. } => {
                gui.hear(window, event);
                return Ok(false);
            }
            WindowEvent::CursorLeft { .. } if is_at => gui.hear(window, event),
            WindowEvent::CursorMoved { position, .. } if self.held.is_none() => {
                gui.hear(window, event);
                let to = [position.x, position.y];
                let is_for_panel = gui.holds_pointer || gui.is_at(to);
                if is_for_panel {
                    self.cursor = to;
                } else if !is_at {
                    return Ok(false);
                }
                self.due = self.due.max(1);
                return Ok(is_for_panel);
            }
            WindowEvent::MouseInput { state: ElementState::Pressed, .. } => {
                if self.held.is_some() || !(is_at || gui.holds_pointer) {
                    gui.leave();
                    self.due = self.due.max(1);
                    return Ok(false);
                }
                gui.holds_pointer = true;
                return self.hear_button(event);
            }
            WindowEvent::MouseInput { state: ElementState::Released, .. } => {
                if !gui.holds_pointer {
                    return Ok(false);
                }
                gui.holds_pointer = false;
                return self.hear_button(event);
            }
            WindowEvent::MouseWheel { .. } if is_at => gui.hear(window, event),
            WindowEvent::KeyboardInput { event: key, .. } => {
                // Also of keys that went down when a text field had the focus.
                if key.state == ElementState::Released {
                    gui.hear(window, event);
                    return Ok(false);
                }
                let is = |named| key.logical_key == Key::Named(named);
                if !gui.takes_keys(is(NamedKey::Escape)) || is(NamedKey::Tab) {
                    return Ok(false);
                }
                gui.hear(window, event);
                self.run_panel()?;
            }
            WindowEvent::Ime(_) if gui.takes_keys(false) => gui.hear(window, event),
            _ => return Ok(false),
        }
        self.due = self.due.max(1);
        Ok(true)
    }

    /// egui takes the pointer's last position in a pass as the position of a button event. A pass before the event and one
    /// after it let a fast drag begin where the button went down.
    fn hear_button(&mut self, event: &WindowEvent) -> Result<bool> {
        self.run_panel()?;
        if let Some(OpenWindow { gui, window, .. }) = &mut self.shown {
            gui.hear(window, event);
        }
        self.run_panel()?;
        self.due = self.due.max(1);
        Ok(true)
    }

    /// Runs a pass and does what it asks for.
    fn run_panel(&mut self) -> Result<()> {
        let Some(shown) = &mut self.shown else { return Ok(()) };
        let (changes, _) = shown.run_panel(&self.state);
        self.change(changes)
    }

    /// Does what the panel asks for.
    pub(super) fn change(&mut self, changes: Vec<Change>) -> Result<()> {
        for change in changes {
            let (size, _) = self.within(self.cursor);
            let before = self.state.light();
            let wish = self.state.change(change, size);
            self.grant(wish, before)?;
        }
        Ok(())
    }
}

impl OpenWindow {
    /// Runs a pass of the panel, once there is light. Returns what it asks for, and whether egui asks for another pass.
    pub(super) fn run_panel(&mut self, state: &State) -> (Vec<Change>, bool) {
        let Self { preview, lit, compare, figures, gui, window, screen, .. } = self;
        if preview.lit().is_none() && lit.is_none() {
            return (Vec::new(), false);
        }
        let (lefts, size) = places(self.size, compare.is_some());
        // If only one picture fits, it is the main one, without a label.
        let compared = compare.as_ref().filter(|_| lefts.len() > 1 && state.text != Text::Nothing);
        let words = compared.map(|compare| compare.labels());
        let labels = Labels { words: words.as_ref(), lefts: &lefts, size };
        let marks = state.marks(size);
        let mut panel = Panel::default();
        let (textures, asks) = gui.run(window, self.size, |ui| {
            panel.places.clear();
            paint_over(ui, &marks, &labels);
            panel.show(ui, state, figures);
        });
        screen.set_textures(textures);
        self.places = panel.places;
        (panel.changes, asks)
    }
}

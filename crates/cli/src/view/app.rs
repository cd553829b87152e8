//! The window's events and frames.

mod compare;
mod drawing;
mod level;
mod overlay;
mod preview;
mod saving;
mod sides;
mod steps;

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::{Duration, Instant};

use ridgelight::gpu::Frame;
use ridgelight::plan::{Limits, Rectangle};
use ridgelight::scene::Camera;
use ridgelight::{Error, Result};
use ridgelight_viewer::Screen;
use winit::application::ApplicationHandler;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::{Key, ModifiersState, NamedKey};
use winit::window::{Window, WindowId};

use super::gui::Gui;
use super::opening::{Opened, destroyed};
use super::script::{Button, Step};
use super::state::{Figures, Light, State, Wish};
use crate::args::ViewArgs;
use crate::setup::tuned;
use compare::Compare;
pub use preview::Preview;
pub use saving::save_pixels;

/// Interval between attempts of a window that shows nothing.
const PAUSE: Duration = Duration::from_millis(50);
/// Interval between questions to a device that is busy with a preview or its refinement.
const GLANCE: Duration = Duration::from_millis(2);

pub struct App<'a> {
    args: &'a ViewArgs,
    state: State,
    shown: Option<OpenWindow>,
    /// The rest of the script; none without a script.
    steps: Option<VecDeque<Step>>,
    /// Why it ended.
    error: Option<Error>,
    keys: ModifiersState,
    cursor: [f64; 2],
    held: Option<Button>,
    /// Whether the window is hidden, as far as its system reports that.
    is_hidden: bool,
    /// Frames still to be drawn; timings of a frame arrive two frames later.
    due: u32,
    frames: u64,
    /// Milliseconds of the frames since the last report.
    spent: Vec<f64>,
    last: Option<Instant>,
    /// Since when the window has shown nothing though it should, and why.
    blank: Option<(Instant, &'static str)>,
    /// How long it may, where a script draws.
    patience: Duration,
    /// Whether slow light is previewed; scripts ask for it, as their pictures must not depend on time.
    previews: bool,
    /// Whether a picture is to be saved once the full light is complete.
    saves_picture: bool,
    /// The clipboard, once used: it serves other programs as long as this one runs.
    clipboard: Option<arboard::Clipboard>,
    /// When the first input came that no submitted picture shows.
    asked: Option<Instant>,
    /// The same for a picture that the device is drawing, and that picture's slot.
    answering: Option<(Instant, usize)>,
    /// Milliseconds from input to picture since the last report.
    answers: Vec<f64>,
}

/// A window and its frames.
struct OpenWindow {
    lit: Option<Frame>,
    /// Whether the light must be recomputed.
    is_stale: bool,
    /// Whether all heights are new and nothing else has changed.
    has_moved: bool,
    /// Where specular is viewed from; `None` for a view from straight above.
    eye_m: Option<[f64; 3]>,
    /// The last light that could be drawn.
    good: Option<Light>,
    /// Whether that light is being recomputed after a refusal.
    has_fallen_back: bool,
    gui: Gui,
    /// Places of the panel's parts by name, units of egui.
    places: Vec<(String, egui::Rect)>,
    preview: Preview,
    /// Whether the last picture has the mesh of moving views.
    has_coarse_mesh: bool,
    /// The last picture's camera, and when it last turned.
    camera: Option<Camera>,
    turned: Option<Instant>,
    /// The comparison pictures, if shown.
    compare: Option<Compare>,
    figures: Figures,
    last_edit: Option<Rectangle>,
    limits: Limits,
    screen: Screen,
    window: Arc<Window>,
    /// The size of the arguments, then that of the last resize event, for surfaces without a size of their own.
    inner: [u32; 2],
    /// Size of each picture.
    size: [u32; 2],
}

impl<'a> App<'a> {
    pub fn new(
        args: &'a ViewArgs,
        state: State,
        steps: Option<VecDeque<Step>>,
        (Opened { window, inner, mut screen, gui }, preview): (Opened, Preview),
    ) -> Self {
        let limits = tuned::limits(screen.gpu().report(), args.global.memory_budget);
        let shown = OpenWindow {
            lit: None,
            is_stale: true,
            has_moved: false,
            eye_m: None,
            good: None,
            has_fallen_back: false,
            gui,
            places: Vec::new(),
            preview,
            has_coarse_mesh: false,
            camera: None,
            turned: None,
            compare: None,
            figures: Figures::default(),
            last_edit: None,
            limits,
            screen,
            window,
            inner,
            size: args.size,
        };
        Self {
            args,
            state,
            shown: Some(shown),
            previews: steps.is_none(),
            saves_picture: false,
            clipboard: None,
            asked: None,
            answering: None,
            answers: Vec::new(),
            steps,
            error: None,
            keys: ModifiersState::empty(),
            cursor: [0.0; 2],
            held: None,
            is_hidden: false,
            due: 3,
            frames: 0,
            spent: Vec::new(),
            last: None,
            blank: None,
            patience: steps::PATIENCE,
        }
    }

    /// The result of the run.
    pub fn end(mut self) -> Result<()> {
        self.close();
        self.error.map_or(Ok(()), Err)
    }

    /// Frees the device's resources and reports validation messages.
    fn close(&mut self) {
        let Some(mut shown) = self.shown.take() else { return };
        let beside = shown.compare.take().map_or(Ok(()), |old| old.end(&mut shown.screen));
        let previews = shown.preview.end(&mut shown.screen);
        let freed = shown.lit.take().map_or(Ok(()), |lit| shown.screen.end(lit));
        let freed = freed.and(beside).and(previews);
        let said = shown.screen.gpu().take_messages();
        if self.args.validate {
            crate::say!("{} validation messages", said.len());
        }
        if let (Err(error), None) = (freed, &self.error) {
            self.error = Some(error);
        }
        if let (Some(first), None) = (said.first(), &self.error) {
            let doing = format!("{} validation messages", said.len());
            self.error = Some(Error::Device { doing, reason: first.clone() });
        }
    }

    /// Whether a change not yet shown must be drawn.
    fn is_due(&self) -> bool {
        let gathers = |compare: &Compare| compare.is_busy(&self.state);
        let compare = self.shown.as_ref().and_then(|shown| shown.compare.as_ref());
        self.due > 0 || !self.is_hidden && (self.state.is_moving() || compare.is_some_and(gathers))
    }

    fn failed(&mut self, events: &ActiveEventLoop, error: Error) {
        self.error.get_or_insert(error);
        events.exit();
    }

    /// The window's pixels.
    fn size(&self) -> [u32; 2] {
        self.shown.as_ref().map_or(self.args.size, |shown| shown.size)
    }

    /// The size of one of the pictures side by side, or of the only one; and the position within it
    /// of a place in the window.
    fn within(&self, [x, y]: [f64; 2]) -> ([u32; 2], [f64; 2]) {
        let (lefts, size) = drawing::places(self.size(), self.state.is_split);
        let left = lefts.iter().map(|l| f64::from(*l)).rev().find(|l| *l <= x).unwrap_or(0.0);
        (size, [x - left, y])
    }

    fn key(&mut self, name: &str) -> Result<bool> {
        let (size, _) = self.within(self.cursor);
        let before = self.state.light();
        let wish = self.state.key(name, size);
        self.grant(wish, before)
    }
}

fn name(key: &Key, keys: ModifiersState) -> Option<String> {
    let name = match key {
        Key::Named(NamedKey::ArrowLeft) => "left",
        Key::Named(NamedKey::ArrowRight) => "right",
        Key::Named(NamedKey::ArrowUp) => "up",
        Key::Named(NamedKey::ArrowDown) => "down",
        Key::Named(NamedKey::Home) => "home",
        Key::Named(NamedKey::Tab) => "tab",
        Key::Named(NamedKey::Delete) => "delete",
        Key::Named(NamedKey::PageUp) => "pageup",
        Key::Named(NamedKey::PageDown) => "pagedown",
        Key::Named(NamedKey::Escape) => "escape",
        Key::Character(text) => return Some(text.to_lowercase()),
        _ => return None,
    };
    Some(if keys.shift_key() { format!("shift+{name}") } else { name.to_owned() })
}

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, _: &ActiveEventLoop) {}

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        match self.heard(event) {
            Ok(true) => {}
            Ok(false) => events.exit(),
            Err(error) => self.failed(events, error),
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        match self.turn() {
            Ok(true) => {}
            Ok(false) => return events.exit(),
            Err(error) => return self.failed(events, error),
        }
        let uses_preview = self.uses_preview();
        let refines = self.refines();
        let is_busy = self.is_due() || self.steps.is_some();
        events.set_control_flow(match (is_busy, self.blank) {
            (true, Some(_)) => ControlFlow::wait_duration(PAUSE),
            _ if refines || uses_preview && is_busy => ControlFlow::wait_duration(GLANCE),
            (true, None) => ControlFlow::Poll,
            _ if self.answering.is_some() => ControlFlow::wait_duration(GLANCE),
            (false, _) => ControlFlow::Wait,
        });
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.close();
    }
}

impl App<'_> {
    /// Whether a preview leaves work for a picture at rest, for the panel or for the next input.
    fn refines(&self) -> bool {
        let has_more = |OpenWindow { preview, has_coarse_mesh, .. }: &OpenWindow| {
            preview.is_busy() || preview.has_more() || *has_coarse_mesh
        };
        self.uses_preview() && self.shown.as_ref().is_some_and(has_more)
    }

    /// Whether to go on.
    fn heard(&mut self, event: WindowEvent) -> Result<bool> {
        if self.is_for_panel(&event)? {
            return Ok(true);
        }
        match event {
            WindowEvent::CloseRequested => return Ok(false),
            WindowEvent::Destroyed => return Err(destroyed()),
            WindowEvent::Resized(size) => {
                if let Some(shown) = &mut self.shown {
                    shown.inner = size.into();
                }
                self.due = self.due.max(1);
            }
            WindowEvent::RedrawRequested | WindowEvent::ScaleFactorChanged { .. } => {
                self.due = self.due.max(1);
            }
            WindowEvent::Occluded(is_hidden) => {
                self.is_hidden = is_hidden;
                self.due = self.due.max(1);
            }
            WindowEvent::ModifiersChanged(keys) => self.keys = keys.state(),
            // Keys that are down when the window gets the focus belong to another window, or are
            // repeats.
            WindowEvent::KeyboardInput { event, is_synthetic: false, .. }
                if event.state == ElementState::Pressed =>
            {
                if let Some(name) = name(&event.logical_key, self.keys) {
                    return self.key(&name);
                }
            }
            WindowEvent::MouseInput { state, button, .. } => {
                let is_sun = button == MouseButton::Right || self.keys.shift_key();
                let held = match button {
                    MouseButton::Left | MouseButton::Right if is_sun => Some(Button::Right),
                    MouseButton::Left => Some(Button::Left),
                    MouseButton::Middle => Some(Button::Middle),
                    _ => return Ok(true),
                };
                self.held = held.filter(|_| state == ElementState::Pressed);
                return match self.held {
                    Some(button) => self.press(button),
                    None => self.release(),
                };
            }
            WindowEvent::CursorMoved { position, .. } => {
                let way = [position.x - self.cursor[0], position.y - self.cursor[1]];
                let dragged = self.held.map(|button| self.drag(button, way));
                self.cursor = [position.x, position.y];
                if let Some(dragged) = dragged {
                    return dragged;
                }
                let wish = self.state.point(self.within(self.cursor).1);
                return self.do_plainly(wish);
            }
            WindowEvent::MouseWheel { delta, .. } => {
                let notches = match delta {
                    MouseScrollDelta::LineDelta(_, up) => f64::from(up),
                    // A touchpad's pixels, about as many as a line of text is high.
                    MouseScrollDelta::PixelDelta(way) => way.y / 20.0,
                };
                return self.wheel(notches, self.cursor);
            }
            _ => {}
        }
        Ok(true)
    }

    fn press(&mut self, button: Button) -> Result<bool> {
        let (size, at) = self.within(self.cursor);
        let before = self.state.light();
        let wish = self.state.press(button, at, size);
        self.grant(wish, before)
    }

    fn release(&mut self) -> Result<bool> {
        let wish = self.state.release();
        self.do_plainly(wish)
    }

    /// A drag that starts at the cursor.
    fn drag(&mut self, button: Button, way: [f64; 2]) -> Result<bool> {
        let (size, from) = self.within(self.cursor);
        let before = self.state.light();
        let wish = self.state.drag(button, from, way, size);
        self.grant(wish, before)
    }

    fn wheel(&mut self, notches: f64, at: [f64; 2]) -> Result<bool> {
        let (size, at) = self.within(at);
        let wish = self.state.wheel(notches, at, size);
        self.do_plainly(wish)
    }

    /// Events that change no light.
    fn do_plainly(&mut self, wish: Wish) -> Result<bool> {
        if wish != Wish::Nothing {
            self.asked.get_or_insert_with(Instant::now);
            self.due = self.due.max(1);
        }
        Ok(true)
    }
}

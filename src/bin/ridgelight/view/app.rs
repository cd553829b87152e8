//! The window's events, and its frames.

mod drawing;
mod saving;
mod steps;

use std::collections::VecDeque;
use std::sync::Arc;
use std::time::Instant;

use ridgelight::gpu::{Frame, HeadlessOptions, Screen, Timing};
use ridgelight::plan::Limits;
use ridgelight::{Error, Result};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, MouseButton, MouseScrollDelta, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::keyboard::{Key, ModifiersState, NamedKey};
use winit::window::{Window, WindowId};

use super::script::{Button, Step};
use super::state::State;
use crate::args::ViewArgs;

pub struct App<'a> {
    args: &'a ViewArgs,
    state: State,
    shown: Option<Shown>,
    /// None without a script; what is left of it.
    steps: Option<VecDeque<Step>>,
    /// Why it ended.
    error: Option<Error>,
    keys: ModifiersState,
    cursor: [f64; 2],
    held: Option<Button>,
    /// Frames that are still to be drawn; the figures of one are known two frames later.
    due: u32,
    frames: u64,
    /// Milliseconds of the frames since the last report.
    spent: Vec<f64>,
    last: Option<Instant>,
}

/// A window and what is drawn in it.
struct Shown {
    lit: Option<Frame>,
    /// Whether the light has to be found anew.
    is_stale: bool,
    times: Vec<Timing>,
    limits: Limits,
    screen: Screen,
    window: Arc<Window>,
    /// Of its pictures.
    size: [u32; 2],
}

impl<'a> App<'a> {
    pub fn new(args: &'a ViewArgs, state: State, steps: Option<VecDeque<Step>>) -> Self {
        Self {
            args,
            state,
            shown: None,
            steps,
            error: None,
            keys: ModifiersState::empty(),
            cursor: [0.0; 2],
            held: None,
            due: 0,
            frames: 0,
            spent: Vec::new(),
            last: None,
        }
    }

    /// What it ended with.
    pub fn end(mut self) -> Result<()> {
        self.close();
        self.error.map_or(Ok(()), Err)
    }

    fn open(&mut self, events: &ActiveEventLoop) -> Result<()> {
        let [width, height] = self.args.size;
        let name = self.args.input.path.file_name().unwrap_or_default().to_string_lossy();
        let attributes = Window::default_attributes()
            .with_title(format!("{name} - ridgelight"))
            .with_inner_size(PhysicalSize::new(width, height));
        let refused = |e: winit::error::OsError| Error::Device {
            doing: "opening a window".into(),
            reason: e.to_string(),
        };
        let window = Arc::new(events.create_window(attributes).map_err(refused)?);
        let options = HeadlessOptions {
            device: self.args.global.device.clone(),
            validation: self.args.validate,
        };
        let mut screen = Screen::new(Arc::clone(&window), &options)?;
        let mut limits = screen.gpu().report().limits;
        if let Some(budget) = self.args.global.memory_budget {
            limits.memory_budget = budget;
        }
        let (size, times) = (self.args.size, Vec::new());
        self.shown = Some(Shown { lit: None, is_stale: true, times, limits, screen, window, size });
        self.due = 3;
        Ok(())
    }

    /// Frees what is on the device; tells what validation said.
    fn close(&mut self) {
        let Some(mut shown) = self.shown.take() else { return };
        let freed = shown.lit.take().map_or(Ok(()), |lit| shown.screen.end(lit));
        let said = shown.screen.gpu().take_messages();
        if let (Err(error), None) = (freed, &self.error) {
            self.error = Some(error);
        }
        if let (Some(first), None) = (said.first(), &self.error) {
            let doing = format!("{} validation messages", said.len());
            self.error = Some(Error::Device { doing, reason: first.clone() });
        }
    }

    fn failed(&mut self, events: &ActiveEventLoop, error: Error) {
        self.error.get_or_insert(error);
        events.exit();
    }

    fn size(&self) -> [u32; 2] {
        self.shown.as_ref().map_or(self.args.size, |shown| shown.size)
    }

    fn key(&mut self, name: &str) -> Result<bool> {
        let size = self.size();
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
        Key::Named(NamedKey::Escape) => "escape",
        Key::Character(text) => return Some(text.to_lowercase()),
        _ => return None,
    };
    Some(if keys.shift_key() { format!("shift+{name}") } else { name.to_owned() })
}

impl ApplicationHandler for App<'_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.shown.is_none()
            && let Err(error) = self.open(events)
        {
            self.failed(events, error);
        }
    }

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
        let is_busy = self.due > 0 || self.state.is_moving() || self.steps.is_some();
        events.set_control_flow(if is_busy { ControlFlow::Poll } else { ControlFlow::Wait });
    }

    fn exiting(&mut self, _: &ActiveEventLoop) {
        self.close();
    }
}

impl App<'_> {
    /// Whether to go on.
    fn heard(&mut self, event: WindowEvent) -> Result<bool> {
        match event {
            WindowEvent::CloseRequested => return Ok(false),
            WindowEvent::Resized(_)
            | WindowEvent::RedrawRequested
            | WindowEvent::Occluded(false)
            | WindowEvent::ScaleFactorChanged { .. } => self.due = self.due.max(1),
            WindowEvent::ModifiersChanged(keys) => self.keys = keys.state(),
            WindowEvent::KeyboardInput { event, .. } if event.state == ElementState::Pressed => {
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
            }
            WindowEvent::CursorMoved { position, .. } => {
                let way = [position.x - self.cursor[0], position.y - self.cursor[1]];
                self.cursor = [position.x, position.y];
                if let Some(button) = self.held {
                    return self.drag(button, way);
                }
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

    fn drag(&mut self, button: Button, way: [f64; 2]) -> Result<bool> {
        let size = self.size();
        let before = self.state.light();
        let wish = self.state.drag(button, way, size);
        self.grant(wish, before)
    }

    fn wheel(&mut self, notches: f64, at: [f64; 2]) -> Result<bool> {
        let size = self.size();
        let before = self.state.light();
        let wish = self.state.wheel(notches, at, size);
        self.grant(wish, before)
    }
}

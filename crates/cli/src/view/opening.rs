//! The window while the field is read: what is read, and how far it is.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::ScopedJoinHandle;
use std::time::{Duration, Instant};

use egui::{Align2, FontId, ProgressBar, Rect, Vec2, pos2};
use ridgelight::gpu::HeadlessOptions;
use ridgelight::scene::{Quality, Scene};
use ridgelight::{Error, Result};
use ridgelight_io as files;
use ridgelight_viewer::{PresentOptions, Screen};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, ControlFlow};
use winit::window::{Window, WindowId};

use super::app::{App, Preview, save_pixels};
use super::gui::{Gui, INK};
use super::script::Step;
use super::state::State;
use crate::args::ViewArgs;

/// A field that is read in less time shows no progress.
const PATIENCE: Duration = Duration::from_millis(150);
/// Interval between questions to the thread before that, and between pictures of the progress.
const GLANCE: Duration = Duration::from_millis(5);
const INTERVAL: Duration = Duration::from_millis(100);
const MIB: f64 = 1024.0 * 1024.0;

/// The thread that reads the field.
pub type Reading<'scope> = ScopedJoinHandle<'scope, Result<(Scene, Quality)>>;

/// A window with its device and its panel.
pub struct Opened {
    pub window: Arc<Window>,
    /// The size of the arguments, then that of the last resize event. For a destroyed window winit panics instead of giving a size.
    pub inner: [u32; 2],
    pub screen: Screen,
    pub gui: Gui,
}

/// The window's events: first while the field is read, then the viewer's.
pub struct Opening<'a, 'scope> {
    args: &'a ViewArgs,
    steps: Option<VecDeque<Step>>,
    reading: Option<Reading<'scope>>,
    began: Instant,
    opened: Option<Opened>,
    /// The state and the preview, while a thread makes the first preview's grids.
    read: Option<(State, Preview)>,
    app: Option<App<'a>>,
    error: Option<Error>,
}

impl<'a, 'scope> Opening<'a, 'scope> {
    pub fn new(
        args: &'a ViewArgs,
        steps: Option<VecDeque<Step>>,
        reading: Reading<'scope>,
    ) -> Self {
        let (opened, read, app, error) = (None, None, None, None);
        let began = Instant::now();
        Self { args, steps, reading: Some(reading), began, opened, read, app, error }
    }

    /// The result of the run. A window that is closed while the field is read ends the program.
    pub fn end(self) -> Result<()> {
        let Self { reading, opened, app, error, .. } = self;
        drop(opened);
        if let Some(error) = error {
            return Err(error);
        }
        if reading.is_some_and(|reading| !reading.is_finished()) {
            files::abandon_unfinished();
            std::process::exit(0);
        }
        app.map_or(Ok(()), App::end)
    }

    fn failed(&mut self, events: &ActiveEventLoop, error: Error) {
        // An error of the field comes before one of the window.
        let of_field = self.reading.take().and_then(|reading| joined(reading.join()).err());
        self.error.get_or_insert(of_field.unwrap_or(error));
        events.exit();
    }

    fn open(&self, events: &ActiveEventLoop) -> Result<Opened> {
        let [width, height] = self.args.size;
        let attributes = Window::default_attributes()
            .with_title(format!("{} - ridgelight", name(self.args.input.first())))
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
        let screen = Screen::new(Arc::clone(&window), &options)?;
        let gui = Gui::new(&window);
        Ok(Opened { window, inner: self.args.size, screen, gui })
    }

    /// Shows the progress, or the viewer once the field is read. Returns whether that has begun.
    fn advance(&mut self) -> Result<bool> {
        // A script's pictures do not depend on time: it shows the progress as its first step, or never.
        let is_step = |step: Option<&Step>| matches!(step, Some(Step::Opening(_)));
        if let Some(steps) = self.steps.as_mut().filter(|steps| is_step(steps.front())) {
            if let (Some(opened), Some(Step::Opening(path))) = (&mut self.opened, steps.front()) {
                let Some((size, pixels)) = opened.show(&self.args.input.path, true)? else {
                    return Ok(false);
                };
                save_pixels(path, size, &pixels)?;
            }
            steps.pop_front();
            return Ok(false);
        }
        if let Some(opened) = &mut self.opened
            && let Some(reading) = self.reading.take_if(|reading| reading.is_finished())
        {
            let (scene, quality) = joined(reading.join())?;
            let state = State::new(self.args, scene, quality);
            let mut preview = Preview::new(opened.screen.gpu().report().limits.is_cpu);
            // A script begins without previews.
            if self.steps.is_none() {
                preview.prepare(&state);
            }
            self.read = Some((state, preview));
        }
        let is_ready = |read: &mut (State, Preview)| !read.1.makes_grids();
        if let Some((state, preview)) = self.read.take_if(is_ready)
            && let Some(opened) = self.opened.take()
        {
            self.app = Some(App::new(self.args, state, self.steps.take(), (opened, preview)));
            return Ok(true);
        }
        if let (None, Some(opened)) = (&self.steps, &mut self.opened)
            && self.began.elapsed() > PATIENCE
        {
            opened.show(&self.args.input.path, false)?;
        }
        Ok(false)
    }
}

/// The error of a window that another program has destroyed.
pub fn destroyed() -> Error {
    let reason = "another program has destroyed it".into();
    Error::Device { doing: "showing pictures in a window".into(), reason }
}

/// A thread's result.
pub fn joined<T>(result: std::thread::Result<T>) -> T {
    // Goes on with its panic, which it has reported.
    result.unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

fn name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A picture's size, and its pixels where they are kept.
type Drawn = ([u32; 2], Vec<[u8; 4]>);

impl Opened {
    /// Draws what has been read; none where the window is not ready.
    fn show(&mut self, paths: &[PathBuf], keeps: bool) -> Result<Option<Drawn>> {
        let Some(size) = self.screen.size(self.inner)? else { return Ok(None) };
        let all = paths.iter().filter_map(|path| std::fs::metadata(path).ok()).map(|m| m.len());
        let (all, done) = (all.sum::<u64>() as f64, files::bytes_read() as f64);
        let more = match paths.len() {
            0 | 1 => String::new(),
            count => format!(" and {} more", count - 1),
        };
        let what = paths.first().map(|path| name(path)).unwrap_or_default();
        let line = if done < all {
            format!("Reading {what}{more}: {:.1} of {:.1} MiB", done / MIB, all / MIB)
        } else {
            format!("Preparing {what}{more}: {:.1} MiB are read", all / MIB)
        };
        let share = if all > 0.0 { (done / all).min(1.0) as f32 } else { 1.0 };
        let (textures, _) = self.gui.run(&self.window, size, |ui| {
            let middle = ui.ctx().viewport_rect().center();
            let font = FontId::proportional(14.0);
            ui.painter().text(
                middle - Vec2::new(0.0, 16.0),
                Align2::CENTER_CENTER,
                &line,
                font,
                INK,
            );
            let bar =
                Rect::from_center_size(pos2(middle.x, middle.y + 10.0), Vec2::new(240.0, 8.0));
            ui.put(bar, ProgressBar::new(share).desired_height(8.0));
        });
        self.screen.set_textures(textures);
        let overlay = self.gui.overlay();
        let options = PresentOptions { voids: None, overlay, keeps };
        let done = self.screen.draw(&mut [], &options)?;
        Ok(done.map(|done| (size, done.pixels.unwrap_or_default())))
    }
}

impl ApplicationHandler for Opening<'_, '_> {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.app.is_none() && self.opened.is_none() {
            match self.open(events) {
                Ok(opened) => self.opened = Some(opened),
                Err(error) => self.failed(events, error),
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        if let Some(app) = &mut self.app {
            return app.window_event(events, id, event);
        }
        match (event, &mut self.opened) {
            (WindowEvent::CloseRequested, _) => events.exit(),
            (WindowEvent::Destroyed, _) => self.failed(events, destroyed()),
            (WindowEvent::Resized(size), Some(opened)) => opened.inner = size.into(),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if self.app.is_none() {
            let is_soon = self.steps.is_some() || self.began.elapsed() < PATIENCE;
            let interval = if is_soon { GLANCE } else { INTERVAL };
            events.set_control_flow(ControlFlow::wait_duration(interval));
            match self.advance() {
                Ok(true) => {}
                Ok(false) => return,
                Err(error) => return self.failed(events, error),
            }
        }
        if let Some(app) = &mut self.app {
            app.about_to_wait(events);
        }
    }

    fn exiting(&mut self, events: &ActiveEventLoop) {
        if let Some(app) = &mut self.app {
            app.exiting(events);
        }
    }
}

//! `ridgelight view`: a lit field in a window.

mod app;
mod brush;
mod gui;
mod marks;
mod moving;
mod opening;
mod panel;
mod script;
mod smaller;
mod state;
mod strokes;

use std::collections::VecDeque;

use ridgelight::plan::{self, Limits};
use ridgelight::scene::{Quality, Scene};
use ridgelight::{Error, Result};
use winit::event_loop::EventLoop;

use crate::args::ViewArgs;
use crate::idle;
use crate::setup::{self, Outcome};
use opening::{Opening, Reading};
use script::Step;

pub fn run(args: &ViewArgs) -> Result<Outcome> {
    let inputs = setup::inputs(&args.input.path, &args.scene);
    setup::check_outputs(&[("--json", args.global.json.as_deref(), &["json"])], &inputs)?;
    args.exposure.map_or(Ok(()), |e| crate::render::check_positive("--exposure", e))?;
    let quality = args.quality.quality()?;
    std::thread::scope(|scope| {
        // The window opens meanwhile.
        let reading = scope.spawn(|| load(args, quality));
        show(args, reading)
    })
}

/// Reads the field and checks the request.
fn load(args: &ViewArgs, mut quality: Quality) -> Result<(Scene, Quality)> {
    let field = setup::field(&args.input.path, &args.scene.field, &args.global)?;
    let unlit = setup::Unlit::of(&quality, None);
    let mut scene = setup::scene(field, &args.scene, unlit, args.global.quiet)?;
    setup::tinted(&mut scene, &args.scene);
    setup::suit(&mut quality, &args.quality, (&scene, None));
    let still = setup::wanted(&[]);
    let picture = |limits: &Limits| plan::picture(&scene, &quality, limits, still);
    setup::check_plan(&args.global, picture)?;
    let used = picture(&Limits::boundless(true, 1 << 50))
        .or_else(|_| picture(&Limits::boundless(false, 1 << 50)))?;
    idle::say(args.global.quiet, &args.quality.written, &used.settings);
    Ok((scene, quality))
}

/// Shows the window from now on. An error of the field comes before one of the window.
fn show(args: &ViewArgs, reading: Reading<'_>) -> Result<Outcome> {
    let (events, steps) = match prepare(args) {
        Ok(prepared) => prepared,
        Err(error) => return opening::joined(reading.join()).and(Err(error)),
    };
    let mut opening = Opening::new(args, steps, reading);
    let ended = events.run_app(&mut opening).map_err(no_display);
    opening.end().and(ended).map(|()| Outcome::Done)
}

/// The steps of a script, if there is one.
type Steps = Option<VecDeque<Step>>;

fn prepare(args: &ViewArgs) -> Result<(EventLoop<()>, Steps)> {
    let steps = args.script.as_deref().map(script::read).transpose()?.map(VecDeque::from);
    check_keyboard()?;
    Ok((EventLoop::new().map_err(no_display)?, steps))
}

fn no_display(error: winit::error::EventLoopError) -> Error {
    let text = error.to_string();
    // The reason follows winit's source position.
    let why = text.rsplit_once(".rs:").and_then(|(_, rest)| rest.split_once(": "));
    let why = why.map_or(text.as_str(), |(_, why)| why).trim_end_matches('.');
    Error::Device { doing: "view".into(), reason: format!("needs a display: {why}") }
}

/// Refuses to start where winit would panic: on X it loads this library when it opens a window.
#[cfg(all(unix, not(target_vendor = "apple")))]
fn check_keyboard() -> Result<()> {
    let is_there = xkbcommon_dl::xkbcommon_option().is_some()
        && xkbcommon_dl::x11::xkbcommon_x11_option().is_some();
    let reason = "needs libxkbcommon-x11.so.0 (Debian: libxkbcommon-x11-0)";
    let missing = || Error::Device { doing: "view".into(), reason: reason.into() };
    is_there.then_some(()).ok_or_else(missing)
}

#[cfg(not(all(unix, not(target_vendor = "apple"))))]
fn check_keyboard() -> Result<()> {
    Ok(())
}

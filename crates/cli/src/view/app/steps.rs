//! One iteration of the loop: due frames and steps of a script.

use std::time::{Duration, Instant};

use ridgelight::{Error, Result};
use ridgelight_io as files;
use winit::dpi::PhysicalSize;

use super::super::script::Step;
use super::compare::MOST_PATHS;
use super::drawing::places;
use super::preview::Preview;
use super::saving::save_pixels;
use super::{App, OpenWindow};

/// How long a script's window may show nothing, unless the script sets it.
pub(super) const PATIENCE: Duration = Duration::from_secs(120);
/// How long a script waits for a requested size: window managers of busy machines take seconds.
const RESIZE_PATIENCE: Duration = Duration::from_secs(120);

impl App<'_> {
    /// False where it ends.
    pub(super) fn turn(&mut self) -> Result<bool> {
        if self.shown.is_none() {
            return Ok(true);
        }
        self.note_answer(None)?;
        if self.steps.is_none() {
            self.advance()?;
            return Ok(true);
        }
        let Some(step) = self.steps.as_mut().and_then(|steps| steps.pop_front()) else {
            return Ok(false);
        };
        let again = match step {
            Step::Key(name) => return self.key(&name),
            Step::Drag(button, from, way) => {
                self.cursor = from;
                self.press(button)?;
                self.drag(button, way)?;
                self.cursor = [from[0] + way[0], from[1] + way[1]];
                return self.release();
            }
            Step::Wheel(notches, at) => return self.wheel(notches, at),
            Step::Frames(0) => None,
            Step::Frames(left) => {
                let is_drawn = self.picture(false)?.is_some();
                self.check_shown("frames")?;
                Some(Step::Frames(left - u32::from(is_drawn)))
            }
            Step::Size(wanted) => self.resize(wanted, RESIZE_PATIENCE)?,
            Step::Resizing(wanted, until) => {
                let left = until.saturating_duration_since(Instant::now());
                self.resize(wanted, left)?
            }
            Step::Lose => {
                if let Some(shown) = &mut self.shown {
                    shown.screen.renew()?;
                }
                None
            }
            Step::Picture(path) => {
                if self.check_picture()? {
                    self.save_picture(Some(&path)).map(|()| None)?
                } else {
                    self.advance()?;
                    self.check_shown("picture")?;
                    Some(Step::Picture(path))
                }
            }
            Step::Scene(path) => self.save_scene(Some(&path)).map(|()| None)?,
            Step::Preview(sides) => {
                self.previews = true;
                if let Some(shown) = &mut self.shown {
                    shown.preview.sides.fixed = sides;
                }
                None
            }
            Step::RestPreview => {
                self.advance()?;
                let preview = self.shown.as_ref().map(|shown| &shown.preview);
                let awaits = preview.is_some_and(Preview::awaits_rest_preview);
                if !awaits && !preview.is_some_and(Preview::shows_rest_preview) {
                    let expected = "grids of its own, after a full light";
                    return Err(Error::setting("--script: rest-preview", "none", expected));
                }
                awaits.then_some(Step::RestPreview)
            }
            Step::Rest => {
                self.advance()?;
                let is_busy = self.refines() || self.answering.is_some();
                (is_busy || self.is_due()).then_some(Step::Rest)
            }
            Step::Screenshot(path) => match self.picture(true)? {
                Some(pixels) => save_pixels(&path, self.size(), &pixels).map(|()| None)?,
                None => {
                    self.check_shown("screenshot")?;
                    Some(Step::Screenshot(path))
                }
            },
            Step::Text(path) => files::write_text(&path, &self.text()).map(|()| None)?,
            Step::Command(path) => {
                let shown = self.shown.as_ref();
                let line = shown.map_or_else(String::new, |shown| self.command_line(shown));
                files::write_text(&path, &line).map(|()| None)?
            }
            Step::Places(path) => files::write_text(&path, &self.places()).map(|()| None)?,
            Step::Shown(path, name) => {
                let places = self.shown.as_ref().map_or(&[][..], |shown| &shown.places);
                let is_there = places.iter().any(|(known, _)| *known == name);
                let is_due = self.is_due();
                match (is_due, is_there) {
                    (true, _) => self.advance()?,
                    (false, true) => files::write_text(&path, &self.places())?,
                    (false, false) => std::thread::sleep(Duration::from_millis(5)),
                }
                (is_due || !is_there).then_some(Step::Shown(path, name))
            }
            Step::Paths(count) => {
                self.check_paths(count)?;
                let compare = self.shown.as_ref().and_then(|shown| shown.compare.as_ref());
                let has_all = compare.is_some_and(|c| c.paths() >= count);
                if !has_all {
                    self.draw(false)?;
                    self.check_shown("paths")?;
                }
                (!has_all).then_some(Step::Paths(count))
            }
            Step::Report(what) => {
                self.report(&what);
                None
            }
            Step::Wait(path) => {
                // Asked before the loop takes input once more: what came before the file is then heard.
                let is_there = path.exists();
                if self.is_due() {
                    self.advance()?;
                } else {
                    std::thread::sleep(Duration::from_millis(5));
                }
                Some(if is_there { Step::Heard } else { Step::Wait(path) })
            }
            Step::Heard => {
                if self.is_due() {
                    self.draw(false)?;
                }
                None
            }
            // As the first step it was done while the field was read.
            Step::Opening(path) => {
                let found = path.display().to_string();
                return Err(Error::setting("--script: opening", found, "the first step"));
            }
            Step::Patience(seconds) => {
                self.patience = Duration::from_secs_f64(seconds);
                None
            }
        };
        if let (Some(again), Some(steps)) = (again, &mut self.steps) {
            steps.push_front(again);
        }
        Ok(true)
    }

    /// Draws a picture; none where the device is busy with the last one of a preview.
    fn picture(&mut self, keeps: bool) -> Result<Option<Vec<[u8; 4]>>> {
        let is_ready = !self.uses_preview() || self.is_ready()?;
        if is_ready { self.draw(keeps) } else { Ok(None) }
    }

    /// Refuses a window that has shown nothing for too long.
    fn check_shown(&self, step: &str) -> Result<()> {
        let Some((_, why)) = self.blank.filter(|(since, _)| since.elapsed() > self.patience) else {
            return Ok(());
        };
        let reason =
            format!("the window has shown nothing for {} s: {why}", self.patience.as_secs_f64());
        Err(Error::Device { doing: format!("--script: {step}"), reason })
    }

    /// Whether so many paths per texel can be reached.
    fn check_paths(&self, count: u32) -> Result<()> {
        let width = self.shown.as_ref().map_or(0, |shown| shown.size[0]);
        let (found, expected) = if count > MOST_PATHS {
            (format!("{count}"), format!("{MOST_PATHS} or less"))
        } else if !self.state.is_split {
            ("no reference".to_owned(), "key c first".to_owned())
        } else if self.state.is_moving() {
            ("a moving field".to_owned(), "key w or key g first, which stops it".to_owned())
        } else if width > 0 && places([width, 1], true).0.len() < 3 {
            (format!("a window {width} pixels wide"), "room for three pictures".to_owned())
        } else {
            return Ok(());
        };
        Err(Error::setting("--script: paths", found, expected))
    }

    /// Requests a size until the pictures have it.
    fn resize(&mut self, wanted: [u32; 2], left: Duration) -> Result<Option<Step>> {
        let Some(shown) = &self.shown else { return Ok(None) };
        if shown.size == wanted {
            return Ok(None);
        }
        if left.is_zero() {
            let found = format!("{} × {}", shown.size[0], shown.size[1]);
            let expected = format!("{} × {}", wanted[0], wanted[1]);
            return Err(Error::setting("--script: size", found, expected));
        }
        let until = Instant::now() + left;
        if left == RESIZE_PATIENCE {
            let _ = shown.window.request_inner_size(PhysicalSize::new(wanted[0], wanted[1]));
        }
        self.draw(false)?;
        Ok(Some(Step::Resizing(wanted, until)))
    }

    /// The text of the panel.
    fn text(&self) -> String {
        let Some(OpenWindow { figures, .. }) = &self.shown else { return String::new() };
        let lines = self.state.lines(figures);
        lines.iter().map(|line| format!("{line}\n")).collect()
    }

    /// Names of the panel's parts, and the pixel in the middle and the size of each.
    fn places(&self) -> String {
        let Some(OpenWindow { places, window, .. }) = &self.shown else { return String::new() };
        let scale = window.scale_factor() as f32;
        let line = |(name, rect): &(String, egui::Rect)| {
            let (at, size) = (rect.center() * scale, rect.size() * scale);
            format!("{name}: {:.0} {:.0} {:.0} {:.0}\n", at.x, at.y, size.x, size.y)
        };
        places.iter().map(line).collect()
    }

    fn report(&mut self, what: &str) {
        let what = if what.is_empty() { String::new() } else { format!("{what}: ") };
        let spent = std::mem::take(&mut self.spent);
        let middle = median(spent.clone());
        let passes = self.shown.as_ref().map_or(0.0, |shown| shown.figures.ms());
        let resident = resident_kib().map_or_else(|| "unknown".into(), |kib| kib.to_string());
        let answers = std::mem::take(&mut self.answers);
        let preview = self.shown.as_ref().map(|shown| &shown.preview);
        if let (Some(slowest), Some(preview)) = (answers.iter().copied().reduce(f64::max), preview)
        {
            let after = |what: &str, s: Option<f64>| {
                s.map_or_else(String::new, |s| format!("; {what} {s:.2} s"))
            };
            let rest = after("rest preview", preview.rest_s);
            let full = rest + &after("full light", preview.full_s);
            let found = preview.errors.iter().flatten().map(|e| format!("{:.2}", 100.0 * e));
            let found = found.collect::<Vec<_>>().join(" / ");
            let errors = if found.is_empty() { found } else { format!("; RMSE {found} %") };
            crate::say!(
                "{what}input to picture, median {:.1} ms, longest {slowest:.1} ms ({}){full}{errors}",
                median(answers.clone()),
                answers.len(),
            );
        }
        crate::say!(
            "{what}frames {}, median of {} {middle:.3} ms, passes {passes:.3} ms, resident KiB {resident}",
            self.frames,
            spent.len()
        );
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Memory of this process, as Linux reports it.
fn resident_kib() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.trim().trim_end_matches("kB").trim().parse().ok()
}

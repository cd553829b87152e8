//! Saves pictures and scenes to files.

use std::path::{Path, PathBuf};

use ridgelight::scene::Tone;
use ridgelight::{Error, Result};
use ridgelight_io as files;

use super::{App, OpenWindow};
use crate::{render, setup};

impl App<'_> {
    /// Saves a picture under a free name, now or once the full light is complete.
    pub(super) fn request_picture(&mut self) -> Result<()> {
        match self.check_picture() {
            Err(why) => {
                self.state.message = Some(format!("not saved: {why}"));
                self.due = self.due.max(1);
            }
            Ok(true) => return self.save_picture(None),
            Ok(false) => {
                self.saves_picture = true;
                if self.uses_preview() {
                    let message = "the picture will be saved when the full light is complete";
                    if self.state.message.as_deref() != Some(message) {
                        self.state.message = Some(message.to_owned());
                        self.due = self.due.max(1);
                    }
                } else {
                    self.due = self.due.max(1);
                }
            }
        }
        Ok(())
    }

    /// Saves a picture that was requested before its light was complete.
    pub(super) fn save_requested(&mut self) -> Result<()> {
        let is_wanted = std::mem::take(&mut self.saves_picture);
        if is_wanted { self.request_picture() } else { Ok(()) }
    }

    /// Whether the full light is that of the current settings.
    ///
    /// # Errors
    /// Moving heights with previews, which never have it.
    pub(super) fn check_picture(&self) -> Result<bool> {
        let previews = self.uses_preview();
        if previews && self.state.is_moving() {
            let expected = "key w or key g first, which stops it";
            return Err(Error::setting("picture", "a moving field with previews", expected));
        }
        let shown = self.shown.as_ref();
        let is_old = |shown: &OpenWindow| {
            let is_old = shown.is_stale || shown.lit.is_none() || self.state.edited.is_some();
            let is_old = is_old || shown.eye_m != self.state.eye_m();
            is_old || shown.preview.is_busy() || !previews && shown.preview.is_old()
        };
        Ok(!shown.is_some_and(is_old) || self.state.is_moving())
    }

    /// Saves the lit field, one pixel per texel, or the camera's picture, to a file or to a free
    /// name.
    pub(super) fn save_picture(&mut self, path: Option<&Path>) -> Result<()> {
        let path = path.map_or_else(|| self.free_name("png"), Path::to_owned);
        let Some(shown) = &mut self.shown else { return Ok(()) };
        let Some(lit) = &shown.lit else { return Ok(()) };
        shown.screen.wait()?;
        let field = &self.state.scene.field;
        let tone = self.state.tone();
        let view = self.state.view(
            (&self.state.scene, None, false),
            lit.plan(),
            shown.size,
            &shown.limits,
        )?;
        let gpu = shown.screen.gpu();
        let pixels = gpu.pixels(lit, 0)?;
        if let Some(view) = view {
            let radiance = gpu.look(lit, &view, field.voids())?.radiance;
            let (rows, cols) = (view.size[1] as usize, view.size[0] as usize);
            let saved = files::write_png(&path, rows, cols, &radiance, None, tone, &view.settings);
            return self.say(saved, &path);
        }
        let saved = render::check_finite(&pixels, field).and_then(|()| {
            let metadata = setup::metadata(gpu, field, lit.plan());
            let (rows, cols) = (field.rows(), field.cols());
            let picture = render::rgb(&pixels);
            files::write_png(&path, rows, cols, &picture, field.voids(), tone, &metadata)
        });
        self.say(saved, &path)
    }

    /// Saves a scene for `render --scene`, and its heights if they have changed.
    pub(super) fn save_scene(&mut self, path: Option<&Path>) -> Result<()> {
        let path = path.map_or_else(|| self.free_name("json"), Path::to_owned);
        let Some(shown) = &self.shown else { return Ok(()) };
        let heights = self.state.has_other_heights().then(|| path.with_extension("npy"));
        let name = heights.as_ref().and_then(|h| h.file_name()).map(|n| n.to_string_lossy());
        let asked = self.state.asked(shown.size, &shown.limits, name.as_deref());
        let scene = asked.to_json();
        let save = |h: &PathBuf| files::write_npy_heights(h, &*self.state.field_shown()?);
        let saved = heights.iter().try_for_each(save);
        self.say(saved.and_then(|()| files::write_json(&path, &scene)), &path)
    }

    /// Copies the command line of `render` for the picture; prints it where there is no clipboard.
    pub(super) fn copy_command(&mut self) {
        self.due = self.due.max(1);
        let Some(shown) = &self.shown else { return };
        if self.state.has_other_heights() {
            let message = "brushes or motion changed the heights: save the scene (S) instead";
            self.state.message = Some(message.to_owned());
            return;
        }
        let line = self.command_line(shown);
        let copied = match &mut self.clipboard {
            Some(clipboard) => clipboard.set_text(&line),
            none => arboard::Clipboard::new()
                .and_then(|clipboard| none.insert(clipboard).set_text(&line)),
        };
        let message = match copied {
            Ok(()) => "copied the command line",
            Err(_) => {
                crate::say!("{line}");
                "no clipboard: the command line is on standard output"
            }
        };
        self.state.message = Some(message.to_owned());
    }

    /// The command line of `render` that draws the picture, quoted for a shell.
    pub(super) fn command_line(&self, shown: &OpenWindow) -> String {
        let mut words = vec!["ridgelight".to_owned(), "render".to_owned()];
        words.extend(self.state.asked(shown.size, &shown.limits, None).words());
        words.push(format!("--exposure={}", self.state.exposure));
        words.extend(["-o".to_owned(), self.free_name("png").display().to_string()]);
        words.iter().map(|word| setup::terminal::quoted(word)).collect::<Vec<_>>().join(" ")
    }

    /// Reports a saved file or an error, on the screen and on standard output. With a script an
    /// error ends the run.
    fn say(&mut self, saved: Result<()>, path: &Path) -> Result<()> {
        let line = match saved {
            Ok(()) => format!("saved {}", path.display()),
            Err(error) if self.steps.is_some() => return Err(error),
            Err(error) => format!("not saved: {error}"),
        };
        if !self.args.global.quiet {
            crate::say!("{line}");
        }
        self.state.message = Some(line);
        self.due = self.due.max(1);
        Ok(())
    }

    /// A free name in this folder, after the field's.
    fn free_name(&self, extension: &str) -> PathBuf {
        let stem = self.args.input.first().file_stem().unwrap_or_default().to_string_lossy();
        let name = |n: u32| PathBuf::from(format!("{stem}-view-{n}.{extension}"));
        let is_free = |path: &PathBuf| !path.exists() && !path.with_extension("npy").exists();
        (1..).map(name).find(is_free).expect("some number is free")
    }
}

/// Saves a window's pixels.
pub fn save_pixels(path: &Path, [width, height]: [u32; 2], pixels: &[[u8; 4]]) -> Result<()> {
    let steps = Tone::default().steps();
    let light: Vec<[f32; 3]> =
        pixels.iter().map(|p| [p[0], p[1], p[2]].map(|c| steps[usize::from(c)])).collect();
    let (rows, cols) = (height as usize, width as usize);
    files::write_png(path, rows, cols, &light, None, Tone::default(), &[])
}

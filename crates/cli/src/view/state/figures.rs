//! The text of the panel: figures, settings, and keys.

use ridgelight::gpu::Timing;
use ridgelight::plan::Rectangle;
use ridgelight::scene::Setting;

use super::lights::compass;
use super::{State, Text, Tool};
use crate::idle;
use crate::view::brush::Action;

/// The keys, as listed on the screen and in docs/viewer.md.
pub const KEYS: [&str; 21] = [
    "V                 from above, from a camera",
    "arrows, drag      move the map, turn the camera",
    "I J K L           move the map or the camera; middle drag",
    "+ - or wheel      nearer, farther     Home    all of it",
    "Shift+arrows      move the first sun, or add one; right drag",
    "E D  A            brighter, darker; automatic exposure",
    "C                 without shadows | Ridgelight | path-traced reference",
    "R                 error against the reference, with C",
    "M  B              method, bounces",
    "Tab Shift+Tab     select the next, the previous setting",
    ", .               lower, raise the selected setting (first: azimuths)",
    "1                 drag moves the view, as above",
    "2 3 4             drag raises, lowers, erodes",
    "5                 click places or selects a light; drag moves it",
    "[ ] ; '           size and strength of brush or light",
    "T  X  PgUp PgDn   the light's colour; delete it; up, down; O adds one",
    "Z Y               undo, redo",
    "W G               waves, a ridge that travels: on and off",
    "P                 save the picture, as `render` does",
    "S                 save the scene, for `render --scene`",
    "H    Q Esc        list and panel, panel only, neither; quit",
];

/// Measured values.
#[derive(Default)]
pub struct Figures {
    /// Passes of the last complete frame.
    pub light: Vec<Timing>,
    /// Passes that draw it.
    pub drawing: Vec<Timing>,
    /// The last edit, and milliseconds of its passes.
    pub edit: Option<(Rectangle, f64)>,
    /// Milliseconds from frame to frame.
    pub frame_ms: Option<f64>,
    /// Memory of the light and of the previews.
    pub bytes: u64,
    /// Settings of the full light; none while a preview is shown, which uses its own.
    pub used: Option<Vec<(String, String)>>,
    /// How the shown light was computed, where it is not the full one.
    pub preview: Option<String>,
    /// The share of the full light that is done, where it is being computed.
    pub progress: Option<f32>,
    /// Milliseconds from the last input to its picture, and seconds to the full light.
    pub answer_ms: Option<f64>,
    pub full_s: Option<f64>,
    /// Result of the comparison.
    pub compared: Option<String>,
}

impl Figures {
    fn times(&self) -> impl Iterator<Item = &Timing> {
        self.light.iter().chain(&self.drawing)
    }

    /// Nanoseconds by pass name, in order of first appearance.
    pub fn passes(&self) -> Vec<(&str, f64)> {
        let mut all: Vec<(&str, f64)> = Vec::new();
        for time in self.times() {
            let name = time.label.split(' ').next().unwrap_or_default();
            match all.iter_mut().find(|(known, _)| *known == name) {
                Some((_, ns)) => *ns += time.ns,
                None => all.push((name, time.ns)),
            }
        }
        all
    }

    /// Milliseconds of all passes.
    pub fn ms(&self) -> f64 {
        self.times().map(|t| t.ns).sum::<f64>() / 1e6
    }

    /// The time of all passes, and that from frame to frame.
    fn time_text(&self) -> String {
        let frame = self.frame_ms.map_or_else(String::new, |ms| format!("  frame {ms:.1} ms"));
        format!("passes {:.2} ms{frame}", self.ms())
    }

    fn mib(&self) -> f64 {
        self.bytes as f64 / f64::from(1 << 20)
    }
}

impl State {
    /// The panel as lines of text; none where it is hidden.
    pub fn lines(&self, figures: &Figures) -> Vec<String> {
        if self.text == Text::Nothing {
            return Vec::new();
        }
        let mut lines = self.lines_of_light();
        lines.extend(self.tool_line());
        lines.push(format!("{}  memory {:.1} MiB", figures.time_text(), figures.mib()));
        for (name, ns) in figures.passes() {
            lines.push(format!("  {name:<18}{:>9.2} ms", ns / 1e6));
        }
        lines.extend(self.lines_of_progress(figures));
        if self.text == Text::Settings {
            lines.push(String::new());
            lines.extend(self.setting_lines());
            lines.extend(self.notes(figures));
        }
        lines.extend(self.message.clone());
        if self.text == Text::Keys {
            lines.push(String::new());
            lines.extend(KEYS.iter().map(|line| (*line).to_owned()));
        }
        lines
    }

    /// The field, the tool, and the time of all passes: what the panel's other parts do not show.
    pub fn lines_beside_widgets(&self, figures: &Figures) -> Vec<String> {
        let field = &self.scene.field;
        let mut lines =
            vec![format!("{} x {}  memory {:.1} MiB", field.cols(), field.rows(), figures.mib())];
        lines.extend(self.tool_line());
        lines.push(figures.time_text());
        lines
    }

    /// Field, settings and sun.
    fn lines_of_light(&self) -> Vec<String> {
        let field = &self.scene.field;
        let word = |id: &str| {
            let mut all = self.settings();
            all.find(|(setting, ..)| setting.name == id).map_or(String::new(), |(_, word, _)| word)
        };
        let mut lines = vec![format!(
            "{} x {}  method {}  azimuths {}  bounces {}",
            field.cols(),
            field.rows(),
            word("method"),
            self.quality.azimuths,
            self.quality.bounces.count
        )];
        if let Some(sun) = self.scene.lights.suns.first() {
            let [azimuth, elevation] = compass(sun);
            lines.push(format!("sun {azimuth:.2}, {elevation:.2}  exposure {:.3}", self.exposure));
        }
        lines
    }

    /// The last edit, the preview and the comparison.
    pub fn lines_of_progress(&self, figures: &Figures) -> Vec<String> {
        let mut lines = Vec::new();
        if let (Tool::Brush(_), Some((at, ms))) = (self.tool, &figures.edit) {
            let Rectangle { cols, rows, .. } = at;
            lines.push(format!("  edit of {cols} x {rows}, light {ms:.2} ms"));
        }
        lines.extend(figures.preview.clone());
        let progress = figures.progress.map(|done| format!("full light: {:.0} %", 100.0 * done));
        lines.extend(progress);
        if let Some(ms) = figures.answer_ms {
            let full =
                figures.full_s.map_or_else(String::new, |s| format!(", full light after {s:.2} s"));
            lines.push(format!("input to picture {ms:.0} ms{full}"));
        }
        lines.extend(figures.compared.clone());
        lines
    }

    /// All settings with their values, and whether each is the chosen one.
    pub fn settings(&self) -> impl Iterator<Item = (&'static Setting, String, bool)> {
        self.settings.list(&self.asked)
    }

    fn tool_line(&self) -> Option<String> {
        let work = match self.tool {
            Tool::Look => return None,
            Tool::Lights => {
                let count = self.scene.lights.sphere_lights.len();
                let chosen =
                    self.chosen_sphere_light().map_or("none".into(), |n| (n + 1).to_string());
                return Some(format!("lights: {count}, chosen {chosen}"));
            }
            Tool::Brush(Action::Raise) => "raise",
            Tool::Brush(Action::Lower) => "lower",
            Tool::Brush(Action::Erode) => "erode",
        };
        let [done, undone] = self.strokes.count();
        let (radius, strength) = (self.brush.radius_m, self.brush.strength);
        Some(format!(
            "{work}: radius {radius:.4} m, strength {strength:.3}, undo {done}, redo {undone}"
        ))
    }

    /// All settings with the chosen one marked.
    fn setting_lines(&self) -> Vec<String> {
        let line = |(setting, word, is_chosen): (&Setting, String, bool)| {
            let mark = if is_chosen { '>' } else { ' ' };
            format!("{mark} {:<22}{word}", setting.name)
        };
        self.settings().map(line).collect()
    }

    /// Why the chosen setting has no effect on the shown light; none if it has one, or while a preview is shown.
    pub fn notes(&self, figures: &Figures) -> Vec<String> {
        let Some(used) = &figures.used else { return Vec::new() };
        let chosen = self.settings().filter(|(setting, _, is_chosen)| {
            *is_chosen && self.asked.first(setting.name).is_some()
        });
        let written: Vec<_> =
            chosen.map(|(setting, word, _)| (setting.name.to_owned(), word)).collect();
        idle::notes(&written, used, &|_| None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// In the order on the screen.
    #[test]
    fn the_viewers_page_lists_the_keys() {
        let page = include_str!("../../../../../docs/viewer.md");
        let listed: Vec<&str> = page.lines().filter(|line| KEYS.contains(line)).collect();
        assert_eq!(listed, KEYS);
    }
}

//! The text over the picture: figures, settings, and keys.

use ridgelight::gpu::Timing;
use ridgelight::plan::{Plan, Rectangle};

use super::lights::compass;
use super::{State, Text, Tool};
use crate::idle;
use crate::view::brush::Action;

/// The keys, as listed on the screen and in docs/viewer.md.
const KEYS: [&str; 21] = [
    "V                 from above, from a camera",
    "arrows, drag      move the map, turn the camera",
    "I J K L           move either; middle drag",
    "+ - or wheel      nearer, farther     Home    all of it",
    "Shift+arrows      the sun (there is one from then on); right drag",
    "E D               brighter, darker",
    "C                 without shadows | ours | path-traced reference",
    "R                 error against the reference, with C",
    "M  B              method, bounces",
    "Tab Shift+Tab     all settings: the next, the one before",
    ", .               less, more of it (azimuths at first)",
    "1                 drag moves the view, as above",
    "2 3 4             drag raises, lowers, erodes",
    "5                 click places or selects a light; drag moves it",
    "[ ] ; '           size and strength of brush or light",
    "T  X  PgUp PgDn   the light's colour; delete it; up, down; O adds one",
    "Z Y               undo, redo",
    "W G               waves, a ridge that travels: on and off",
    "P                 save the picture, as `render` does",
    "S                 save the scene, for `render --scene`",
    "H    Q Esc        this list, the figures, nothing; end",
];

/// Measured values.
#[derive(Default)]
pub struct Figures {
    /// Passes of the last complete frame.
    pub light: Vec<Timing>,
    /// Memory of the drawing passes.
    pub drawing: Vec<Timing>,
    /// The last edit, and milliseconds of its passes.
    pub edit: Option<(Rectangle, f64)>,
    /// Milliseconds from frame to frame.
    pub frame_ms: Option<f64>,
    /// Result of the comparison.
    pub compared: Vec<String>,
}

impl Figures {
    fn times(&self) -> impl Iterator<Item = &Timing> {
        self.light.iter().chain(&self.drawing)
    }

    /// Milliseconds of all passes.
    pub fn ms(&self) -> f64 {
        self.times().map(|t| t.ns).sum::<f64>() / 1e6
    }
}

impl State {
    /// The text over the picture, in lines of so many letters; none where it is hidden.
    pub fn lines(&self, plan: &Plan, figures: &Figures, letters: usize) -> Vec<String> {
        if self.text == Text::Nothing {
            return Vec::new();
        }
        let field = &self.scene.field;
        let word = |id: &str| {
            let mut all = self.settings.list(&self.asked);
            all.find(|(name, ..)| *name == id).map_or(String::new(), |(_, word, _)| word)
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
            let (azimuth, elevation) = compass(sun);
            lines.push(format!("sun {azimuth:.2}, {elevation:.2}  exposure {:.3}", self.exposure));
        }
        lines.extend(self.tool_line());
        let total = figures.ms();
        let frame = figures.frame_ms.map_or_else(String::new, |ms| format!("  frame {ms:.1} ms"));
        let mib = plan.bytes() as f64 / f64::from(1 << 20);
        lines.push(format!("passes {total:.2} ms{frame}  memory {mib:.1} MiB"));
        for (name, ns) in by_pass(figures.times()) {
            lines.push(format!("  {name:<18}{:>9.2} ms", ns / 1e6));
        }
        if let (Tool::Brush(_), Some((at, ms))) = (self.tool, &figures.edit) {
            let Rectangle { cols, rows, .. } = at;
            lines.push(format!("  edit of {cols} x {rows}, light {ms:.2} ms"));
        }
        lines.extend(figures.compared.iter().cloned());
        if self.text == Text::Settings {
            lines.push(String::new());
            lines.extend(self.setting_lines(plan));
        }
        lines.extend(self.message.clone());
        if self.text == Text::Keys {
            lines.push(String::new());
            lines.extend(KEYS.iter().map(|line| (*line).to_owned()));
        }
        lines.iter().flat_map(|line| wrapped(line, letters)).collect()
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

    /// All settings with the chosen one marked, and why it changes nothing if so.
    fn setting_lines(&self, plan: &Plan) -> Vec<String> {
        let mut lines = Vec::new();
        for (name, word, is_chosen) in self.settings.list(&self.asked) {
            let mark = if is_chosen { '>' } else { ' ' };
            lines.push(format!("{mark} {name:<22}{word}"));
        }
        let all = self.settings.list(&self.asked);
        let chosen = all.filter(|(id, _, is_chosen)| *is_chosen && self.asked.first(id).is_some());
        let written: Vec<_> = chosen.map(|(id, word, _)| (id.to_owned(), word)).collect();
        lines.extend(idle::notes(&written, &plan.settings, &|_| None));
        lines
    }
}

/// Breaks a line after at most so many letters, at spaces where possible.
fn wrapped(line: &str, letters: usize) -> Vec<String> {
    let letters = letters.max(16);
    let mut rest: Vec<char> = line.chars().collect();
    let mut pieces = Vec::new();
    while rest.len() > letters {
        let space = rest[..letters].iter().rposition(|c| *c == ' ').filter(|at| *at > letters / 2);
        let after = rest.split_off(space.map_or(letters, |at| at + 1));
        pieces.push(rest.iter().collect());
        rest = "    ".chars().chain(after).collect();
    }
    pieces.push(rest.iter().collect());
    pieces
}

/// Times summed by pass name, in order of first appearance.
fn by_pass<'a>(times: impl Iterator<Item = &'a Timing>) -> Vec<(&'a str, f64)> {
    let mut all: Vec<(&str, f64)> = Vec::new();
    for time in times {
        let name = time.label.split(' ').next().unwrap_or_default();
        match all.iter_mut().find(|(known, _)| *known == name) {
            Some((_, ns)) => *ns += time.ns,
            None => all.push((name, time.ns)),
        }
    }
    all
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

    #[test]
    fn long_lines_go_on_below() {
        assert_eq!(wrapped("short", 20), ["short"]);
        let pieces = wrapped("twenty letters a line, and then as many again", 20);
        assert_eq!(pieces, ["twenty letters a ", "    line, and then ", "    as many again"]);
        assert_eq!(
            wrapped(&"x".repeat(30), 20),
            ["x".repeat(20), format!("    {}", "x".repeat(10))]
        );
    }
}

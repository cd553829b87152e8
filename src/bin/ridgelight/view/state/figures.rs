//! What stands over the picture: figures, and the keys.

use ridgelight::gpu::Timing;
use ridgelight::plan::Plan;

use super::{State, Text, compass, method};

/// The keys, as they are listed on the screen.
const KEYS: [&str; 11] = [
    "V                 from above, from a camera",
    "arrows, drag      move the map, turn the camera",
    "I J K L           move either; middle drag",
    "+ - or wheel      nearer, farther     Home    all of it",
    "Shift+arrows      the sun (there is one from then on); right drag",
    "M  B  , .         method, bounces, fewer and more azimuths",
    "E D               brighter, darker",
    "W                 waves, on and off",
    "P                 save the picture, as `render` does",
    "S                 save the scene, for `render --scene`",
    "H    Q Esc        this list, the figures, nothing; end",
];

impl State {
    /// What stands over the picture; nothing where no text is wanted.
    pub fn lines(&self, plan: &Plan, times: &[Timing], frame_ms: Option<f64>) -> Vec<String> {
        if self.text == Text::Nothing {
            return Vec::new();
        }
        let field = &self.scene.field;
        let asked = format!("method {}", method(&self.quality));
        let mut lines = vec![format!(
            "{} x {}  {asked}  azimuths {}  bounces {}",
            field.cols(),
            field.rows(),
            self.quality.azimuths,
            self.quality.bounces.count
        )];
        if let Some(sun) = self.scene.lights.suns.first() {
            let (azimuth, elevation) = compass(sun);
            lines.push(format!("sun {azimuth:.2}, {elevation:.2}  exposure {:.3}", self.exposure));
        }
        let ms = |ns: f64| ns / 1e6;
        let total: f64 = times.iter().map(|t| t.ns).sum();
        let frame = frame_ms.map_or_else(String::new, |ms| format!("  frame {ms:.1} ms"));
        let mib = plan.bytes() as f64 / f64::from(1 << 20);
        lines.push(format!("passes {:.2} ms{frame}  memory {mib:.1} MiB", ms(total)));
        for (name, ns) in by_pass(times) {
            lines.push(format!("  {name:<18}{:>9.2} ms", ms(ns)));
        }
        lines.extend(self.message.clone());
        if self.text == Text::Keys {
            lines.push(String::new());
            lines.extend(KEYS.iter().map(|line| (*line).to_owned()));
        }
        lines
    }
}

/// Times of passes of one name together, in the order of the first of each.
fn by_pass(times: &[Timing]) -> Vec<(&str, f64)> {
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

//! The panel over the picture.

use egui::{
    Align2, Color32, ComboBox, FontId, Frame, Margin, Pos2, Rect, RichText, ScrollArea, Sense,
    Slider, Stroke, Ui, pos2, vec2,
};
use ridgelight::scene::{Audience, Setting, Values};

use super::gui::{ACCENT, FAINT, GROUND, INK, PAPER};
use super::state::{Change, Figures, KEYS, State, Text};

/// Width of the content, and its margin: with it 29 % of a window 1024 wide.
const WIDTH: f32 = 284.0;
const MARGIN: i8 = 7;
/// Columns of a setting: its name, then its value.
const NAME: f32 = 130.0;
/// Rim of the compass, where the elevation is 0.
const COMPASS: f32 = 48.0;
/// Least and largest exposure of the slider; keys go beyond.
const EXPOSURES: std::ops::RangeInclusive<f32> = 1e-3..=1e3;
/// Colour of a pass's bar.
const BAR: Color32 = Color32::from_rgb(0x2c, 0x3b, 0x4a);
/// Columns of the keys in the list of keys.
const KEY_LETTERS: usize = 18;

/// The panel: what it asks for, and the places of its parts by name, in points.
#[derive(Default)]
pub struct Panel {
    pub changes: Vec<Change>,
    pub places: Vec<(String, Rect)>,
}

impl Panel {
    /// Shows the panel; nothing where it is hidden.
    pub fn show(&mut self, ui: &mut Ui, state: &State, figures: &Figures) {
        if state.text == Text::Nothing {
            return;
        }
        let height = ui.ctx().viewport_rect().height() - 2.0 * f32::from(MARGIN);
        let area = egui::Area::new(egui::Id::new("panel")).fixed_pos(Pos2::ZERO).constrain(false);
        area.show(ui.ctx(), |ui| {
            Frame::new().fill(PAPER).inner_margin(Margin::same(MARGIN)).show(ui, |ui| {
                ui.set_width(WIDTH);
                // An area otherwise begins with a height of its own.
                ui.set_max_height(height.max(0.0));
                let scroll = ScrollArea::vertical();
                scroll.show(ui, |ui| self.content(ui, state, figures));
            });
        });
        if let Some(message) = &state.message {
            say(ui, message);
        }
    }

    fn content(&mut self, ui: &mut Ui, state: &State, figures: &Figures) {
        ui.horizontal(|ui| {
            for (word, hint, change) in [
                ("Picture", "Saves the picture, as `render` does (P)", Change::Key("p")),
                ("Scene", "Saves the scene, for `render --scene` (S)", Change::Key("s")),
                ("Copy command", "Copies the command line of `render`", Change::Copy),
            ] {
                let button = ui.button(word).on_hover_text(hint);
                self.places.push((word.to_lowercase(), button.rect));
                if button.clicked() {
                    self.changes.push(change);
                }
            }
        });
        ui.horizontal(|ui| {
            self.compass(ui, state);
            ui.vertical(|ui| {
                ui.label("Sun");
                let words = state.sun().map_or_else(
                    || ["none".to_owned(), String::new()],
                    |[azimuth, elevation]| {
                        [format!("azimuth   {azimuth:6.2}"), format!("elevation {elevation:6.2}")]
                    },
                );
                for word in words {
                    ui.monospace(word);
                }
                self.exposure(ui, state);
            });
        });
        ui.separator();
        let settings: Vec<_> = state.settings().collect();
        let (expert, plain): (Vec<_>, Vec<_>) =
            settings.into_iter().partition(|(setting, ..)| setting.audience == Audience::Expert);
        plain.iter().for_each(|of| self.setting(ui, of));
        ui.separator();
        // Below the settings, which stay in place while the number of lines changes.
        for line in state.lines_beside_widgets(figures) {
            ui.monospace(line);
        }
        bars(ui, figures);
        ui.add_space(2.0);
        for line in state.lines_of_progress(figures) {
            ui.monospace(line.trim_start());
        }
        for note in state.notes(figures) {
            ui.label(RichText::new(note).color(FAINT));
        }
        if ui.ctx().egui_wants_keyboard_input() {
            self.places.push(("typing".to_owned(), ui.min_rect()));
        }
        ui.separator();
        if self.fold(ui, "More settings (Tab)", (state.text, Text::Settings)) {
            expert.iter().for_each(|of| self.setting(ui, of));
        }
        if self.fold(ui, "Keys (H)", (state.text, Text::Keys)) {
            keys(ui);
        }
    }

    /// A line that opens and closes a list; whether it is open.
    fn fold(&mut self, ui: &mut Ui, title: &str, (shown, wanted): (Text, Text)) -> bool {
        let is_open = shown == wanted;
        let sign = if is_open { "⏷" } else { "⏵" };
        let line = ui.add(egui::Button::new(format!("{sign} {title}")).frame(false));
        self.places.push((title.to_lowercase(), line.rect));
        if line.clicked() {
            self.changes.push(Change::Text(if is_open { Text::Figures } else { wanted }));
        }
        is_open
    }

    /// The sky around the zenith, north up: the sun is dragged on it.
    fn compass(&mut self, ui: &mut Ui, state: &State) {
        let side = 2.0 * COMPASS + 28.0;
        let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::click_and_drag());
        let centre = rect.center();
        self.places.push((
            "compass".to_owned(),
            Rect::from_center_size(centre, vec2(1.0, 1.0) * 2.0 * COMPASS),
        ));
        let painter = ui.painter_at(rect);
        let line = Stroke::new(1.0, Color32::from_gray(0x50));
        painter.circle(centre, COMPASS, GROUND, line);
        for ring in [1.0 / 3.0, 2.0 / 3.0] {
            painter.circle_stroke(
                centre,
                ring * COMPASS,
                Stroke::new(1.0, Color32::from_gray(0x38)),
            );
        }
        for (word, azimuth) in [("N", 0.0), ("E", 90.0), ("S", 180.0), ("W", 270.0)] {
            let at = on_compass(centre, [azimuth, 0.0]);
            let inner = centre + (at - centre) * 0.9;
            painter.line_segment([inner, at], line);
            let out = centre + (at - centre) * 1.12;
            painter.text(out, Align2::CENTER_CENTER, word, FontId::proportional(10.0), FAINT);
        }
        if let Some(sun) = state.sun() {
            let at = on_compass(centre, sun);
            painter.line_segment([centre, at], Stroke::new(1.0, FAINT));
            painter.circle(at, 5.0, ACCENT, Stroke::new(1.0, PAPER));
        }
        let response = response.on_hover_text("Drag the sun: the rim is the horizon");
        if let Some(at) = response.interact_pointer_pos() {
            let to = sun_at(centre, at);
            if state.sun() != Some(to) {
                self.changes.push(Change::Sun(to));
            }
        }
    }

    fn exposure(&mut self, ui: &mut Ui, state: &State) {
        ui.label("Exposure");
        let mut exposure = state.exposure;
        ui.horizontal(|ui| {
            ui.spacing_mut().slider_width = 56.0;
            let slider = Slider::new(&mut exposure, EXPOSURES)
                .logarithmic(true)
                .custom_formatter(|exposure, _| format!("{exposure:.3}"));
            if self.slider(ui, "exposure", slider) {
                self.changes.push(Change::Exposure(exposure));
            }
            if ui.small_button("auto").on_hover_text("Automatic exposure (A)").clicked() {
                self.changes.push(Change::Key("a"));
            }
        });
    }

    /// A setting's name and the widget that suits its values.
    fn setting(
        &mut self,
        ui: &mut Ui,
        (setting, word, is_chosen): &(&'static Setting, String, bool),
    ) {
        ui.horizontal(|ui| {
            let colour = if *is_chosen { ACCENT } else { INK };
            let name = RichText::new(setting.name).monospace().color(colour);
            let label = egui::Label::new(name).truncate().sense(Sense::hover());
            let hint = format!("{}\n\n{}", setting.summary(), setting.trade());
            ui.scope(|ui| {
                ui.set_width(NAME);
                let label = ui.add(label).on_hover_text(hint.trim());
                if *is_chosen {
                    scroll_to_new(ui, setting.name, &label);
                }
            });
            ui.spacing_mut().slider_width = WIDTH - NAME - 70.0;
            let new = match &setting.values {
                Values::Words(words) => {
                    let names = words.iter().map(|word| word.name.to_owned());
                    self.choice(ui, setting.name, (word, names.collect()))
                }
                Values::OneOf(all) => {
                    let names = all.iter().map(u32::to_string);
                    self.choice(ui, setting.name, (word, names.collect()))
                }
                Values::Whole(range) => {
                    let mut n = word.parse::<u32>().unwrap_or(*range.start());
                    let is_long = *range.end() >= 256;
                    let slider = Slider::new(&mut n, range.clone()).logarithmic(is_long);
                    self.slider(ui, setting.name, slider).then(|| n.to_string())
                }
                Values::Share => {
                    let mut share = word.parse::<f64>().unwrap_or(0.0);
                    let slider = Slider::new(&mut share, 0.0..=1.0)
                        .logarithmic(true)
                        .smallest_positive(1e-6)
                        .custom_formatter(|share, _| format!("{share:.1e}"));
                    self.slider(ui, setting.name, slider).then(|| share.to_string())
                }
            };
            let line = ui.min_rect();
            self.places.push((format!("{} = {word}", setting.name), line));
            if let Some(new) = new.filter(|new| new != word) {
                self.changes.push(Change::Setting(setting.name, new));
            }
        });
    }

    /// Whether the user has changed it.
    fn slider(&mut self, ui: &mut Ui, name: &str, slider: Slider<'_>) -> bool {
        // A value that nobody touches stays as it is: neither clamped nor rounded.
        let slider = slider.clamping(egui::SliderClamping::Edits).update_while_editing(false);
        let (rail, gap) = (ui.spacing().slider_width, ui.spacing().item_spacing.x);
        let response = ui.add(slider);
        let mut value = response.rect;
        value.min.x = (value.min.x + rail + gap).min(value.max.x);
        self.places.push((format!("{name} value"), value));
        self.places.push((name.to_owned(), response.rect));
        response.changed()
    }

    /// A list that opens; the chosen word.
    fn choice(
        &mut self,
        ui: &mut Ui,
        name: &str,
        (word, all): (&str, Vec<String>),
    ) -> Option<String> {
        let list = ComboBox::from_id_salt(name)
            .selected_text(RichText::new(word).monospace())
            .width(WIDTH - NAME - 12.0);
        let mut chosen = None;
        let shown = list.show_ui(ui, |ui| {
            for other in all {
                let line = ui.selectable_label(other == word, RichText::new(&other).monospace());
                self.places.push((format!("{name} {other}"), line.rect));
                if line.clicked() {
                    chosen = Some(other);
                }
            }
        });
        self.places.push((name.to_owned(), shown.response.rect));
        chosen
    }
}

/// A message beside the panel, so that it moves no widget under the mouse; clicks go through it.
fn say(ui: &Ui, message: &str) {
    let at = pos2(WIDTH + 2.0 * f32::from(MARGIN) + 4.0, 0.0);
    let area = egui::Area::new(egui::Id::new("message")).fixed_pos(at).interactable(false);
    area.show(ui.ctx(), |ui| {
        Frame::new().fill(PAPER).inner_margin(Margin::same(MARGIN)).show(ui, |ui| {
            ui.set_max_width(WIDTH);
            ui.label(RichText::new(message).color(ACCENT));
        });
    });
}

/// Scrolls to a setting's name when it becomes the chosen one.
fn scroll_to_new(ui: &Ui, name: &'static str, label: &egui::Response) {
    let id = egui::Id::new("chosen setting");
    let last = ui.data_mut(|data| {
        let last = data.get_temp::<&'static str>(id);
        data.insert_temp(id, name);
        last
    });
    if last != Some(name) {
        label.scroll_to_me(None);
    }
}

/// Times of passes, the longest across the panel.
fn bars(ui: &mut Ui, figures: &Figures) {
    let passes = figures.passes();
    let longest = passes.iter().map(|(_, ns)| *ns).fold(0.0, f64::max);
    ui.spacing_mut().item_spacing.y = 1.0;
    for (name, ns) in passes {
        let (rect, _) = ui.allocate_exact_size(vec2(WIDTH, 13.0), Sense::hover());
        let share = if longest > 0.0 { (ns / longest) as f32 } else { 0.0 };
        let painter = ui.painter_at(rect);
        let bar = Rect::from_min_size(rect.min, vec2(share * WIDTH, rect.height()));
        painter.rect_filled(bar, 0.0, BAR);
        let font = FontId::monospace(10.5);
        let [left, right] =
            [rect.left_center() + vec2(3.0, 0.0), rect.right_center() - vec2(3.0, 0.0)];
        painter.text(left, Align2::LEFT_CENTER, name, font.clone(), INK);
        let ms = format!("{:.2} ms", ns / 1e6);
        painter.text(right, Align2::RIGHT_CENTER, ms, font, INK);
    }
    ui.spacing_mut().item_spacing.y = 3.0;
}

/// The list of keys in two columns.
fn keys(ui: &mut Ui) {
    egui::Grid::new("keys").num_columns(2).spacing(vec2(8.0, 1.0)).show(ui, |ui| {
        for line in KEYS {
            let (keys, use_) = line.split_at_checked(KEY_LETTERS).unwrap_or((line, ""));
            ui.label(RichText::new(keys.trim_end()).monospace().size(10.5).color(ACCENT));
            ui.add(egui::Label::new(RichText::new(use_).size(11.0)).wrap());
            ui.end_row();
        }
    });
}

/// Where a compass around a centre shows an azimuth and an elevation, degrees.
fn on_compass(centre: Pos2, [azimuth, elevation]: [f64; 2]) -> Pos2 {
    let (sin, cos) = azimuth.to_radians().sin_cos();
    let off = (1.0 - elevation / 90.0) * f64::from(COMPASS);
    centre + vec2((off * sin) as f32, (-off * cos) as f32)
}

/// The azimuth and the elevation there, to a tenth of a degree; beyond the rim the elevation is 0.
fn sun_at(centre: Pos2, at: Pos2) -> [f64; 2] {
    let off = at - centre;
    let tenths = |degrees: f32| (f64::from(degrees) * 10.0).round() / 10.0;
    let azimuth = tenths(off.x.atan2(-off.y).to_degrees().rem_euclid(360.0)) % 360.0;
    [azimuth, tenths(90.0 * (1.0 - off.length() / COMPASS).max(0.0))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::gpu::Timing;

    /// The longest time fills the width; the others fill their share of it. The parts of a pass are added: 3 ms, 1.5 ms and
    /// 0.75 ms. Widths are compared to within rounding of f32.
    #[test]
    fn bars_have_the_lengths_of_the_times() {
        let timing = |label: &str, ns: f64| Timing { label: label.to_owned(), ns };
        let light = vec![
            timing("horizon_sweep 0+8", 1e6),
            timing("sky_shade", 1.5e6),
            timing("horizon_sweep 8+8", 2e6),
        ];
        let figures =
            Figures { light, drawing: vec![timing("map_draw", 7.5e5)], ..Figures::default() };
        let context = egui::Context::default();
        let mut output = context.run_ui(egui::RawInput::default(), |ui| bars(ui, &figures));
        // No renderer takes the font textures.
        output.textures_delta.clear();
        let length = |shape: &egui::Shape| match shape {
            egui::Shape::Rect(bar) if bar.fill == BAR => Some(bar.rect.width()),
            _ => None,
        };
        let lengths: Vec<f32> =
            output.shapes.iter().filter_map(|clipped| length(&clipped.shape)).collect();
        let wanted = [WIDTH, WIDTH / 2.0, WIDTH / 4.0];
        assert_eq!(lengths.len(), wanted.len(), "{lengths:?}");
        let is_near = lengths.iter().zip(wanted).all(|(got, want)| (got - want).abs() < 0.01);
        assert!(is_near, "{lengths:?}");
    }

    /// To half of the tenth of a degree that it is rounded to, and what f32 leaves of it.
    #[test]
    fn a_place_on_the_compass_is_its_suns() {
        let centre = pos2(80.0, 60.0);
        for sun in [[0.0, 0.0], [90.0, 30.0], [200.3, 61.7], [315.0, 45.0]] {
            let got = sun_at(centre, on_compass(centre, sun));
            let off = [got[0] - sun[0], got[1] - sun[1]];
            assert!(off.iter().all(|v| v.abs() < 0.051), "{sun:?}: {got:?}");
        }
        assert_eq!(sun_at(centre, centre)[1], 90.0);
        // East is right, south is below; outside is the horizon.
        assert_eq!(sun_at(centre, centre + vec2(500.0, 0.0)), [90.0, 0.0]);
        assert_eq!(sun_at(centre, centre + vec2(0.0, COMPASS / 2.0)), [180.0, 45.0]);
    }
}

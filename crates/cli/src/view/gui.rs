//! egui in the window: its input, its style, and the shapes that it draws.

use std::time::Instant;

use egui::epaint::ClippedPrimitive;
use egui::{Color32, CornerRadius, FontId, Pos2, Rect, Stroke, TextStyle, TexturesDelta, vec2};
use ridgelight_viewer::Overlay;
use winit::event::WindowEvent;
use winit::window::Window;

/// Texels of a texture's side: every device has twice as many.
const MOST_TEXELS: usize = 2048;
/// Passes after an event in which egui may ask for another picture, so that it cannot ask forever.
const SETTLING: u32 = 30;

pub const INK: Color32 = Color32::from_rgb(0xdc, 0xdc, 0xd6);
pub const FAINT: Color32 = Color32::from_rgb(0x93, 0x96, 0x9c);
pub const PAPER: Color32 = Color32::from_rgb(0x18, 0x1a, 0x20);
pub const GROUND: Color32 = Color32::from_rgb(0x26, 0x29, 0x31);
pub const ACCENT: Color32 = Color32::from_rgb(0xe0, 0xb0, 0x50);

/// egui's context and its last output.
pub struct Gui {
    context: egui::Context,
    input: egui_winit::State,
    began: Instant,
    shapes: Vec<ClippedPrimitive>,
    pixels_per_point: f32,
    /// Whether a button went down over the panel and is still held.
    pub holds_pointer: bool,
    /// Passes left in which egui may ask for another picture.
    settling: u32,
}

impl Gui {
    pub fn new(window: &Window) -> Self {
        let context = egui::Context::default();
        // A press and a release are a click however long a picture takes between them.
        context.options_mut(|options| options.input_options.max_click_duration = f64::INFINITY);
        set_style(&context);
        let id = egui::ViewportId::ROOT;
        let scale = Some(window.scale_factor() as f32);
        let input =
            egui_winit::State::new(context.clone(), id, window, scale, None, Some(MOST_TEXELS));
        Self {
            context,
            input,
            began: Instant::now(),
            shapes: Vec::new(),
            pixels_per_point: 1.0,
            holds_pointer: false,
            settling: 0,
        }
    }

    /// Whether the panel, or a list that it has opened, is at a pixel.
    pub fn is_at(&self, [x, y]: [f64; 2]) -> bool {
        let at = Pos2::new(x as f32, y as f32) / self.pixels_per_point;
        let layer = self.context.layer_id_at(at);
        layer.is_some_and(|layer| layer.order != egui::Order::Background)
    }

    /// Whether keys are for the panel: a text field has the focus, or Escape closes a list.
    pub fn takes_keys(&self, is_escape: bool) -> bool {
        self.context.egui_wants_keyboard_input() || is_escape && self.context.any_popup_open()
    }

    /// Takes the focus from a text field and closes lists: a button went down elsewhere.
    pub fn leave(&mut self) {
        self.context.memory_mut(|memory| {
            if let Some(id) = memory.focused() {
                memory.surrender_focus(id);
            }
        });
        egui::Popup::close_all(&self.context);
    }

    /// Takes an event for the next pass.
    pub fn hear(&mut self, window: &Window, event: &WindowEvent) {
        self.settling = SETTLING;
        let _ = self.input.on_window_event(window, event);
    }

    /// Runs a pass over the window's content. Returns changed textures, and whether egui asks for another picture.
    pub fn run(
        &mut self,
        window: &Window,
        size: [u32; 2],
        content: impl FnMut(&mut egui::Ui),
    ) -> (TexturesDelta, bool) {
        // Not `take_egui_input`: it asks winit for the size of the window, and winit panics if the window is destroyed.
        let per_point = egui_winit::pixels_per_point(&self.context, window);
        let [width, height] = size.map(|n| n as f32 / per_point);
        let input = self.input.egui_input_mut();
        input.time = Some(self.began.elapsed().as_secs_f64());
        input.screen_rect = Some(Rect::from_min_size(Pos2::ZERO, vec2(width, height)));
        let viewport = input.viewports.entry(egui::ViewportId::ROOT).or_default();
        viewport.native_pixels_per_point = Some(window.scale_factor() as f32);
        let input = input.take();
        let mut output = self.context.run_ui(input, content);
        self.input.handle_platform_output(window, std::mem::take(&mut output.platform_output));
        self.pixels_per_point = output.pixels_per_point;
        let shapes = std::mem::take(&mut output.shapes);
        self.shapes = self.context.tessellate(shapes, output.pixels_per_point);
        let now = output.viewport_output.values().any(|viewport| viewport.repaint_delay.is_zero());
        let asks = now && self.settling > 0;
        self.settling = self.settling.saturating_sub(1);
        (std::mem::take(&mut output.textures_delta), asks)
    }

    /// The shapes of the last pass.
    pub fn overlay(&self) -> Overlay<'_> {
        Overlay { primitives: &self.shapes, pixels_per_point: self.pixels_per_point }
    }
}

/// Dark, compact, without animations.
fn set_style(context: &egui::Context) {
    context.set_theme(egui::Theme::Dark);
    context.all_styles_mut(|style| {
        style.animation_time = 0.0;
        style.scroll_animation = egui::style::ScrollAnimation::none();
        style.interaction.tooltip_delay = 0.0;
        style.interaction.show_tooltips_only_when_still = false;
        style.interaction.selectable_labels = false;
        style.drag_value_text_style = TextStyle::Monospace;
        style.text_styles = [
            (TextStyle::Small, FontId::proportional(10.5)),
            (TextStyle::Body, FontId::proportional(12.5)),
            (TextStyle::Button, FontId::proportional(12.5)),
            (TextStyle::Heading, FontId::proportional(13.0)),
            (TextStyle::Monospace, FontId::monospace(11.0)),
        ]
        .into();
        let spacing = &mut style.spacing;
        spacing.item_spacing = vec2(6.0, 3.0);
        spacing.button_padding = vec2(6.0, 1.0);
        spacing.interact_size = vec2(30.0, 16.0);
        spacing.slider_rail_height = 4.0;
        spacing.tooltip_width = 260.0;
        let visuals = &mut style.visuals;
        visuals.override_text_color = Some(INK);
        visuals.panel_fill = PAPER;
        visuals.window_fill = PAPER;
        visuals.extreme_bg_color = GROUND;
        visuals.popup_shadow = egui::Shadow::NONE;
        visuals.window_shadow = egui::Shadow::NONE;
        visuals.text_cursor.blink = false;
        visuals.slider_trailing_fill = true;
        visuals.selection.bg_fill = Color32::from_rgb(0x5c, 0x4c, 0x28);
        visuals.selection.stroke = Stroke::new(1.0, ACCENT);
        visuals.window_corner_radius = CornerRadius::same(2);
        visuals.menu_corner_radius = CornerRadius::same(2);
        let widgets = &mut visuals.widgets;
        for of in [&mut widgets.inactive, &mut widgets.hovered, &mut widgets.active] {
            of.corner_radius = CornerRadius::same(2);
            of.expansion = 0.0;
        }
        widgets.inactive.bg_fill = Color32::from_rgb(0x3a, 0x3e, 0x48);
        widgets.inactive.weak_bg_fill = Color32::from_rgb(0x2e, 0x32, 0x3b);
    });
}

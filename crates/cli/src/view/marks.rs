//! Marks on the pictures, and labels below them.

use egui::{Color32, FontId, Rect, Ui, pos2, vec2};

use super::gui::{INK, PAPER};
use super::state::Mark;

/// Labels below the pictures, and where those begin.
pub struct Labels<'a> {
    pub words: Option<&'a [String; 3]>,
    pub lefts: &'a [u32],
    /// Size of each picture, pixels.
    pub size: [u32; 2],
}

/// Paints both over the pictures, below the panel.
pub fn paint_over(ui: &Ui, marks: &[Mark], labels: &Labels<'_>) {
    let scale = ui.ctx().pixels_per_point();
    let [width, height] = labels.size.map(|n| n as f32);
    for (n, left) in labels.lefts.iter().map(|left| *left as f32).enumerate() {
        let pane = Rect::from_min_size(pos2(left, 0.0) / scale, vec2(width, height) / scale);
        let painter = ui.painter().with_clip_rect(pane);
        for mark in marks {
            // Whole pixels, with a rim of one around them.
            let at = mark.at.map(f64::floor).map(|v| v as f32 + 0.5);
            let side = (2 * mark.half + 1) as f32;
            let rim = if mark.is_chosen { Color32::WHITE } else { Color32::BLACK };
            let [r, g, b, _] = mark.colour;
            for (side, colour) in [(side + 2.0, rim), (side, Color32::from_rgb(r, g, b))] {
                let at = pos2(left + at[0], at[1]) / scale;
                let square = Rect::from_center_size(at, vec2(side, side) / scale);
                painter.rect_filled(square, 0.0, colour);
            }
        }
        if let Some(label) = labels.words.and_then(|words| words.get(n)) {
            let text = painter.layout_no_wrap(label.clone(), FontId::monospace(11.0), INK);
            let size = text.size() + vec2(10.0, 6.0);
            let place = Rect::from_min_size(pane.left_bottom() - vec2(0.0, size.y), size);
            painter.rect_filled(place, 0.0, PAPER);
            painter.galley(place.min + vec2(5.0, 3.0), text, INK);
        }
    }
}

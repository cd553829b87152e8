//! One level of a height pyramid from the level an octave finer: each texel is the mean of four bilinear samples
//! around its position (Nowrouzezahrai & Snyder 2009, §9).

use crate::shared::sweep::{Heights, wrapped};
use ridgelight::plan::pyramid::Pyramid;

/// Two neighbouring texels of an axis, and the fraction between them; beyond the ends the last two are extrapolated
/// linearly.
fn between(place: f32, count: u32, periodic: bool) -> (u32, u32, f32) {
    let count = count as i32;
    let cell = place.floor() as i32;
    if periodic {
        let [low, high] = [cell, cell + 1].map(|i| wrapped(i, count) as u32);
        return (low, high, place - cell as f32);
    }
    let held = cell.clamp(0, (count - 2).max(0));
    (held as u32, (held + 1).min(count - 1) as u32, place - held as f32)
}

/// The texels of level `number` from those of all levels; only its source's are read.
///
/// # Panics
/// When there are fewer texels than the source needs.
pub fn height_reduce(
    heights: &Heights,
    pyramid: &Pyramid,
    number: u32,
    texels: &[f32],
) -> Vec<f32> {
    let from = pyramid.source(number);
    let (level, source) = (pyramid.level(number), pyramid.level(from));
    let ratio = pyramid.ratio(number);
    let beside = ratio.map(|r| 0.5 * (r - 1.0));
    let source_at = |x: u32, y: u32| {
        if from == 0 {
            heights.at(x as i32, y as i32)
        } else {
            texels[source.first as usize + (y * source.size[0] + x) as usize]
        }
    };
    let bilinear = |place: [f32; 2]| {
        let (left, right, t) = between(place[0], source.size[0], pyramid.periodic);
        let (north, south, u) = between(place[1], source.size[1], pyramid.periodic);
        let row = |y: u32| {
            let low = source_at(left, y);
            low + t * (source_at(right, y) - low)
        };
        let low = row(north);
        low + u * (row(south) - low)
    };
    let [cols, rows] = level.size;
    let texel = |i: u32| {
        let (x, y) = ((i % cols) as f32 * ratio[0], (i / cols) as f32 * ratio[1]);
        let (west, east) = (x - beside[0], x + beside[0]);
        let (north, south) = (y - beside[1], y + beside[1]);
        let northern = bilinear([west, north]) + bilinear([east, north]);
        0.25 * (northern + (bilinear([west, south]) + bilinear([east, south])))
    };
    (0..cols * rows).map(texel).collect()
}

/// The texels of all levels besides the field itself.
pub fn height_levels(heights: &Heights, pyramid: &Pyramid) -> Vec<f32> {
    let mut all = Vec::new();
    for number in 1..=pyramid.levels() {
        let made = height_reduce(heights, pyramid, number, &all);
        all.extend(made);
    }
    all
}

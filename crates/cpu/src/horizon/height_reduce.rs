//! One level of a height pyramid from the level an octave finer: each texel is the mean of four bilinear samples
//! around its position (Nowrouzezahrai & Snyder 2009, §9).

use crate::shared::levels::{all_levels, between};
use crate::shared::sweep::Heights;
use ridgelight::plan::pyramid::Pyramid;

/// The texels of level `number` from those of all levels; only its source's are read.
pub fn height_reduce(field: &Heights, pyramid: &Pyramid, number: u32, texels: &[f32]) -> Vec<f32> {
    let from = pyramid.source(number);
    let (level, source) = (pyramid.level(number), pyramid.level(from));
    let ratio = pyramid.ratio(number);
    let beside = ratio.map(|r| 0.5 * (r - 1.0));
    let source_at = |x: usize, y: usize| {
        if from == 0 {
            field.at(x as i32, y as i32)
        } else {
            texels[source.first as usize + y * source.size[0] as usize + x]
        }
    };
    let bilinear = |place: [f32; 2]| {
        let ([left, right], t) = between(place[0], source.size[0], pyramid.periodic);
        let ([north, south], u) = between(place[1], source.size[1], pyramid.periodic);
        let row = |y: usize| {
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
    all_levels(pyramid, |number, texels| height_reduce(heights, pyramid, number, texels))
}

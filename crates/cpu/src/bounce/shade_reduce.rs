//! One level of the pyramid of exit radiance from the level an octave finer, as `height_reduce`, but clamped to the
//! range of its source.

use crate::Rgb;
use crate::shared::levels::{all_levels, held_between};
use ridgelight::plan::pyramid::Pyramid;

/// R, G, B of level `number` from the grid points' exit radiance and the texels of the levels before it.
pub fn shade_reduce(exit: &[Rgb], pyramid: &Pyramid, number: u32, texels: &[Rgb]) -> Vec<Rgb> {
    let from = pyramid.source(number);
    let (level, source) = (pyramid.level(number), pyramid.level(from));
    let ratio = pyramid.ratio(number);
    let [width, height] = source.size;
    let source_of = if from == 0 { exit } else { &texels[source.first as usize..] };
    let bilinear = |place: [f32; 2]| {
        let (x, t) = held_between(place[0], width, pyramid.periodic);
        let (y, u) = held_between(place[1], height, pyramid.periodic);
        let row = |y: usize| {
            let [low, high] = x.map(|x| source_of[y * width as usize + x]);
            [0, 1, 2].map(|c| low[c] + t * (high[c] - low[c]))
        };
        let [low, high] = y.map(row);
        [0, 1, 2].map(|c| low[c] + u * (high[c] - low[c]))
    };
    let [cols, rows] = level.size;
    let texel = |i: u32| {
        let place = [(i % cols) as f32 * ratio[0], (i / cols) as f32 * ratio[1]];
        let mut sum = [0.0; 3];
        for side in [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]] {
            let four = bilinear([0, 1].map(|i| place[i] + side[i] * (ratio[i] - 1.0)));
            sum = [0, 1, 2].map(|c| sum[c] + 0.25 * four[c]);
        }
        sum
    };
    (0..cols * rows).map(texel).collect()
}

/// The texels of all levels besides the grid points themselves.
pub fn shade_levels(exit: &[Rgb], pyramid: &Pyramid) -> Vec<Rgb> {
    all_levels(pyramid, |number, texels| shade_reduce(exit, pyramid, number, texels))
}

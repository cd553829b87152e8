//! Levels of a height pyramid at the field's own grid points, by their B-splines.

use crate::shared::levels::LevelTexels;

/// Level `number` at every grid point, row after row.
pub fn height_expand(levels: &LevelTexels, number: u32) -> Vec<f32> {
    let [cols, rows] = levels.pyramid.size;
    let texel = |i: u32| levels.spline_at(number, [(i % cols) as f32, (i / cols) as f32]);
    (0..cols * rows).map(texel).collect()
}

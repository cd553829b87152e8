//! Levels of a height pyramid at the field's own grid points, by their B-splines.

use crate::shared::levels::LevelTexels;

/// Level `number` at every grid point, row after row.
///
/// # Panics
/// When there are fewer texels than the level needs.
pub fn height_expand(levels: &LevelTexels, number: u32) -> Vec<f32> {
    let level = levels.pyramid.level(number);
    let [cols, rows] = levels.pyramid.size;
    let texel = |i: u32| {
        let at = [(i % cols) as f32, (i / cols) as f32];
        levels.spline_at(&level, [at[0] * level.per_grid_point[0], at[1] * level.per_grid_point[1]])
    };
    (0..cols * rows).map(texel).collect()
}

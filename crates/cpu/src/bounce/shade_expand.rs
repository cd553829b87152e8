//! Every level of the pyramid of exit radiance at the field's own grid points, by its B-spline.

use crate::Rgb;
use crate::shared::levels::spline_taps;
use ridgelight::plan::pyramid::Pyramid;

/// R, G, B of level `number` at a position in grid points (column, row), from the texels of all levels.
pub fn shade_at(pyramid: &Pyramid, texels: &[Rgb], number: u32, place: [f64; 2]) -> Rgb {
    let level = pyramid.level(number);
    let [cols, rows] = level.size;
    let at = [0, 1].map(|i| place[i] as f32 * level.per_grid_point[i]);
    let (x, x_weight) = spline_taps(at[0], cols, pyramid.periodic);
    let (y, y_weight) = spline_taps(at[1], rows, pyramid.periodic);
    let mut sum = [0.0; 3];
    for (row, weight) in y.iter().zip(y_weight) {
        for (col, across) in x.iter().zip(x_weight) {
            let from = texels[level.first as usize + (row * cols + col) as usize];
            let weight = f64::from(weight * across);
            sum = [0, 1, 2].map(|c| sum[c] + weight * from[c]);
        }
    }
    sum
}

/// The same at every grid point, row-major.
pub fn shade_expand(pyramid: &Pyramid, texels: &[Rgb], number: u32) -> Vec<Rgb> {
    let [cols, rows] = pyramid.size;
    let at = |i: u32| [f64::from(i % cols), f64::from(i / cols)];
    (0..cols * rows).map(|i| shade_at(pyramid, texels, number, at(i))).collect()
}

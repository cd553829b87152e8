//! `levels.glsl` and `spline.glsl`: the B-spline of a height pyramid's level.

use super::sweep::wrapped;
use ridgelight::plan::pyramid::Pyramid;

/// Texels of all levels besides the field itself, as in `height_levels`.
#[derive(Clone, Copy, Debug)]
pub struct LevelTexels<'a> {
    /// Their layout.
    pub pyramid: &'a Pyramid,
    /// One level behind the other, row after row.
    pub texels: &'a [f32],
}

/// The texels of all levels, each made from its number and those before it.
pub fn all_levels<T>(pyramid: &Pyramid, reduce: impl Fn(u32, &[T]) -> Vec<T>) -> Vec<T> {
    (1..=pyramid.levels()).fold(Vec::new(), |mut all, number| {
        let made = reduce(number, &all);
        all.extend(made);
        all
    })
}

/// Two neighbouring texels of an axis of `count`, and the fraction between them; beyond the ends the last two are
/// extrapolated linearly.
pub fn between(place: f32, count: u32, periodic: bool) -> ([usize; 2], f32) {
    let (count, cell) = (count as i32, place.floor() as i32);
    if periodic {
        return ([cell, cell + 1].map(|i| wrapped(i, count) as usize), place - cell as f32);
    }
    let held = cell.clamp(0, (count - 2).max(0));
    ([held, (held + 1).min(count - 1)].map(|i| i as usize), place - held as f32)
}

/// The same; beyond the ends the last texel is held.
pub fn held_between(place: f32, count: u32, periodic: bool) -> ([usize; 2], f64) {
    let (two, t) = between(place, count, periodic);
    (two, f64::from(t).clamp(0.0, 1.0))
}

/// Four neighbouring texels of an axis of `count` and their weights at a position in texels: the uniform cubic
/// B-spline; beyond the ends coefficients continue by point reflection.
pub fn spline_taps(place: f32, count: u32, periodic: bool) -> ([u32; 4], [f32; 4]) {
    let count = count as i32;
    let cell = place.floor() as i32;
    let cell = if periodic { cell } else { cell.clamp(0, (count - 2).max(0)) };
    let t = place - cell as f32;
    let s = 1.0 - t;
    let inner = |a: f32| (3.0 * a - 6.0) * a * a + 4.0;
    let mut weight = [s * s * s, inner(t), inner(s), t * t * t].map(|w| w * (1.0 / 6.0));
    let at = [-1, 0, 1, 2].map(|i| cell + i);
    if periodic {
        return (at.map(|i| wrapped(i, count) as u32), weight);
    }
    let low = if cell == 0 { weight[0] } else { 0.0 };
    let high = if cell == count - 2 { weight[3] } else { 0.0 };
    weight[0] -= low;
    weight[1] += 2.0 * low - high;
    weight[2] += 2.0 * high - low;
    weight[3] -= high;
    (at.map(|i| i.clamp(0, count - 1) as u32), weight)
}

impl LevelTexels<'_> {
    /// Height of level `number` at a place in grid points (column, row).
    pub fn spline_at(&self, number: u32, place: [f32; 2]) -> f32 {
        let level = self.pyramid.level(number);
        let [cols, rows] = level.size;
        let at = [0, 1].map(|i| place[i] * level.per_grid_point[i]);
        let (x, x_weight) = spline_taps(at[0], cols, self.pyramid.periodic);
        let (y, y_weight) = spline_taps(at[1], rows, self.pyramid.periodic);
        let mut sum = 0.0;
        for (row, weight) in y.iter().zip(y_weight) {
            let first = level.first as usize + (row * cols) as usize;
            let along: f32 =
                x.iter().zip(x_weight).map(|(col, w)| w * self.texels[first + *col as usize]).sum();
            sum += weight * along;
        }
        sum
    }
}

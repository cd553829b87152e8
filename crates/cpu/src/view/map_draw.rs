//! A shaded field from above, as displayed on a screen.

use ridgelight::plan::Map;

/// The four bytes of each pixel, row after row; `shaded` (radiance) and `voids` are the field's, one per grid point.
pub fn map_draw(map: &Map, shaded: &[[f32; 3]], voids: Option<&[bool]>) -> Vec<[u8; 4]> {
    let [width, height] = map.size;
    // All in f32, as on the device: both must find the same grid points for a pixel.
    let place = |corner: f32, point: f32, count: u32| {
        (point * map.grid_points_per_pixel + corner).clamp(-1.0, count as f32)
    };
    let places = |[x, y]: [f32; 2]| {
        [place(map.corner[0], x, map.field[0]), place(map.corner[1], y, map.field[1])]
    };
    let light = |[col, row]: [f32; 2]| {
        let [col, row] = [(col, map.field[0]), (row, map.field[1])]
            .map(|(at, count)| (at >= 0.0 && at < count as f32).then_some(at as usize));
        let at = row? * map.field[0] as usize + col?;
        (!voids.is_some_and(|v| v[at])).then(|| shaded[at])
    };
    let pixel = |x: u32, y: u32| {
        let there = places([x as f32 + 0.5, y as f32 + 0.5]);
        let middle = light(there)?;
        let or_middle = |there| light(there).unwrap_or(middle);
        let nearest = |[col, row]: [f32; 2]| {
            let last = map.field.map(|count| (count - 1) as f32);
            or_middle([col.clamp(0.0, last[0]), row.clamp(0.0, last[1])])
        };
        let shown = match places_of(map) {
            1 if map.is_smooth => between(there, nearest),
            1 => middle,
            count => mean(count, |col, row| or_middle(places([x as f32 + col, y as f32 + row]))),
        };
        let [r, g, b] = shown.map(|light| map.tone.code(light));
        Some(if map.swaps { [b, g, r, 255] } else { [r, g, b, 255] })
    };
    let row = |y: u32| (0..width).map(move |x| pixel(x, y).unwrap_or(Map::BEYOND));
    (0..height).flat_map(row).collect()
}

/// Places of a pixel along a side.
fn places_of(map: &Map) -> u32 {
    let needed = map.grid_points_per_pixel.clamp(1.0, 8.0);
    let is_one = map.is_smooth && needed < 2.0;
    if is_one { 1 } else { (needed.ceil() as u32).next_power_of_two() }
}

/// Of places within a pixel, row after row.
fn mean(count: u32, light: impl Fn(f32, f32) -> [f32; 3]) -> [f32; 3] {
    let share = 1.0 / count as f32;
    let within = |n: u32| (n as f32 + 0.5) * share;
    let sum = (0..count * count).fold([0.0_f32; 3], |sum, i| {
        let next = light(within(i % count), within(i / count));
        std::array::from_fn(|c| sum[c] + next[c])
    });
    sum.map(|s| s * (share * share))
}

/// Bilinear between the centres of texels.
fn between([col, row]: [f32; 2], light: impl Fn([f32; 2]) -> [f32; 3]) -> [f32; 3] {
    let from = [col - 0.5, row - 0.5];
    let [x, y] = from.map(f32::floor);
    let part = [from[0] - x, from[1] - y];
    let [a, b, c, d] = [[x, y], [x + 1.0, y], [x, y + 1.0], [x + 1.0, y + 1.0]].map(light);
    std::array::from_fn(|k| {
        let above = a[k] + (b[k] - a[k]) * part[0];
        let below = c[k] + (d[k] - c[k]) * part[0];
        above + (below - above) * part[1]
    })
}

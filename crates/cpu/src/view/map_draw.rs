//! A shaded field from above, as displayed on a screen.

use ridgelight::plan::Map;
use ridgelight::scene::Tone;

/// The four bytes of each pixel, row after row; `shaded` (radiance) and `voids` are the field's, one per grid point.
pub fn map_draw(
    map: &Map,
    shaded: &[[f32; 3]],
    voids: Option<&[bool]>,
    tone: Tone,
) -> Vec<[u8; 4]> {
    let [width, height] = map.size;
    // In f32, as on the device: both must find the same grid point for a pixel's centre.
    let grid_point = |corner: f32, pixel: u32, count: u32| {
        let place = ((pixel as f32 + 0.5) * map.grid_points_per_pixel + corner).floor();
        (place >= 0.0 && place < count as f32).then_some(place as usize)
    };
    let pixel = |x: u32, y: u32| {
        let col = grid_point(map.corner[0], x, map.field[0])?;
        let at = grid_point(map.corner[1], y, map.field[1])? * map.field[0] as usize + col;
        if voids.is_some_and(|v| v[at]) {
            return None;
        }
        let [r, g, b] = shaded[at].map(|light| tone.code(light));
        Some(if map.swaps { [b, g, r, 255] } else { [r, g, b, 255] })
    };
    let row = |y: u32| (0..width).map(move |x| pixel(x, y).unwrap_or(Map::BEYOND));
    (0..height).flat_map(row).collect()
}

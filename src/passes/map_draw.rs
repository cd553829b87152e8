use crate::gpu::shaders::{self, same_layout};
use crate::plan::{Builder, Map, ResourceId};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct MapDrawPush {
    size: [i32; 2],
    field: [i32; 2],
    corner: [f32; 2],
    samples_per_pixel: f32,
    swaps: u32,
    beyond: u32,
}

same_layout!(
    MapDrawPush,
    map_draw_push,
    size = WIDTH,
    field = COLS,
    corner = FIRST_COL,
    samples_per_pixel = SAMPLES_PER_PIXEL,
    swaps = SWAPS,
    beyond = BEYOND,
);

/// A pixel a sample, or fewer or more.
pub(crate) fn plan(builder: &mut Builder, map: &Map, bound: &[(&str, ResourceId)]) {
    let [width, height] = map.size;
    let pixels = u64::from(width) * u64::from(height);
    builder.pass(
        shaders::MapDraw { grey: !map.has_colour, has_voids: map.has_voids },
        "",
        "radiance as a screen shows it",
        [width.div_ceil(8), height.div_ceil(8), 1],
        &MapDrawPush {
            size: map.size.map(|n| n as i32),
            field: map.field.map(|n| n as i32),
            corner: map.corner,
            samples_per_pixel: map.samples_per_pixel,
            swaps: u32::from(map.swaps),
            beyond: u32::from_le_bytes(Map::BEYOND),
        },
        bound,
        pixels * if map.has_colour { 20 } else { 8 },
        pixels,
    );
}

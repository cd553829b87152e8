use crate::gpu::shaders::{self, same_layout};
use crate::plan::{Axis, Builder, ResourceId};
use crate::scene::{Border, Sun};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct SunGlossPush {
    cols: i32,
    rows: i32,
    cell_x_m: f32,
    cell_y_m: f32,
    towards: [f32; 4],
    colour: [f32; 4],
}

same_layout!(
    SunGlossPush,
    sun_gloss_push,
    cols = COLS,
    rows = ROWS,
    cell_x_m = CELL_X_M,
    cell_y_m = CELL_Y_M,
    towards = TOWARDS,
    colour = COLOUR,
);

/// A sun in a lobe, by the part of it that diffuse ground sees; `begins` the sum with it.
pub(crate) fn plan(
    builder: &mut Builder,
    (axis, border, cell_m): (Axis, Border, [f64; 2]),
    name: &str,
    (sun, exponent): (&Sun, f32),
    [lane_heights, sun_sum, gloss_sum]: [ResourceId; 3],
    begins: bool,
) {
    let [cols, rows] = axis.size();
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let (up, along) = sun.elevation_rad.sin_cos();
    let [east, north, up] = [cos * along, sin * along, up].map(|v| v as f32);
    let [r, g, b] = sun.irradiance;
    builder.pass(
        &shaders::SUN_GLOSS,
        name,
        "the lobe towards the sun, times the part of it that is seen",
        [axis.steps.div_ceil(8), axis.lanes.div_ceil(4 * 16), 1],
        &[(0, border as u32), (1, u32::from(axis.marches_rows))],
        &SunGlossPush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            towards: [east, north, up, exponent],
            colour: [r, g, b, f32::from(u8::from(begins))],
        },
        &[("lane_heights", lane_heights), ("sun_sum", sun_sum), ("gloss_sum", gloss_sum)],
        axis.samples() * (4 + 4 + 2 * 16),
        axis.samples(),
    );
}

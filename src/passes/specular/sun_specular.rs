use crate::graph::shaders;
use crate::graph::shaders::same_layout;
use crate::graph::{Axis, Builder, ResourceId};
use crate::passes::Lobes;
use crate::passes::glossy::Glossy;
use crate::scene::{Border, Sun};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct SunSpecularPush {
    cols: i32,
    rows: i32,
    cell_x_m: f32,
    cell_y_m: f32,
    towards: [f32; 4],
    colour: [f32; 4],
    lobe: [f32; 2],
}

same_layout!(
    SunSpecularPush,
    sun_specular_push,
    cols = COLS,
    rows = ROWS,
    cell_x_m = CELL_X_M,
    cell_y_m = CELL_Y_M,
    towards = TOWARDS,
    colour = COLOUR,
    lobe = LOBE,
);

/// A sun in a lobe, by the part of it that diffuse ground sees; `begins` the sum with it.
pub(crate) fn plan(
    builder: &mut Builder,
    (axis, border, cell_m): (Axis, Border, [f64; 2]),
    name: &str,
    (sun, lobes): (&Sun, Lobes),
    [lane_heights, sun_sum, gloss_sum]: [ResourceId; 3],
    (begins, thrown): (bool, Option<Glossy>),
) {
    let [cols, rows] = axis.size();
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let (up, along) = sun.elevation_rad.sin_cos();
    let [east, north, up] = [cos * along, sin * along, up].map(|v| v as f32);
    let [r, g, b] = sun.irradiance;
    let mut bound =
        vec![("lane_heights", lane_heights), ("sun_sum", sun_sum), ("gloss_sum", gloss_sum)];
    bound.extend(lobes.map.map(|map| ("phong_map", map)));
    bound.extend(thrown.map(|glossy| ("arriving", glossy.arriving)));
    let layers = thrown.map_or(0, |glossy| glossy.layers());
    builder.pass(
        shaders::SunSpecular {
            border: border as u32,
            marches_rows: axis.marches_rows,
            lobe_is_map: lobes.map.is_some(),
            order: thrown.map_or(0, |glossy| glossy.order) as i32,
            grey: thrown.is_some_and(|glossy| glossy.grey),
        },
        name,
        "the lobe towards the sun, times the part of it that is seen",
        [axis.steps.div_ceil(8), axis.lanes.div_ceil(4 * 16), 1],
        &SunSpecularPush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            towards: [east, north, up, 0.0],
            colour: [r, g, b, f32::from(u8::from(begins))],
            lobe: [lobes.constant.exponent, lobes.constant.scale],
        },
        &bound,
        axis.samples() * (4 + 4 + 2 * 16 * (1 + u64::from(layers))),
        axis.samples(),
    );
}

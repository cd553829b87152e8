use crate::graph::{Axis, Builder, ResourceId, shaders};
use crate::scene::Border;

use super::mirror_map::MirrorMap;

/// Specular reflection of sky and environment: the unoccluded reflection times the free share. It begins the sum.
pub(crate) fn plan(
    builder: &mut Builder,
    (axis, border, cell_m): (Axis, Border, [f64; 2]),
    (scale, eye_m): (f32, [f32; 4]),
    [unoccluded, swept]: [&MirrorMap; 2],
    [lane_heights, blocked_sum, specular_sum]: [ResourceId; 3],
) {
    let [cols, rows] = axis.size();
    builder.pass(
        shaders::SpecularLight { border: border as u32, marches_rows: axis.marches_rows },
        "",
        "the unoccluded reflection, times the share that horizons leave free",
        shaders::SPECULAR_LIGHT.groups([axis.steps, axis.lanes.div_ceil(4), 1]),
        &shaders::SpecularLightPush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            eye_m,
            scale,
            unoccluded_columns: unoccluded.columns as i32,
            swept_columns: swept.columns as i32,
        },
        &[
            ("lane_heights", lane_heights),
            ("blocked_sum", blocked_sum),
            ("unoccluded_map", unoccluded.image),
            ("swept_map", swept.image),
            ("specular_sum", specular_sum),
        ],
        axis.texels() * (4 + 2 * 16 + 2 * 16 * 16),
        axis.texels(),
    );
}

use crate::graph::{Axis, Builder, ResourceId, shaders};
use crate::scene::Border;

use super::mirror_map::MirrorMap;
use crate::passes::PhongSource;
use crate::passes::specular_tables::MapLevels;

/// What horizons hide, and of which exponents.
pub(crate) struct Hidden {
    pub blocked_sum: ResourceId,
    pub levels: MapLevels,
}

/// Specular reflection of sky and environment: the unoccluded reflection times the free share. It begins the sum.
pub(crate) fn plan(
    builder: &mut Builder,
    (axis, border, cell_m): (Axis, Border, [f64; 2]),
    (phong, eye_m): (PhongSource, [f32; 4]),
    [unoccluded, swept]: [&MirrorMap; 2],
    (hidden, [lane_heights, specular_sum]): (&Hidden, [ResourceId; 2]),
) {
    let [cols, rows] = axis.size();
    let levels = &hidden.levels;
    let mut bound = vec![
        ("lane_heights", lane_heights),
        ("blocked_sum", hidden.blocked_sum),
        ("unoccluded_map", unoccluded.image),
        ("swept_map", swept.image),
        ("specular_sum", specular_sum),
        ("constants", levels.constants),
    ];
    bound.extend(levels.map_images.iter().flat_map(|of| of.bound()));
    // Texels of maps: of one exponent, or of four unoccluded ones and two that were swept.
    let fetched = if levels.map_images.is_some() { 6 * 16 } else { 2 * 16 };
    builder.pass(
        shaders::SpecularLight {
            border: border as u32,
            marches_rows: axis.marches_rows,
            specular_is_map: levels.map_images.is_some(),
        },
        "",
        "the unoccluded reflection, times the share that horizons leave free",
        shaders::SPECULAR_LIGHT.groups([axis.steps, axis.lanes.div_ceil(4), 1]),
        &shaders::SpecularLightPush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            eye_m,
            scale: phong.constant.scale,
            unoccluded_repeats: unoccluded.repeats() as i32,
            swept_repeats: swept.repeats() as i32,
            first_level: levels.first_texel as i32,
            level_count: levels.count as i32,
            levels_per_log: levels.per_log,
        },
        &bound,
        axis.texels() * (4 + 2 * 16 + fetched * 16),
        axis.texels(),
    );
}

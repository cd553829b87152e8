use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::bounced_specular::BouncedSpecular;

/// Incoming light from all directions, as an SH series.
pub(crate) fn plan(
    builder: &mut Builder,
    [cols, rows]: [u32; 2],
    specular: &BouncedSpecular,
    [visibility, light_matrix]: [ResourceId; 2],
) {
    let grid_points = u64::from(cols) * u64::from(rows);
    let fours = u64::from((specular.order * specular.order).div_ceil(4));
    builder.pass(
        shaders::SpecularVisibility { order: specular.order as i32, grey: specular.grey },
        "",
        "visibility times the light, for bounces",
        shaders::SPECULAR_VISIBILITY.groups([cols, rows, 1]),
        &shaders::SpecularVisibilityPush { cols: cols as i32, rows: rows as i32 },
        &[
            ("visibility", visibility),
            ("light_matrix", light_matrix),
            ("arriving", specular.arriving),
        ],
        grid_points * 16 * (fours + u64::from(specular.layers())),
        grid_points,
    );
}

use crate::graph::{Axis, Builder, ResourceId, shaders};
use crate::passes::PhongSource;
use crate::passes::sh_layout::{Lit, Sh};
use crate::scene::Border;

/// Light from visibility and the light's matrix, with normals of full resolution. `specular` is reflected towards an eye over the
/// field's base; its last number is 0 for a view from straight above.
pub(crate) fn plan(
    builder: &mut Builder,
    (axis, border, cell_m): (Axis, Border, [f64; 2]),
    sh: &Sh,
    [lane_heights, visibility, light_matrix, env_sum]: [ResourceId; 4],
    nodes: Option<ResourceId>,
    specular: Option<(PhongSource, [f32; 4])>,
) {
    let [cols, rows] = axis.size();
    let mut bound = vec![
        ("lane_heights", lane_heights),
        ("visibility", visibility),
        ("light_matrix", light_matrix),
        ("env_sum", env_sum),
    ];
    bound.extend(nodes.map(|n| ("nodes", n)));
    let map = specular.and_then(|(phong, _)| phong.map);
    bound.extend(map.map(|map| ("phong_map", map)));
    let [across, along] = sh.nodes.size([cols, rows]).map(u64::from);
    let visibility = across * along * 16 * (sh.layers() as u64 + u64::from(nodes.is_some()));
    builder.pass(
        shaders::ShShade {
            border: border as u32,
            marches_rows: axis.marches_rows,
            order: sh.order as i32,
            receiver: sh.lit as u32,
            node_stride: sh.nodes.stride as i32,
            specular_is_map: map.is_some(),
        },
        match sh.lit {
            Lit::Plane | Lit::Cosine => "env",
            Lit::Specular => "specular",
        },
        match sh.lit {
            Lit::Plane => "visibility times the light's matrix; the cosine is exact",
            Lit::Cosine => "visibility times the light's matrix; a cosine of three bands",
            Lit::Specular => "visibility times the light's matrix; a Phong lobe of as many bands",
        },
        shaders::SH_SHADE.groups([axis.steps, axis.lanes.div_ceil(4), 1]),
        &shaders::ShShadePush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            eye_m: specular.map_or([0.0; 4], |(_, eye_m)| eye_m),
            specular: specular.map_or([0.0; 2], |(l, _)| [l.constant.exponent, l.constant.scale]),
        },
        &bound,
        axis.texels() * (4 + 16) + visibility,
        axis.texels(),
    );
}

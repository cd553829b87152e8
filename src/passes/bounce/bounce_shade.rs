use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::bounces::Bounce;
use crate::scene::HeightField;

/// Irradiance at every grid point, from that at the nodes around it.
pub(crate) fn plan(
    builder: &mut Builder,
    field: &HeightField,
    bounce: &Bounce,
    [ground, sky_share]: [ResourceId; 2],
) {
    let at = bounce.found_at();
    let size = [field.cols() as u32, field.rows() as u32];
    let [cell_x, cell_y] = field.cell_m();
    let grid_points = u64::from(size[0]) * u64::from(size[1]);
    builder.pass(
        shaders::BounceShade { node_stride: at.nodes.stride as i32 },
        &bounce.name,
        "mean radiance of the ground visible from nodes, times each texel's own share of ground",
        shaders::BOUNCE_SHADE.groups([size[0], size[1], 1]),
        &shaders::BounceShadePush {
            cols: size[0] as i32,
            rows: size[1] as i32,
            cell_x_m: cell_x as f32,
            cell_y_m: cell_y as f32,
        },
        &[
            ("ground", ground),
            ("sky_share", sky_share),
            ("node_sum", at.sum),
            ("bounce_sum", bounce.sum),
        ],
        grid_points * (16 + 4 + 16) + at.count(size) * 16,
        grid_points,
    );
}

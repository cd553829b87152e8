use crate::graph::shaders;
use crate::graph::shaders::same_layout;
use crate::graph::{Axis, Builder, Reach, Rectangle, ResourceId};
use crate::scene::Border;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct HeightTransposePush {
    lanes: i32,
    steps: i32,
    rectangle: [i32; 4],
}

same_layout!(
    HeightTransposePush,
    height_transpose_push,
    lanes = LANES,
    steps = STEPS,
    rectangle = FIRST_COL,
);

/// Heights transposed for one axis, four lanes per texel.
pub(crate) fn plan(
    builder: &mut Builder,
    axis: Axis,
    border: Border,
    heights: ResourceId,
    lane_heights: ResourceId,
) {
    let quads = axis.lanes.div_ceil(4);
    let pass = builder.pass(
        shaders::HeightTranspose {
            marches_rows: axis.marches_rows,
            periodic: border == Border::Periodic,
        },
        axis.name(),
        "so that one fetch reads four neighbouring lanes",
        [quads.div_ceil(8), axis.steps.div_ceil(8), 1],
        &HeightTransposePush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            rectangle: Rectangle::whole(axis.size()).words(),
        },
        &[("heights", heights), ("lane_heights", lane_heights)],
        8 * axis.texels(),
        axis.texels(),
    );
    pass.reach = Some(Reach::Quads(axis));
}

use crate::gpu::shaders::{self, same_layout};
use crate::plan::{Bounce, BounceNodes, Builder, CAST_SLOTS, ResourceId};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct CastGatherPush {
    nodes_x: i32,
    nodes_y: i32,
}

same_layout!(CastGatherPush, cast_gather_push, nodes_x = NODES_X, nodes_y = NODES_Y);

/// What every node sees of one more bounce, by the casting sets that the first one left.
pub(crate) fn plan(
    builder: &mut Builder,
    size: [u32; 2],
    azimuths: u32,
    (at, casts): (&BounceNodes, ResourceId),
    bounce: &Bounce,
) {
    let [nodes_x, nodes_y] = at.nodes.size(size);
    let seen = at.count(size) * u64::from(azimuths);
    builder.pass(
        &shaders::CAST_GATHER,
        &bounce.name,
        format!("{}, by the casting sets of {azimuths} azimuths", bounce.why),
        [nodes_x.div_ceil(8), nodes_y.div_ceil(8), 1],
        &[(0, azimuths), (1, CAST_SLOTS), (2, u32::from(bounce.grey))],
        &CastGatherPush { nodes_x: nodes_x as i32, nodes_y: nodes_y as i32 },
        &[
            ("casting_sets", casts),
            (if bounce.grey { "exit_grey" } else { "exit_radiance" }, bounce.exit),
            ("bounce_sum", at.sum),
        ],
        at.count(size) * 32 + seen * (8 + if bounce.grey { 4 } else { 16 }),
        seen,
    );
}

use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::bounce_nodes::NodeSum;
use crate::passes::bounces::Bounce;
use crate::scene::Border;
use std::ops::Range;

/// One more bounce at every node, from the visibility cache that the first bounce left along some of the
/// `azimuths`. `before`: the sum of the bounce before, whose nodes include these.
pub(crate) fn plan(
    builder: &mut Builder,
    (size, border): ([u32; 2], Border),
    (azimuths, circle): (ResourceId, Range<u32>),
    (before, visibility_cache): (&NodeSum, ResourceId),
    bounce: &Bounce,
) {
    let at = bounce.found_at();
    let [nodes_x, nodes_y] = at.nodes.size(size);
    let count = circle.len() as u32;
    let visible = at.count(size) * u64::from(count);
    let pass = builder.pass(
        shaders::CacheGather {
            border: border as u32,
            grey: bounce.grey,
            node_stride: at.nodes.stride as i32,
            sum_stride: before.nodes.stride as i32,
        },
        &bounce.name,
        format!("{}, by the visibility cache of {count} azimuths", bounce.why),
        shaders::CACHE_GATHER.groups([nodes_x, nodes_y, 1]),
        &shaders::CacheGatherPush {
            cols: size[0] as i32,
            rows: size[1] as i32,
            begin: circle.start,
            count,
        },
        &[
            ("visibility_cache", visibility_cache),
            ("azimuths", azimuths),
            (if bounce.grey { "exit_grey" } else { "exit_radiance" }, bounce.exit),
            ("node_sum", before.sum),
            ("bounce_sum", at.sum),
        ],
        at.count(size) * 32 + visible * (16 + if bounce.grey { 16 } else { 64 }),
        visible,
    );
    pass.azimuths = circle;
}

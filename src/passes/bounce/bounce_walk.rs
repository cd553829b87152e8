use crate::graph::{Axis, Builder, MOST_TURNS, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::bounce_ground::BounceGround;
use crate::passes::bounce_nodes::NodeSum;
use crate::passes::bounces::Bounce;
use crate::passes::line_blocks::LineBlocks;
use crate::passes::nodes::Nodes;
use crate::scene::Border;
use std::ops::Range;

/// What a walk reads: ground and the results of a sweep.
pub(crate) struct Swept {
    pub azimuths: ResourceId,
    pub occluders: ResourceId,
    pub line_blocks: LineBlocks,
    pub ground: BounceGround,
    pub line_shift: u32,
    /// Azimuths used for bounces: the first, and the one after the last.
    pub begin: u32,
    pub end: u32,
    /// The visibility cache, and the nodes that have one.
    pub visibility_cache: Option<(ResourceId, Nodes)>,
    /// Where walks from every grid point find the share of the sky.
    pub sky_share: Option<ResourceId>,
}

/// Which nodes a dispatch walks from.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum From {
    All,
    /// The nodes of later bounces. They write the visibility cache.
    Kept,
    /// The other nodes of the same lanes.
    Between,
    /// Nodes of the other lanes.
    Rest,
}

/// Azimuths that a dispatch can walk: at most 33 steps near by, nine blocks an octave, the longest ones, and eight up
/// to the occluder.
pub(crate) fn most_azimuths(axis: Axis) -> u32 {
    MOST_TURNS / (33 + 9 * 10 + 8 + (axis.steps + axis.warm_up) / 256)
}

/// Gathers bounced light at every grid point, or at every node, along some azimuths of a batch.
pub(crate) fn plan(
    builder: &mut Builder,
    (border, cell_m): (Border, [f64; 2]),
    (batch, azimuths, part): (&Batch, &Range<u32>, &str),
    swept: &Swept,
    bounce: &Bounce,
) {
    let axis = batch.axis;
    let [cols, rows] = axis.size();
    let count = azimuths.len() as u32;
    let NodeSum { nodes, sum } = bounce.found_at();
    let [along, across] = nodes.size([axis.steps, axis.lanes]);
    let kept_each = swept.visibility_cache.map_or(2, |(_, later)| later.stride / nodes.stride);
    let dispatches = match swept.visibility_cache {
        None => vec![(From::All, "", [across, along])],
        Some((_, later)) => {
            let [kept_along, kept] = later.size([axis.steps, axis.lanes]);
            vec![
                (From::Kept, " kept", [kept, kept_along]),
                (From::Between, " between", [kept, along - kept_along]),
                (From::Rest, " rest", [across - kept, along]),
            ]
        }
    };
    let (line_blocks, block_layers) = swept.line_blocks.of(axis);
    let mut bound = vec![
        ("azimuths", swept.azimuths),
        ("occluders", swept.occluders),
        (LineBlocks::binding(bounce.grey), line_blocks),
        swept.ground.bound(),
        ("bounce_sum", sum),
    ];
    bound.extend(swept.sky_share.map(|share| ("sky_share", share)));
    let share_bytes = if swept.sky_share.is_some() { 8 } else { 0 };
    for (from, which, [across, along]) in dispatches.iter().filter(|d| !d.2.contains(&0)) {
        let found = u64::from(*along) * u64::from(*across);
        let mut bound = bound.clone();
        bound.extend(
            swept
                .visibility_cache
                .filter(|_| *from == From::Kept)
                .map(|c| ("visibility_cache", c.0)),
        );
        let bytes_an_azimuth = if *from == From::Kept { 18 } else { 2 };
        let pass = builder.pass(
            shaders::BounceWalk {
                layer_shift: batch.layer_shift as i32,
                line_shift: swept.line_shift as i32,
                border: border as u32,
                marches_rows: axis.marches_rows,
                grey: bounce.grey,
                node_stride: nodes.stride as i32,
                from: *from as u32,
                kept_each: kept_each as i32,
                finds_share: swept.sky_share.is_some(),
            },
            &format!("{part}{which}"),
            format!("{}, visible ground along {count} azimuths", bounce.why),
            shaders::BOUNCE_WALK.groups([*across, *along, 1]),
            &shaders::BounceWalkPush {
                cols: cols as i32,
                rows: rows as i32,
                cell_x_m: cell_m[0] as f32,
                cell_y_m: cell_m[1] as f32,
                warm_up: axis.warm_up as i32,
                first_azimuth: azimuths.start,
                azimuth_count: count,
                clears: u32::from(azimuths.start == swept.begin),
                is_last: u32::from(azimuths.end == swept.end),
                begin: swept.begin,
                block_layers,
            },
            &bound,
            found
                * (swept.ground.texel_bytes()
                    + 32
                    + share_bytes
                    + u64::from(count) * bytes_an_azimuth),
            found * u64::from(count),
        );
        pass.azimuths = azimuths.clone();
    }
}

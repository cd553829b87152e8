use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::bounce_nodes::NodeSum;
use crate::passes::bounces::Bounce;
use crate::passes::nodes::Nodes;
use crate::passes::sphere_shade::MOST_TURNS;
use crate::scene::Border;

/// What a walk reads: heights and the results of a sweep.
pub(crate) struct Swept {
    pub lane_heights: ResourceId,
    pub azimuths: ResourceId,
    pub occluders: ResourceId,
    pub line_shift: u32,
    /// Whether the circle begins with this batch, and whether it ends with it.
    pub begin: u32,
    pub is_last: bool,
    /// The visibility cache of every second node.
    pub visibility_cache: Option<ResourceId>,
}

/// Which nodes a dispatch walks from; numbered as in the shader.
#[derive(Clone, Copy, PartialEq)]
enum From {
    All,
    /// Nodes of every second lane and of the last one. Every second one along a lane writes the visibility
    /// cache.
    Kept,
    /// Nodes of the other lanes.
    Rest,
}

/// Gathers bounced light at every grid point, or at every node, along the azimuths of a batch. As many
/// dispatches as its loop iterations need.
pub(crate) fn plan(
    builder: &mut Builder,
    (border, cell_m): (Border, [f64; 2]),
    (batch, part): (&Batch, &str),
    swept: &Swept,
    bounce: &Bounce,
) {
    let axis = batch.axis;
    let [cols, rows] = axis.size();
    let at_once = (MOST_TURNS / (axis.steps + axis.warm_up + 1)).max(1);
    let all = batch.azimuths();
    let NodeSum { nodes, sum } = bounce.found_at();
    let [along, across] = nodes.size([axis.steps, axis.lanes]);
    let [_, kept] = Nodes { stride: 2 * nodes.stride }.size([axis.steps, axis.lanes]);
    let dispatches = match swept.visibility_cache {
        None => vec![(From::All, "", across)],
        Some(_) => vec![(From::Kept, " kept", kept), (From::Rest, " not kept", across - kept)],
    };
    let bound = [
        ("lane_heights", swept.lane_heights),
        ("azimuths", swept.azimuths),
        ("occluders", swept.occluders),
        (if bounce.grey { "exit_grey" } else { "exit_radiance" }, bounce.exit),
        ("bounce_sum", sum),
    ];
    for first in all.clone().step_by(at_once as usize) {
        let last = all.end.min(first + at_once);
        let turn = match last - first == batch.count {
            true => String::new(),
            false => format!(" azimuths {}..{}", first - all.start, last - all.start),
        };
        for (from, which, across) in dispatches.iter().filter(|d| d.2 > 0) {
            let found = u64::from(along) * u64::from(*across);
            let mut bound = bound.to_vec();
            bound.extend(
                swept
                    .visibility_cache
                    .filter(|_| *from == From::Kept)
                    .map(|c| ("visibility_cache", c)),
            );
            // One of two nodes stores 16 bytes.
            let bytes_an_azimuth = if *from == From::Kept { 10 } else { 2 };
            let pass = builder.pass(
                shaders::BounceWalk {
                    line_shift: swept.line_shift as i32,
                    border: border as u32,
                    marches_rows: axis.marches_rows,
                    grey: bounce.grey,
                    node_stride: nodes.stride as i32,
                    from: *from as u32,
                },
                &format!("{part}{which}{turn}"),
                format!("{}, visible intervals along {} azimuths", bounce.why, last - first),
                [along.div_ceil(8), across.div_ceil(8), 1],
                &shaders::BounceWalkPush {
                    cols: cols as i32,
                    rows: rows as i32,
                    cell_x_m: cell_m[0] as f32,
                    cell_y_m: cell_m[1] as f32,
                    warm_up: axis.warm_up as i32,
                    first_azimuth: first,
                    azimuth_count: last - first,
                    clears: u32::from(batch.is_first && first == all.start),
                    is_last: u32::from(swept.is_last && last == all.end),
                    begin: swept.begin,
                },
                &bound,
                found * (4 + 32 + u64::from(last - first) * bytes_an_azimuth),
                found * u64::from(last - first),
            );
            pass.azimuths = first..last;
        }
    }
}

use crate::graph::shaders;
use crate::graph::shaders::same_layout;
use crate::graph::{Builder, ResourceId};
use crate::passes::batch::Batch;
use crate::passes::bounce_nodes::NodeSum;
use crate::passes::bounces::Bounce;
use crate::passes::nodes::Nodes;
use crate::passes::sphere_shade::MOST_TURNS;
use crate::scene::Border;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct BounceWalkPush {
    cols: i32,
    rows: i32,
    cell_x_m: f32,
    cell_y_m: f32,
    warm_up: i32,
    first_azimuth: u32,
    azimuth_count: u32,
    clears: u32,
    is_last: u32,
    begin: u32,
}

same_layout!(
    BounceWalkPush,
    bounce_walk_push,
    cols = COLS,
    rows = ROWS,
    cell_x_m = CELL_X_M,
    cell_y_m = CELL_Y_M,
    warm_up = WARM_UP,
    first_azimuth = FIRST_AZIMUTH,
    azimuth_count = AZIMUTH_COUNT,
    clears = CLEARS,
    is_last = IS_LAST,
    begin = BEGIN,
);

/// What a walk reads of the heights and of what a sweep left.
pub(crate) struct Swept {
    pub lane_heights: ResourceId,
    pub azimuths: ResourceId,
    pub occluders: ResourceId,
    pub line_shift: u32,
    /// Where the circle begins, and whether it ends with the batch.
    pub begin: u32,
    pub is_last: bool,
    /// Where what is seen from every second node is kept.
    pub casts: Option<ResourceId>,
}

/// Which nodes a dispatch walks from, as the shader's constant.
#[derive(Clone, Copy, PartialEq)]
enum From {
    All,
    /// Those of every second lane and of the last, of which every second along keeps its casting sets.
    Kept,
    /// Those of other lanes.
    Rest,
}

/// What every sample, or every node, sees of the ground in the azimuths of a batch, in as many dispatches as its turns need.
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
    let dispatches = match swept.casts {
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
            bound.extend(swept.casts.filter(|_| *from == From::Kept).map(|c| ("casting_sets", c)));
            // Of two nodes one keeps 16 bytes.
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
                format!("{}, stretches seen along {} azimuths", bounce.why, last - first),
                [along.div_ceil(8), across.div_ceil(8), 1],
                &BounceWalkPush {
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

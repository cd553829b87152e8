use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::nodes::Nodes;

/// Brute force: every crossing of every grid point's own line.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    (distances, nodes): (bool, Nodes),
    [lane_heights, azimuths, slopes]: [ResourceId; 3],
) {
    let axis = batch.axis;
    let [lanes, steps] = nodes.size([axis.lanes, axis.steps]);
    let grid_points = u64::from(lanes) * u64::from(steps) * u64::from(batch.count);
    let pass = builder.pass(
        shaders::HorizonMarch {
            periodic: axis.warm_up > 0,
            writes_distances: distances,
            node_stride: nodes.stride as i32,
        },
        part,
        format!("brute-force horizons of {} azimuths along {}", batch.count, axis.name()),
        [lanes.div_ceil(8), steps.div_ceil(8), batch.count],
        &shaders::MarchPush::of(batch),
        &[("lane_heights", lane_heights), ("azimuths", azimuths), ("slopes", slopes)],
        grid_points * 8,
        grid_points,
    );
    pass.azimuths = batch.azimuths();
}

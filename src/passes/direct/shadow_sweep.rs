use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;

/// Shadow heights along all lines of a batch, a cell apart. `group_size` invocations sweep four lines each.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    (group_size, fetches_ahead): (u32, bool),
    [lane_heights, azimuths, shadows]: [ResourceId; 3],
) {
    let axis = batch.axis;
    let pass = builder.pass(
        shaders::ShadowSweep {
            layer_shift: batch.layer_shift as i32,
            local_size_x: group_size,
            periodic: axis.warm_up > 0,
            fetches_ahead,
        },
        part,
        format!("shadow heights of {} azimuths along {}", batch.count, axis.name()),
        [batch.most_lines.div_ceil(4 * group_size), 1, batch.count],
        &shaders::ShadowSweepPush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
        },
        &[("lane_heights", lane_heights), ("azimuths", azimuths), ("shadows", shadows)],
        batch.line_texels * 8,
        batch.line_texels,
    );
    pass.azimuths = batch.azimuths();
}

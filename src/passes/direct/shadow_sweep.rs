use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;

/// Shadow heights along all lines of a batch, a cell apart. Each of `group_size` invocations marches one line over the heights of
/// lane_buffer, or four lines over those of lane_heights.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    group_size: u32,
    heights: (&str, ResourceId),
    [azimuths, shadows]: [ResourceId; 2],
) {
    let axis = batch.axis;
    let one_line = heights.0 == "lane_buffer";
    let group_lines = if one_line { group_size } else { 4 * group_size };
    let pass = builder.pass(
        shaders::ShadowSweep {
            layer_shift: batch.layer_shift as i32,
            local_size_x: group_size,
            periodic: axis.warm_up > 0,
            one_line,
            written_words: if one_line { 2 * 4 * group_size as i32 } else { 1 },
        },
        part,
        format!("shadow heights of {} azimuths along {}", batch.count, axis.name()),
        [batch.most_lines.div_ceil(group_lines), 1, batch.count],
        &shaders::ShadowSweepPush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
        },
        &[heights, ("azimuths", azimuths), ("shadows", shadows)],
        batch.line_texels * 8,
        batch.line_texels,
    );
    pass.azimuths = batch.azimuths();
}

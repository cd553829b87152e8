use crate::graph::{Builder, Limits, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::sweep::{group_size, line_segments};

/// Shadow heights along all lines of a batch, of a light with at most so many slices, a cell apart. Each invocation marches a segment of one line over the heights of
/// lane_buffer, or four whole lines over those of lane_heights.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    (slices, limits): (u32, &Limits),
    heights: (&str, ResourceId),
    [azimuths, shadows]: [ResourceId; 2],
) {
    let axis = batch.axis;
    let one_line = heights.0 == "lane_buffer";
    let group_size = group_size(limits);
    let group_lines = if one_line { group_size } else { 4 * group_size };
    // Two buffers of four steps, and a height with its step.
    let [written, highest] = [2 * 4 * group_size, 2 * group_size];
    let segments = if one_line {
        // Half of the slices march along each axis, if both are used. The lines of this batch would change as a sun moves, and with
        // them its pipelines.
        let lines = slices.div_ceil(2) * (axis.lanes + axis.steps);
        line_segments(lines, group_size, 4 * (written + highest), limits)
    } else {
        1
    };
    let pass = builder.pass(
        shaders::ShadowSweep {
            layer_shift: batch.layer_shift as i32,
            local_size_x: group_size,
            local_size_y: segments,
            periodic: axis.warm_up > 0,
            one_line,
            written_words: if one_line { (written * segments) as i32 } else { 1 },
            segment_words: if one_line { (group_size * segments) as i32 } else { 1 },
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

use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;

/// Exact sweeps along grid vectors: the hull holds every crossing of every line.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    hull_depth: u32,
    distances: bool,
    [lane_heights, azimuths, slopes]: [ResourceId; 3],
) {
    let axis = batch.axis;
    let group_size = 8;
    let pass = builder.pass(
        shaders::SurfaceSweep {
            local_size_x: group_size,
            hull_depth: hull_depth as i32,
            periodic: axis.warm_up > 0,
            writes_distances: distances,
        },
        part,
        format!("exact horizons of {} azimuths along {}", batch.count, axis.name()),
        [batch.most_lines.div_ceil(group_size), 1, batch.count],
        &shaders::MarchPush::of(batch),
        &[("lane_heights", lane_heights), ("azimuths", azimuths), ("slopes", slopes)],
        batch.line_texels * 4 + axis.texels() * u64::from(batch.count) * 4,
        batch.line_texels,
    );
    pass.azimuths = batch.azimuths();
}

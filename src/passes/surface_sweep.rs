use crate::gpu::shaders::{self, same_layout};
use crate::plan::{Batch, Builder, ResourceId};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct SurfaceSweepPush {
    lanes: i32,
    steps: i32,
    warm_up: i32,
    first_azimuth: u32,
}

same_layout!(
    SurfaceSweepPush,
    surface_sweep_push,
    lanes = LANES,
    steps = STEPS,
    warm_up = WARM_UP,
    first_azimuth = FIRST_AZIMUTH,
);

/// Exact sweeps along grid vectors: every crossing of every line on its hull.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    hull_depth: u32,
    distances: bool,
    [heights, azimuths, slopes]: [ResourceId; 3],
) {
    let axis = batch.axis;
    let group_size = 8;
    builder.pass(
        &shaders::SURFACE_SWEEP,
        part,
        format!("exact horizons of {} azimuths along {}", batch.count, axis.name()),
        [batch.most_lines.div_ceil(group_size), 1, batch.count],
        &[
            (0, group_size),
            (1, hull_depth),
            (2, u32::from(axis.warm_up > 0)),
            (3, u32::from(distances)),
        ],
        &SurfaceSweepPush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
        },
        &[("heights", heights), ("azimuths", azimuths), ("slopes", slopes)],
        batch.line_samples * 4 + axis.samples() * u64::from(batch.count) * 4,
        batch.line_samples,
    );
}

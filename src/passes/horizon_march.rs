use crate::gpu::shaders::{self, same_layout};
use crate::plan::{Batch, Builder, ResourceId};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct HorizonMarchPush {
    lanes: i32,
    steps: i32,
    warm_up: i32,
    first_azimuth: u32,
}

same_layout!(
    HorizonMarchPush,
    horizon_march_push,
    lanes = LANES,
    steps = STEPS,
    warm_up = WARM_UP,
    first_azimuth = FIRST_AZIMUTH,
);

/// Brute force: every crossing of every sample's own line.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    distances: bool,
    [heights, azimuths, slopes]: [ResourceId; 3],
) {
    let axis = batch.axis;
    builder.pass(
        &shaders::HORIZON_MARCH,
        part,
        format!("brute-force horizons of {} azimuths along {}", batch.count, axis.name()),
        [axis.lanes.div_ceil(8), axis.steps.div_ceil(8), batch.count],
        &[(0, 1), (1, u32::from(axis.warm_up > 0)), (2, u32::from(distances))],
        &HorizonMarchPush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
        },
        &[("heights", heights), ("azimuths", azimuths), ("slopes", slopes)],
        axis.samples() * u64::from(batch.count) * 8,
        axis.samples() * u64::from(batch.count),
    );
}

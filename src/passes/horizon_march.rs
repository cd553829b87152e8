use super::push::MarchPush;
use crate::gpu::shaders;
use crate::plan::{Batch, Builder, ResourceId};

/// Brute force: every crossing of every sample's own line.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    distances: bool,
    [heights, azimuths, slopes]: [ResourceId; 3],
) {
    let axis = batch.axis;
    let pass = builder.pass(
        &shaders::HORIZON_MARCH,
        part,
        format!("brute-force horizons of {} azimuths along {}", batch.count, axis.name()),
        [axis.lanes.div_ceil(8), axis.steps.div_ceil(8), batch.count],
        &[(0, 1), (1, u32::from(axis.warm_up > 0)), (2, u32::from(distances))],
        &MarchPush::of(batch),
        &[("heights", heights), ("azimuths", azimuths), ("slopes", slopes)],
        axis.samples() * u64::from(batch.count) * 8,
        axis.samples() * u64::from(batch.count),
    );
    pass.azimuths = batch.azimuths();
}

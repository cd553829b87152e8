use crate::gpu::shaders::{self, same_layout};
use crate::plan::sweep::Sweep;
use crate::plan::{Batch, Builder, ResourceId};
use crate::scene::Border;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct SweepFusePush {
    cols: i32,
    rows: i32,
    warm_up: i32,
    first_azimuth: u32,
    first_layer: u32,
}

same_layout!(
    SweepFusePush,
    sweep_fuse_push,
    cols = COLS,
    rows = ROWS,
    warm_up = WARM_UP,
    first_azimuth = FIRST_AZIMUTH,
    first_layer = FIRST_LAYER,
);

/// Horizons of the samples themselves, as elevations.
pub(crate) fn plan(
    builder: &mut Builder,
    sweep: &Sweep,
    border: Border,
    batch: &Batch,
    part: &str,
    [lane_heights, azimuths, angles]: [ResourceId; 3],
    (lattice, distances): (Option<ResourceId>, Option<ResourceId>),
) {
    let axis = batch.axis;
    let [cols, rows] = axis.size();
    let mut bound =
        vec![("lane_heights", lane_heights), ("azimuths", azimuths), ("horizon_angles", angles)];
    bound.extend(lattice.map(|l| (sweep.lattice_binding(), l)));
    bound.extend(distances.map(|d| ("horizon_distances", d)));
    let pass = builder.pass(
        &shaders::SWEEP_FUSE,
        part,
        "from the lines back to the samples",
        [axis.steps.div_ceil(8), axis.lanes.div_ceil(4 * 16), batch.count],
        &[
            (0, sweep.fuse_mode()),
            (1, sweep.lattice_content()),
            (2, sweep.line_shift()),
            (3, border as u32),
            (4, u32::from(distances.is_some())),
            (5, u32::from(sweep.lattice_has_distances())),
            (6, u32::from(axis.marches_rows)),
        ],
        &SweepFusePush {
            cols: cols as i32,
            rows: rows as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
            first_layer: batch.first,
        },
        &bound,
        axis.samples() * u64::from(batch.count) * (8 + sweep.lattice_bytes()),
        axis.samples() * u64::from(batch.count),
    );
    pass.azimuths = batch.azimuths();
}

use crate::gpu::shaders::{self, same_layout};
use crate::plan::sweep::Sweep;
use crate::plan::{Batch, Builder, ResourceId};
use crate::scene::Border;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct SunShadePush {
    cols: i32,
    rows: i32,
    cell_x_m: f32,
    cell_y_m: f32,
    warm_up: i32,
    first_azimuth: u32,
    azimuth_count: u32,
    clears: u32,
}

same_layout!(
    SunShadePush,
    sun_shade_push,
    cols = COLS,
    rows = ROWS,
    cell_x_m = CELL_X_M,
    cell_y_m = CELL_Y_M,
    warm_up = WARM_UP,
    first_azimuth = FIRST_AZIMUTH,
    azimuth_count = AZIMUTH_COUNT,
    clears = CLEARS,
);

/// Light of one sun through the horizons of the azimuths that its disc covers.
#[expect(clippy::too_many_arguments, reason = "a pass is its inputs")]
pub(crate) fn plan(
    builder: &mut Builder,
    sweep: &Sweep,
    border: Border,
    cell_m: [f64; 2],
    batch: &Batch,
    part: &str,
    is_point: bool,
    [lane_heights, lattice, azimuths, sun_sum]: [ResourceId; 4],
) {
    let axis = batch.axis;
    let [cols, rows] = axis.size();
    builder.pass(
        &shaders::SUN_SHADE,
        part,
        if is_point {
            "a point: lit or not"
        } else {
            "the part of each chord of the disc above the horizon"
        },
        [axis.steps.div_ceil(8), axis.lanes.div_ceil(4 * 16), 1],
        &[
            (0, sweep.fuse_mode()),
            (1, sweep.lattice_content()),
            (2, sweep.line_shift()),
            (3, border as u32),
            (4, u32::from(is_point)),
            (5, u32::from(axis.marches_rows)),
        ],
        &SunShadePush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
            azimuth_count: batch.count,
            clears: u32::from(batch.is_first),
        },
        &[
            ("lane_heights", lane_heights),
            (sweep.lattice_binding(), lattice),
            ("azimuths", azimuths),
            ("sun_sum", sun_sum),
        ],
        axis.samples() * (12 + u64::from(batch.count) * sweep.lattice_bytes()),
        axis.samples() * u64::from(batch.count),
    );
}

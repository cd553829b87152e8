//! One file a pass: what it binds, how large it is, and why it is there; below, what several push alike.

pub(crate) mod bounce_gather;
pub(crate) mod bounce_march;
pub(crate) mod bounce_walk;
pub(crate) mod dirty_list;
pub(crate) mod dirty_mark;
pub(crate) mod env_tables;
pub(crate) mod env_turns;
pub(crate) mod env_wedges;
pub(crate) mod height_bounds;
pub(crate) mod height_cells;
pub(crate) mod height_expand;
pub(crate) mod height_reduce;
pub(crate) mod height_transpose;
pub(crate) mod horizon_march;
pub(crate) mod horizon_resweep;
pub(crate) mod horizon_sweep;
pub(crate) mod light_matrix;
pub(crate) mod light_resolve;
pub(crate) mod path_trace;
pub(crate) mod pyramid_march;
pub(crate) mod sh_shade;
pub(crate) mod sh_visibility;
pub(crate) mod sh_wedges;
pub(crate) mod shade_expand;
pub(crate) mod shade_reduce;
pub(crate) mod sky_shade;
pub(crate) mod sphere_sh_shade;
pub(crate) mod sphere_shade;
pub(crate) mod sun_gloss;
pub(crate) mod sun_shade;
pub(crate) mod surface_sweep;
pub(crate) mod sweep_fuse;

use crate::gpu::shaders::same_layout;
use crate::plan::Batch;

/// Of the passes that add light through a batch's horizons.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ShadePush {
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
    ShadePush,
    shade_push,
    cols = COLS,
    rows = ROWS,
    cell_x_m = CELL_X_M,
    cell_y_m = CELL_Y_M,
    warm_up = WARM_UP,
    first_azimuth = FIRST_AZIMUTH,
    azimuth_count = AZIMUTH_COUNT,
    clears = CLEARS,
);

impl ShadePush {
    pub fn of(batch: &Batch, cell_m: [f64; 2]) -> Self {
        let [cols, rows] = batch.axis.size();
        Self {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            warm_up: batch.axis.warm_up as i32,
            first_azimuth: batch.first,
            azimuth_count: batch.count,
            clears: u32::from(batch.is_first),
        }
    }
}

/// Of the passes that march over the field's own heights, cell by cell.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct MarchPush {
    lanes: i32,
    steps: i32,
    warm_up: i32,
    first_azimuth: u32,
}

same_layout!(
    MarchPush,
    march_push,
    lanes = LANES,
    steps = STEPS,
    warm_up = WARM_UP,
    first_azimuth = FIRST_AZIMUTH,
);

impl MarchPush {
    pub fn of(batch: &Batch) -> Self {
        let axis = batch.axis;
        Self {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
        }
    }
}

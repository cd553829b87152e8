//! Passes, one file per shader: bindings, size, reason and cost of each dispatch. A folder per technique.
//! This file holds the push constants that several passes share.

pub(crate) mod bake;
pub(crate) mod bounce;
pub(crate) mod direct;
pub(crate) mod edit;
pub(crate) mod horizon;
pub(crate) mod rays;
pub(crate) mod reference;
pub(crate) mod sh;
pub(crate) mod specular;
pub(crate) mod view;

pub use bake::facet_mask;
pub(crate) use bake::{bent_directions, ellipse_fit, fan_weights, scatter_gather, visible_points};
pub(crate) use bounce::{
    bounce_gather, bounce_march, bounce_nodes, bounce_shade, bounce_walk, bounces, cache_gather,
    shade_expand, shade_reduce, specular_gather, vector_reduce,
};
pub(crate) use direct::{
    env_tables, light_resolve, sky_shade, sphere_sh, sphere_sh_shade, sphere_shade, spheres,
    sun_shade,
};
pub(crate) use edit::{dirty_list, dirty_mark, edits, horizon_resweep};
pub use horizon::{azimuths, batch, nodes, pyramid, sweep, sweeping};
pub(crate) use horizon::{
    height_expand, height_reduce, height_transpose, horizon_march, horizon_sweep, pyramid_march,
    surface_sweep, sweep_fuse,
};
pub(crate) use rays::{blocks, height_bounds, height_cells};
pub(crate) use reference::path_trace;
pub(crate) use sh::{
    env_rotation, env_wedges, light_matrix, sh_layout, sh_shade, sh_visibility, sh_wedges,
};
pub(crate) use specular::{bounced_specular, specular_exit, specular_visibility, sun_specular};
pub use view::map_draw;
pub(crate) use view::{picture_tone, sky_draw, terrain_draw};

use crate::graph::ResourceId;
use crate::graph::shaders::same_layout;
use crate::passes::batch::Batch;
use crate::passes::blocks::Blocks;
use crate::passes::pyramid::Pyramid;
use crate::scene::{HeightField, PhongSpecular};

/// Phong specular: constant, or a map.
#[derive(Clone, Copy)]
pub(crate) struct PhongSource {
    /// Used where there is no map.
    pub constant: PhongSpecular,
    pub map: Option<ResourceId>,
}

/// Push constants of the passes that add light through a batch's horizons.
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
    pub(crate) fn of(batch: &Batch, cell_m: [f64; 2]) -> Self {
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

/// Push constants of the passes that march over the field's own heights, cell by cell.
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
    pub(crate) fn of(batch: &Batch) -> Self {
        let axis = batch.axis;
        Self {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
        }
    }
}

/// First push constants of the passes whose rays traverse blocks of cells: what `walk.glsl` reads.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct LandPush {
    cols: i32,
    rows: i32,
    cells_x: i32,
    cells_y: i32,
    padded_rows: i32,
    top_level: i32,
    cell_x_m: f32,
    cell_y_m: f32,
}

same_layout!(
    LandPush,
    [sphere_shade_push, sphere_sh_shade_push, bounce_march_push],
    {
        cols = COLS,
        rows = ROWS,
        cells_x = CELLS_X,
        cells_y = CELLS_Y,
        padded_rows = PADDED_ROWS,
        top_level = TOP_LEVEL,
        cell_x_m = CELL_X_M,
        cell_y_m = CELL_Y_M,
    }
);

impl LandPush {
    pub(crate) fn of(field: &HeightField, blocks: &Blocks) -> Self {
        let [cell_x, cell_y] = field.cell_m();
        Self {
            cols: field.cols() as i32,
            rows: field.rows() as i32,
            cells_x: blocks.cells[0] as i32,
            cells_y: blocks.cells[1] as i32,
            padded_rows: blocks.padded_rows as i32,
            top_level: blocks.top_level as i32,
            cell_x_m: cell_x as f32,
            cell_y_m: cell_y as f32,
        }
    }
}

/// Push constants of the passes that make a pyramid level from a finer one.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ReducePush {
    size: [i32; 2],
    first: i32,
    source_size: [i32; 2],
    source_first: i32,
    ratio: [f32; 2],
    per_grid_point: [f32; 2],
    level: i32,
    width_shift: i32,
}

same_layout!(
    ReducePush,
    [height_reduce_push, shade_reduce_push, vector_reduce_push],
    {
        size = COLS,
        first = FIRST,
        source_size = SOURCE_COLS,
        source_first = SOURCE_FIRST,
        ratio = RATIO_X,
        per_grid_point = PER_GRID_POINT_X,
        level = LEVEL,
        width_shift = WIDTH_SHIFT,
    }
);

impl ReducePush {
    pub(crate) fn of(pyramid: &Pyramid, number: u32) -> Self {
        let (level, source) = (pyramid.level(number), pyramid.level(pyramid.source(number)));
        Self {
            size: level.size.map(|n| n as i32),
            first: level.first as i32,
            source_size: source.size.map(|n| n as i32),
            source_first: source.first as i32,
            ratio: pyramid.ratio(number),
            per_grid_point: level.per_grid_point,
            level: number as i32,
            width_shift: pyramid.width_shift() as i32,
        }
    }
}

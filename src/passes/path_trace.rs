use std::ops::Range;

use crate::gpu::shaders::{self, same_layout};
use crate::plan::{Builder, ResourceId};
use crate::scene::{Albedo, Border, Scene};

/// log2 of the paths a sample of one batch, 8 at most. Fewer: more dispatches. More: a net fills its square
/// more evenly, but fewer batches tell the standard error.
const SET_BITS: u32 = 6;

/// Paths a sample that one run of the pass adds.
pub(crate) const BATCH_PATHS: u32 = 1 << SET_BITS;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct PathTracePush {
    cols: i32,
    rows: i32,
    cells_x: i32,
    cells_y: i32,
    padded_rows: i32,
    top_level: i32,
    highest_m: f32,
    cell_x_m: f32,
    cell_y_m: f32,
    rotation_turns: f32,
    exponent: f32,
    lobe_share: f32,
    bounces: i32,
    suns: i32,
    light_count: i32,
    seed: u32,
    albedo: [f32; 4],
    sky: [f32; 4],
    first_row: i32,
    keys: i32,
}

same_layout!(
    PathTracePush,
    path_trace_push,
    cols = COLS,
    rows = ROWS,
    cells_x = CELLS_X,
    cells_y = CELLS_Y,
    padded_rows = PADDED_ROWS,
    top_level = TOP_LEVEL,
    highest_m = HIGHEST_M,
    cell_x_m = CELL_X_M,
    cell_y_m = CELL_Y_M,
    rotation_turns = ROTATION_TURNS,
    exponent = EXPONENT,
    lobe_share = LOBE_SHARE,
    bounces = BOUNCES,
    suns = SUNS,
    light_count = LIGHT_COUNT,
    seed = SEED,
    albedo = ALBEDO,
    sky = SKY,
    first_row = FIRST_ROW,
    keys = KEYS,
);

/// What rays skip by: cells, rows of the image that the levels' places follow from, levels.
pub(crate) struct Blocks {
    pub cells: [u32; 2],
    pub padded_rows: u32,
    pub top_level: u32,
}

/// Steps that no ray of a field can ask for: over its longest side, or as far as a ray over repetitions is
/// followed, two cells a cell along it, and half as many changes of level; and those of the last block.
fn most_steps([cells_x, cells_y]: [u32; 2], border: Border) -> u32 {
    let reach = if border == Border::Periodic { REACH_CELLS } else { cells_x.max(cells_y) };
    3 * reach + 64
}

/// As in `trace.glsl`.
const REACH_CELLS: u32 = 16384;

/// One batch of paths from every sample of some rows, counted in eights.
pub(crate) fn plan(
    builder: &mut Builder,
    scene: &Scene,
    blocks: &Blocks,
    (bounces, seed): (u32, u32),
    band: Range<u32>,
    bound: &[(&str, ResourceId)],
) {
    let Scene { field, surface, lights } = scene;
    let (cols, rows) = (field.cols() as u32, field.rows() as u32);
    let samples = u64::from(cols) * u64::from(band.end - band.start);
    let part = match band.end - band.start {
        all if all == rows => String::new(),
        _ => format!("rows {}..{}", band.start, band.end),
    };
    let highest_m = field.heights_m().iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let is_line = |n| surface.border != Border::Periodic && n == 1;
    let count = lights.suns.len() + lights.keys.len() + lights.spheres.len();
    let four = |[r, g, b]: [f32; 3]| [r, g, b, 1.0];
    let (albedo, is_map) = match surface.albedo {
        Albedo::Constant(colour) => (colour, false),
        Albedo::Map(_) => ([0.0; 3], true),
    };
    let turns = |e: &crate::scene::Environment| {
        (e.rotation_rad() / std::f64::consts::TAU).rem_euclid(1.0) as f32
    };
    builder.pass(
        &shaders::PATH_TRACE,
        &part,
        format!("{BATCH_PATHS} more paths a sample, up to {bounces} bounces"),
        [cols.div_ceil(8), (band.end - band.start).div_ceil(8), 1],
        &[
            (0, surface.border as u32),
            (1, u32::from(is_line(rows))),
            (6, u32::from(is_line(cols))),
            (2, SET_BITS),
            (3, u32::from(is_map)),
            (4, u32::from(lights.environment.is_some())),
            (5, u32::from(surface.phong.is_some())),
            (7, u32::from(count > 0)),
            (11, u32::from(!lights.keys.is_empty())),
            (8, u32::from(!lights.spheres.is_empty())),
            (9, u32::from(bounces > 0)),
            (10, most_steps(blocks.cells, surface.border)),
        ],
        &PathTracePush {
            cols: cols as i32,
            rows: rows as i32,
            cells_x: blocks.cells[0] as i32,
            cells_y: blocks.cells[1] as i32,
            padded_rows: blocks.padded_rows as i32,
            top_level: blocks.top_level as i32,
            highest_m,
            cell_x_m: field.cell_m()[0] as f32,
            cell_y_m: field.cell_m()[1] as f32,
            rotation_turns: lights.environment.as_ref().map_or(0.0, turns),
            exponent: surface.phong.map_or(0.0, |p| p.exponent),
            lobe_share: surface.phong.map_or(0.0, |p| p.scale),
            bounces: bounces as i32,
            suns: lights.suns.len() as i32,
            light_count: count as i32,
            seed,
            albedo: four(albedo),
            sky: four(lights.sky.unwrap_or_default()),
            first_row: band.start as i32,
            keys: lights.keys.len() as i32,
        },
        bound,
        samples * 7 * 16,
        samples * u64::from(BATCH_PATHS),
    );
}

use crate::graph::shaders::same_layout;

/// Push constants of the field's mesh.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub(crate) struct TerrainDrawPush {
    /// Columns of the matrix from (columns, rows, metres) relative to the origin to clip coordinates.
    pub clip_per_col: [f32; 4],
    pub clip_per_row: [f32; 4],
    pub clip_per_metre: [f32; 4],
    pub clip_at_origin: [f32; 4],
    pub origin_col: i32,
    pub origin_row: i32,
    pub origin_m: f32,
    pub cols: i32,
    pub rows: i32,
    pub mesh_step: i32,
    pub tiles_across: i32,
}

same_layout!(
    TerrainDrawPush,
    terrain_draw_push,
    clip_per_col = CLIP_PER_COL,
    clip_per_row = CLIP_PER_ROW,
    clip_per_metre = CLIP_PER_METRE,
    clip_at_origin = CLIP_AT_ORIGIN,
    origin_col = ORIGIN_COL,
    origin_row = ORIGIN_ROW,
    origin_m = ORIGIN_M,
    cols = COLS,
    rows = ROWS,
    mesh_step = MESH_STEP,
    tiles_across = TILES_ACROSS,
);

/// Cells per side of a tile of the mesh; one instance draws a tile.
pub(crate) const TILE: u32 = 16;

/// Vertices of a tile's triangles, row after row of cells: (r, c), (r, c+1), (r+1, c+1) and (r, c), (r+1, c+1),
/// (r+1, c).
pub(crate) fn tile_indices() -> Vec<u16> {
    let side = TILE as u16 + 1;
    let cells = (0..TILE as u16).flat_map(|r| (0..TILE as u16).map(move |c| r * side + c));
    cells.flat_map(|nw| [nw, nw + 1, nw + side + 1, nw, nw + side + 1, nw + side]).collect()
}

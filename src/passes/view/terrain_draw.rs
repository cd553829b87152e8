/// Cells per side of a tile of the mesh; one instance draws a tile.
pub(crate) const TILE: u32 = 16;

/// Vertices of a tile's triangles, row after row of cells: (r, c), (r, c+1), (r+1, c+1) and (r, c), (r+1, c+1),
/// (r+1, c).
pub(crate) fn tile_indices() -> Vec<u16> {
    let side = TILE as u16 + 1;
    let cells = (0..TILE as u16).flat_map(|r| (0..TILE as u16).map(move |c| r * side + c));
    cells.flat_map(|nw| [nw, nw + 1, nw + side + 1, nw, nw + side + 1, nw + side]).collect()
}

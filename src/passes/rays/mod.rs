//! Images of the surface: the ground, and what rays read, which are cells and the maximum height of blocks of cells. Bounces by
//! brute force, sphere lights, facet masks and the path tracer trace rays. Other bounces read the ground alone.

pub(crate) mod blocks;
/// For sphere lights and `reference`: the highest of each 4 × 4, 16 × 16, … cells.
pub(crate) mod height_bounds;
/// For bounces, sphere lights and `reference`: height and slopes of each grid point, and cells as rays read them.
pub(crate) mod height_cells;

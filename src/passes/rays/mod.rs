//! What rays over the surface read: cells, and the maximum height of blocks of cells. Bounces by brute force, sphere lights,
//! facet masks and the path tracer use it. And the ground, which other bounces read, too.

pub(crate) mod blocks;
/// For sphere lights and `reference`: the highest of each 4 × 4, 16 × 16, … cells.
pub(crate) mod height_bounds;
/// For bounces, sphere lights and `reference`: height and slopes of each grid point, and cells as rays read them.
pub(crate) mod height_cells;

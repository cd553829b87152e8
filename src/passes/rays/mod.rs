//! What rays over the surface read: cells, and the maximum height of blocks of cells.
//! Bounces by brute force, sphere lights, facet masks and the path tracer use it.

pub(crate) mod blocks;
pub(crate) mod height_bounds;
pub(crate) mod height_cells;

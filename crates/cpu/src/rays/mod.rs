//! CPU references of the passes that prepare the surface for rays: cell corners, and the
//! hierarchy of block maxima with which rays skip.

pub mod height_bounds;
pub mod height_cells;

pub(crate) mod blocks;
pub(crate) mod height_bounds;
pub(crate) mod height_cells;

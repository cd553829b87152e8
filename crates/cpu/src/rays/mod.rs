pub mod height_bounds;
pub mod height_cells;

//! The maximum of each block of cells that rays may skip.

/// Highest corner of the cells of each block of 4^level by 4^level, row-major: `cells` are the first `cells_x` of
/// each of the first `cells_y` rows of `cols`.
pub fn height_bounds(
    cells: &[[f32; 4]],
    cols: usize,
    [cells_x, cells_y]: [usize; 2],
    level: u32,
) -> Vec<f32> {
    let side = 4_usize.pow(level);
    let (across, down) = (cells_x.div_ceil(side), cells_y.div_ceil(side));
    let mut highest = vec![f32::NEG_INFINITY; across * down];
    for r in 0..cells_y {
        for c in 0..cells_x {
            let of_cell = cells[r * cols + c].into_iter().fold(f32::NEG_INFINITY, f32::max);
            let block = &mut highest[r / side * across + c / side];
            *block = block.max(of_cell);
        }
    }
    highest
}

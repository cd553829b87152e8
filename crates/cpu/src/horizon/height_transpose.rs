//! The heights in the layout of sweeps, one copy per march axis, lanes contiguous.

/// `heights_by_col`: for marches along columns, `[col][row]`.
pub fn heights_by_col(heights: &[f32], cols: usize, rows: usize) -> Vec<f32> {
    (0..cols * rows).map(|i| heights[(i % rows) * cols + i / rows]).collect()
}

/// `heights_by_row`: for marches along rows, `[row][col]`, as the field itself.
pub fn heights_by_row(heights: &[f32]) -> Vec<f32> {
    heights.to_vec()
}

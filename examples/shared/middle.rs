//! A part of a field that is small enough for the truth.

use ridgelight::Result;
use ridgelight::scene::HeightField;

/// The middle of a field, at most `side`² samples; voids are ground.
pub fn middle(field: &HeightField, side: usize) -> Result<HeightField> {
    let [rows, cols] = [field.rows(), field.cols()].map(|n| n.min(side));
    let first = [(field.rows() - rows) / 2, (field.cols() - cols) / 2];
    let at = |i: usize| (first[0] + i / cols) * field.cols() + first[1] + i % cols;
    let heights: Vec<f64> = (0..rows * cols).map(|i| f64::from(field.heights_m()[at(i)])).collect();
    HeightField::new(rows, cols, &heights, field.cell_m(), None)
}

//! CPU references, the f64 oracle and quadrature, and bakes, against closed forms and each other: a module is a room.

mod bake;
mod bounce;
mod direct;
mod edit {
    mod resweep;
}
#[path = "../common/brute_force_paths.rs"]
mod brute_force_paths;
mod horizon;
#[path = "../common/reference_page.rs"]
mod reference_page;
#[path = "../common/scenes.rs"]
mod scenes;
#[path = "../common/v_grooves.rs"]
mod v_grooves;

use ridgelight::scene::{Border, HeightField};

const BORDERS: [Border; 3] = [Border::Plane, Border::Open, Border::Periodic];

/// A field from a function of (row, column).
fn field(
    rows: usize,
    cols: usize,
    cell_m: [f64; 2],
    h: impl Fn(usize, usize) -> f64,
) -> HeightField {
    let heights: Vec<f64> = (0..rows * cols).map(|i| h(i / cols, i % cols)).collect();
    HeightField::new(rows, cols, &heights, cell_m, None).unwrap()
}

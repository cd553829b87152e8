//! Fields and scenes of formulas.

use ridgelight::scene::{Albedo, Border, HeightField, Lights, Scene, Surface};

/// A field from a function of (row, column).
pub fn field(
    rows: usize,
    cols: usize,
    cell_m: [f64; 2],
    height: impl Fn(usize, usize) -> f64,
) -> HeightField {
    let heights: Vec<f64> = (0..rows * cols).map(|i| height(i / cols, i % cols)).collect();
    HeightField::new(rows, cols, &heights, cell_m, None).expect("a field")
}

/// Under a sky of radiance 1, with one albedo.
pub fn under_sky(field: HeightField, border: Border, albedo: f32) -> Scene {
    Scene {
        field,
        surface: Surface { border, albedo: Albedo::Constant([albedo; 3]), specular: None },
        lights: Lights { sky: Some([1.0; 3]), ..Lights::default() },
    }
}

//! What the references of a preview's passes share: the coarse grid's light, slopes, the sun.

use ridgelight::scene::{HeightField, Sun};

/// The light of a coarse grid, R, G, B of each grid point: all of it, the sun's, and the albedo.
pub struct Coarse<'a> {
    /// The coarse heights; its cells are whole numbers of fine ones.
    pub field: &'a HeightField,
    /// All light.
    pub radiance: &'a [[f32; 3]],
    /// Of the first sun with irradiance, and that sun.
    pub sun: Option<(&'a [[f32; 3]], &'a Sun)>,
    /// Its albedo.
    pub albedo: Colours<'a>,
}

/// Albedo of a grid.
#[derive(Clone, Copy)]
pub enum Colours<'a> {
    /// The same everywhere.
    Constant([f32; 3]),
    /// One per grid point.
    Map(&'a [[f32; 3]]),
}

impl Colours<'_> {
    pub(super) fn at(&self, i: usize, c: usize) -> f64 {
        f64::from(match self {
            Self::Constant(colour) => colour[c],
            Self::Map(all) => all[i][c],
        })
    }
}

impl Coarse<'_> {
    /// The direction to its sun; up where there is none.
    pub(super) fn towards(&self) -> [f64; 3] {
        self.sun.map_or([0.0, 0.0, 1.0], |(_, sun)| direction(sun))
    }

    /// Radiance of a white texel that faces the sun.
    pub(super) fn most(&self) -> [f64; 3] {
        let most = self.sun.map_or([0.0; 3], |(_, sun)| sun.irradiance.map(f64::from));
        most.map(|e| e / std::f64::consts::PI)
    }
}

/// Upward normal by central differences, one-sided at the edge.
pub fn normal(field: &HeightField, i: usize) -> [f64; 3] {
    let (rows, cols, [cell_x, cell_y]) = (field.rows(), field.cols(), field.cell_m());
    let (row, col) = (i / cols, i % cols);
    let at = |row: usize, col: usize| f64::from(field.heights_m()[row * cols + col]);
    let [west, east] = [col.saturating_sub(1), (col + 1).min(cols - 1)];
    let [north, south] = [row.saturating_sub(1), (row + 1).min(rows - 1)];
    let x = (at(row, east) - at(row, west)) / ((east - west).max(1) as f64 * cell_x);
    let y = (at(south, col) - at(north, col)) / ((south - north).max(1) as f64 * cell_y);
    let length = (x * x + y * y + 1.0).sqrt();
    [-x / length, y / length, 1.0 / length]
}

/// Direction to a sun: east, north, up.
pub fn direction(sun: &Sun) -> [f64; 3] {
    let across = sun.elevation_rad.cos();
    [across * sun.azimuth_rad.cos(), across * sun.azimuth_rad.sin(), sun.elevation_rad.sin()]
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

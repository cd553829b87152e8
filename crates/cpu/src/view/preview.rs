//! The light of a coarse grid on the slopes of a finer one (`preview_gather`, `preview_shade`).

use ridgelight::scene::{HeightField, Sun};

/// As in the shader: the least cosine to the sun to divide by.
const GRAZING: f64 = 1e-3;
/// As the shader's: albedo below which light is not divided by it.
const DARK: f64 = 1e-3;

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
    fn at(&self, i: usize, c: usize) -> f64 {
        f64::from(match self {
            Self::Constant(colour) => colour[c],
            Self::Map(all) => all[i][c],
        })
    }
}

/// Exit radiance of the fine grid.
pub fn preview(fine: &HeightField, albedo: Colours<'_>, coarse: &Coarse<'_>) -> Vec<[f64; 3]> {
    let towards = coarse.sun.map_or([0.0, 0.0, 1.0], |(_, sun)| direction(sun));
    let most = coarse.sun.map_or([0.0; 3], |(_, sun)| sun.irradiance.map(f64::from));
    let most = most.map(|e| e / std::f64::consts::PI);
    let gathered: Vec<[f64; 4]> = (0..coarse.radiance.len())
        .map(|i| {
            let normal = normal(coarse.field, i);
            let facing = dot(normal, towards).max(GRAZING);
            let of = |c: usize| {
                let sun = coarse.sun.map_or(0.0, |(light, _)| f64::from(light[i][c]));
                let albedo = coarse.albedo.at(i, c).max(DARK);
                let lit = albedo * most[c] * facing;
                let share = if lit > 0.0 { sun / lit } else { 0.0 };
                let sky = (f64::from(coarse.radiance[i][c]) - sun) / (albedo * (1.0 + normal[2]));
                [sky, share]
            };
            let [r, g, b] = [0, 1, 2].map(of);
            [r[0], g[0], b[0], r[1].max(g[1]).max(b[1]).clamp(0.0, 1.0)]
        })
        .collect();
    let ratio = fine.cell_m()[0] / coarse.field.cell_m()[0];
    (0..fine.rows() * fine.cols())
        .map(|i| {
            let light = between(&gathered, coarse.field, fine, (i, ratio));
            let normal = normal(fine, i);
            let facing = dot(normal, towards).max(0.0);
            std::array::from_fn(|c| {
                let all = light[c] * (1.0 + normal[2]) + light[3] * most[c] * facing;
                all * albedo.at(i, c)
            })
        })
        .collect()
}

/// Bilinear at a fine grid point's centre.
fn between(
    gathered: &[[f64; 4]],
    coarse: &HeightField,
    fine: &HeightField,
    (i, ratio): (usize, f64),
) -> [f64; 4] {
    let along = |at: usize, count: usize| {
        let from = ((at as f64 + 0.5) * ratio - 0.5).clamp(0.0, (count - 1) as f64);
        let first = from.floor() as usize;
        (first, (first + 1).min(count - 1), from - from.floor())
    };
    let (west, east, x) = along(i % fine.cols(), coarse.cols());
    let (north, south, y) = along(i / fine.cols(), coarse.rows());
    let at = |row: usize, col: usize| gathered[row * coarse.cols() + col];
    let corners = [at(north, west), at(north, east), at(south, west), at(south, east)];
    let weights = [(1.0 - x) * (1.0 - y), x * (1.0 - y), (1.0 - x) * y, x * y];
    std::array::from_fn(|k| corners.iter().zip(weights).map(|(v, w)| v[k] * w).sum())
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

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On one grid, where the sun reaches all of it, the light comes back as it was.
    #[test]
    fn one_grid_gives_its_light_back() {
        let heights: Vec<f64> = (0..30).map(|i| 0.1 * f64::from(i * i % 7)).collect();
        let field = HeightField::new(5, 6, &heights, [1.0, 2.0], None).unwrap();
        let sun = Sun {
            azimuth_rad: 0.7,
            elevation_rad: 1.0,
            diameter_rad: 0.0,
            irradiance: [3.0, 2.0, 1.0],
        };
        let lit = |i: usize| dot(normal(&field, i), direction(&sun)) / std::f64::consts::PI;
        let of_sun: Vec<[f32; 3]> =
            (0..30).map(|i| sun.irradiance.map(|e| (f64::from(e) * lit(i)) as f32)).collect();
        let radiance: Vec<[f32; 3]> = of_sun.iter().map(|s| s.map(|v| v + 0.25)).collect();
        let white = Colours::Constant([1.0; 3]);
        let sun = Some((of_sun.as_slice(), &sun));
        let coarse = Coarse { field: &field, radiance: &radiance, sun, albedo: white };
        for (found, want) in preview(&field, white, &coarse).iter().zip(&radiance) {
            for c in 0..3 {
                assert!((found[c] - f64::from(want[c])).abs() < 4.0 * f64::from(f32::EPSILON));
            }
        }
    }
}

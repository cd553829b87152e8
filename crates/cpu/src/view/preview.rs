//! The light of coarse grids on the slopes of a finer one (`preview_gather`, `preview_shade`).

use ridgelight::scene::{Border, HeightField, Sun, normal};

/// Albedo below which light is not divided by it, as in the shader.
const DARK: f64 = 1e-3;

/// How unoccluded light depends on the normal: `most` times a constant plus its product with a vector, and `least` or more.
#[derive(Clone, Copy)]
pub struct Slope {
    /// East, north, up.
    pub vector: [f64; 3],
    /// The constant.
    pub constant: f64,
    /// R, G, B.
    pub most: [f64; 3],
    /// The least value of the sum.
    pub least: f64,
    /// The largest share of that light.
    pub ceiling: f64,
}

impl Slope {
    /// A sun's light of a white texel: its irradiance times the cosine, over π.
    pub fn of_sun(sun: &Sun) -> Self {
        let across = sun.elevation_rad.cos();
        let [x, y] = [sun.azimuth_rad.cos(), sun.azimuth_rad.sin()].map(|v| across * v);
        let vector = [x, y, sun.elevation_rad.sin()];
        let most = sun.irradiance.map(|e| f64::from(e) / std::f64::consts::PI);
        Self { vector, constant: 0.0, most, least: 1e-3, ceiling: 1.0 }
    }

    /// A uniform sky: 1 + the cosine of the slope.
    pub fn of_sky() -> Self {
        let (vector, ceiling) = ([0.0, 0.0, 1.0], f64::from(f32::MAX));
        Self { vector, constant: 1.0, most: [1.0; 3], least: 0.05, ceiling }
    }

    fn at(&self, normal: [f64; 3]) -> f64 {
        self.constant + (0..3).map(|i| self.vector[i] * normal[i]).sum::<f64>()
    }
}

/// The light of a coarse grid, R, G, B of each grid point.
pub struct Coarse<'a> {
    /// The coarse heights.
    pub field: &'a HeightField,
    /// All light.
    pub radiance: &'a [[f32; 3]],
    /// The sun's, if it is not part of this one.
    pub without: Option<&'a [[f32; 3]]>,
    /// Its albedo.
    pub albedo: Colours<'a>,
    /// What it is divided by.
    pub slope: Slope,
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

impl Coarse<'_> {
    /// Its light without its slopes and albedo.
    fn gathered(&self) -> Vec<[f64; 3]> {
        let Slope { most, least, ceiling, .. } = self.slope;
        let cols = self.field.cols();
        let share = |(i, all): (usize, &[f32; 3])| {
            let normal = normal(self.field, Border::Plane, i / cols, i % cols).to_array();
            let facing = self.slope.at(normal).max(least);
            std::array::from_fn(|c| {
                let sun = self.without.map_or(0.0, |light| f64::from(light[i][c]));
                let lit = self.albedo.at(i, c).max(DARK) * most[c] * facing;
                let light = f64::from(all[c]) - sun;
                if lit > 0.0 { (light / lit).clamp(0.0, ceiling) } else { 0.0 }
            })
        };
        self.radiance.iter().enumerate().map(share).collect()
    }
}

/// Exit radiance of the fine grid, which has these mean normals.
pub fn preview(
    (fine, normals): (&HeightField, &[[f64; 3]]),
    albedo: Colours<'_>,
    sky: &Coarse<'_>,
    sun: Option<&Coarse<'_>>,
) -> Vec<[f64; 3]> {
    let lights: Vec<(&Coarse<'_>, Vec<[f64; 3]>, f64)> = std::iter::once((sky, sky.slope.least))
        .chain(sun.map(|sun| (sun, 0.0)))
        .map(|(coarse, least)| (coarse, coarse.gathered(), least))
        .collect();
    (0..fine.rows() * fine.cols())
        .map(|i| {
            let of = |(coarse, gathered, least): &(&Coarse<'_>, Vec<[f64; 3]>, f64)| {
                let share = between(gathered, coarse.field, fine, i);
                let facing = coarse.slope.at(normals[i]).max(*least);
                [0, 1, 2].map(|c| share[c] * coarse.slope.most[c] * facing)
            };
            let all: Vec<[f64; 3]> = lights.iter().map(of).collect();
            std::array::from_fn(|c| all.iter().map(|light| light[c]).sum::<f64>() * albedo.at(i, c))
        })
        .collect()
}

/// Bilinear at a fine grid point's centre.
fn between(gathered: &[[f64; 3]], coarse: &HeightField, fine: &HeightField, i: usize) -> [f64; 3] {
    let ratio = fine.cell_m()[0] / coarse.cell_m()[0];
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
        let slope = Slope::of_sun(&sun);
        let normals: Vec<[f64; 3]> =
            (0..30).map(|i| normal(&field, Border::Plane, i / 6, i % 6).to_array()).collect();
        let of_sun: Vec<[f32; 3]> = normals
            .iter()
            .map(|n| slope.most.map(|most| (most * slope.at(*n)) as f32))
            .collect();
        let radiance: Vec<[f32; 3]> = of_sun.iter().map(|s| s.map(|v| v + 0.25)).collect();
        let albedo = Colours::Constant([1.0; 3]);
        let of = |radiance, without, slope| Coarse { field: &field, radiance, without, albedo, slope };
        let sky = of(&radiance, Some(of_sun.as_slice()), Slope::of_sky());
        let sun = of(&of_sun, None, slope);
        for (found, want) in preview((&field, &normals), albedo, &sky, Some(&sun)).iter().zip(&radiance) {
            for c in 0..3 {
                assert!((found[c] - f64::from(want[c])).abs() < 4.0 * f64::from(f32::EPSILON));
            }
        }
    }
}

//! The slopes of a fine grid, lit by the light of a coarse grid, gathered without slopes, and by the sun with its shadow heights.

use ridgelight::scene::{HeightField, Sun};

use super::preview::{Coarse, Colours, Unoccluded};
use super::preview_gather::preview_gather;
use super::preview_shadow::preview_shadow;
use crate::shared::sweep::March;
use ridgelight::plan::azimuths::CELL;

/// Least height over which a texel goes from dark to lit, metres, as in the shader.
const LEAST_EDGE_M: f64 = 1e-6;

/// A sun over the fine grid.
#[derive(Clone, Copy)]
pub struct FineSun<'a> {
    /// The sun.
    pub sun: &'a Sun,
    /// The fine grid in its azimuth.
    pub march: &'a March<'a>,
    /// Slopes of rays to its lower and upper edge.
    pub edges: [f64; 2],
}

/// Exit radiance of the fine grid, which has these mean normals.
pub fn preview_shade(
    (fine, normals): (&HeightField, &[[f64; 3]]),
    albedo: Colours<'_>,
    sky: &Coarse<'_>,
    sun: Option<&FineSun<'_>>,
) -> Vec<[f64; 3]> {
    let gathered = preview_gather(sky);
    let shares = sun.map(|sun| sun_shares((fine, normals), sun));
    let of_sun = sun.map(|sun| Unoccluded::of_sun(sun.sun));
    (0..fine.rows() * fine.cols())
        .map(|i| {
            let share = between(&gathered, sky.field, fine, i);
            let facing = sky.unoccluded.at(normals[i]).max(sky.unoccluded.least);
            let mut light = [0, 1, 2].map(|c| share[c] * sky.unoccluded.most[c] * facing);
            if let (Some(shares), Some(of_sun)) = (&shares, &of_sun) {
                let facing = of_sun.at(normals[i]).max(0.0);
                (0..3).for_each(|c| light[c] += of_sun.most[c] * facing * shares[i][0]);
            }
            std::array::from_fn(|c| light[c] * albedo.at(i, c))
        })
        .collect()
}

/// The visible share of the sun at each texel, and the height over which a texel goes from dark to lit, metres.
///
/// The share is where the texel's height lies between the height below which none of the sun is visible and that from which all
/// of it is. The slope of the texel's ground towards the sun, relative to the ray, moves the two apart.
pub fn sun_shares(
    (fine, normals): (&HeightField, &[[f64; 3]]),
    FineSun { sun, march, edges }: &FineSun<'_>,
) -> Vec<[f64; 2]> {
    let step_m = f64::from(march.azimuth.step_m);
    let heights = preview_shadow(march, edges.map(|edge| edge * step_m));
    let towards = [sun.azimuth_rad.cos(), sun.azimuth_rad.sin()];
    let width_m = (towards[0] * fine.cell_m()[0]).hypot(towards[1] * fine.cell_m()[1]);
    (0..fine.rows() * fine.cols())
        .map(|i| {
            let (lane, step) =
                march.of_grid_point((i % fine.cols()) as i32, (i / fine.cols()) as i32);
            let part = f64::from((-step * march.azimuth.shear) & (CELL - 1)) / f64::from(CELL);
            let [col, row] = march.grid_point(lane + 1, step).map(|n| n as usize);
            let other = row * fine.cols() + col;
            let [lit, dark] =
                [0, 1].map(|k| heights[i][k] + (heights[other][k] - heights[i][k]) * part);
            let slope = |k: usize| -normals[i][k] / normals[i][2].max(1e-3);
            let along = slope(0) * towards[0] + slope(1) * towards[1];
            let spread = 0.5 * width_m * (along - edges[0]).abs();
            let over = f64::from(fine.heights_m()[i]) - dark + spread;
            let edge_m = (lit - dark + 2.0 * spread).max(LEAST_EDGE_M);
            let share = (over / edge_m).clamp(0.0, 1.0);
            [share * share * (3.0 - 2.0 * share), edge_m]
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
    use crate::shared::sweep::Heights;
    use ridgelight::plan::azimuths::across_sun;
    use ridgelight::scene::{Border, normal};

    /// On one grid, where the sun reaches all of it, the light comes back as it was.
    #[test]
    fn one_grid_gives_its_light_back() {
        let heights: Vec<f64> = (0..30).map(|i| 0.1 * f64::from(i % 6)).collect();
        let field = HeightField::new(5, 6, &heights, [1.0, 2.0], None).unwrap();
        let sun = Sun {
            azimuth_rad: 0.7,
            elevation_rad: 1.0,
            diameter_rad: 0.0,
            irradiance: [3.0, 2.0, 1.0],
        };
        let unoccluded = Unoccluded::of_sun(&sun);
        let normals: Vec<[f64; 3]> =
            (0..30).map(|i| normal(&field, Border::Plane, i / 6, i % 6).to_array()).collect();
        let of_sun: Vec<[f32; 3]> = normals
            .iter()
            .map(|n| unoccluded.most.map(|most| (most * unoccluded.at(*n)) as f32))
            .collect();
        let radiance: Vec<[f32; 3]> = of_sun.iter().map(|s| s.map(|v| v + 0.25)).collect();
        let albedo = Colours::Constant([1.0; 3]);
        let sky = Coarse {
            field: &field,
            radiance: &radiance,
            without: Some(&of_sun),
            albedo,
            unoccluded: Unoccluded::of_sky(),
        };
        let azimuth = across_sun(&sun, 1, field.cell_m())[0];
        let march = March::new(Heights::of(&field, Border::Plane), &azimuth);
        let edges = [sun.elevation_rad.tan(); 2];
        let sun = FineSun { sun: &sun, march: &march, edges };
        for (found, want) in
            preview_shade((&field, &normals), albedo, &sky, Some(&sun)).iter().zip(&radiance)
        {
            for c in 0..3 {
                assert!((found[c] - f64::from(want[c])).abs() < 4.0 * f64::from(f32::EPSILON));
            }
        }
    }
}

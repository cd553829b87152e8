//! The light of coarse grids, gathered without slopes, on the slopes of a finer one.

use ridgelight::scene::HeightField;

use super::preview::{Coarse, Colours};
use super::preview_gather::preview_gather;

/// Exit radiance of the fine grid, which has these mean normals.
pub fn preview_shade(
    (fine, normals): (&HeightField, &[[f64; 3]]),
    albedo: Colours<'_>,
    sky: &Coarse<'_>,
    sun: Option<&Coarse<'_>>,
) -> Vec<[f64; 3]> {
    let lights: Vec<(&Coarse<'_>, Vec<[f64; 3]>, f64)> =
        std::iter::once((sky, sky.unoccluded.least))
            .chain(sun.map(|sun| (sun, 0.0)))
            .map(|(coarse, least)| (coarse, preview_gather(coarse), least))
            .collect();
    (0..fine.rows() * fine.cols())
        .map(|i| {
            let of = |(coarse, gathered, least): &(&Coarse<'_>, Vec<[f64; 3]>, f64)| {
                let share = between(gathered, coarse.field, fine, i);
                let facing = coarse.unoccluded.at(normals[i]).max(*least);
                [0, 1, 2].map(|c| share[c] * coarse.unoccluded.most[c] * facing)
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
    use crate::preview::Unoccluded;
    use ridgelight::scene::{Border, Sun, normal};

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
        let unoccluded = Unoccluded::of_sun(&sun);
        let normals: Vec<[f64; 3]> =
            (0..30).map(|i| normal(&field, Border::Plane, i / 6, i % 6).to_array()).collect();
        let of_sun: Vec<[f32; 3]> = normals
            .iter()
            .map(|n| unoccluded.most.map(|most| (most * unoccluded.at(*n)) as f32))
            .collect();
        let radiance: Vec<[f32; 3]> = of_sun.iter().map(|s| s.map(|v| v + 0.25)).collect();
        let albedo = Colours::Constant([1.0; 3]);
        let of = |radiance, without, unoccluded| Coarse {
            field: &field,
            radiance,
            without,
            albedo,
            unoccluded,
        };
        let sky = of(&radiance, Some(of_sun.as_slice()), Unoccluded::of_sky());
        let sun = of(&of_sun, None, unoccluded);
        for (found, want) in
            preview_shade((&field, &normals), albedo, &sky, Some(&sun)).iter().zip(&radiance)
        {
            for c in 0..3 {
                assert!((found[c] - f64::from(want[c])).abs() < 4.0 * f64::from(f32::EPSILON));
            }
        }
    }
}

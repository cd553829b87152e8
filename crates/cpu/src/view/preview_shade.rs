//! The light of a coarse grid, gathered without slopes, on the slopes of a finer one.

use ridgelight::scene::HeightField;

use super::preview::{Coarse, Colours, dot, normal};

/// Exit radiance of the fine grid, from the `gathered` light of the coarse one.
pub fn preview_shade(
    fine: &HeightField,
    albedo: Colours<'_>,
    coarse: &Coarse<'_>,
    gathered: &[[f64; 4]],
) -> Vec<[f64; 3]> {
    let (towards, most) = (coarse.towards(), coarse.most());
    let ratio = fine.cell_m()[0] / coarse.field.cell_m()[0];
    (0..fine.rows() * fine.cols())
        .map(|i| {
            let light = between(gathered, coarse.field, fine, (i, ratio));
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

#[cfg(test)]
mod tests {
    use super::super::preview::direction;
    use super::super::preview_gather::preview_gather;
    use super::*;
    use ridgelight::scene::Sun;

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
        let gathered = preview_gather(&coarse);
        let found = preview_shade(&field, white, &coarse, &gathered);
        for (found, want) in found.iter().zip(&radiance) {
            for c in 0..3 {
                assert!((found[c] - f64::from(want[c])).abs() < 4.0 * f64::from(f32::EPSILON));
            }
        }
    }
}

//! What the passes of a preview share: grids, and how light depends on their slopes.

use crate::scene::{Albedo, Border, Lights, Sun};

/// Least values of a slope's function that light is divided by: of the sun's cosine, and of the sky's, whose linear
/// function of the normal is no longer near the right one where it is small.
const GRAZING: f32 = 1e-3;
const LEAST_SKY: f32 = 0.05;

/// A grid: columns and rows, and the sides of a cell.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Grid {
    pub size: [u32; 2],
    pub cell_m: [f64; 2],
}

impl Grid {
    pub(super) fn texels(self) -> u64 {
        u64::from(self.size[0]) * u64::from(self.size[1])
    }
}

/// How unoccluded light depends on the normal n: `most` times the fourth of `by_normal` plus n · its first three.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unoccluded {
    pub(super) by_normal: [f32; 4],
    pub(super) most: [f32; 3],
    pub(super) least: f32,
    /// The largest share of that light.
    pub(super) ceiling: f32,
}

impl Unoccluded {
    /// Of a sun: the cosine to it.
    pub(crate) fn of_sun(sun: &Sun) -> Self {
        let sun = sun.clamped();
        let across = sun.elevation_rad.cos();
        let [x, y] = [sun.azimuth_rad.cos(), sun.azimuth_rad.sin()].map(|v| (across * v) as f32);
        let most = sun.irradiance.map(|e| e / std::f32::consts::PI);
        let by_normal = [x, y, sun.elevation_rad.sin() as f32, 0.0];
        Self { by_normal, most, least: GRAZING, ceiling: 1.0 }
    }

    /// Of a sky and an environment: the irradiance's spherical harmonics up to order 1 (Ramamoorthi and Hanrahan 2001,
    /// equation 8), ¼ ∫ L dω + ½ n · ∫ L ω dω, over the first. It is 1 + the cosine of the slope for a uniform sky. The mean
    /// of the channels stands for each.
    pub(crate) fn of_sky(lights: &Lights, border: Border) -> Self {
        let [mut all, mut towards] = [0.0, 0.0].map(|v| [v; 3]);
        let mean = |c: &[f32; 3]| c.iter().map(|v| f64::from(*v)).sum::<f64>() / 3.0;
        let mut add = |radiance: f64, direction: [f64; 3]| {
            all[0] += radiance;
            (0..3).for_each(|i| towards[i] += radiance * direction[i]);
        };
        if let Some(sky) = &lights.sky {
            // Of the hemisphere: 2π, and π upwards.
            let radiance = mean(sky) * std::f64::consts::TAU;
            add(radiance, [0.0, 0.0, 0.5]);
        }
        if let Some(environment) = &lights.environment {
            let [cols, rows] = [environment.width(), environment.height()];
            let [by_col, by_row] =
                [std::f64::consts::TAU / cols as f64, std::f64::consts::PI / rows as f64];
            let lit = environment.rows_above_ground(border) * cols;
            for (i, texel) in environment.texels()[..lit].iter().enumerate() {
                let azimuth = std::f64::consts::PI - by_col * ((i % cols) as f64 + 0.5)
                    + environment.rotation_rad();
                let zenith = by_row * ((i / cols) as f64 + 0.5);
                let (across, up) = zenith.sin_cos();
                let direction = [across * azimuth.cos(), across * azimuth.sin(), up];
                add(mean(texel) * across * by_col * by_row, direction);
            }
        }
        let of_normal =
            if all[0] > 0.0 { towards.map(|t| 2.0 * t / all[0]) } else { [0.0, 0.0, 1.0] };
        let [x, y, z] = of_normal.map(|v| v as f32);
        Self { by_normal: [x, y, z, 1.0], most: [1.0; 3], least: LEAST_SKY, ceiling: f32::MAX }
    }
}

/// A constant albedo; 1 where it is a map.
pub(super) fn colour(albedo: &Albedo, least: f32) -> [f32; 4] {
    match albedo {
        Albedo::Constant([r, g, b]) => [*r, *g, *b, least],
        Albedo::Map(_) => [1.0, 1.0, 1.0, least],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Environment;

    fn near(found: [f32; 4], want: [f64; 4], error: f64) -> bool {
        found.iter().zip(want).all(|(f, w)| (f64::from(*f) - w).abs() <= error)
    }

    /// A uniform sky gives 1 + n.z, also as an environment: the middles of 64 rows above the ground integrate the sine and
    /// the cosine of the zenith angle to (π / 128)² / 6 of them.
    #[test]
    fn a_uniform_sky_is_that_of_its_hemisphere() {
        let environment = Environment::new(8, 128, vec![[2.0; 3]; 1024], 0.3).unwrap();
        let uniform = [0.0, 0.0, 1.0, 1.0];
        let sky = Lights { sky: Some([0.5; 3]), ..Lights::default() };
        let env = Lights { environment: Some(environment), ..Lights::default() };
        assert!(near(Unoccluded::of_sky(&sky, Border::Plane).by_normal, uniform, 1e-6));
        let error = (std::f64::consts::PI / 128.0).powi(2) / 3.0;
        assert!(near(Unoccluded::of_sky(&env, Border::Plane).by_normal, uniform, error));
        assert!(near(
            Unoccluded::of_sky(&Lights::default(), Border::Plane).by_normal,
            uniform,
            0.0
        ));
    }

    /// All light from one direction: twice that direction. Column 0 of 4 begins at the west and runs clockwise, so that its
    /// middle is the north-west, which a rotation by a quarter turns to the south-west.
    #[test]
    fn one_bright_texel_is_a_direction() {
        let mut texels = vec![[0.0; 3]; 16];
        texels[0] = [3.0, 0.0, 0.0];
        let quarter = std::f64::consts::FRAC_PI_2;
        let environment = Environment::new(4, 4, texels, quarter).unwrap();
        let lights = Lights { environment: Some(environment), ..Lights::default() };
        let (across, up) = (std::f64::consts::PI / 8.0).sin_cos();
        let flat = -2.0 * across * 0.5_f64.sqrt();
        let want = [flat, flat, 2.0 * up, 1.0];
        assert!(near(Unoccluded::of_sky(&lights, Border::Plane).by_normal, want, 1e-6));
    }
}

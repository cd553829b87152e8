//! Lights of the specular reflection: suns, and the sky of each direction.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use crate::scene::{Border, Directions, Environment, Scene, Sun};

/// Unit vector towards the centre of a sun.
pub(crate) fn towards(sun: &Sun) -> DVec3 {
    let (sin, cos) = sun.elevation_rad.sin_cos();
    DVec3::new(cos * sun.azimuth_rad.cos(), cos * sun.azimuth_rad.sin(), sin)
}

/// Two texels per sun: direction of its centre; irradiance.
pub(super) fn sun_texels(suns: &[Sun]) -> Vec<f32> {
    let texels = suns.iter().flat_map(|sun| {
        let (e, [r, g, b]) = (towards(sun), sun.irradiance);
        [e.x as f32, e.y as f32, e.z as f32, 0.0, r, g, b, 0.0]
    });
    texels.collect()
}

/// Radiance of sky and environment in each direction. For an environment, each texel adds to its nearest direction, so no
/// light is lost; texels above horizontal add to directions above it only. Texels below horizontal count under `open`
/// only, down to the lowest direction.
pub(crate) fn sky_of(scene: &Scene, directions: &Directions) -> Vec<[f64; 3]> {
    let vectors = directions.vectors();
    let uniform = scene.lights.sky.unwrap_or_default().map(f64::from);
    let is_open = scene.surface.border == Border::Open;
    let mut all: Vec<[f64; 3]> =
        vectors.iter().map(|v| if is_open || v.z > 0.0 { uniform } else { [0.0; 3] }).collect();
    let Some(environment) = &scene.lights.environment else { return all };
    let candidates: Vec<usize> =
        (0..vectors.len()).filter(|i| is_open || vectors[*i].z > 0.0).collect();
    let rows = environment.rows_above_ground(scene.surface.border);
    let [width, height] = [environment.width(), environment.height()];
    for row in 0..rows {
        let (sin, cos) = (PI * (row as f64 + 0.5) / height as f64).sin_cos();
        if cos < directions.lowest_z() {
            continue;
        }
        let solid = texel_sr(environment, row);
        for col in 0..width {
            let azimuth = PI - TAU * (col as f64 + 0.5) / width as f64 + environment.rotation_rad();
            let e = DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos);
            let along = |i: &&usize| vectors[**i].dot(e);
            let nearest = candidates.iter().max_by(|a, b| along(a).total_cmp(&along(b)));
            let Some(nearest) = nearest else { return all };
            let light = environment.texels()[row * width + col].map(f64::from);
            for (sum, light) in all[*nearest].iter_mut().zip(light) {
                *sum += light * solid / directions.share_sr();
            }
        }
    }
    all
}

fn texel_sr(environment: &Environment, row: usize) -> f64 {
    let edge = |row: usize| (PI * row as f64 / environment.height() as f64).cos();
    TAU / environment.width() as f64 * (edge(row) - edge(row + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{HeightField, Lights, Surface};

    /// An environment of 1 gives 2π above horizontal like the uniform sky, and 4π under `open`, for any number of directions,
    /// within one rounding of each texel and sum.
    #[test]
    fn no_light_of_an_environment_is_lost() {
        let field = HeightField::new(2, 2, &[0.0; 4], [1.0; 2], None).expect("a field");
        let total = |border: Border, count: usize, is_image: bool| -> f64 {
            let image = Environment::new(32, 16, vec![[1.0; 3]; 32 * 16], 0.3).expect("an image");
            let lights = match is_image {
                true => Lights { environment: Some(image), ..Lights::default() },
                false => Lights { sky: Some([1.0; 3]), ..Lights::default() },
            };
            let surface = Surface { border, ..Surface::default() };
            let scene = Scene { field: field.clone(), surface, lights };
            let directions = Directions::fibonacci(count, -1.0, 0).expect("directions");
            let all = sky_of(&scene, &directions);
            let below = directions.vectors().iter().zip(&all).filter(|(v, _)| v.z <= 0.0);
            let is_dark = below.map(|(_, sky)| sky[0]).sum::<f64>() == 0.0;
            assert_eq!(is_dark, border != Border::Open);
            all.iter().map(|sky| sky[0] * directions.share_sr()).sum()
        };
        for count in [4, 16, 64, 1024] {
            for (border, whole) in
                [(Border::Plane, TAU), (Border::Periodic, TAU), (Border::Open, 2.0 * TAU)]
            {
                for is_image in [false, true] {
                    let error = (total(border, count, is_image) - whole).abs();
                    let bound = f64::EPSILON * whole * (1024.0 + 512.0);
                    assert!(error <= bound, "{count} {border:?} {is_image}: {error:e} {bound:e}");
                }
            }
        }
    }
}

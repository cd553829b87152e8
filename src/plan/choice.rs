//! How paths choose directions of an environment, and the most that one of them can bring.

use std::f64::consts::PI;

use super::reference::seen_part;
use crate::scene::{Albedo, Border, Environment, KeyLight, Lobe, Scene, Sun};

/// How an environment's texels are chosen, in proportion to the light of all channels that they give:
/// rows of width + 1. First column: the share of the rows from the zenith down to this one; then the
/// share, in this row, of the texels up to each. Rows below horizontal count under `open` alone.
pub(super) fn environment_cdf(environment: &Environment, border: Border) -> Vec<f32> {
    let (width, height) = (environment.width(), environment.height());
    let seen = environment.rows_above_ground(border);
    let rows: Vec<Vec<f64>> = environment
        .texels()
        .chunks_exact(width)
        .map(|row| {
            let light = row.iter().map(|t| t.iter().map(|v| f64::from(*v)).sum());
            running_shares(light)
        })
        .collect();
    let of_row = |row: usize| -> f64 {
        let texels = &environment.texels()[row * width..(row + 1) * width];
        let sum: f64 = texels.iter().flatten().map(|v| f64::from(*v)).sum();
        let middle = PI * (row as f64 + 0.5) / height as f64;
        if row < seen { sum * middle.sin() } else { 0.0 }
    };
    let down = running_shares((0..height).map(of_row));
    let texels = down.iter().zip(&rows).flat_map(|(d, row)| std::iter::once(d).chain(row));
    texels.map(|v| *v as f32).collect()
}

/// Running sums over the whole sum; 0 where that is 0.
fn running_shares(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut sum = 0.0;
    let sums: Vec<f64> = values
        .map(|v| {
            sum += v;
            sum
        })
        .collect();
    sums.into_iter().map(|s| if sum > 0.0 { s / sum } else { 0.0 }).collect()
}

/// How densely the directions of each texel are chosen, 1/sr: the shares as they were rounded, over the
/// texel's solid angle (2π/width)(cos a - cos b), written without cancellation.
pub(super) fn choice_density(environment: &Environment, cdf: &[f32]) -> Vec<f64> {
    let (width, height) = (environment.width(), environment.height());
    let at = |row: usize, col: usize| f64::from(cdf[row * (width + 1) + col]);
    let half_row = 0.5 * PI / height as f64;
    let density = |i: usize| {
        let (row, col) = (i / width, i % width);
        let of_row = at(row, 0) - if row > 0 { at(row - 1, 0) } else { 0.0 };
        let of_texel = at(row, col + 1) - if col > 0 { at(row, col) } else { 0.0 };
        let middle = (2 * row + 1) as f64 * half_row;
        let solid = 4.0 * PI / width as f64 * middle.sin() * half_row.sin();
        of_row * of_texel / solid
    };
    (0..width * height).map(density).collect()
}

/// The most that one path of up to `bounces` can bring, R, G, B.
///
/// With f the most that a vertex scatters of what arrives, and R the most it reflects of an irradiance, a
/// vertex brings from a sun of irradiance E at most R·E, from a key light of radiance L and solid angle Ω at
/// most R·L·Ω, from a ball of radiance L at most 2π·R·L, and
/// from the environment, chosen with density p and weighed by the balance heuristic, at most f·L and
/// R·L/p; its scattered ray then passes balls on their inside, each at most once, and meets what is far, or the next vertex.
pub fn most_light(scene: &Scene, bounces: u32) -> [f64; 3] {
    let Scene { surface, lights, .. } = scene;
    let albedo = match &surface.albedo {
        Albedo::Constant(colour) => *colour,
        Albedo::Map(map) => {
            map.iter().fold([0.0; 3], |most, t| [0, 1, 2].map(|c| t[c].max(most[c])))
        }
    };
    let largest = surface.phong.as_ref().map(Lobe::largest);
    let lobe = largest.map_or([0.0; 2], |p| [p.scale, p.exponent].map(f64::from));
    let brightest = albedo.into_iter().fold(0.0_f32, f32::max);
    let shares = lights.environment.as_ref().map(|environment| {
        let cdf = environment_cdf(environment, surface.border);
        (environment, choice_density(environment, &cdf))
    });
    [0, 1, 2].map(|c| {
        // Radiance, and radiance over density.
        let mut environment = [0.0_f64; 2];
        let seen = |e: &Environment| e.rows_above_ground(surface.border) * e.width();
        let texels = shares.iter().flat_map(|(e, d)| e.texels().iter().zip(d).take(seen(e)));
        for (of, density) in texels {
            let of = f64::from(of[c]);
            let over = if of > 0.0 { of / density } else { 0.0 };
            environment = [environment[0].max(of), environment[1].max(over)];
        }
        let sky = lights.sky.map_or(0.0, |s| f64::from(s[c]));
        let suns: f64 = lights.suns.iter().map(|s| sun_facing(s, c)).sum();
        let keys: f64 = lights.keys.iter().map(|k| key_facing(k, surface.border, c)).sum();
        let balls: f64 = lights.spheres.iter().map(|s| f64::from(s.radiance[c])).sum();
        let diffuse = f64::from(albedo[c]);
        // Of what is scattered and reflected at most and chosen as densely: what a vertex brings wherever its scattered ray
        // ends, what that meets where it leaves the ground, and the share of what it meets on the ground.
        let vertex = |scattered: f64, reflected: f64, dense: f64| {
            let chosen = (scattered * environment[0]).min(reflected * environment[1]);
            let direct = reflected * (suns + keys + 2.0 * PI * balls) + chosen;
            let met = environment[0].min(dense * environment[1]);
            (direct + scattered * balls, scattered * (sky + met), scattered)
        };
        let peak = (lobe[1] + 1.0) / (2.0 * PI);
        let all = if surface.phong.is_some() { f64::from(brightest) + lobe[0] } else { diffuse };
        let dense = if surface.phong.is_some() { peak.max(1.0 / PI) } else { 1.0 / PI };
        let (always, met, scattered) = vertex(all, diffuse / PI + lobe[0] * peak, dense);
        (0..=bounces).fold(0.0, |later, _| always + met.max(scattered * later))
    })
}

/// Irradiance facing a sun, spread over all of its cone: see [`super::reference_inputs`].
fn sun_facing(sun: &Sun, channel: usize) -> f64 {
    2.0 / (1.0 + (0.5 * sun.diameter_rad).cos()) * f64::from(sun.irradiance[channel])
}

/// Radiance of a key light times its solid angle.
fn key_facing(key: &KeyLight, border: Border, channel: usize) -> f64 {
    let [top, bottom] = seen_part(key, border);
    key.width_rad * 2.0 * (bottom - top) * f64::from(key.radiance[channel])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{HeightField, Lights, Phong, SphereLight, Surface};

    /// Two vertices inside a ball of green 1, on ground of albedo (1, 0, 0) with a lobe of 1/2 and exponent 0: where the
    /// lobe alone sends a ray, at grazing, it scatters 1 + 1/2 of what arrives. Each ray sees the ball and the second also
    /// brings what the next vertex does: 3/2 (1 + 3/2) at least. Directly no vertex gets more than the lobe's
    /// 1/2 · 1/2π · 2π: in all 1/2 + 3/2, and 3/2 of as much once more.
    #[test]
    fn a_path_sees_the_ball_that_it_leaves_and_goes_on() {
        let ball =
            SphereLight { position_m: [1.0, 1.0, 0.0], radius_m: 9.0, radiance: [0.0, 1.0, 0.0] };
        let scene = Scene {
            field: HeightField::new(3, 3, &[0.0; 9], [1.0, 1.0], None).unwrap(),
            surface: Surface {
                albedo: Albedo::Constant([1.0, 0.0, 0.0]),
                phong: Some(Lobe::Constant(Phong { exponent: 0.0, scale: 0.5 })),
                ..Surface::default()
            },
            lights: Lights { spheres: vec![ball], ..Lights::default() },
        };
        let [red, green, blue] = most_light(&scene, 1);
        assert!(green >= 1.5 * (1.0 + 1.5), "{green}");
        assert!((green - 5.0).abs() < 1e-9, "{green}");
        assert_eq!([red, blue], [0.0; 2]);
    }
}

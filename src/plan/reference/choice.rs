//! How paths choose directions of an environment, and an upper bound on the light of one path.

use std::f64::consts::PI;

use crate::plan::reference::visible_part;
use crate::scene::{Albedo, Border, Environment, KeyLight, Scene, Specular, Sun};

/// Cumulative distribution of an environment's texels, in proportion to the light of all channels: rows of width + 1
/// values. First column: the share of the rows from the zenith to this one. Then the share, within the row, of the
/// texels up to each. Rows below horizontal count under `open` only.
pub(in crate::plan) fn environment_cdf(environment: &Environment, border: Border) -> Vec<f32> {
    let (width, height) = (environment.width(), environment.height());
    let lit_rows = environment.rows_above_ground(border);
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
        if row < lit_rows { sum * middle.sin() } else { 0.0 }
    };
    let down = running_shares((0..height).map(of_row));
    let texels = down.iter().zip(&rows).flat_map(|(d, row)| std::iter::once(d).chain(row));
    texels.map(|v| *v as f32).collect()
}

/// Running sums divided by the total; 0 if the total is 0.
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

/// Density of the chosen directions of each texel, 1/sr: the rounded shares over the texel's solid angle
/// (2π/width)(cos a - cos b), written without cancellation.
pub(in crate::plan) fn choice_density(environment: &Environment, cdf: &[f32]) -> Vec<f64> {
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

/// Upper bound on the light of one path of up to `bounces` bounces: R, G, B.
///
/// f is the largest share of arriving light that a vertex scatters, R the largest share of an irradiance that it reflects.
/// A vertex adds at most R·E for a sun of irradiance E, R·L·Ω for a key light of radiance L and solid angle Ω, 2π·R·L for
/// a sphere light of radiance L, and f·L and R·L/p for the environment, chosen with density p and weighted by the balance
/// heuristic. Its scattered ray then passes the inside of sphere lights, each at most once, and reaches the sky or the
/// next vertex.
pub fn max_path_light(scene: &Scene, bounces: u32) -> [f64; 3] {
    let Scene { surface, lights, .. } = scene;
    let albedo = match &surface.albedo {
        Albedo::Constant(colour) => *colour,
        Albedo::Map(map) => {
            map.iter().fold([0.0; 3], |most, t| [0, 1, 2].map(|c| t[c].max(most[c])))
        }
    };
    let largest = surface.specular.as_ref().map(Specular::largest);
    let [scale, exponent] = largest.map_or([0.0; 2], |p| [p.scale, p.exponent].map(f64::from));
    let brightest = albedo.into_iter().fold(0.0_f32, f32::max);
    let shares = lights.environment.as_ref().map(|environment| {
        let cdf = environment_cdf(environment, surface.border);
        (environment, choice_density(environment, &cdf))
    });
    [0, 1, 2].map(|c| {
        // Radiance, and radiance over density.
        let mut environment = [0.0_f64; 2];
        let lit_texels = |e: &Environment| e.rows_above_ground(surface.border) * e.width();
        let texels = shares.iter().flat_map(|(e, d)| e.texels().iter().zip(d).take(lit_texels(e)));
        for (of, density) in texels {
            let of = f64::from(of[c]);
            let over = if of > 0.0 { of / density } else { 0.0 };
            environment = [environment[0].max(of), environment[1].max(over)];
        }
        let sky = lights.sky.map_or(0.0, |s| f64::from(s[c]));
        let suns: f64 = lights.suns.iter().map(|s| sun_facing(s, c)).sum();
        let keys: f64 = lights.keys.iter().map(|k| key_facing(k, surface.border, c)).sum();
        let sphere_lights: f64 =
            lights.sphere_lights.iter().map(|s| f64::from(s.radiance[c])).sum();
        let diffuse = f64::from(albedo[c]);
        // From the largest scattered and reflected shares and the largest density: what a vertex adds wherever its scattered
        // ray ends; what that ray reaches when it leaves the ground; the scattered share.
        let vertex = |scattered: f64, reflected: f64, dense: f64| {
            let chosen = (scattered * environment[0]).min(reflected * environment[1]);
            let direct = reflected * (suns + keys + 2.0 * PI * sphere_lights) + chosen;
            let met = environment[0].min(dense * environment[1]);
            (direct + scattered * sphere_lights, scattered * (sky + met), scattered)
        };
        let peak = (exponent + 1.0) / (2.0 * PI);
        let all = if surface.specular.is_some() { f64::from(brightest) + scale } else { diffuse };
        let dense = if surface.specular.is_some() { peak.max(1.0 / PI) } else { 1.0 / PI };
        let (always, met, scattered) = vertex(all, diffuse / PI + scale * peak, dense);
        (0..=bounces).fold(0.0, |later, _| always + met.max(scattered * later))
    })
}

/// Irradiance facing a sun, spread over its whole cone: see [`crate::plan::reference_inputs`].
fn sun_facing(sun: &Sun, channel: usize) -> f64 {
    2.0 / (1.0 + (0.5 * sun.clamped().diameter_rad).cos()) * f64::from(sun.irradiance[channel])
}

/// Radiance of a key light times its solid angle.
fn key_facing(key: &KeyLight, border: Border, channel: usize) -> f64 {
    let key = &key.clamped();
    let [top, bottom] = visible_part(key, border);
    key.width_rad * 2.0 * (bottom - top) * f64::from(key.radiance[channel])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{HeightField, Lights, PhongSpecular, SphereLight, Surface};

    /// Two vertices inside a sphere light of green 1, on ground of albedo (1, 0, 0) with a specular scale of 1/2 and exponent
    /// 0. Where the lobe alone emits a ray, at grazing, it scatters 1 + 1/2 of the arriving light. Each ray reaches the
    /// sphere, and the second also adds the light of the next vertex: 3/2 (1 + 3/2) at least. Directly a vertex gets at most
    /// the lobe's 1/2 · 1/2π · 2π: in all 1/2 + 3/2, and 3/2 of the same once more.
    #[test]
    fn a_path_counts_the_sphere_light_around_each_vertex() {
        let sphere =
            SphereLight { position_m: [1.0, 1.0, 0.0], radius_m: 9.0, radiance: [0.0, 1.0, 0.0] };
        let scene = Scene {
            field: HeightField::new(3, 3, &[0.0; 9], [1.0, 1.0], None).unwrap(),
            surface: Surface {
                albedo: Albedo::Constant([1.0, 0.0, 0.0]),
                specular: Some(Specular::Constant(PhongSpecular { exponent: 0.0, scale: 0.5 })),
                ..Surface::default()
            },
            lights: Lights { sphere_lights: vec![sphere], ..Lights::default() },
        };
        let [red, green, blue] = max_path_light(&scene, 1);
        assert!(green >= 1.5 * (1.0 + 1.5), "{green}");
        assert!((green - 5.0).abs() < 1e-9, "{green}");
        assert_eq!([red, blue], [0.0; 2]);
    }
}

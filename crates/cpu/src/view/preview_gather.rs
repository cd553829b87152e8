//! The light of a coarse grid without its slopes.

use super::preview::{Coarse, dot, normal};

/// As in the shader: the least cosine to the sun to divide by.
const GRAZING: f64 = 1e-3;
/// As the shader's: albedo below which light is not divided by it.
const DARK: f64 = 1e-3;

/// Of each grid point: light but for the sun's, per albedo and share of the sky, R, G, B; the share of the sun.
pub fn preview_gather(coarse: &Coarse<'_>) -> Vec<[f64; 4]> {
    let (towards, most) = (coarse.towards(), coarse.most());
    (0..coarse.radiance.len())
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
        .collect()
}

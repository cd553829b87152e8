//! The light of a coarse grid without its slopes.

use ridgelight::scene::{Border, normal};

use super::preview::{Coarse, Unoccluded};

/// Albedo below which light is not divided by it, as in the shader.
const DARK: f64 = 1e-3;

/// A coarse grid's light without its slopes and albedo.
pub fn preview_gather(coarse: &Coarse<'_>) -> Vec<[f64; 3]> {
    let Unoccluded { most, least, ceiling, .. } = coarse.unoccluded;
    let cols = coarse.field.cols();
    let share = |(i, all): (usize, &[f32; 3])| {
        let normal = normal(coarse.field, Border::Plane, i / cols, i % cols).to_array();
        let facing = coarse.unoccluded.at(normal).max(least);
        std::array::from_fn(|c| {
            let sun = coarse.without.map_or(0.0, |light| f64::from(light[i][c]));
            let lit = coarse.albedo.at(i, c).max(DARK) * most[c] * facing;
            let light = f64::from(all[c]) - sun;
            if lit > 0.0 { (light / lit).clamp(0.0, ceiling) } else { 0.0 }
        })
    };
    coarse.radiance.iter().enumerate().map(share).collect()
}

//! Background of a view in a direction, in f64.

use glam::DVec3;
use ridgelight::scene::{Border, Environment, Scene};
use std::f64::consts::{PI, TAU};

/// Radiance from a direction, of any length. `background` applies where there is neither ground nor sky.
pub fn sky_draw(scene: &Scene, background: [f32; 3], direction: DVec3) -> [f64; 3] {
    let lights = &scene.lights;
    let bare = if lights.environment.is_some() { [0.0; 3] } else { background };
    let above = lights.sky.unwrap_or(bare);
    let is_above = direction.z > 0.0 || scene.surface.border == Border::Open;
    let colour = if is_above { above } else { background };
    let around = lights.environment.as_ref().map_or([0.0; 3], |e| towards(e, direction));
    std::array::from_fn(|k| f64::from(colour[k]) + around[k])
}

/// Bilinear between texel centres.
fn towards(environment: &Environment, e: DVec3) -> [f64; 3] {
    let (width, height) = (environment.width(), environment.height());
    let turn = 0.5 - (e.y.atan2(e.x) - environment.rotation_rad()) / TAU;
    let down = e.x.hypot(e.y).atan2(e.z) / PI;
    let [x, y] = [turn * width as f64 - 0.5, down * height as f64 - 0.5];
    let texel = |row: f64, col: f64, k: usize| {
        let row = row.clamp(0.0, (height - 1) as f64) as usize;
        let col = (col as i64).rem_euclid(width as i64) as usize;
        f64::from(environment.texels()[row * width + col][k])
    };
    let (col, row) = (x.floor(), y.floor());
    std::array::from_fn(|k| {
        let across = |row: f64| {
            let west = texel(row, col, k);
            west + (x - col) * (texel(row, col + 1.0, k) - west)
        };
        across(row) + (y - row) * (across(row + 1.0) - across(row))
    })
}

use std::f64::consts::TAU;

use glam::DVec3;

use crate::graph::shaders::SkyDrawPush;
use crate::scene::{Border, Camera, Lens, Scene};

/// `background`: radiance without ground or sky. `is_on_device`: only the device knows the sky's radiance.
pub(crate) fn push(
    scene: &Scene,
    camera: &Camera,
    aspect: f64,
    background: [f32; 3],
    is_on_device: bool,
) -> SkyDrawPush {
    let [right, up, back] = camera.axes();
    let half_m = match camera.lens {
        Lens::Perspective { fov_rad } => (fov_rad / 2.0).tan(),
        Lens::Orthographic { .. } => 0.0,
    };
    let four = |v: DVec3| v.extend(0.0).as_vec4().to_array();
    let colour = |c: [f32; 3]| [c[0], c[1], c[2], 0.0];
    let above = match (scene.lights.sky, &scene.lights.environment) {
        (Some(sky), _) if !is_on_device => sky,
        (None, Some(_)) => [0.0; 3],
        _ => background,
    };
    let is_open = scene.surface.border == Border::Open;
    let below = if is_open { above } else { background };
    let turns = scene.lights.environment.as_ref().map_or(0.0, |e| e.rotation_rad() / TAU);
    SkyDrawPush {
        forward: four(-back),
        right: four(right * half_m * aspect),
        down: four(-up * half_m),
        above: colour(above),
        below: colour(below),
        rotation_turns: (turns - turns.floor()) as f32,
    }
}

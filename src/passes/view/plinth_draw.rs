use glam::DVec3;

use crate::graph::shaders::{PlinthDrawPush, TerrainDrawPush};
use crate::scene::{Camera, Lens, Scene};

/// Outward directions of the walls: north, east, south, west.
const OUTWARD: [DVec3; 4] = [DVec3::Y, DVec3::X, DVec3::NEG_Y, DVec3::NEG_X];

/// Tone of a wall at right angles to the light, and how much more a wall towards the light has: shares of the ground's
/// mean luminance. Chosen by eye: darker than the ground, with sides that differ.
const WALL_TONE: [f64; 2] = [0.35, 0.15];
/// Tone of the base.
const BASE_TONE: f32 = 0.2;
/// A face that is turned away from the camera.
const AWAY: f32 = -1.0;

/// Faces: four walls and the base. One instance draws a face.
pub(crate) const FACES: u32 = 5;

/// Only faces turned towards the camera are drawn. Field and plinth lie in a convex prism, so a ray enters through at most
/// one such face, before it meets any ground. So depths need neither test nor change.
pub(crate) fn push(
    scene: &Scene,
    camera: &Camera,
    base_m: f64,
    terrain: &TerrainDrawPush,
) -> PlinthDrawPush {
    let field = &scene.field;
    let [cell_x, cell_y] = field.cell_m();
    let far = [(field.cols() - 1) as f64 * cell_x, (field.rows() - 1) as f64 * cell_y];
    // A point of the southern wall, the western wall and the base, and one of the others.
    let (low, high) = (DVec3::new(0.0, 0.0, base_m), DVec3::new(far[0], far[1], base_m));
    let back = camera.axes()[2];
    let is_facing = |outward: DVec3, on: DVec3| match camera.lens {
        Lens::Perspective { .. } => (camera.eye_m() - on).dot(outward) > 0.0,
        Lens::Orthographic { .. } => back.dot(outward) > 0.0,
    };
    let light = light(scene, camera);
    let tone = |k: usize| {
        let on = if k < 2 { high } else { low };
        match is_facing(OUTWARD[k], on) {
            true => (WALL_TONE[0] + WALL_TONE[1] * OUTWARD[k].dot(light)) as f32,
            false => AWAY,
        }
    };
    PlinthDrawPush {
        clip_per_col: terrain.clip_per_col,
        clip_per_row: terrain.clip_per_row,
        clip_per_metre: terrain.clip_per_metre,
        clip_at_origin: terrain.clip_at_origin,
        origin_col: terrain.origin_col,
        origin_row: terrain.origin_row,
        origin_m: terrain.origin_m,
        cols: terrain.cols,
        rows: terrain.rows,
        mesh_step: terrain.mesh_step,
        base_m: (base_m - field.base_m()) as f32,
        base_tone: if is_facing(DVec3::NEG_Z, low) { BASE_TONE } else { AWAY },
        wall_tones: std::array::from_fn(tone),
    }
}

/// Horizontal direction of the light: to the brightest sun, else 60 degrees to the left of the camera, as the default sun
/// of `render`.
fn light(scene: &Scene, camera: &Camera) -> DVec3 {
    let bright = |sun: &[f32; 3]| sun.iter().sum::<f32>();
    let suns = scene.lights.suns.iter();
    let sun = suns.max_by(|a, b| bright(&a.irradiance).total_cmp(&bright(&b.irradiance)));
    let azimuth_rad = sun.map_or(camera.azimuth_rad - 60_f64.to_radians(), |sun| sun.azimuth_rad);
    DVec3::new(azimuth_rad.cos(), azimuth_rad.sin(), 0.0)
}

/// Vertices of a face: six for each quadrilateral of the longer walls.
pub(crate) fn vertices(push: &PlinthDrawPush) -> u32 {
    let cells = (push.cols.max(push.rows) - 1) as u32;
    6 * cells.div_ceil(push.mesh_step as u32)
}

//! Hit of a camera ray on the plinth, and its radiance, in f64, by testing every face.

use glam::DVec3;
use ridgelight::scene::{Camera, HeightField, Lens, Scene};

use super::terrain_draw::ray;

/// Tone of a wall at right angles to the light, what a wall towards the light has more, and the tone of the base.
const TONES: [f64; 3] = [0.35, 0.15, 0.2];

/// Share of the ground's mean luminance at a place of a picture, if the plinth is visible there; for the rest as
/// [`terrain_draw`](super::terrain_draw::terrain_draw). The mesh has a vertex at every `step`th grid point.
pub fn plinth_draw(
    scene: &Scene,
    camera: &Camera,
    (size, pixel): ([u32; 2], [f64; 2]),
    (step, base_m): (u32, f64),
) -> Option<f64> {
    let field = &scene.field;
    let [origin, along] = ray(camera, size, pixel);
    let [cell_x, cell_y] = field.cell_m();
    let (last_row, last_col) = (field.rows() - 1, field.cols() - 1);
    let far = [last_col as f64 * cell_x, last_row as f64 * cell_y];
    let height = |row: usize, col: usize| {
        field.base_m() + f64::from(field.heights_m()[row * field.cols() + col])
    };
    let bright = |c: [f32; 3]| c.iter().sum::<f32>();
    let suns = scene.lights.suns.iter();
    let sun = suns.max_by(|a, b| bright(a.irradiance).total_cmp(&bright(b.irradiance)));
    let azimuth = sun.map_or(camera.azimuth_rad - 60_f64.to_radians(), |sun| sun.azimuth_rad);
    let light = DVec3::new(azimuth.cos(), azimuth.sin(), 0.0);
    let reaches = |t: f64| t > 0.0 || matches!(camera.lens, Lens::Orthographic { .. });
    let walls = [(DVec3::Y, far[1]), (DVec3::X, far[0]), (DVec3::NEG_Y, 0.0), (DVec3::NEG_X, 0.0)];
    for (k, (outward, at)) in walls.into_iter().enumerate() {
        // From outside only.
        let towards = along.dot(outward);
        let t = (at - origin.dot(outward.abs())) / along.dot(outward.abs());
        if towards >= 0.0 || !reaches(t) {
            continue;
        }
        let hit = origin + t * along;
        let (share, last) = match k % 2 {
            0 => (hit.x / cell_x, last_col),
            _ => (last_row as f64 - hit.y / cell_y, last_row),
        };
        if !(0.0..=last as f64).contains(&share) {
            continue;
        }
        let grid_point = |n: usize| match k {
            0 => (0, n),
            1 => (n, last_col),
            2 => (last_row, n),
            _ => (n, 0),
        };
        let top = |n: usize| {
            let (row, col) = grid_point(n);
            height(row, col)
        };
        let fine = (share as usize).min(last - 1);
        let is_void = |n: usize| {
            let (row, col) = grid_point(n);
            field.voids().is_some_and(|voids| voids[row * field.cols() + col])
        };
        let first = fine / step as usize * step as usize;
        let second = (first + step as usize).min(last);
        let part = (share - first as f64) / (second - first) as f64;
        let edge = top(first) + part * (top(second) - top(first));
        if (base_m..=edge).contains(&hit.z) && !is_void(fine) && !is_void(fine + 1) {
            return Some(TONES[0] + TONES[1] * outward.dot(light));
        }
    }
    let t = (base_m - origin.z) / along.z;
    let hit = origin + t * along;
    let is_base = along.z > 0.0
        && reaches(t)
        && (0.0..=far[0]).contains(&hit.x)
        && (0.0..=far[1]).contains(&hit.y);
    is_base.then_some(TONES[2])
}

/// Mean luminance of the ground at 8 by 8 texels: in the middle of as many equal rectangles, voids left out.
pub fn mean_luminance(field: &HeightField, radiance: &[[f32; 3]]) -> f64 {
    let texels = (0..64).map(|i| {
        let [row, col] = [(i / 8, field.rows()), (i % 8, field.cols())]
            .map(|(at, count)| ((at as f64 + 0.5) / 8.0 * count as f64) as usize);
        row * field.cols() + col
    });
    let ground: Vec<f64> = texels
        .filter(|i| !field.voids().is_some_and(|voids| voids[*i]))
        .map(|i| {
            let [r, g, b] = radiance[i].map(f64::from);
            0.2126 * r + 0.7152 * g + 0.0722 * b
        })
        .collect();
    ground.iter().sum::<f64>() / ground.len().max(1) as f64
}

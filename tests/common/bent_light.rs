//! Scattered light: path-traced over the bent mesh, and by visible points of the flat field.

use std::f64::consts::TAU;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::scene::{Curvature, Directions, HeightField, Scene, VisiblePoint, VisiblePoints};
use ridgelight_cpu::scatter_gather::GridPoints;

use super::mesh::Mesh;

pub const ALBEDO: f64 = 0.8;
/// Reflections in the compared light: at most one, and at most three.
pub const BOUNCES: [usize; 2] = [1, 3];
/// Rays of a grid point, evenly over the hemisphere about its normal by cosine. Later segments are
/// random.
pub const RAYS: usize = 2048;

/// Emitted light: 1 on walls that face east, half of it between two walls.
pub fn emitted(col: usize, period: usize) -> f64 {
    match col % period {
        0 => 0.5,
        at if 2 * at == period => 0.5,
        at if 2 * at < period => 1.0,
        _ => 0.0,
    }
}

/// Scattered light of some grid points by paths over the mesh, for each of [`BOUNCES`].
pub fn path_traced(mesh: &Mesh, field: &HeightField, points: &[usize]) -> Result<Vec<[f64; 2]>> {
    let rays = Directions::fibonacci(RAYS, 0.0, 3)?;
    let normals = mesh.normals();
    let mut seed = 1_u64;
    // Marsaglia's xorshift (2003), its upper bits.
    let mut random = move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    // Both triangles of a cell go from its north-west to a corner in the east, which is lower where the
    // wall faces east.
    let emits = |triangle: usize| {
        let [west, _, east] = mesh.triangles[triangle].map(|i| field.heights_m()[i]);
        f64::from(u8::from(west > east))
    };
    let mut of = |at: &usize| {
        let mut sums = [0.0; 2];
        for ray in rays.vectors() {
            // Even heights z are even u of a cosine √u.
            let mut e = by_cosine(normals[*at], ray.z, ray.y.atan2(ray.x));
            let (mut from, mut share) = (mesh.over(*at), 1.0);
            for bounce in 1..=BOUNCES[1] {
                let Some(hit) = mesh.met(from, e) else { break };
                share *= ALBEDO;
                for (sum, most) in sums.iter_mut().zip(BOUNCES) {
                    *sum += if bounce <= most { share * emits(hit.triangle) } else { 0.0 };
                }
                from = mesh.place(&hit, from, e);
                e = by_cosine(mesh.facing(hit.triangle, e), random(), TAU * random());
            }
        }
        sums.map(|sum| sum / RAYS as f64)
    };
    Ok(points.iter().map(&mut of).collect())
}

/// A direction about a normal whose cosine to it is √u.
fn by_cosine(normal: DVec3, u: f64, azimuth: f64) -> DVec3 {
    let x = normal.any_orthonormal_vector();
    let (sin, cos) = azimuth.sin_cos();
    let plan = (1.0 - u).max(0.0).sqrt();
    plan * (cos * x + sin * normal.cross(x)) + u.sqrt() * normal
}

/// The directions of visible points at each grid point on a base, and their weights.
pub struct BentDirections {
    pub bent: Vec<Vec<DVec3>>,
    pub weights: Option<Vec<Vec<f64>>>,
}

/// Scattered light of all grid points for each of [`BOUNCES`]: the limit of paths, by all directions in
/// turn at every bounce. It is that of the renderer, which refuses strong bends.
pub fn scattered(
    scene: &Scene,
    points: &VisiblePoints,
    curvature: Curvature,
    directions: &BentDirections,
    emitted: &[f64],
) -> [Vec<f64>; 2] {
    let materials = GridPoints::of(scene).on(curvature);
    let share = points.directions().share_sr();
    let gathered = |exit: &[f64]| -> Vec<f64> {
        let of = |(at, bent): (usize, &Vec<DVec3>)| -> f64 {
            let along = |i: usize| {
                let VisiblePoint::GridPoint(there) = points.point(i, at) else { return 0.0 };
                let weight = directions.weights.as_ref().map_or(1.0, |weights| weights[at][i]);
                let arrives = [[exit[there]; 3], [0.0; 3]];
                materials.scattered(at, (bent[i], share * weight), DVec3::Z, arrives).light[0]
            };
            (0..bent.len()).map(along).sum()
        };
        directions.bent.iter().enumerate().map(of).collect()
    };
    let (mut exit, mut all) = (emitted.to_vec(), Vec::new());
    for _ in 0..BOUNCES[1] {
        let scattered = gathered(&exit);
        exit = emitted.iter().zip(&scattered).map(|(own, more)| own + more).collect();
        all.push(scattered);
    }
    BOUNCES.map(|bounces| all[bounces - 1].clone())
}

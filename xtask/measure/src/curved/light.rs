//! Scattered light: path-traced over the bent mesh, and by visible points of the flat field.

use std::f64::consts::TAU;

use glam::DVec3;
use ridgelight::Result;
use ridgelight::scene::{Curvature, Directions, HeightField, Scene, VisiblePoint, VisiblePoints};
use ridgelight_cpu::scatter_gather::GridPoints;

use super::mesh::Mesh;

pub const ALBEDO: f64 = 0.8;
/// Times that light is reflected in what is compared: at most once, and at most so often.
pub const BOUNCES: [usize; 2] = [1, 3];
/// Rays of a sample, evenly over the hemisphere about its normal by cosine; those that go on from what they meet are drawn by chance.
pub const RAYS: usize = 2048;

/// What shines: walls that face east, half of it between two walls.
pub fn shines(col: usize, period: usize) -> f64 {
    match col % period {
        0 => 0.5,
        at if 2 * at == period => 0.5,
        at if 2 * at < period => 1.0,
        _ => 0.0,
    }
}

/// What samples of the mesh scatter, of light reflected up to [`BOUNCES`] times.
pub fn ground_truth(mesh: &Mesh, field: &HeightField, samples: &[usize]) -> Result<Vec<[f64; 2]>> {
    let rays = Directions::fibonacci(RAYS, 0.0, 3)?;
    let normals = mesh.normals(field.cols());
    let mut seed = 1_u64;
    // Marsaglia's xorshift (2003), its upper bits.
    let mut chance = move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        (seed >> 11) as f64 / (1_u64 << 53) as f64
    };
    // Both triangles of a cell go from its north-west to a corner in the east: towards which it falls where it faces east.
    let shines = |triangle: usize| {
        let [west, _, east] = mesh.triangles[triangle].map(|i| field.heights_m()[i]);
        f64::from(u8::from(west > east))
    };
    let mut of = |sample: &usize| {
        let mut sums = [0.0; 2];
        for ray in rays.vectors() {
            // z = √u of even u is as likely as its cosine.
            let azimuth = ray.y.atan2(ray.x);
            let mut e = by_cosine(normals[*sample], ray.z, azimuth);
            let mut from = mesh.over(*sample);
            let mut share = 1.0;
            for bounce in 1..=BOUNCES[1] {
                let Some(hit) = mesh.met(from, e) else { break };
                share *= ALBEDO;
                let light = share * shines(hit.triangle);
                for (sum, bounces) in sums.iter_mut().zip(BOUNCES) {
                    *sum += if bounce <= bounces { light } else { 0.0 };
                }
                from = mesh.place(&hit, from, e);
                let normal = mesh.facing(hit.triangle, e);
                e = by_cosine(normal, chance(), TAU * chance());
            }
        }
        sums.map(|sum| sum / RAYS as f64)
    };
    Ok(samples.iter().map(&mut of).collect())
}

/// A direction about a normal whose cosine to it is √u.
fn by_cosine(normal: DVec3, u: f64, azimuth: f64) -> DVec3 {
    let x = normal.any_orthonormal_vector();
    let (sin, cos) = azimuth.sin_cos();
    let plan = (1.0 - u).max(0.0).sqrt();
    plan * (cos * x + sin * normal.cross(x)) + u.sqrt() * normal
}

/// Where samples see what they see, and what each direction counts for.
pub struct BentRays {
    pub bent: Vec<Vec<DVec3>>,
    pub weights: Option<Vec<Vec<f64>>>,
}

/// What all samples scatter, of light reflected up to [`BOUNCES`] times: what paths tend to with their number, by all directions
/// in turn at every bounce. As the renderer has it, which refuses strong bends.
pub fn scattered(
    scene: &Scene,
    points: &VisiblePoints,
    curvature: Curvature,
    looks: &BentRays,
    own: &[f64],
) -> [Vec<f64>; 2] {
    let materials = GridPoints::of(scene).on(curvature);
    let share = points.directions().share_sr();
    let gathered = |leaving: &[f64]| -> Vec<f64> {
        let of = |(at, bent): (usize, &Vec<DVec3>)| -> f64 {
            let of_look = |i: usize| {
                let VisiblePoint::GridPoint(there) = points.point(i, at) else { return 0.0 };
                let weight = looks.weights.as_ref().map_or(1.0, |weights| weights[at][i]);
                let arrives = [[leaving[there]; 3], [0.0; 3]];
                materials.scattered(at, (bent[i], share * weight), DVec3::Z, arrives).light[0]
            };
            (0..bent.len()).map(of_look).sum()
        };
        looks.bent.iter().enumerate().map(of).collect()
    };
    let mut leaving = own.to_vec();
    let mut all = Vec::new();
    for _ in 0..BOUNCES[1] {
        let scattered = gathered(&leaving);
        leaving = own.iter().zip(&scattered).map(|(own, more)| own + more).collect();
        all.push(scattered);
    }
    BOUNCES.map(|bounces| all[bounces - 1].clone())
}

//! Phong specular reflection of a sun towards the view.

use crate::mirror_map::mirrored;
use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::scene::{PhongSpecular, Sun};
use std::f64::consts::{PI, TAU};

/// Exit radiance towards `view` for irradiance 1 at a normal, from the sun's light on diffuse ground there ([`crate::sun_shade`]).
///
/// The Phong lobe is taken as constant over the sun: for a radius a and an exponent n the error is n a²/4 of its
/// peak, 5 % for the sun's 0.27° and n = 10⁴. Where a grid point's own plane or a horizon cuts a disc, the visible
/// part is weighted by the cosine.
pub fn specular_on(
    (normal, view): (DVec3, DVec3),
    sun: &Sun,
    phong: PhongSpecular,
    sun_sum: f64,
) -> f64 {
    let [exponent, scale] = [phong.exponent, phong.scale].map(f64::from);
    let towards = towards(sun);
    let mirror = mirrored(normal, view);
    let cosine = mirror.dot(towards);
    // 0 to the power of 0 would be light from behind.
    if cosine <= 0.0 {
        return 0.0;
    }
    let density = (exponent + 1.0) / TAU * cosine.powf(exponent);
    scale * visible(normal, towards, sun_sum) * density
}

/// Incident light of the sun for irradiance 1, as a series of n²: the visible fraction, all of it from the sun's
/// centre.
pub fn arriving(normal: DVec3, sun: &Sun, order: usize, sun_sum: f64) -> Vec<f64> {
    let towards = towards(sun);
    let visible = visible(normal, towards, sun_sum);
    evaluate(order, towards).iter().map(|y| visible * y).collect()
}

fn towards(sun: &Sun) -> DVec3 {
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let (up, along) = sun.elevation_rad.sin_cos();
    DVec3::new(cos * along, sin * along, up)
}

/// The visible fraction of a sun.
fn visible(normal: DVec3, towards: DVec3, sun_sum: f64) -> f64 {
    let facing = normal.dot(towards);
    if facing > 0.0 { (PI * sun_sum / facing).min(1.0) } else { 0.0 }
}

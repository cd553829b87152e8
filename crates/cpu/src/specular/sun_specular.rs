//! What a lobe about the mirror direction of the view from straight above reflects of a sun.

use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::scene::{Phong, Sun};
use std::f64::consts::{PI, TAU};

/// Exit radiance for irradiance 1 at a normal, by what the sun gives to diffuse ground there
/// ([`crate::sun_shade`]).
///
/// The lobe counts as even over the sun: for a radius a and an exponent n it is off by n a²/4 of its peak,
/// 5 % for the sun's 0.27° and n = 10⁴. Where a sample's own plane or a horizon cuts a disc, the part that is
/// seen is weighed by the cosine.
pub fn gloss_on(normal: DVec3, sun: &Sun, phong: Phong, sun_sum: f64) -> f64 {
    let [exponent, scale] = [phong.exponent, phong.scale].map(f64::from);
    let towards = towards(sun);
    let mirror = 2.0 * normal.z * normal - DVec3::Z;
    let cosine = mirror.dot(towards);
    // 0 to the power of 0 would be light from behind.
    if cosine <= 0.0 {
        return 0.0;
    }
    let density = (exponent + 1.0) / TAU * cosine.powf(exponent);
    scale * seen(normal, towards, sun_sum) * density
}

/// What arrives of the sun for irradiance 1, as a series of n²: the part that is seen, all of it from the sun's middle.
pub fn arriving(normal: DVec3, sun: &Sun, order: usize, sun_sum: f64) -> Vec<f64> {
    let towards = towards(sun);
    let seen = seen(normal, towards, sun_sum);
    evaluate(order, towards).iter().map(|y| seen * y).collect()
}

fn towards(sun: &Sun) -> DVec3 {
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let (up, along) = sun.elevation_rad.sin_cos();
    DVec3::new(cos * along, sin * along, up)
}

/// The part of a sun that is seen.
fn seen(normal: DVec3, towards: DVec3, sun_sum: f64) -> f64 {
    let facing = normal.dot(towards);
    if facing > 0.0 { (PI * sun_sum / facing).min(1.0) } else { 0.0 }
}

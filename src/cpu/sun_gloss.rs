//! What a lobe about the mirror direction of the view from straight above reflects of a sun.

use crate::scene::Sun;
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// Exit radiance for scale 1 and irradiance 1 at a normal, by what the sun gives to diffuse ground there
/// ([`super::sun_shade`]).
///
/// The lobe counts as even over the sun: for a radius a and an exponent n it is off by n a²/4 of its peak,
/// 5 % for the sun's 0.27° and n = 10⁴. Where a sample's own plane or a horizon cuts a disc, the part that is
/// seen is weighed by the cosine.
pub fn gloss_on(normal: DVec3, sun: &Sun, exponent: f64, sun_sum: f64) -> f64 {
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let (up, along) = sun.elevation_rad.sin_cos();
    let towards = DVec3::new(cos * along, sin * along, up);
    let facing = normal.dot(towards);
    if facing <= 0.0 {
        return 0.0;
    }
    let mirror = 2.0 * normal.z * normal - DVec3::Z;
    let seen = (PI * sun_sum / facing).min(1.0);
    seen * (exponent + 1.0) / TAU * mirror.dot(towards).max(0.0).powf(exponent)
}

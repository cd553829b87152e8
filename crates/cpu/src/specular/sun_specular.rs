//! Phong specular reflection of a sun towards the view.

use crate::mirror_map::mirrored;
use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::scene::{PhongSpecular, Sun};
use std::f64::consts::{PI, TAU};

/// Exit radiance towards `view` for irradiance 1 at a normal, from the sun's light on diffuse ground there ([`crate::sun_shade`]).
///
/// The mean of the Phong lobe over the disc, times its visible part. Where a grid point's own plane or a horizon cuts the
/// disc, that part is weighted by the cosine and not by the lobe.
pub fn specular_on(
    (normal, view): (DVec3, DVec3),
    sun: &Sun,
    phong: PhongSpecular,
    sun_sum: f64,
) -> f64 {
    let [exponent, scale] = [phong.exponent, phong.scale].map(f64::from);
    let visible = visible(normal, towards(sun), sun_sum);
    if visible == 0.0 {
        return 0.0;
    }
    scale * visible * disc_density(mirrored(normal, view), sun, exponent)
}

/// Integral of a lobe about `mirror` over a sun's disc, for irradiance 1. Lobes narrower than a seventh of the disc are
/// widened to that: n r² is 48 at most.
pub fn disc_density(mirror: DVec3, sun: &Sun, exponent: f64) -> f64 {
    let radius = if sun.is_point() { 0.0 } else { 0.5 * sun.diameter_rad };
    let n = exponent.min(WIDEST / (radius * radius));
    let density = |e: DVec3| {
        let cosine = e.dot(mirror);
        // 0 to the power of 0 would be light from behind.
        if cosine <= 0.0 { 0.0 } else { (n + 1.0) / TAU * cosine.powf(n) }
    };
    let centre = towards(sun);
    if radius == 0.0 {
        return density(centre);
    }
    let (sin, cos) = sun.azimuth_rad.sin_cos();
    let level = DVec3::new(-sin, cos, 0.0);
    let up = centre.cross(level);
    let depth = 2.0 * (0.5 * radius).sin().powi(2);
    // The midpoint rule over 1 - cos of the angle to the centre, with as many directions as lobes need.
    let mut sum = 0.0;
    for ring in 0..RINGS {
        let h = depth * (ring as f64 + 0.5) / RINGS as f64;
        let across = (h * (2.0 - h)).sqrt();
        for k in 0..AROUND {
            let (sin, cos) = (TAU * (k as f64 + 0.5) / AROUND as f64).sin_cos();
            sum += density((1.0 - h) * centre + across * (cos * level + sin * up));
        }
    }
    2.0 / (2.0 - depth) * sum / (RINGS * AROUND) as f64
}

/// Exponent times the squared radius of a disc, at most.
const WIDEST: f64 = 48.0;
const RINGS: usize = 128;
const AROUND: usize = 48;

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

//! Exit radiance of a grid point from incident light as a series: Phong specular, and diffuse light beside it.

use crate::Rgb;
use crate::basis::{half_turn, reconstruct};
use crate::specular_gather::Series;
use glam::DVec3;
use ridgelight::basis::bands;
use ridgelight::basis::zonal::phong_bands;
use ridgelight::scene::PhongSpecular;
use std::f64::consts::PI;

/// A channel of incident light, smoothed by the Phong lobe and scaled.
fn smoothed(arriving: &Series, phong: PhongSpecular, channel: usize) -> Vec<f64> {
    let order = arriving.len().isqrt();
    let kept = phong_bands(order, phong.exponent.into());
    let all = bands(order).zip(arriving);
    all.map(|((l, _), u)| f64::from(phong.scale) * kept[l] * u[channel]).collect()
}

/// Phong specular straight upwards, clamped at 0.
pub fn mirrored(arriving: &Series, normal: DVec3, phong: PhongSpecular) -> Rgb {
    let mirror = 2.0 * normal.z * normal - DVec3::Z;
    [0, 1, 2].map(|c| reconstruct(&smoothed(arriving, phong, c), mirror).max(0.0))
}

/// Exit radiance by direction, without the diffuse part: incident light, smoothed by the lobe, at the mirror
/// direction about the normal.
pub fn exit_series(arriving: &Series, normal: DVec3, phong: PhongSpecular, diffuse: Rgb) -> Series {
    let channels = [0, 1, 2].map(|c| {
        let mut turned = half_turn(&smoothed(arriving, phong, c), normal);
        turned[0] += (4.0 * PI).sqrt() * diffuse[c];
        turned
    });
    (0..arriving.len()).map(|i| [0, 1, 2].map(|c| channels[c][i])).collect()
}

//! Exit radiance of a grid point from incident light as a series: Phong specular, and diffuse light beside it.

use crate::Rgb;
use crate::basis::{half_turn, reconstruct};
use crate::mirror_map::mirrored;
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

/// Phong specular towards a unit `view`, clamped at 0.
pub fn reflected(arriving: &Series, (normal, view): (DVec3, DVec3), phong: PhongSpecular) -> Rgb {
    let mirror = mirrored(normal, view);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// In the direction of a view, exit radiance by direction equals the light reflected towards it, where that is not clamped.
    #[test]
    fn series_of_exit_radiance_hold_every_view() {
        let normal = DVec3::new(0.3, -0.4, 0.8).normalize();
        let phong = PhongSpecular { exponent: 4.0, scale: 0.6 };
        let mut apart = 0.0_f64;
        for order in 2..=6 {
            // Band 0 is so bright that the other bands darken no direction below 0.
            let arriving: Series = (0..order * order)
                .map(|i| {
                    [0, 1, 2].map(|c| if i == 0 { 40.0 } else { ((i * 5 + c) % 7) as f64 - 3.0 })
                })
                .collect();
            let exit = exit_series(&arriving, normal, phong, [0.0; 3]);
            let upward = reflected(&arriving, (normal, DVec3::Z), phong);
            for view in [DVec3::Z, DVec3::X, DVec3::new(-0.5, 0.7, 0.2).normalize(), -DVec3::Y] {
                let found = reflected(&arriving, (normal, view), phong);
                for c in 0..3 {
                    let channel: Vec<f64> = exit.iter().map(|s| s[c]).collect();
                    let want = reconstruct(&channel, view);
                    assert!(want > 0.0 && (found[c] - want).abs() < 1e-9, "{order} {view}: {want}");
                    apart = apart.max((found[c] - upward[c]).abs());
                }
            }
        }
        assert!(apart > 0.1, "views differ by {apart} only");
    }
}

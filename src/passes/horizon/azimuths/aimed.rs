use std::f64::consts::FRAC_PI_2;

use crate::passes::azimuths::{Azimuth, STEEPEST, grid_direction, swept, with_wedge};
use crate::scene::KeyLight;

/// The part of the sky that a light covers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// A sun's disc: a chord in each azimuth, partly above the horizon.
    Disc,
    /// A point sun: one azimuth, lit or not.
    Point,
    /// A key light: the same elevations over each wedge, partly above the horizon.
    Patch,
}

/// The azimuths of a key light: the middles of `count` equal wedges across it.
///
/// Each wedge is lit evenly between the two elevations. The irradiance of an unoccluded surface is exact for
/// any number of wedges.
pub fn across_key(key: &KeyLight, count: u32, cell_m: [f64; 2]) -> Vec<Azimuth> {
    let key = key.clamped();
    let [low_slope, high_slope] = key.elevations_rad.map(slope);
    let width = key.width_rad / f64::from(count);
    let first = key.azimuth_rad - key.width_rad / 2.0;
    (0..count)
        .map(|k| {
            let wedge = [0.0, 1.0].map(|end| first + width * (f64::from(k) + end));
            let phi = first + width * (f64::from(k) + 0.5);
            let (dcol, drow) = grid_direction(phi, cell_m);
            let azimuth = with_wedge(swept(dcol, drow, cell_m), phi, wedge);
            Azimuth { low_slope, high_slope, weight: 1.0, ..azimuth }
        })
        .collect()
}

/// The slope of an elevation; safe to square in f32.
pub(crate) fn slope(elevation_rad: f64) -> f32 {
    let steepest = f64::from(STEEPEST);
    match elevation_rad {
        e if e >= FRAC_PI_2 => STEEPEST,
        e if e <= -FRAC_PI_2 => -STEEPEST,
        e => e.tan().clamp(-steepest, steepest) as f32,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight_cpu::shared::gather::elevation_moments;
    use std::f64::consts::TAU;

    /// Level ground receives L width (sin²high - sin²low) / 2 from any number of slices. Wedges and slopes are
    /// f32: an elevation moves by half a unit of 2^-24 of its sine and cosine.
    #[test]
    fn slices_make_up_the_light() {
        for (low, high, width) in [(0.0, 90.0, 360.0), (10.0, 12.0, 0.5), (-90.0, 40.0, 90.0)] {
            let key = KeyLight {
                azimuth_rad: 2.5,
                width_rad: f64::to_radians(width),
                elevations_rad: [f64::to_radians(low), f64::to_radians(high)],
                radiance: [1.0; 3],
            };
            for count in [1, 3, 8, 256] {
                let slices = across_key(&key, count, [30.0, 90.0]);
                assert_eq!(slices.len(), count as usize);
                let vertical = |slope: f32| elevation_moments(f64::from(slope).max(0.0))[1];
                let sum: f64 = slices
                    .iter()
                    .map(|a| {
                        f64::from(a.wedge_rad) * (vertical(a.low_slope) - vertical(a.high_slope))
                    })
                    .sum();
                let expected = key.level_irradiance();
                let rounding = 2.0_f64.powi(-24) * (expected + key.width_rad);
                assert!(
                    (sum - expected).abs() <= rounding,
                    "{low} {width} {count}: {sum} {expected}"
                );
            }
        }
    }

    /// A full circle of 12 slices that begins half a slice before east has the azimuths of 12 even ones.
    #[test]
    fn a_whole_circle_has_the_skys_azimuths() {
        let key = KeyLight {
            azimuth_rad: TAU / 2.0 - TAU / 24.0,
            width_rad: TAU,
            elevations_rad: [0.0, FRAC_PI_2],
            radiance: [1.0; 3],
        };
        let cell = [3.0, 2.0];
        for (a, b) in across_key(&key, 12, cell).iter().zip(super::super::even(12, cell)) {
            assert_eq!((a.shear, a.flags), (b.shear, b.flags));
            let near = |a: f32, b: f32| (a - b).abs() < 3e-7;
            assert!(near(a.wedge_cos, b.wedge_cos) && near(a.wedge_sin, b.wedge_sin), "{a:?}");
            assert!(near(a.wedge_rad, b.wedge_rad) && near(a.cos_phi, b.cos_phi), "{a:?}");
        }
    }
}

//! What a sun gives to every sample through its horizons in the azimuths that its disc covers.

use super::shared::gather::{Swept, elevation_moments};
use std::f64::consts::PI;

/// Exit radiance of one sample for irradiance 1 and albedo 1. `point`: lit or not; else the part of
/// each chord of the disc that the horizon leaves free.
///
/// # Panics
/// Outside the field.
pub fn sun_at(swept: &Swept, point: bool, col: i32, row: i32) -> f64 {
    let mut sun = 0.0;
    swept.add_all(col, row, |_, azimuth, lowest, normal| {
        let flat_part =
            normal.x * f64::from(azimuth.cos_phi) + normal.y * f64::from(azimuth.sin_phi);
        let (low, high) = (f64::from(azimuth.low_slope), f64::from(azimuth.high_slope));
        let weight = f64::from(azimuth.weight) / PI;
        if lowest >= high {
            return;
        }
        if point {
            let cos_elevation = 1.0 / (1.0 + high * high).sqrt();
            let facing = (flat_part + normal.z * high) * cos_elevation;
            sun += facing.max(0.0) * weight;
        } else {
            let [from, to] = [elevation_moments(lowest.max(low)), elevation_moments(high)];
            sun += (flat_part * (from[0] - to[0]) + normal.z * (from[1] - to[1])) * weight;
        }
    });
    sun
}

/// `sun_sum` of all azimuths: [`sun_at`] for every sample, row-major.
pub fn sun_shade(swept: &Swept, point: bool) -> Vec<f64> {
    swept.per_sample(|col, row| sun_at(swept, point, col, row))
}

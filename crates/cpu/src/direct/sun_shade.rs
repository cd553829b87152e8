//! Direct light of a sun or a key light, from a grid point's horizons in the azimuths that it covers. Specular of key lights:
//! [`crate::key_specular`].

use crate::shared::gather::{Swept, elevation_moments};
use glam::DVec3;
use ridgelight::plan::Azimuth;
use ridgelight::plan::azimuths::Shape;
use std::f64::consts::PI;

/// Exit radiance of one grid point of albedo 1, for irradiance 1 of a sun or radiance 1 of a key light.
pub fn sun_at(swept: &Swept, shape: Shape, col: i32, row: i32) -> f64 {
    let mut sun = 0.0;
    swept.add_all([col, row], true, |_, azimuth, lowest, normal| {
        sun += sun_slice(azimuth, shape, lowest, normal);
    });
    sun
}

/// The light vector of one azimuth of a disc, above a slope: directions times irradiance.
pub fn vector_slice(azimuth: &Azimuth, lowest: f64) -> DVec3 {
    let (low, high) = (f64::from(azimuth.low_slope), f64::from(azimuth.high_slope));
    if lowest >= high {
        return DVec3::ZERO;
    }
    let [from, to] = [elevation_moments(lowest.max(low)), elevation_moments(high)];
    let (along, up) = (from[0] - to[0], from[1] - to[1]);
    let [cos, sin] = [azimuth.cos_phi, azimuth.sin_phi].map(f64::from);
    f64::from(azimuth.weight) * DVec3::new(along * cos, along * sin, up)
}

/// The light vector of all azimuths.
pub fn vector_at(swept: &Swept, col: i32, row: i32) -> DVec3 {
    let mut vector = DVec3::ZERO;
    swept.add_all([col, row], true, |_, azimuth, lowest, _| {
        vector += vector_slice(azimuth, lowest);
    });
    vector
}

/// The light of one azimuth, above a slope.
pub fn sun_slice(azimuth: &Azimuth, shape: Shape, lowest: f64, normal: DVec3) -> f64 {
    let along = |cos: f32, sin: f32| normal.x * f64::from(cos) + normal.y * f64::from(sin);
    let [flat_part, vertical] = match shape {
        Shape::Patch => {
            [along(azimuth.wedge_cos, azimuth.wedge_sin), normal.z * f64::from(azimuth.wedge_rad)]
        }
        Shape::Disc | Shape::Point => [along(azimuth.cos_phi, azimuth.sin_phi), normal.z],
    };
    let (low, high) = (f64::from(azimuth.low_slope), f64::from(azimuth.high_slope));
    let weight = f64::from(azimuth.weight) / PI;
    if lowest >= high {
        return 0.0;
    }
    if shape == Shape::Point {
        let cos_elevation = 1.0 / (1.0 + high * high).sqrt();
        let facing = (flat_part + vertical * high) * cos_elevation;
        facing.max(0.0) * weight
    } else {
        let [from, to] = [elevation_moments(lowest.max(low)), elevation_moments(high)];
        (flat_part * (from[0] - to[0]) + vertical * (from[1] - to[1])) * weight
    }
}

/// Sum of the weights of a light's slices, as [`ShadeError::sun`](crate::tolerance::ShadeError::sun) takes it.
pub fn weights(azimuths: &[Azimuth], shape: Shape) -> f64 {
    let weight = |a: &Azimuth| match shape {
        Shape::Patch => f64::from(a.wedge_rad),
        Shape::Disc | Shape::Point => f64::from(a.weight),
    };
    azimuths.iter().map(weight).sum()
}

/// `sun_sum` of all azimuths: [`sun_at`] for every grid point, row-major.
pub fn sun_shade(swept: &Swept, shape: Shape) -> Vec<f64> {
    swept.per_grid_point(|col, row| sun_at(swept, shape, col, row))
}

//! Exit radiance under a uniform sky and an environment, from a grid point's horizons.

use crate::Rgb;
use crate::env_tables::EnvTables;
use crate::shared::gather::{Swept, elevation_moments};
use glam::DVec3;
use ridgelight::plan::Azimuth;
use std::f64::consts::PI;

/// Exit radiance of one grid point of albedo 1 under a sky of radiance 1.
pub fn sky_at(swept: &Swept, col: i32, row: i32) -> f64 {
    let mut sky = 0.0;
    swept.add_all([col, row], true, |_, azimuth, lowest, normal| {
        sky += wedge_of_sky(azimuth, lowest, normal);
    });
    sky
}

/// Irradiance from a wedge of it above a slope.
pub fn wedge_of_sky(azimuth: &Azimuth, lowest: f64, normal: DVec3) -> f64 {
    // TW10 eq. 5, with the normal integrated over the wedge instead of evaluated at its centre.
    let moments = elevation_moments(lowest);
    let flat_part =
        normal.x * f64::from(azimuth.wedge_cos) + normal.y * f64::from(azimuth.wedge_sin);
    let wedge = f64::from(azimuth.wedge_rad);
    (flat_part * moments[0] + normal.z * wedge * moments[1]) / PI
}

/// `sky_sum` of all azimuths: [`sky_at`] for every grid point, row-major.
pub fn sky_shade(swept: &Swept) -> Vec<f64> {
    swept.per_grid_point(|col, row| sky_at(swept, col, row))
}

/// `env_sum` of all azimuths: exit radiance of every grid point of albedo 1 under an environment, RGB, row-major.
pub fn env_shade(swept: &Swept, tables: &EnvTables) -> Vec<Rgb> {
    swept.per_grid_point(|col, row| {
        let mut environment = DVec3::ZERO;
        swept.add_all([col, row], true, |index, _, lowest, normal| {
            environment += tables.light(index, lowest, normal);
        });
        environment.to_array()
    })
}

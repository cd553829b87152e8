//! Direct light of a sphere light: the shader's own slices, each from the oracle's profile in f64, where the shader
//! marches over blocks of cells.

use crate::light::{Site, diffuse_at};
use crate::oracle::Oracle;
use crate::shared::field::towards_m;
use ridgelight::scene::SphereLight;
use std::f64::consts::PI;

/// Exit radiance of a grid point for a sphere light of radiance 1 and albedo 1; `slices` is the setting.
pub fn sphere_at(oracle: &Oracle, light: &SphereLight, slices: u32, row: usize, col: usize) -> f64 {
    let [narrow, around] = light.slices(slices, oracle.field().cell_m());
    let [east, north] = towards_m(oracle.field(), row, col, light);
    let away = east.hypot(north);
    let count = if light.radius_m < away {
        let wide = f64::from(around) * (light.radius_m / away).asin() / PI;
        narrow.max((wide - 0.001).ceil() as u32)
    } else {
        around
    };
    Site::of(oracle, [row, col], &diffuse_at(oracle, row, col)).sphere(light, count as usize)[0]
}

/// [`sphere_at`] of every grid point, row-major.
pub fn sphere_shade(oracle: &Oracle, sphere: &SphereLight, slices: u32) -> Vec<f64> {
    let (rows, cols) = (oracle.field().rows(), oracle.field().cols());
    let of = |i: usize| sphere_at(oracle, sphere, slices, i / cols, i % cols);
    (0..rows * cols).map(of).collect()
}

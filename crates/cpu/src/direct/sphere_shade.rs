//! Direct light of a sphere light: the shader's own slices, each from the oracle's profile in f64, where the shader
//! marches over blocks of cells.

use crate::light::{Receiver, Site, diffuse_at};
use crate::oracle::Oracle;
use crate::shared::field::towards_m;
use crate::specular_tables::phong_error;
use crate::tolerance::{EPSILON, SphereGeometry};
use ridgelight::scene::SphereLight;
use std::f64::consts::{E, PI, TAU};

/// Exit radiance of a grid point for a sphere light of radiance 1 and albedo 1; `slices` is the setting.
pub fn sphere_at(oracle: &Oracle, light: &SphereLight, slices: u32, row: usize, col: usize) -> f64 {
    let counts = light.slices(slices, oracle.field().cell_m());
    sphere_with(oracle, light, counts, [row, col], &diffuse_at(oracle, row, col))[0]
}

/// Exit radiance of receivers at a grid point, diffuse of albedo 1 or specular of scale 1. The two counts are the slices where the
/// sphere is narrow as viewed from there, and where it surrounds the grid point.
pub fn sphere_with(
    oracle: &Oracle,
    light: &SphereLight,
    [narrow, around]: [u32; 2],
    [row, col]: [usize; 2],
    receivers: &[Receiver],
) -> Vec<f64> {
    let [east, north] = towards_m(oracle.field(), row, col, light);
    let away = east.hypot(north);
    let count = if light.radius_m < away {
        let wide = f64::from(around) * (light.radius_m / away).asin() / PI;
        narrow.max((wide - 0.001).ceil() as u32)
    } else {
        around
    };
    Site::of(oracle, [row, col], receivers).sphere(light, count as usize)
}

/// Tolerance of the specular of `sphere_shade`, for radiance and scale 1 and a mirror direction that errs by `off_rad`.
///
/// Ends of slices have the errors of diffuse light, where the lobe is (n + 1) / 2π at most. Its antiderivative errs at both ends;
/// where the surface cuts the sphere, at those of four pieces. Elsewhere the lobe changes by √(n/e) of that per radian. Over the
/// sphere's solid angle it errs by 20 ε and by x e^-x ≤ 1/e of a series' 1e-7. A narrow interval, at most 1/20 of the lobe's
/// standard deviation wide, uses the lobe in its middle: an error of 1/24 of the square, 1.1e-4.
pub fn device_sphere_specular(geometry: &SphereGeometry, exponent: f64, off_rad: f64) -> f64 {
    let n = exponent;
    let peak = (n + 1.0) / TAU;
    let [weights, angle, touch] = geometry.of_slices();
    let pieces = if geometry.is_cut { 4.0 } else { 1.0 };
    let solid = weights * geometry.height_rad();
    let ends = peak * (2.0 * angle + touch) + 2.0 * pieces * phong_error(n);
    let inside = (n / E).sqrt() * off_rad + 20.0 * EPSILON + 1e-7 + 1.1e-4;
    weights * ends + peak * solid * inside
}

/// [`sphere_at`] of every grid point, row-major.
pub fn sphere_shade(oracle: &Oracle, sphere: &SphereLight, slices: u32) -> Vec<f64> {
    let (rows, cols) = (oracle.field().rows(), oracle.field().cols());
    let of = |i: usize| sphere_at(oracle, sphere, slices, i / cols, i % cols);
    (0..rows * cols).map(of).collect()
}

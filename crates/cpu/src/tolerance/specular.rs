//! Tolerances of Phong specular.

use super::{CastError, EPSILON, Slices, device_sh_specular};
use crate::shared::bounced::{Along, Cast};
use std::f64::consts::PI;

/// A coefficient of `specular_visibility`, of the magnitudes of all products that it sums: one rounding each and one a sum.
pub fn device_specular_visibility(order: usize) -> f64 {
    ((order * order) as f64 + 1.0) * EPSILON
}

/// A coefficient that `sun_specular` adds of a sun of irradiance 1 that faces the grid point by `facing`, the cosine: the part
/// that is visible errs as in [`device_sun_specular`](super::device_sun_specular), Y_lm, 1 at most, by 100 ε, their products by 3 ε.
pub fn device_sun_arriving(normal_error: f64, facing: f64) -> f64 {
    ((normal_error + 6.0 * EPSILON) / facing.max(1e-30)).min(1.0) + 104.0 * EPSILON
}

/// A coefficient of `specular_exit`, of the magnitudes of all coefficients that arrive, smoothed.
///
/// At each of n (2n - 1) directions the sum errs as in [`device_sh_specular`]. Weights times |Y_lm| sum to √4π at most, the
/// product of the norms of 1 and of Y_lm, rounded once, and sums of them err by one rounding a direction.
pub fn device_specular_exit(order: usize, normal_error: f64) -> f64 {
    let directions = (order * (2 * order - 1)) as f64;
    (4.0 * PI).sqrt() * (device_sh_specular(order, normal_error) + (directions + 4.0) * EPSILON)
}

/// Error of a coefficient of incident light by `specular_gather` or `bounce_march`. `all` are the CPU reference's visible intervals;
/// `error` gives each one's error. The magnitudes of the surface's exit coefficients sum to `of.brightest` at most.
///
/// An end closes the contribution of one place and opens the next one: twice its error times `brightest`, with Y_lm 1 at
/// most; the first is the own plane, which turns with the normal. Radiance errs by itself, changes by n a radian of
/// direction, and its series sum with 100 ε; slices are polynomials whose coefficients sum to 15, 100 ε an end.
pub fn device_arriving(
    all: &[Along],
    error: impl Fn(&Along, &Cast) -> CastError,
    order: usize,
    of: &Slices,
) -> f64 {
    let brightest = of.brightest;
    let cast_off = |along: &Along, cast: &Cast| {
        let here = error(along, cast);
        let end = 2.0 * (here.elevation_rad + 100.0 * EPSILON) * brightest;
        let turned = order as f64 * here.elevation_rad + 100.0 * EPSILON;
        end + (cast.high_rad - cast.low_rad) * (here.radiance + turned * brightest)
    };
    let slice_off = |along: &Along| {
        let casts = along.casts.iter().map(|cast| cast_off(along, cast));
        (of.normal + 100.0 * EPSILON) * brightest + casts.sum::<f64>()
    };
    2.0 * PI / all.len() as f64 * all.iter().map(slice_off).sum::<f64>()
}

/// Values stored as f16: a device may round either way, the CPU reference rounds to nearest: 2^-10 of it, or of the
/// smallest numbers 2^-24.
pub fn stored_f16(value: f64) -> f64 {
    value.abs() / 1024.0 + 1.0 / (1 << 24) as f64
}

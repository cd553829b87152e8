//! Light that lobes throw.

use std::f64::consts::PI;

use super::{EPSILON, twin_pyramid_angle, twin_sh_gloss};

/// A coefficient of `gloss_seen`, of the magnitudes of all products that it sums: one rounding each and one a sum.
pub fn twin_gloss_seen(order: usize) -> f64 {
    ((order * order) as f64 + 1.0) * EPSILON
}

/// A coefficient that `sun_gloss` adds of a sun of irradiance 1 that faces the sample by `facing`, the cosine: the part
/// that is seen errs as in [`twin_sun_gloss`](super::twin_sun_gloss), Y_lm, 1 at most, by 100 ε, their products by 3 ε.
pub fn twin_sun_arriving(normal_error: f64, facing: f64) -> f64 {
    ((normal_error + 6.0 * EPSILON) / facing.max(1e-30)).min(1.0) + 104.0 * EPSILON
}

/// A coefficient of `gloss_exit`, of the magnitudes of all coefficients that arrive, smoothed.
///
/// At each of n (2n - 1) directions the sum errs as in [`twin_sh_gloss`]. Weights times |Y_lm| sum to √4π at most, the
/// product of the norms of 1 and of Y_lm, rounded once, and sums of them err by one rounding a direction.
pub fn twin_gloss_exit(order: usize, normal_error: f64) -> f64 {
    let directions = (order * (2 * order - 1)) as f64;
    (4.0 * PI).sqrt() * (twin_sh_gloss(order, normal_error) + (directions + 4.0) * EPSILON)
}

/// A coefficient of what arrives by `gloss_gather`, from `samples` an azimuth, of surface whose radiance by direction has
/// coefficients that sum to `brightest` at most, by magnitude.
///
/// Elevations err as in [`twin_gathered`](super::twin_gathered). One that is seen ends what one place throws and begins
/// what the next does: twice its error times `brightest`, with Y_lm 1 at most, over all azimuths. Radiance changes by n
/// a radian of direction, and errs by roundings as there, of series 100 ε besides; slices, of polynomials whose coefficients sum
/// to 15, by 100 ε. The twin errs by less.
pub fn twin_arriving(
    [largest_m, relief_m, step_m]: [f64; 3],
    (samples, order): (u32, usize),
    brightest: f64,
) -> f64 {
    let placed = 4.0 * EPSILON * relief_m / step_m;
    let angle = twin_pyramid_angle(largest_m, relief_m, step_m) + placed + 24.0 * EPSILON;
    let ends = 2.0 * f64::from(samples + 2) * (angle + 100.0 * EPSILON);
    2.0 * PI * (ends + PI * (order as f64 * angle + 600.0 * EPSILON)) * brightest
}

/// What is stored as f16: rounded either way by a device and to nearest by the twin, 2^-10 of it, or of the smallest
/// numbers 2^-24.
pub fn stored_f16(value: f64) -> f64 {
    value.abs() / 1024.0 + 1.0 / (1 << 24) as f64
}

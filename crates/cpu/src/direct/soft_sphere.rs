//! Tolerance of a sphere light by spherical harmonics against its CPU reference: the f32 error at any order, sphere
//! and field. The truncation error of the harmonics is not part of it.

use crate::basis::receiver;
use crate::light_matrix::light_matrix;
use crate::sphere_sh_shade::BEYOND;
use crate::tolerance::{ARC_TANGENT, EPSILON, ShadeError, SphereGeometry};
use glam::DVec3;
use ridgelight::basis::bands;
use ridgelight::scene::{Quality, Receiver, Wedges};
use std::f64::consts::PI;

/// Contributions of visibility and sphere coefficients to the light, for a quality.
#[derive(Clone, Debug)]
pub struct SphereShError {
    quality: Quality,
    /// `[coefficient of the sphere][row of the receiver][coefficient of visibility]`, magnitudes.
    shares: Vec<Vec<Vec<f64>>>,
}

impl SphereShError {
    /// Of a quality.
    pub fn new(quality: &Quality) -> Self {
        let count = quality.light_order().pow(2);
        let of_one = |i: usize| {
            let mut unit = vec![DVec3::ZERO; count];
            unit[i] = DVec3::ONE;
            let rows = light_matrix(quality, &unit);
            rows.iter().map(|row| row.iter().map(|v| v.x.abs()).collect()).collect()
        };
        Self { quality: *quality, shares: (0..count).map(of_one).collect() }
    }

    /// For a series `visibility` through horizons with a slope error of `slope_error`, on a surface of this normal, under a
    /// sphere light of radiance 1.
    ///
    /// A coefficient of visibility errs as [`ShadeError::series`] gives it, for azimuths across the sphere and
    /// beyond; the azimuths' ends by an arc tangent and 24 ε, at which the series jumps by √((2l+1)/4π) · √2 at most,
    /// at both. One of the sphere as `coefficient` gives it. Products sum as many terms as there are, each of four
    /// factors, whose polynomials of the normal are 2 at most and change by 6 a radian.
    pub fn tolerance(
        &self,
        sphere: &SphereGeometry,
        slope_error: f64,
        normal: DVec3,
        visibility: &[f64],
    ) -> f64 {
        let order = self.quality.sh_order as usize;
        let beyond = if self.quality.wedges == Wedges::Table { 0 } else { BEYOND };
        let count = self.quality.sun_azimuths as usize + beyond;
        let error = ShadeError::new(slope_error, sphere.relief_m, sphere.cell_m, count);
        let end = 2.0 * (ARC_TANGENT + 24.0 * EPSILON);
        let of_visibility: Vec<f64> = bands(order)
            .map(|(l, _)| {
                let jump = 2.0_f64.sqrt() * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
                error.series(l, self.quality.wedges) + end * jump
            })
            .collect();
        let all = receiver(normal.to_array());
        let first = usize::from(self.quality.receiver == Receiver::Plane);
        let terms = self.shares.iter().flatten().flatten().filter(|share| **share > 1e-9).count();
        let mut sum = 0.0;
        for ((l, _), rows) in bands(self.quality.light_order()).zip(&self.shares) {
            let [light, off] = coefficient(sphere, l);
            for (row, shares) in rows.iter().enumerate() {
                let polynomial = all[first + row].abs() + 6.0 * error.normal();
                let turned = 6.0 * error.normal() + (8.0 + terms as f64) * EPSILON * polynomial;
                for (k, share) in shares.iter().enumerate() {
                    let (value, of_visibility) = (visibility[k].abs(), of_visibility[k]);
                    let of_parts = light * of_visibility + off * (value + of_visibility);
                    sum += share * (polynomial * of_parts + turned * light * value);
                }
            }
        }
        sum
    }
}

/// The largest magnitude of a coefficient of band l of a sphere, and its error.
///
/// A cap of half-angle a has 2π √((2l+1)/4π) sin²a P_l'(cos a)/(l(l+1)) about its axis, P_l' ≤ l(l+1)/2. Its sine
/// errs by δ = 6 ε + 4 ε (1 + H/d) of itself (as [`SphereGeometry::tolerance`] has the place), its cosine by
/// min(sin² δ/cos, √(2 δ)), by which P_l' moves (l-1)(l+2)/4 of its largest, or band 0 by its own; recurrences by
/// 40 ε. Turned to an axis that errs by the place it changes by l of itself, whose harmonics err by 30 ε.
fn coefficient(sphere: &SphereGeometry, l: usize) -> [f64; 2] {
    let SphereGeometry { distance_m: d, radius_m: r, largest_m, .. } = *sphere;
    let band = 2.0 * PI * ((2 * l + 1) as f64 / (4.0 * PI)).sqrt();
    let place = 4.0 * EPSILON * (1.0 + largest_m / d.max(1e-3 * r));
    let (sin, of_sin) = ((r / d).min(1.0), 6.0 * EPSILON + place);
    if d < r {
        // The whole sphere, in band 0 alone.
        let whole = if l == 0 { 2.0 * band } else { 0.0 };
        return [whole, 40.0 * EPSILON * whole];
    }
    let cos = ((1.0 - sin) * (1.0 + sin)).sqrt();
    let of_cos = (sin * sin * of_sin / cos.max(1e-30)).min((2.0 * of_sin).sqrt());
    let largest = band * sin * sin * if l == 0 { 1.0 } else { 0.5 };
    let moved = if l == 0 { 1.0 } else { ((l - 1) * (l + 2)) as f64 / 4.0 + 1.0 };
    let relative = 2.0 * of_sin + moved * of_cos + l as f64 * place + 70.0 * EPSILON;
    [largest, largest * relative]
}

/// Slope of the surface's horizon up to a sphere light, against its CPU reference: as [`SphereGeometry::tolerance`] has it, and an end that
/// errs by 16 ε, and by what a difference of distance and radius leaves of its own, of itself, across which it
/// changes by two slopes of R / c at most.
pub fn device_surface_within(sphere: &SphereGeometry) -> f64 {
    let SphereGeometry { distance_m: d, radius_m: r, largest_m, .. } = *sphere;
    let left = 4.0 * EPSILON * (d + largest_m) / (d - r).abs().max(1e-30);
    (108.0 * EPSILON + 2.0 * (16.0 * EPSILON + left).min(1.0)) * sphere.relief_m / sphere.cell_m
}

/// The same of a pyramid's, whose march errs by `pyramid` from given levels: a direction, places and an end as of
/// the surface; and the end in samples of k an octave by k times 3 ulp of a logarithm of 16 at most and 2⁻²¹, across
/// each of which a spline of angles changes by π at most.
pub fn device_pyramid_within(
    sphere: &SphereGeometry,
    pyramid: f64,
    slope: f64,
    level_step: u32,
) -> f64 {
    let end = f64::from(level_step) * (3.0 * 16.0 * EPSILON + 2.0_f64.powi(-21)) * PI;
    let slopes = pyramid + device_surface_within(sphere);
    let steepest = slope.abs() + slopes;
    slopes + end * (1.0 + steepest * steepest)
}

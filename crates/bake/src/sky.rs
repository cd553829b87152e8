//! Unoccluded shares of the sky, cosine-weighted and by solid angle, and the bent normal.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{HorizonMap, Ray};
use ridgelight_cpu::light::slice;

/// Cosine-weighted unoccluded share of the hemisphere about the *normal*: 1/π ∫ V max(N·e, 0) de.
///
/// It is the exit radiance of a surface of albedo 1 under a uniform sky of radiance 1. Known
/// values: an unoccluded tilted plane has 1 with an `open` border, which lets light in from below
/// horizontal, and (1 + cos tilt)/2 with `plane`. The centre of a basin with a rim at elevation b
/// has cos²b. The foot of an infinite wall of elevation b has (1 + cos b)/2.
pub struct SkyView;

impl HorizonMap for SkyView {
    fn sums(&self) -> usize {
        1
    }

    fn azimuth_factors(&self, ray: Ray) -> Vec<f64> {
        let (sin, cos) = ray.azimuth_rad.sin_cos();
        vec![cos, sin, ray.width_rad]
    }

    fn add(&self, factors: &[f64], normal: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        // Along the azimuth N·e = a cos ω + b sin ω, positive above the elevation of the tangent
        // plane.
        let (a, b) = (normal.x * factors[0] + normal.y * factors[1], normal.z);
        let low = elevation_rad.max((-a).atan2(b));
        sums[0] += factors[2] / PI * slice(a, b, low, FRAC_PI_2);
    }
}

/// Unoccluded share of the upper hemisphere's solid angle: 1/2π ∫ V de over elevations above
/// horizontal. This is the mean over azimuths of 1 - sin(horizon), horizons below horizontal
/// counted as 0.
///
/// The normal is ignored. Basin of elevation b: 1 - sin b. At the foot of an infinite wall of
/// elevation b, whose horizon is atan(tan b cos φ) towards it: 1 - b/π.
pub struct VisibleSky;

impl HorizonMap for VisibleSky {
    fn sums(&self) -> usize {
        1
    }

    fn azimuth_factors(&self, ray: Ray) -> Vec<f64> {
        vec![ray.width_rad / TAU]
    }

    fn add(&self, factors: &[f64], _: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        // 1 - sin ω without cancellation near the zenith.
        let above = 2.0 * (0.5 * (FRAC_PI_2 - elevation_rad.max(0.0))).sin().powi(2);
        sums[0] += factors[0] * above;
    }
}

/// Mean unoccluded direction, and the half-angle of a cone with the unoccluded solid angle.
///
/// All directions have the same weight. Only the horizon occludes; the surface normal does not.
/// Values: the unit vector along ∫ V e de (x east, y north, z up; the zenith where nothing is
/// unoccluded), and the half-angle a, radians. The cone's solid angle 2π (1 - cos a) is the
/// unoccluded solid angle. Without occlusion: (0, 0, 1) and π/2. With an `open` border, directions
/// below horizontal count too, and a may exceed π/2.
pub struct BentNormal;

impl HorizonMap for BentNormal {
    fn sums(&self) -> usize {
        4
    }

    fn azimuth_factors(&self, ray: Ray) -> Vec<f64> {
        let (sin, cos) = ray.azimuth_rad.sin_cos();
        vec![ray.width_rad * cos, ray.width_rad * sin, ray.width_rad]
    }

    fn add(&self, factors: &[f64], _: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        // From h to the zenith, with q = π/2 - h: ∫ cos²ω dω = q/2 - sin 2q/4, ∫ sin ω cos ω dω = sin²q/2,
        // ∫ cos ω dω = 1 - sin h = 2 sin²(q/2).
        let above = FRAC_PI_2 - elevation_rad;
        let level = 0.5 * above - 0.25 * (2.0 * above).sin();
        sums[0] += factors[0] * level;
        sums[1] += factors[1] * level;
        sums[2] += factors[2] * 0.5 * above.sin().powi(2);
        sums[3] += factors[2] * 2.0 * (0.5 * above).sin().powi(2);
    }

    fn end(&self, _: DVec3, sums: &[f64], values: &mut [f64]) {
        let mean = DVec3::new(sums[0], sums[1], sums[2]).try_normalize().unwrap_or(DVec3::Z);
        // Ω = 2π (1 - cos a) = 4π sin²(a/2).
        let share = (sums[3] / (2.0 * TAU)).clamp(0.0, 1.0);
        values.copy_from_slice(&[mean.x, mean.y, mean.z, 2.0 * share.sqrt().asin()]);
    }
}

//! The bent normal.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

use super::{HorizonMap, Ray};

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

    fn values(&self) -> usize {
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

//! The middle of what is free.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, TAU};

use super::{Ray, Sum};

/// The mean direction of all that is free above the horizon, and the cone about it that is as large.
///
/// Directions are weighted alike, and what hides them is the horizon alone: the normal has no part in it. Values: the
/// unit vector along ∫ V e de (x east, y north, z up; the zenith where nothing is free), and the half-angle a, radians,
/// of the cone whose solid angle 2π (1 - cos a) is that of all that is free. Nothing hidden: (0, 0, 1) and π/2; below
/// horizontal, where the border is `open`, directions are free, too, and a may pass π/2.
pub struct BentNormal;

impl Sum for BentNormal {
    fn sums(&self) -> usize {
        4
    }

    fn values(&self) -> usize {
        4
    }

    fn turn(&self, ray: Ray) -> Vec<f64> {
        let (sin, cos) = ray.azimuth_rad.sin_cos();
        vec![ray.width_rad * cos, ray.width_rad * sin, ray.width_rad]
    }

    fn add(&self, turn: &[f64], _: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        // From h to the zenith, with q = π/2 - h: ∫ cos²ω dω = q/2 - sin 2q/4, ∫ sin ω cos ω dω = sin²q/2,
        // ∫ cos ω dω = 1 - sin h = 2 sin²(q/2).
        let above = FRAC_PI_2 - elevation_rad;
        let level = 0.5 * above - 0.25 * (2.0 * above).sin();
        sums[0] += turn[0] * level;
        sums[1] += turn[1] * level;
        sums[2] += turn[2] * 0.5 * above.sin().powi(2);
        sums[3] += turn[2] * 2.0 * (0.5 * above).sin().powi(2);
    }

    fn end(&self, _: DVec3, sums: &[f64], values: &mut [f64]) {
        let mean = DVec3::new(sums[0], sums[1], sums[2]).try_normalize().unwrap_or(DVec3::Z);
        // Ω = 2π (1 - cos a) = 4π sin²(a/2).
        let share = (sums[3] / (2.0 * TAU)).clamp(0.0, 1.0);
        values.copy_from_slice(&[mean.x, mean.y, mean.z, 2.0 * share.sqrt().asin()]);
    }
}

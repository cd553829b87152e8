//! Shares of the sky: as light on the ground, and as solid angle.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{Ray, Sum};
use ridgelight_cpu::light::slice;

/// The cosine-weighted share of the hemisphere about the sample's *normal* that is free: 1/π ∫ V max(N·e, 0) de.
///
/// It is the exit radiance that a uniform sky of radiance 1 gives to a surface of albedo 1. A free tilted plane
/// that sees below horizontal (`open`) has 1; under `plane`, where the ground goes on, (1 + cos tilt)/2; the middle
/// of a basin with a rim at elevation b cos²b; the foot of an infinite wall of elevation b (1 + cos b)/2.
pub struct SkyView;

impl Sum for SkyView {
    fn sums(&self) -> usize {
        1
    }

    fn values(&self) -> usize {
        1
    }

    fn turn(&self, ray: Ray) -> Vec<f64> {
        let (sin, cos) = ray.azimuth_rad.sin_cos();
        vec![cos, sin, ray.width_rad]
    }

    fn add(&self, turn: &[f64], normal: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        // Along the azimuth N·e = a cos ω + b sin ω, above 0 from the elevation of the normal's plane on.
        let (a, b) = (normal.x * turn[0] + normal.y * turn[1], normal.z);
        let low = elevation_rad.max((-a).atan2(b));
        sums[0] += turn[2] / PI * slice(a, b, low, FRAC_PI_2);
    }

    fn end(&self, _: DVec3, sums: &[f64], values: &mut [f64]) {
        values[0] = sums[0];
    }
}

/// The unweighted share of the upper hemisphere's solid angle that is free: 1/2π ∫ over elevations above horizontal of V
/// de, which is the mean over azimuths of 1 - sin(horizon), horizons below horizontal counted as 0.
///
/// The normal has no part in it. Basin of elevation b: 1 - sin b. At the foot of an infinite wall of elevation b, whose
/// horizon is atan(tan b cos φ) towards it: 1 - b/π.
pub struct VisibleSky;

impl Sum for VisibleSky {
    fn sums(&self) -> usize {
        1
    }

    fn values(&self) -> usize {
        1
    }

    fn turn(&self, ray: Ray) -> Vec<f64> {
        vec![ray.width_rad / TAU]
    }

    fn add(&self, turn: &[f64], _: DVec3, elevation_rad: f64, sums: &mut [f64]) {
        // 1 - sin ω, which is no difference of nearly equal numbers near the zenith.
        let above = 2.0 * (0.5 * (FRAC_PI_2 - elevation_rad.max(0.0))).sin().powi(2);
        sums[0] += turn[0] * above;
    }

    fn end(&self, _: DVec3, sums: &[f64], values: &mut [f64]) {
        values[0] = sums[0];
    }
}

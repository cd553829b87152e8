use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::scene::lights::{ANGLE, RADIANCES, is_angle, is_valid_radiance, within};
use crate::{Error, Result};

/// A patch of uniform radiance at infinity between two azimuths and two elevations: a window, or a bright part of the
/// sky (Nowrouzezahrai & Snyder 2009, §6).
///
/// Its part below horizontal gives light under an `open` border only.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeyLight {
    /// Direction of its centre in the plane, radians counter-clockwise from east.
    pub azimuth_rad: f64,
    /// Extent in azimuth, radians, above 0 up to 2π; 2π rounded to f32 counts as 2π.
    pub width_rad: f64,
    /// Its lowest and its highest elevation, radians, [-π/2..π/2]; ±π/2 rounded to f32 count as ±π/2.
    pub elevations_rad: [f64; 2],
    /// Radiance, linear RGB.
    pub radiance: [f32; 3],
}

/// Smallest height of a key light, radians: f32 rounds each of its edges by 6e-8.
const LOWEST_RAD: f64 = 1e-5;

/// Width of a key light with as many slices as the setting: 25°. For a key light 50° wide over Mt Washington with
/// border `plane`, 16 slices instead of 8 reduce the error from 0.203 % to 0.079 % (defaults.txt in benches/results at commit
/// d23f9d59). For one 4° wide, 4 slices instead of 8 change it from 0.043 % to 0.050 %, in 0.64 times the time (at commit
/// 007ec15a).
const SLICED_RAD: f64 = 25.0 * PI / 180.0;

impl KeyLight {
    /// This light, with the exact limit in place of each limit rounded to f32: such an angle is in range and counts as the
    /// limit.
    pub(crate) fn clamped(&self) -> Self {
        Self {
            width_rad: within(self.width_rad, TAU),
            elevations_rad: self.elevations_rad.map(|rad| within(rad, FRAC_PI_2)),
            ..*self
        }
    }

    /// Checks every range; `number` counts from 1.
    pub(in crate::scene) fn check(&self, number: usize) -> Result<()> {
        let bad = |what: &str, found: String, expected: &str| {
            Err(Error::setting(format!("key {number}: {what}"), found, expected))
        };
        // Without the rounding of degrees to radians and back.
        let degrees = |rad: f64| format!("{}°", (rad.to_degrees() * 1e9).round() / 1e9);
        let Self { azimuth_rad, width_rad, elevations_rad: [low, high], radiance } = self.clamped();
        if !is_angle(azimuth_rad) {
            return bad("azimuth", azimuth_rad.to_string(), ANGLE);
        }
        if !(width_rad > 0.0 && width_rad <= TAU) {
            return bad("width", degrees(width_rad), "an angle above 0°, up to 360°");
        }
        if !(low >= -FRAC_PI_2 && low < high && high <= FRAC_PI_2) {
            let found = format!("{} to {}", degrees(low), degrees(high));
            return bad("elevations", found, "a lower and a higher one, from -90° to 90°");
        }
        if high - low < LOWEST_RAD {
            let found = format!("{} to {}", degrees(low), degrees(high));
            return bad("elevations", found, "0.0006° between them at least: f32 resolves no less");
        }
        if !is_valid_radiance(&radiance) {
            return bad("radiance", format!("{radiance:?}"), RADIANCES);
        }
        Ok(())
    }

    /// Number of slices for a setting: the setting times width / 25°, clamped to between half and four times the setting, rounded, and
    /// at least 1. At the default, lights up to 12.5° wide have 4, and lights of 100° and wider 32, as many as a sky has azimuths.
    pub fn slices(&self, setting: u32) -> u32 {
        let times = (self.clamped().width_rad / SLICED_RAD).clamp(0.5, 4.0);
        (f64::from(setting) * times).round().max(1.0) as u32
    }

    /// Irradiance of unoccluded level ground at radiance 1: ∫∫ sin ω cos ω dω dφ = width (sin²high - sin²low) / 2, of the
    /// part above horizontal.
    pub fn level_irradiance(&self) -> f64 {
        let Self { width_rad, elevations_rad, .. } = self.clamped();
        let [low, high] = elevations_rad.map(|e| e.max(0.0).sin().powi(2));
        width_rad * (high - low) / 2.0
    }
}

#[cfg(test)]
mod tests {
    use std::f32;

    use super::*;
    use crate::scene::Lights;

    /// Up to f32's π/2 and 2π.
    #[test]
    fn limits_of_a_key_light_may_be_rounded_to_f32() {
        let [right, turn] = [f32::consts::FRAC_PI_2, f32::consts::TAU].map(f64::from);
        let of = |right: f64, width_rad: f64| KeyLight {
            azimuth_rad: 0.3,
            width_rad,
            elevations_rad: [-right, right],
            radiance: [1.0; 3],
        };
        let (rounded, exact) = (of(right, turn), of(FRAC_PI_2, TAU));
        assert_ne!(rounded, exact);
        rounded.check(1).expect("in range");
        assert_eq!(rounded.clamped(), exact);
        assert_eq!(rounded.level_irradiance(), exact.level_irradiance());
        assert_eq!(exact.clamped(), exact);
    }

    #[test]
    fn an_error_names_the_key_light_that_is_out_of_range() {
        let elevations_rad = [-FRAC_PI_2, FRAC_PI_2];
        let good =
            KeyLight { azimuth_rad: -9.0, width_rad: TAU, elevations_rad, radiance: [0.0; 3] };
        let of = |key| Lights { keys: vec![good, key], ..Lights::default() }.check();
        assert!(of(good).is_ok());
        let between = |low, high| KeyLight { elevations_rad: [low, high], ..good };
        for (key, what) in [
            (KeyLight { azimuth_rad: f64::NAN, ..good }, "azimuth"),
            (KeyLight { width_rad: 0.0, ..good }, "width"),
            (KeyLight { width_rad: f64::NAN, ..good }, "width"),
            (KeyLight { width_rad: 6.3, ..good }, "width"),
            (between(0.5, 0.5), "elevations"),
            (between(0.5, 0.2), "elevations"),
            (KeyLight { width_rad: f64::from(f32::consts::TAU.next_up()), ..good }, "width"),
            (between(-1.6, 0.2), "elevations"),
            (between(0.2, 1.6), "elevations"),
            (between(0.2, f64::from(f32::consts::FRAC_PI_2.next_up())), "elevations"),
            (between(f64::NAN, 0.2), "elevations"),
            (between(0.2, f64::NAN), "elevations"),
            (KeyLight { radiance: [1.0, -1.0, 0.0], ..good }, "radiance"),
            (KeyLight { radiance: [f32::INFINITY; 3], ..good }, "radiance"),
        ] {
            let message = of(key).unwrap_err().to_string();
            assert!(message.starts_with(&format!("key 2: {what}: ")), "{message}");
        }
    }

    #[test]
    fn a_key_light_has_slices_by_its_width() {
        let of = |degrees: f64, setting| {
            let elevations_rad = [0.1, 0.2];
            let width_rad = degrees.to_radians();
            KeyLight { azimuth_rad: 0.0, width_rad, elevations_rad, radiance: [1.0; 3] }
                .slices(setting)
        };
        let degrees = [0.1, 12.5, 18.0, 25.0, 50.0, 75.0, 100.0, 360.0];
        assert_eq!(degrees.map(|w| of(w, 8)), [4, 4, 6, 8, 16, 24, 32, 32]);
        assert_eq!([0.1, 25.0, 40.0, 360.0].map(|w| of(w, 1)), [1, 1, 2, 4]);
        assert_eq!(of(0.1, 0), 1);
        assert_eq!(of(360.0, 256), 1024);
        assert_eq!(of(360.0, 8), crate::scene::Quality::default().azimuths);
    }

    /// The upper hemisphere gives π, like a uniform sky. The part below horizontal gives nothing.
    #[test]
    fn the_whole_hemisphere_gives_pi() {
        let all = |low| KeyLight {
            azimuth_rad: 0.0,
            width_rad: TAU,
            elevations_rad: [low, FRAC_PI_2],
            radiance: [1.0; 3],
        };
        for low in [0.0, -0.3, -FRAC_PI_2] {
            assert!((all(low).level_irradiance() - std::f64::consts::PI).abs() < 1e-15, "{low}");
        }
        let sunk = KeyLight { elevations_rad: [-0.5, -0.1], ..all(0.0) };
        assert_eq!(sunk.level_irradiance(), 0.0);
    }
}

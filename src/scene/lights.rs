use super::{Environment, KeyLight};
use crate::{Error, Result};

/// Everything that shines on the field. Nothing here is nothing lit.
///
/// Radiance and irradiance are linear RGB in one unit of the caller's, each [0..1e36]: exit radiance comes out in the
/// same. Level ground of albedo 1 has exit radiance 1 under a sky of radiance 1, and under a sun in the zenith of
/// irradiance π.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    /// A uniform sky's radiance, linear RGB.
    pub sky: Option<[f32; 3]>,
    /// An environment at infinity.
    pub environment: Option<Environment>,
    /// Suns: discs at infinity.
    pub suns: Vec<Sun>,
    /// Key lights: patches at infinity.
    pub keys: Vec<KeyLight>,
    /// Balls of light near the field.
    pub spheres: Vec<SphereLight>,
}

/// A disc of uniform radiance at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Direction of the centre in the plane, radians counter-clockwise from east.
    pub azimuth_rad: f64,
    /// Elevation of the centre above horizontal, radians, [0..π/2].
    pub elevation_rad: f64,
    /// Angular diameter, radians, [0..π/2]; below [`POINT_DIAMETER_RAD`] a point with hard shadows.
    pub diameter_rad: f64,
    /// Irradiance on a surface that faces it, unoccluded, linear RGB.
    pub irradiance: [f32; 3],
}

/// A ball of uniform radiance near the field, or with its middle inside the ground.
///
/// Only what stands between a place and the ball hides it; the ball itself hides nothing, neither the
/// sky behind it nor other lights. A place inside it receives its radiance from every direction
/// that the surface leaves free up to where the ball ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereLight {
    /// Centre: x east from the westernmost column, y north from the southernmost row, z up, absolute
    /// like the file's heights; the field's length unit.
    pub position_m: [f64; 3],
    /// Radius, above 0, in the same unit.
    pub radius_m: f64,
    /// Radiance that it gives off, linear RGB.
    pub radiance: [f32; 3],
}

impl SphereLight {
    /// How many vertical slices a ball is cut into where it is narrow as seen from a sample, and where it
    /// is all around, for a setting.
    ///
    /// Narrow: the setting, but no more than eight a cell that the ball is wide, as the surface is flat within
    /// a cell; at least 4. Around: eight times the setting, at the default as many as a sky has azimuths.
    pub fn slices(&self, setting: u32, cell_m: [f64; 2]) -> [u32; 2] {
        let cells_wide = 2.0 * self.radius_m / cell_m[0].min(cell_m[1]);
        let most = (8.0 * cells_wide).ceil().clamp(4.0, 1e4) as u32;
        [setting.min(most), 8 * setting]
    }
}

/// The farthest that a local light may stand and the largest that it may be, as for heights.
const PLACE_LIMIT: f64 = 1e15;

/// Angular diameter below which a disc is lit as a point, radians: 0.01°. Its penumbra is 9 cm wide at
/// half a kilometre, and the f32 slopes of its limbs would no longer tell its chords' widths.
pub const POINT_DIAMETER_RAD: f64 = 1.75e-4;

/// The largest radiance or irradiance of a light: what lobes and series make of it is within f32.
const BRIGHTEST: f32 = 1e36;
pub(super) const RADIANCES: &str = "numbers from 0 to 1e36";

/// Whether a light may be so bright.
pub(super) fn shines(colour: &[f32; 3]) -> bool {
    colour.iter().all(|v| (0.0..=BRIGHTEST).contains(v))
}

pub(super) const ANGLE: &str = "an angle within ±1e6 radians";

/// Whether so many turns leave digits for the direction.
pub(super) fn is_angle(rad: f64) -> bool {
    rad.abs() <= 1e6
}

impl Sun {
    /// Whether it is lit as a point: lit or not, nothing between.
    pub fn is_point(&self) -> bool {
        self.diameter_rad < POINT_DIAMETER_RAD
    }
}

impl Lights {
    /// Whether some are lit in slices: suns that are no points, key lights, balls of light.
    pub fn have_slices(&self) -> bool {
        let have_others = !self.keys.is_empty() || !self.spheres.is_empty();
        have_others || self.suns.iter().any(|s| !s.is_point())
    }

    /// Checks every range.
    ///
    /// # Errors
    /// The first value out of range, by name.
    pub fn check(&self) -> Result<()> {
        if let Some(sky) = &self.sky
            && !shines(sky)
        {
            return Err(Error::setting("sky radiance", format!("{sky:?}"), RADIANCES));
        }
        for (i, sun) in self.suns.iter().enumerate() {
            let bad = |what: &str, found: String, expected: &str| {
                Err(Error::setting(format!("sun {}: {what}", i + 1), found, expected))
            };
            let half_turn = std::f64::consts::FRAC_PI_2;
            if !is_angle(sun.azimuth_rad) {
                return bad("azimuth", sun.azimuth_rad.to_string(), ANGLE);
            }
            if !(0.0..=half_turn).contains(&sun.elevation_rad) {
                return bad(
                    "elevation",
                    format!("{}°", sun.elevation_rad.to_degrees()),
                    "0° to 90°",
                );
            }
            if !(0.0..=half_turn).contains(&sun.diameter_rad) {
                return bad(
                    "angular diameter",
                    format!("{}°", sun.diameter_rad.to_degrees()),
                    "0° to 90°",
                );
            }
            if !shines(&sun.irradiance) {
                return bad("irradiance", format!("{:?}", sun.irradiance), RADIANCES);
            }
        }
        for (i, key) in self.keys.iter().enumerate() {
            key.check(i + 1)?;
        }
        for (i, sphere) in self.spheres.iter().enumerate() {
            let bad = |what: &str, found: String, expected: &str| {
                Err(Error::setting(format!("light {}: {what}", i + 1), found, expected))
            };
            let SphereLight { position_m, radius_m, radiance } = sphere;
            if !position_m.iter().all(|v| v.abs() <= PLACE_LIMIT) {
                return bad("position", format!("{position_m:?}"), "finite numbers within ±1e15");
            }
            if !(*radius_m > 0.0 && *radius_m <= PLACE_LIMIT) {
                return bad("radius", radius_m.to_string(), "a length above 0, up to 1e15");
            }
            if !shines(radiance) {
                return bad("radiance", format!("{radiance:?}"), RADIANCES);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_light_out_of_range_is_named() {
        let good = SphereLight { position_m: [1.0, -2.0, 9e3], radius_m: 1e-6, radiance: [0.0; 3] };
        let of = |sphere| Lights { spheres: vec![good, sphere], ..Lights::default() }.check();
        assert!(of(good).is_ok());
        let far = [f64::NAN, 0.0, 0.0];
        for (sphere, what) in [
            (SphereLight { position_m: far, ..good }, "position"),
            (SphereLight { position_m: [0.0, 0.0, 1e16], ..good }, "position"),
            (SphereLight { radius_m: 0.0, ..good }, "radius"),
            (SphereLight { radius_m: f64::NAN, ..good }, "radius"),
            (SphereLight { radiance: [1.0, -1.0, 0.0], ..good }, "radiance"),
            (SphereLight { radiance: [f32::INFINITY; 3], ..good }, "radiance"),
        ] {
            let said = of(sphere).unwrap_err().to_string();
            assert!(said.starts_with(&format!("light 2: {what}: ")), "{said}");
        }
    }
}

pub(super) mod key;
pub(super) use super::{Environment, KeyLight};
use crate::{Error, Result};

/// All light sources of a scene. All fields may be empty.
///
/// Radiance and irradiance are linear RGB, each [0..1e36], in one unit that the caller chooses. Exit radiance has the
/// same unit. Level ground of albedo 1 has exit radiance 1 under a sky of radiance 1, and under a zenith sun of
/// irradiance π.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    /// Radiance of a uniform sky, linear RGB.
    pub sky: Option<[f32; 3]>,
    /// An environment at infinity.
    pub environment: Option<Environment>,
    /// Suns: discs at infinity.
    pub suns: Vec<Sun>,
    /// Key lights: patches at infinity.
    pub keys: Vec<KeyLight>,
    /// Sphere lights near the field.
    pub sphere_lights: Vec<SphereLight>,
}

/// A disc of uniform radiance at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Direction of the centre in the plane, radians counter-clockwise from east.
    pub azimuth_rad: f64,
    /// Elevation of the centre above horizontal, radians, [0..π/2].
    pub elevation_rad: f64,
    /// Angular diameter, radians, [0..π/2]; below 0.01° (1.75e-4) a point with hard shadows.
    pub diameter_rad: f64,
    /// Irradiance on a surface that faces it, unoccluded, linear RGB.
    pub irradiance: [f32; 3],
}

/// A sphere of uniform radiance near the field. Its centre may lie inside the ground.
///
/// The surface between a texel and the sphere occludes it. The sphere occludes nothing, neither the sky behind it nor
/// other lights. A texel inside the sphere receives its radiance from every unoccluded direction, up to where the
/// sphere ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereLight {
    /// Centre, in the field's length unit: x east from the westernmost column, y north from the southernmost row, z up
    /// and absolute, like the heights of the file.
    pub position_m: [f64; 3],
    /// Radius, above 0, in the field's length unit.
    pub radius_m: f64,
    /// Radiance that it gives off, linear RGB.
    pub radiance: [f32; 3],
}

impl SphereLight {
    /// Vertical slices for a setting: first where the sphere is narrow from a texel, then where it surrounds the texel.
    ///
    /// Narrow: the setting, but at most eight per cell of the sphere's width, as the surface is flat within a cell; at
    /// least 4. Surrounding: eight times the setting. At the default this equals the azimuths of a sky.
    pub fn slices(&self, setting: u32, cell_m: [f64; 2]) -> [u32; 2] {
        let cells_wide = 2.0 * self.radius_m / cell_m[0].min(cell_m[1]);
        let most = (8.0 * cells_wide).ceil().clamp(4.0, 1e4) as u32;
        [setting.min(most), 8 * setting]
    }
}

/// Largest coordinate and radius of a sphere light, as for heights.
const PLACE_LIMIT: f64 = 1e15;

/// Angular diameter below which a sun is treated as a point, radians: 0.01°. Its penumbra is 9 cm wide at half a
/// kilometre. The f32 slopes of its limbs would no longer resolve the widths of its chords.
pub(super) const POINT_DIAMETER_RAD: f64 = 1.75e-4;

/// Largest radiance or irradiance of a light: products with Phong specular and SH series stay within f32.
const BRIGHTEST: f32 = 1e36;
pub(super) const RADIANCES: &str = "numbers from 0 to 1e36";

/// Whether a radiance or an irradiance is in range.
pub(super) fn is_valid_radiance(colour: &[f32; 3]) -> bool {
    colour.iter().all(|v| (0.0..=BRIGHTEST).contains(v))
}

pub(super) const ANGLE: &str = "an angle within ±1e6 radians";

/// Whether f64 keeps enough digits for the direction.
pub(super) fn is_angle(rad: f64) -> bool {
    rad.abs() <= 1e6
}

impl Sun {
    /// Whether it is treated as a point: visible or not, without a penumbra.
    pub fn is_point(&self) -> bool {
        self.diameter_rad < POINT_DIAMETER_RAD
    }
}

impl Lights {
    /// Checks every range.
    ///
    /// # Errors
    /// The first value out of range, by name.
    pub fn check(&self) -> Result<()> {
        if let Some(sky) = &self.sky
            && !is_valid_radiance(sky)
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
            if !is_valid_radiance(&sun.irradiance) {
                return bad("irradiance", format!("{:?}", sun.irradiance), RADIANCES);
            }
        }
        for (i, key) in self.keys.iter().enumerate() {
            key.check(i + 1)?;
        }
        for (i, sphere) in self.sphere_lights.iter().enumerate() {
            let bad = |what: &str, found: String, expected: &str| {
                Err(Error::setting(format!("sphere light {}: {what}", i + 1), found, expected))
            };
            let SphereLight { position_m, radius_m, radiance } = sphere;
            if !position_m.iter().all(|v| v.abs() <= PLACE_LIMIT) {
                return bad("position", format!("{position_m:?}"), "finite numbers within ±1e15");
            }
            if !(*radius_m > 0.0 && *radius_m <= PLACE_LIMIT) {
                return bad("radius", radius_m.to_string(), "a length above 0, up to 1e15");
            }
            if !is_valid_radiance(radiance) {
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
    fn an_error_names_the_light_that_is_out_of_range() {
        let good = SphereLight { position_m: [1.0, -2.0, 9e3], radius_m: 1e-6, radiance: [0.0; 3] };
        let of = |sphere| Lights { sphere_lights: vec![good, sphere], ..Lights::default() }.check();
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
            let message = of(sphere).unwrap_err().to_string();
            assert!(message.starts_with(&format!("sphere light 2: {what}: ")), "{message}");
        }
    }
}

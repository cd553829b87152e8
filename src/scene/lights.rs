pub(super) mod key;
use std::f64::consts::FRAC_PI_2;

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
    /// Elevation of the centre above horizontal, radians, [0..π/2]; π/2 rounded to f32 counts as π/2.
    pub elevation_rad: f64,
    /// Angular diameter, radians, [0..π/2] like the elevation; below 0.01° (1.75e-4) a point with hard shadows.
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

/// A type of light near the field: its name, how it is shaded and what supports it. The planner's messages, labels, checks
/// and refusals follow.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct NearType {
    /// In messages, before its number.
    pub(crate) name: &'static str,
    /// What `sphere_shade` does for it, as plans print it.
    pub(crate) shaded_by: &'static str,
    /// Whether Phong specular reflects it. The planner refuses it with specular otherwise.
    pub(crate) has_specular: bool,
    /// Whether its light has a series. `light_basis sh` becomes `exact` otherwise.
    pub(crate) has_series: bool,
    /// Whether the path-traced reference includes it. The reference refuses it otherwise.
    pub(crate) has_paths: bool,
}

/// What a scene without lights lacks.
pub(crate) const ANY_LIGHT: &str =
    "at least one of sky, environment, sun, key light and sphere light";

/// Sphere lights.
pub(crate) const SPHERE_LIGHT: NearType = NearType {
    name: "sphere light",
    shaded_by: "slices of the sphere light above the horizon",
    has_specular: true,
    has_series: true,
    has_paths: true,
};

/// A light near the field, as all passes and checks take it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearLight {
    /// Its type.
    pub(crate) of: &'static NearType,
    /// Its position among the scene's lights of its type, from 0.
    pub(crate) position: usize,
    /// Place, size and radiance.
    pub sphere: SphereLight,
}

impl NearLight {
    /// Its name in messages: "sphere light 1" is the scene's first.
    pub(crate) fn name(&self) -> String {
        format!("{} {}", self.of.name, self.position + 1)
    }

    /// Its name in labels and layers: "sphere_light1" is the scene's first.
    pub(crate) fn label(&self) -> String {
        format!("{}{}", self.of.name.replace(' ', "_"), self.position + 1)
    }
}

/// The least radius over the distance to the nearest grid point: the elevations of both limbs have an f32 error
/// of 6e-8, an eighth of it.
const NARROWEST: f64 = 5e-7;

impl SphereLight {
    /// The largest of its channels.
    fn strongest(&self) -> f64 {
        f64::from(self.radiance.iter().fold(0.0, |m: f32, v| m.max(*v)))
    }

    /// The most exit radiance that it gives at a distance from its centre, whatever the heights: L (r/d)².
    pub(crate) fn most_at(&self, distance_m: f64) -> f64 {
        self.strongest() * (self.radius_m / distance_m.max(self.radius_m)).powi(2)
    }

    /// Distance from its centre beyond which it gives less than this.
    pub(crate) fn reach_m(&self, exit_radiance: f64) -> f64 {
        match exit_radiance > 0.0 {
            true => self.radius_m * (self.strongest() / exit_radiance).sqrt(),
            false => f64::INFINITY,
        }
    }

    /// The least radius that f32 resolves, where this one is less, from the most that it gives to the nearest grid point.
    pub(crate) fn too_narrow(&self, on_nearest: f64) -> Option<f64> {
        let seems = (on_nearest / self.strongest()).sqrt();
        (seems < NARROWEST).then(|| self.radius_m * NARROWEST / seems)
    }

    /// Vertical slices for a setting: first where the sphere is narrow from a texel, then where it surrounds the texel.
    ///
    /// Narrow: the setting, but at most eight per cell of the sphere's width, as the surface is flat within a cell; at
    /// least 4. Surrounding: eight times the setting. At the default these are twice the azimuths of a sky.
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

/// Returns ±`limit` for an angle that exceeds it by no more than the rounding of `limit` to f32, else the angle. In f32,
/// `asin(1.0)` is 4.4e-8 above π/2.
pub(super) fn within(rad: f64, limit: f64) -> f64 {
    let is_rounded = rad.abs() > limit && rad.abs() <= f64::from(limit as f32);
    if is_rounded { limit.copysign(rad) } else { rad }
}

impl Sun {
    /// This sun, with π/2 in place of π/2 rounded to f32, which is in range and counts as π/2.
    pub(crate) fn clamped(&self) -> Self {
        let [elevation_rad, diameter_rad] =
            [self.elevation_rad, self.diameter_rad].map(|rad| within(rad, FRAC_PI_2));
        Self { elevation_rad, diameter_rad, ..*self }
    }

    /// Whether it is treated as a point: visible or not, without a penumbra.
    pub fn is_point(&self) -> bool {
        self.diameter_rad < POINT_DIAMETER_RAD
    }
}

impl Lights {
    /// The lights near the field, type by type.
    pub fn near(&self) -> impl Iterator<Item = NearLight> {
        let sphere = |(position, sphere): (usize, &SphereLight)| NearLight {
            of: &SPHERE_LIGHT,
            position,
            sphere: *sphere,
        };
        self.sphere_lights.iter().enumerate().map(sphere)
    }

    /// Splits the lights: those near the field, then those at infinity.
    pub fn near_and_far(&self) -> [Self; 2] {
        let mut far = self.clone();
        let sphere_lights = std::mem::take(&mut far.sphere_lights);
        [Self { sphere_lights, ..Self::default() }, far]
    }

    /// The lights near the field moved by so much, east and north.
    pub fn moved(&self, [east_m, north_m]: [f64; 2]) -> Self {
        let mut moved = self.clone();
        for position_m in moved.sphere_lights.iter_mut().map(|sphere| &mut sphere.position_m) {
            position_m[0] += east_m;
            position_m[1] += north_m;
        }
        moved
    }

    /// Without the lights of radiance 0.
    pub fn lit(&self) -> Self {
        let is_lit = |colour: &[f32; 3]| colour.iter().any(|v| *v > 0.0);
        let mut kept = self.clone();
        kept.sky = self.sky.filter(is_lit);
        kept.suns.retain(|sun| is_lit(&sun.irradiance));
        kept.keys.retain(|key| is_lit(&key.radiance));
        kept.sphere_lights.retain(|sphere| is_lit(&sphere.radiance));
        kept
    }

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
            let sun = sun.clamped();
            if !is_angle(sun.azimuth_rad) {
                return bad("azimuth", sun.azimuth_rad.to_string(), ANGLE);
            }
            if !(0.0..=FRAC_PI_2).contains(&sun.elevation_rad) {
                return bad(
                    "elevation",
                    format!("{}°", sun.elevation_rad.to_degrees()),
                    "0° to 90°",
                );
            }
            if !(0.0..=FRAC_PI_2).contains(&sun.diameter_rad) {
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

    /// Up to f32's π/2, but not the next f32.
    #[test]
    fn a_right_angle_of_a_sun_may_be_rounded_to_f32() {
        let rounded = std::f32::consts::FRAC_PI_2;
        assert_eq!(1_f32.asin(), rounded);
        let of = |elevation_rad, diameter_rad| {
            let sun = Sun { azimuth_rad: 0.0, elevation_rad, diameter_rad, irradiance: [1.0; 3] };
            let message = Lights { suns: vec![sun], ..Lights::default() }.check();
            (message.err().map(|e| e.to_string()), sun.clamped())
        };
        let [rounded, above] = [rounded, rounded.next_up()].map(f64::from);
        let exact = of(FRAC_PI_2, FRAC_PI_2);
        assert_eq!(exact.0, None);
        assert_eq!(of(rounded, rounded), exact);
        for (angles, what) in [([above, 0.0], "elevation"), ([0.0, above], "angular diameter")] {
            let message = of(angles[0], angles[1]).0.expect("an error");
            assert!(message.starts_with(&format!("sun 1: {what}: ")), "{message}");
        }
        // `check` must find the angles that are out of range unchanged.
        for angle in [-0.5, 0.0, FRAC_PI_2.next_down(), above, f64::INFINITY] {
            assert_eq!(of(angle, 0.0).1.elevation_rad, angle);
        }
        assert!(of(f64::NAN, 0.0).1.elevation_rad.is_nan());
    }

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

use super::Environment;
use crate::{Error, Result};

/// Everything that shines on the field. Nothing here is nothing lit.
#[derive(Clone, Debug, Default)]
pub struct Lights {
    /// A uniform sky's radiance, linear RGB.
    pub sky: Option<[f32; 3]>,
    /// An environment at infinity.
    pub environment: Option<Environment>,
    /// Suns: discs at infinity.
    pub suns: Vec<Sun>,
}

/// A disc of uniform radiance at infinity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sun {
    /// Direction of the centre in the plane, radians counter-clockwise from east.
    pub azimuth_rad: f64,
    /// Elevation of the centre above horizontal, radians, [0..π/2].
    pub elevation_rad: f64,
    /// Angular diameter, radians, [0..π/2]; 0 is a point with hard shadows.
    pub diameter_rad: f64,
    /// Irradiance on a surface that faces it, unoccluded, linear RGB.
    pub irradiance: [f32; 3],
}

impl Lights {
    /// Checks every range.
    ///
    /// # Errors
    /// The first value out of range, by name.
    pub fn check(&self) -> Result<()> {
        let shines = |c: &[f32; 3]| c.iter().all(|v| v.is_finite() && *v >= 0.0);
        if let Some(sky) = &self.sky
            && !shines(sky)
        {
            return Err(Error::setting(
                "sky radiance",
                format!("{sky:?}"),
                "finite numbers, 0 or more",
            ));
        }
        for (i, sun) in self.suns.iter().enumerate() {
            let bad = |what: &str, found: String, expected: &str| {
                Err(Error::setting(format!("sun {}: {what}", i + 1), found, expected))
            };
            let half_turn = std::f64::consts::FRAC_PI_2;
            if !sun.azimuth_rad.is_finite() {
                return bad("azimuth", sun.azimuth_rad.to_string(), "a finite angle");
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
                return bad(
                    "irradiance",
                    format!("{:?}", sun.irradiance),
                    "finite numbers, 0 or more",
                );
            }
        }
        Ok(())
    }
}

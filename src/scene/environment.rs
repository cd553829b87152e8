use super::Border;
use super::lights::{ANGLE, RADIANCES, is_angle, is_valid_radiance};
use crate::{Error, Result};

/// Radiance from infinity as an equirectangular (latitude-longitude) image, linear RGB.
///
/// The first row touches the zenith, the last the nadir. Column 0 begins at azimuth π (west). Columns run *clockwise*
/// from above, as the image is viewed from inside: its centre is east (+x, azimuth 0), a quarter to the left
/// is north. Texel (row, col) of a `width`×`height` image covers azimuths π - 2π·[col, col+1]/width and zenith
/// angles π·[row, row+1]/height.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    width: usize,
    height: usize,
    texels: Vec<[f32; 3]>,
    rotation_rad: f64,
}

impl Environment {
    /// An environment of `width`×`height` texels, linear RGB, row after row from the zenith, rotated counter-clockwise by
    /// `rotation_rad`, within ±1e6. An image twice as wide as high has square texels at the horizon.
    ///
    /// # Errors
    /// Sizes that do not match; a texel that is negative or not finite, named by row and column.
    pub fn new(
        width: usize,
        height: usize,
        texels: Vec<[f32; 3]>,
        rotation_rad: f64,
    ) -> Result<Self> {
        if width == 0 || height == 0 || width.checked_mul(height) != Some(texels.len()) {
            return Err(Error::setting(
                "environment",
                format!("{} texels for {width} × {height}", texels.len()),
                "width × height texels, at least one",
            ));
        }
        if !is_angle(rotation_rad) {
            return Err(Error::setting("environment rotation", rotation_rad.to_string(), ANGLE));
        }
        if let Some(i) = texels.iter().position(|t| !t.iter().all(|v| v.is_finite() && *v >= 0.0)) {
            return Err(Error::setting(
                format!("environment at row {}, column {}", i / width, i % width),
                format!("{:?}", texels[i]),
                "finite radiance, 0 or more",
            ));
        }
        Ok(Self { width, height, texels, rotation_rad })
    }

    /// An environment whose texels only the device knows. The plan assumes a uniform one, so azimuths are evenly spaced.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn unknown(width: usize, height: usize, rotation_rad: f64) -> Result<Self> {
        Self::new(width, height, vec![[1.0; 3]; width.saturating_mul(height)], rotation_rad)
    }

    /// Texels around the full circle.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Texels from zenith to nadir.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Row-major radiance, linear RGB.
    pub fn texels(&self) -> &[[f32; 3]] {
        &self.texels
    }

    /// Checks that SH series of the radiances stay within f32.
    ///
    /// # Errors
    /// The first texel above 1e36.
    pub(crate) fn check_series(&self) -> Result<()> {
        let Some(i) = self.texels.iter().position(|t| !is_valid_radiance(t)) else { return Ok(()) };
        Err(Error::setting(
            format!("environment at row {}, column {}", i / self.width, i % self.width),
            format!("{:?}", self.texels[i]),
            format!("{RADIANCES} where harmonics are made of them"),
        ))
    }

    /// Counter-clockwise rotation about the vertical, radians.
    pub fn rotation_rad(&self) -> f64 {
        self.rotation_rad
    }

    /// Rows that give light, counted from the zenith: those wholly or partly above horizontal; all rows under an `open`
    /// border.
    pub fn rows_above_ground(&self, border: Border) -> usize {
        match border {
            Border::Open => self.height(),
            Border::Plane | Border::Periodic => self.height().div_ceil(2),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_a_radiance_too_large_for_series() {
        let of = |radiance: f32| {
            let texels = vec![[0.0; 3], [0.0, radiance, 0.0]];
            Environment::new(2, 1, texels, 0.0).unwrap().check_series()
        };
        assert!(of(1e36).is_ok());
        let message = of(1.1e36).unwrap_err().to_string();
        assert!(message.starts_with("environment at row 0, column 1: "), "{message}");
    }
}

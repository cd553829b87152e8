//! The camera.

use clap::Args;

use super::values::{colour, number, numbers, sides};

// A doc comment on this struct or the next would replace the description of a command.
#[derive(Args)]
#[command(next_help_heading = "Camera")]
pub struct EyeArgs {
    /// View from a camera instead of the map
    ///
    /// Without a value the camera stands in the south, 30 degrees above the horizontal. FROM is south, north-east and so on,
    /// "from 45 up 30", or AZ,EL[,DISTANCE]: the compass azimuth and the elevation of the camera from the look-at point,
    /// degrees, and the distance in metres; by default the whole field fits. With --ortho, DISTANCE is the height of the
    /// picture in metres.
    #[arg(long, value_name = "FROM", value_parser = camera, allow_negative_numbers = true, num_args = 0..=1, default_missing_value = "south")]
    pub camera: Option<CameraAt>,
    /// Look-at point, metres. Default the middle of the field
    ///
    /// X is east of the westernmost column, Y north of the southernmost row, Z above height 0. Z defaults to the height of
    /// the nearest texel.
    #[arg(long, value_name = "X,Y[,Z]", value_parser = place, allow_hyphen_values = true, hide_short_help = true, requires = "camera")]
    pub look_at: Option<LookAt>,
    /// Vertical field of view, degrees
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 40.0,
        value_parser = number::<f64>("an angle, degrees"),
        hide_short_help = true,
        requires = "camera"
    )]
    pub fov: f64,
    /// Orthographic projection
    #[arg(long, hide_short_help = true, requires = "camera", conflicts_with = "fov")]
    pub ortho: bool,
    /// Width and height of the picture, pixels
    #[arg(long, value_name = "WxH", default_value = "2048x1152", value_parser = size, allow_hyphen_values = true, requires = "camera")]
    pub size: Size,
    /// Depth of a plinth under the field, as a share of its longer side; 0 draws none [default: 0.04 in a .png]
    ///
    /// The plinth has walls from the field's edges down to a level base, SHARE of the longer side below the lowest height.
    /// Its light is not computed, and it has no depths. By default a .png has one, unless the camera is below the horizontal,
    /// and an .exr has none. A camera without DISTANCE leaves room for it in both: they have the same ground in the same
    /// pixels.
    #[arg(
        long,
        value_name = "SHARE",
        value_parser = number::<f32>("a share from 0 to 1"),
        hide_short_help = true,
        requires = "camera"
    )]
    pub plinth: Option<f32>,
}

#[derive(Args)]
pub struct CameraArgs {
    #[command(flatten)]
    pub eye: EyeArgs,
    /// MSAA samples per pixel: 1, 2, 4 or 8
    ///
    /// Fewer are faster and leave jagged edges. The device must support the number.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 4,
        value_parser = number::<u32>("a whole number: 1, 2, 4 or 8"),
        hide_short_help = true,
        requires = "camera",
        help_heading = "Camera"
    )]
    pub samples: u32,
    /// Draw the surface through every Nth grid point of every Nth row
    ///
    /// Higher is faster and changes heights; the command reports by how much. Lighting keeps its resolution.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        value_parser = number::<u32>("a whole number from 1 to 1024"),
        requires = "camera",
        help_heading = "Expert"
    )]
    pub mesh_step: u32,
    /// Background radiance behind surface and sky: one number or R,G,B
    #[arg(
        long,
        value_name = "RADIANCE",
        default_value = "0",
        value_parser = colour,
        allow_negative_numbers = true,
        hide_short_help = true,
        requires = "camera",
        help_heading = "Camera"
    )]
    pub background: [f32; 3],
}

impl EyeArgs {
    /// The camera's compass azimuth, if there is a camera; others are refused later.
    pub fn compass_deg(&self) -> Option<f64> {
        self.camera.map(|at| at.azimuth).filter(|azimuth| azimuth.is_finite())
    }
}

/// Compass azimuth and elevation, degrees, and a distance.
#[derive(Clone, Copy)]
pub struct CameraAt {
    pub azimuth: f64,
    pub elevation: f64,
    pub distance_m: Option<f64>,
}

/// Metres east, north and, where given, up.
#[derive(Clone, Copy)]
pub struct LookAt {
    pub east_m: f64,
    pub north_m: f64,
    pub height_m: Option<f64>,
}

/// Columns and rows. An alias, because the parser takes arrays for lists.
pub type Size = [u32; 2];

/// Elevation of a camera that is given by its direction alone, degrees.
const ELEVATION: f64 = 30.0;
/// Clockwise from north, 45 degrees apart.
const DIRECTIONS: [&str; 8] =
    ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];

fn camera(text: &str) -> Result<CameraAt, String> {
    let at = |azimuth, elevation| CameraAt { azimuth, elevation, distance_m: None };
    let named = text.to_lowercase();
    if let Some(eighth) = DIRECTIONS.iter().position(|name| *name == named) {
        return Ok(at(45.0 * eighth as f64, ELEVATION));
    }
    let wrong = || {
        "south, north-east or another of eight directions, \"from 45 up 30\" or AZ,EL[,DISTANCE] in degrees and metres"
            .to_owned()
    };
    let number = |word: &str| word.parse().map_err(|_| wrong());
    match named.split_whitespace().collect::<Vec<_>>().as_slice() {
        ["from", azimuth] => return Ok(at(number(azimuth)?, ELEVATION)),
        ["from", azimuth, "up", elevation] => return Ok(at(number(azimuth)?, number(elevation)?)),
        _ => {}
    }
    match numbers(text).as_deref() {
        Some(&[azimuth, elevation]) => Ok(at(azimuth, elevation)),
        Some(&[azimuth, elevation, distance]) => {
            Ok(CameraAt { distance_m: Some(distance), ..at(azimuth, elevation) })
        }
        _ => Err(wrong()),
    }
}

fn place(text: &str) -> Result<LookAt, String> {
    match numbers(text).as_deref() {
        Some(&[east_m, north_m]) => Ok(LookAt { east_m, north_m, height_m: None }),
        Some(&[east_m, north_m, height]) => Ok(LookAt { east_m, north_m, height_m: Some(height) }),
        _ => Err("X,Y or X,Y,Z in metres".into()),
    }
}

fn size(text: &str) -> Result<Size, String> {
    let expected = "WIDTHxHEIGHT, two whole numbers, as 1280x720";
    sides(text, &['x', 'X', '×']).ok_or_else(|| expected.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cameras_have_names_and_numbers() {
        for (text, azimuth, elevation, distance_m) in [
            ("south", 180.0, 30.0, None),
            ("North-West", 315.0, 30.0, None),
            ("from 45", 45.0, 30.0, None),
            ("from 45 up 20.5", 45.0, 20.5, None),
            ("-10,40", -10.0, 40.0, None),
            ("200,15,900", 200.0, 15.0, Some(900.0)),
        ] {
            let found = camera(text).unwrap();
            let found = (found.azimuth, found.elevation, found.distance_m);
            assert_eq!(found, (azimuth, elevation, distance_m), "{text}");
        }
        for text in ["", "up", "from", "from x", "from 1 up", "dem.tif", "1", "1,2,3,4", "southish"]
        {
            let error = camera(text).err().unwrap();
            assert!(error.starts_with("south, "), "{text}: {error}");
        }
    }
}

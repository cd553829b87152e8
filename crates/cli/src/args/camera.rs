//! From where a picture is seen.

use clap::Args;

use super::values::{colour, numbers, whole};

#[derive(Args)]
#[command(next_help_heading = "Camera")]
pub struct CameraArgs {
    /// Instead of the map, a picture from a camera: compass azimuth and elevation (degrees) of where it stands as
    /// seen from what it looks at, and how far from there (metres; default: all of the field is just seen). With
    /// --ortho the third number is what the picture spans from below to above, metres
    #[arg(long, value_name = "AZ,EL[,DISTANCE]", value_parser = camera, allow_hyphen_values = true)]
    pub camera: Option<CameraAt>,
    /// What it looks at: metres east of the westernmost column, north of the southernmost row, and above 0 (default:
    /// the nearest sample's height). Default the middle of the field
    #[arg(long, value_name = "X,Y[,Z]", value_parser = place, allow_hyphen_values = true, requires = "camera")]
    pub look_at: Option<LookAt>,
    /// Angle between the lower and the upper edge of the picture, degrees
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 40.0,
        allow_negative_numbers = true,
        requires = "camera"
    )]
    pub fov: f64,
    /// Parallel rays: what is farther away is not smaller
    #[arg(long, requires = "camera", conflicts_with = "fov")]
    pub ortho: bool,
    /// Columns and rows of the picture
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size, requires = "camera")]
    pub size: Size,
    /// Samples a pixel: 1, 2, 4 or 8, where the device has them. Edges are means of so many
    #[arg(
        long,
        value_name = "N",
        default_value_t = 4,
        value_parser = whole,
        allow_negative_numbers = true,
        requires = "camera"
    )]
    pub samples: u32,
    /// Draws the ground through every Nth sample of every Nth row: faster, and off in height by what is then said.
    /// The light is not reduced
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        value_parser = whole,
        allow_negative_numbers = true,
        requires = "camera"
    )]
    pub mesh_step: u32,
    /// Radiance where neither ground nor sky is seen: one number or R,G,B
    #[arg(
        long,
        value_name = "RADIANCE",
        default_value = "0",
        value_parser = colour,
        allow_negative_numbers = true,
        requires = "camera"
    )]
    pub background: [f32; 3],
}

/// Compass azimuth and elevation, degrees, and a distance.
#[derive(Clone, Copy)]
pub struct CameraAt {
    pub azimuth: f64,
    pub elevation: f64,
    pub distance_m: Option<f64>,
}

/// East, north, perhaps height.
#[derive(Clone, Copy)]
pub struct LookAt {
    pub east_m: f64,
    pub north_m: f64,
    pub height_m: Option<f64>,
}

/// Columns and rows.
pub type Size = [u32; 2];

fn camera(text: &str) -> Result<CameraAt, String> {
    match *numbers(text)?.as_slice() {
        [azimuth, elevation] => Ok(CameraAt { azimuth, elevation, distance_m: None }),
        [azimuth, elevation, distance] => {
            Ok(CameraAt { azimuth, elevation, distance_m: Some(distance) })
        }
        _ => Err("expected AZ,EL or AZ,EL,DISTANCE".into()),
    }
}

fn place(text: &str) -> Result<LookAt, String> {
    match *numbers(text)?.as_slice() {
        [east_m, north_m] => Ok(LookAt { east_m, north_m, height_m: None }),
        [east_m, north_m, height] => Ok(LookAt { east_m, north_m, height_m: Some(height) }),
        _ => Err("expected X,Y or X,Y,Z".into()),
    }
}

fn size(text: &str) -> Result<Size, String> {
    let sides: Vec<u32> = text.split(['x', 'X', '×']).filter_map(|s| s.parse().ok()).collect();
    match (sides.as_slice(), text.split(['x', 'X', '×']).count()) {
        (&[width, height], 2) => Ok([width, height]),
        _ => Err("expected WIDTHxHEIGHT, as 1280x720".into()),
    }
}

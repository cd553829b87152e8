//! The camera.

use clap::Args;

use super::values::{colour, numbers, whole};

#[derive(Args)]
#[command(next_help_heading = "Camera")]
pub struct CameraArgs {
    /// Perspective view instead of the map
    ///
    /// AZ and EL are the compass azimuth and the elevation of the camera from the look-at point, degrees. DISTANCE is in
    /// metres; by default the whole field fits. With --ortho, DISTANCE is the height of the picture in metres.
    #[arg(long, value_name = "AZ,EL[,DISTANCE]", value_parser = camera, allow_hyphen_values = true)]
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
        allow_negative_numbers = true,
        hide_short_help = true,
        requires = "camera"
    )]
    pub fov: f64,
    /// Orthographic projection
    #[arg(long, hide_short_help = true, requires = "camera", conflicts_with = "fov")]
    pub ortho: bool,
    /// Width and height of the picture, pixels
    #[arg(long, value_name = "WxH", default_value = "1280x720", value_parser = size, requires = "camera")]
    pub size: Size,
    /// MSAA samples per pixel: 1, 2, 4 or 8
    ///
    /// Fewer are faster and leave jagged edges. The device must support the number.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 4,
        value_parser = whole,
        allow_negative_numbers = true,
        hide_short_help = true,
        requires = "camera"
    )]
    pub samples: u32,
    /// Draw the surface through every Nth grid point of every Nth row
    ///
    /// Higher is faster and changes heights; the command reports by how much. Lighting keeps its resolution.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1,
        value_parser = whole,
        allow_negative_numbers = true,
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
        requires = "camera"
    )]
    pub background: [f32; 3],
}

impl CameraArgs {
    /// The camera's compass azimuth, if there is a camera.
    pub fn compass_deg(&self) -> Option<f64> {
        self.camera.map(|at| at.azimuth)
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

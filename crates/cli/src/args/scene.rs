//! Lights and surfaces.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::values::{SpecularArg, cell, colour, key, specular, sphere_light, sun};

#[derive(Args)]
#[command(next_help_heading = "Lights")]
pub struct LightArgs {
    /// Uniform sky: radiance, or R,G,B
    ///
    /// Default 1 where no other light is given.
    #[arg(long, value_name = "RADIANCE", value_parser = colour, allow_negative_numbers = true)]
    pub sky: Option<[f32; 3]>,
    /// Environment map: .hdr or .exr
    ///
    /// Equirectangular, angular map, cube cross or cube faces, at infinity.
    #[arg(long, value_name = "FILE")]
    pub env: Option<PathBuf>,
    /// Rotate the environment clockwise, degrees
    ///
    /// At 0 the middle of the map is in the east.
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        hide_short_help = true,
        requires = "env"
    )]
    pub env_rotate: f64,
    /// Sun: compass azimuth, elevation (degrees)
    ///
    /// ANGLE is the angular diameter in degrees, default 0.53; 0 casts hard shadows. IRRADIANCE is that of a surface facing
    /// the sun, one number or R,G,B, default 1. Repeat the flag for more suns.
    #[arg(long, value_name = "AZ,EL[,ANGLE[,IRRADIANCE]]", value_parser = sun, allow_hyphen_values = true)]
    pub sun: Vec<ridgelight::scene::Sun>,
    /// Key light: bright sky patch (degrees)
    ///
    /// AZ and EL are the compass azimuth and the elevation of its centre; WIDTH and HEIGHT are angles, all in degrees.
    /// RADIANCE is one number or R,G,B. 90,45,360,90,1 is the whole sky; 180,30,60,20,4 is a window to the south. Repeat the
    /// flag for more.
    #[arg(
        long,
        value_name = "AZ,EL,WIDTH,HEIGHT,RADIANCE",
        value_parser = key,
        allow_hyphen_values = true
    )]
    pub key: Vec<ridgelight::scene::KeyLight>,
    /// Sphere light: centre and radius (metres)
    ///
    /// X is east of the westernmost column, Y north of the southernmost row, Z above height 0. RADIANCE is one number or
    /// R,G,B. Repeat the flag for more.
    #[arg(long, value_name = "X,Y,Z,RADIUS,RADIANCE", value_parser = sphere_light, allow_hyphen_values = true)]
    pub sphere_light: Vec<ridgelight::scene::SphereLight>,
}

impl LightArgs {
    /// Whether the command line gives no light.
    pub fn is_empty(&self) -> bool {
        let Self { sky, env, env_rotate: _, sun, key, sphere_light } = self;
        let are_none_aimed = sun.is_empty() && key.is_empty() && sphere_light.is_empty();
        sky.is_none() && env.is_none() && are_none_aimed
    }
}

#[derive(Args)]
pub struct SurfaceArgs {
    #[command(flatten)]
    pub field: FieldArgs,
    /// Diffuse reflectance, 0 to 1: number, R,G,B or .png/.exr
    ///
    /// An image has the size of the field.
    #[arg(
        long,
        value_name = "VALUE|FILE",
        default_value = "1",
        allow_negative_numbers = true,
        help_heading = "Surface"
    )]
    pub albedo: String,
    /// Phong specular: exponent 0 to 10000, scale 0 to 1
    ///
    /// The Phong lobe lies about the mirror direction of a view from straight above. SCALE and --albedo add up to 1 at
    /// most. A file has the size of the field and holds both: .exr R and G, or .npy [2, rows, cols]. `render` lights it by
    /// sky, suns and, with --basis sh, environment; `reference` by all lights.
    #[arg(
        long,
        value_name = "EXPONENT,SCALE|FILE",
        value_parser = specular,
        allow_hyphen_values = true,
        hide_short_help = true,
        help_heading = "Surface"
    )]
    pub specular: Option<SpecularArg>,
}

#[derive(Args)]
#[command(next_help_heading = "Surface")]
pub struct FieldArgs {
    /// Grid spacing in metres. Default the file's, else 1
    ///
    /// Spacing of columns, and of rows where it differs, in the unit of the heights. Overrides the file's.
    #[arg(long, value_name = "X[,Y]", value_parser = cell, allow_negative_numbers = true, help_heading = "Input")]
    pub cell: Option<[f64; 2]>,
    /// Multiply heights by this factor; not 0
    ///
    /// PNG values are metres. For a 16-bit PNG that spans a height range R, use R/65535.
    #[arg(
        long,
        value_name = "S",
        default_value_t = 1.0,
        allow_negative_numbers = true,
        hide_short_help = true,
        help_heading = "Input"
    )]
    pub z_scale: f64,
    /// Height that marks no data, or nan. Default the file's
    #[arg(
        long,
        value_name = "VALUE",
        allow_negative_numbers = true,
        hide_short_help = true,
        help_heading = "Input"
    )]
    pub nodata: Option<f64>,
    /// Surface beyond the edge of the field
    #[arg(long, default_value = "plane", hide_short_help = true)]
    pub border: BorderName,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum BorderName {
    /// Level ground: no horizon is below 0
    Plane,
    /// Nothing: light may come from below horizontal
    Open,
    /// The field repeats
    Periodic,
}

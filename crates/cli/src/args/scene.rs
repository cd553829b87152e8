//! Lights and surfaces.

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::values::{PhongArg, ball, cell, colour, key, phong, sun};

#[derive(Args)]
#[command(next_help_heading = "Lights")]
pub struct LightArgs {
    /// Radiance of a uniform sky: one number or R,G,B. Default 1 where no other light is given
    #[arg(long, value_name = "RADIANCE", value_parser = colour, allow_negative_numbers = true)]
    pub sky: Option<[f32; 3]>,
    /// Environment at infinity: .hdr or .exr, equirectangular, angular map, cube cross or faces
    #[arg(long, value_name = "FILE")]
    pub env: Option<PathBuf>,
    /// Turns the environment clockwise, compass degrees; unturned, its middle is east
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        requires = "env"
    )]
    pub env_rotate: f64,
    /// A sun: compass azimuth, elevation, angular diameter (degrees; default 0.53), irradiance facing
    /// it (one number or R,G,B; default 1). Diameter 0 casts hard shadows. May be repeated
    #[arg(long, value_name = "AZ,EL[,ANGLE[,IRRADIANCE]]", value_parser = sun, allow_hyphen_values = true)]
    pub sun: Vec<ridgelight::scene::Sun>,
    /// A key light, a bright patch of the sky: compass azimuth and elevation of its middle, its width
    /// and height (all degrees), its radiance (one number or R,G,B). 90,45,360,90,1 is the whole sky;
    /// 180,30,60,20,4 a window to the south. Lower and narrower, sharper shadows. May be repeated
    #[arg(
        long,
        value_name = "AZ,EL,WIDTH,HEIGHT,RADIANCE",
        value_parser = key,
        allow_hyphen_values = true
    )]
    pub key: Vec<ridgelight::scene::KeyLight>,
    /// A ball of light: its middle east of the westernmost column, north of the southernmost row and
    /// above 0, its radius (all metres), its radiance (one number or R,G,B). May be repeated
    #[arg(long, value_name = "X,Y,Z,RADIUS,RADIANCE", value_parser = ball, allow_hyphen_values = true)]
    pub light: Vec<ridgelight::scene::SphereLight>,
}

impl LightArgs {
    /// Whether no light is asked for.
    pub fn is_empty(&self) -> bool {
        let Self { sky, env, env_rotate: _, sun, key, light } = self;
        let are_none_aimed = sun.is_empty() && key.is_empty() && light.is_empty();
        sky.is_none() && env.is_none() && are_none_aimed
    }
}

#[derive(Args)]
pub struct SurfaceArgs {
    #[command(flatten)]
    pub field: FieldArgs,
    /// Diffuse reflectance, 0..1: one number, R,G,B, or a picture of the field's size (.png, .exr)
    #[arg(
        long,
        value_name = "VALUE|FILE",
        default_value = "1",
        allow_negative_numbers = true,
        help_heading = "Surface"
    )]
    pub albedo: String,
    /// A lobe about the mirror direction of the view from above: exponent 0..10000, and its share 0..1, no
    /// more than 1 with --albedo; or a file of the field's size with both (.exr R and G, .npy [2, rows, cols]).
    /// `render` mirrors sky, environment (--basis sh) and suns; `reference` all
    #[arg(
        long,
        value_name = "EXPONENT,SCALE|FILE",
        value_parser = phong,
        allow_hyphen_values = true,
        help_heading = "Surface"
    )]
    pub phong: Option<PhongArg>,
}

#[derive(Args)]
#[command(next_help_heading = "Surface")]
pub struct FieldArgs {
    /// Spacing of columns and of rows in the heights' unit (metres), where the file has none or a
    /// wrong one. Default the file's, else 1
    #[arg(long, value_name = "X[,Y]", value_parser = cell, allow_negative_numbers = true)]
    pub cell: Option<[f64; 2]>,
    /// Multiplies heights; not 0
    #[arg(long, value_name = "S", default_value_t = 1.0, allow_negative_numbers = true)]
    pub z_scale: f64,
    /// Beyond the edge: the ground goes on level (plane), nothing (open), the field repeats (periodic)
    #[arg(long, default_value = "plane")]
    pub border: BorderName,
    /// The height that stands for no data, as the file has it (nan is one). Default the file's
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    pub nodata: Option<f64>,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum BorderName {
    Plane,
    Open,
    Periodic,
}

use std::path::PathBuf;

use clap::{Args, ValueEnum};

use super::values::{BOUNCES, ERROR, SEED, count, number, whole};
use super::{EyeArgs, GlobalArgs, Input, SceneArgs};

const PLINTH_HELP: &str =
    "Plinth for which a camera without DISTANCE leaves room, as in `render` [default: 0.04]";

// The camera draws no picture here: its flags have help of their own.
#[derive(Args)]
#[command(
    mut_arg("camera", |arg| {
        arg.help("View --specular from a camera, as `render --camera` does").long_help(
            "View --specular from a camera, as `render --camera` does\n\nThe result still has one pixel per texel. FROM, --look-at, \
            --fov, --ortho, --size and --plinth place the camera as in `render`. The default sun is where `render` puts it for \
            this camera. Light without specular does not depend on the camera.",
        )
    }),
    mut_arg("size", |arg| {
        arg.help("Width and height of the picture that the camera would draw, pixels").hide_short_help(true)
    }),
    mut_arg("plinth", |arg| arg.help(PLINTH_HELP).long_help(PLINTH_HELP))
)]
pub struct ReferenceArgs {
    #[command(flatten)]
    pub input: Input,
    /// Output, .exr or .tif: radiance and its standard error
    ///
    /// Channels R, G, B and standard_error.R, standard_error.G, standard_error.B. `trade --reference` reads the .exr.
    #[arg(short, long, value_name = "OUT.{exr,tif}", help_heading = "Output")]
    pub output: PathBuf,
    /// Paths per texel, in batches of 64, at least 128
    ///
    /// Fewer are noisier. The standard error falls with the square root of their number or faster.
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = count, help_heading = "Quality")]
    pub spp: u32,
    /// Bounces of indirect light, 0 to 64; 0 is direct light
    ///
    /// Fewer leave hollows darker; more take time in proportion.
    #[arg(long, value_name = "B", default_value_t = 0, value_parser = number::<u32>(BOUNCES), help_heading = "Quality")]
    pub bounces: u32,
    /// Normals of the ground between grid points
    ///
    /// Affects bounces only: paths start at grid points, which always have smooth normals.
    #[arg(long, value_name = "N", default_value = "smooth", help_heading = "Quality")]
    pub normals: NormalsName,
    /// Stop at this standard error relative to the mean (0.01 is 1 %)
    ///
    /// The bound includes unsampled light. Stops after 512 paths at the earliest. If --spp ends the run first, the command
    /// writes the file, warns, and exits with status 1.
    #[arg(long, value_name = "E", value_parser = number::<f64>(ERROR), help_heading = "Quality")]
    pub until_error: Option<f64>,
    /// Seed of the paths, 0 to 4294967295
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = whole(SEED), help_heading = "Expert")]
    pub seed: u32,
    #[command(flatten)]
    pub scene: SceneArgs,
    #[command(flatten)]
    pub camera: EyeArgs,
    /// Whether the camera is that of a scene file, which has no notes on keys without effect.
    #[arg(skip)]
    pub has_camera_of_file: bool,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum NormalsName {
    /// As in pictures: normals of grid points, and radiance linear between them
    Smooth,
    /// The normal of each flat triangle
    Flat,
}

impl From<NormalsName> for ridgelight::scene::Normals {
    fn from(name: NormalsName) -> Self {
        match name {
            NormalsName::Smooth => Self::Smooth,
            NormalsName::Flat => Self::Flat,
        }
    }
}

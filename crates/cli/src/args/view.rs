//! The window's.

use std::path::PathBuf;

use clap::{ArgMatches, Args};

use super::values::pixels;
use super::{GlobalArgs, Input, LightArgs, QualityArgs, SurfaceArgs};
use crate::scene_file::Request;

/// Columns and rows; a name of its own, as the parser takes arrays for lists.
pub type Pixels = [u32; 2];

#[derive(Args)]
pub struct ViewArgs {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub lights: LightArgs,
    #[command(flatten)]
    pub surface: SurfaceArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    /// Factor before the picture curve, which clips at 1 and is sRGB
    #[arg(long, default_value_t = 1.0, value_name = "FACTOR", allow_negative_numbers = true)]
    pub exposure: f32,
    /// The window's columns and rows, pixels
    #[arg(long, default_value = "1024x768", value_name = "WxH", value_parser = pixels)]
    pub size: Pixels,
    /// Keys, drags and frames from a file, for tests
    #[arg(long, value_name = "FILE", hide = true)]
    pub script: Option<PathBuf>,
    /// Fails where the validation layer has something to say
    #[arg(long, hide = true)]
    pub validate: bool,
    #[command(flatten)]
    pub global: GlobalArgs,
    /// What was given, for scenes to be saved with.
    #[arg(skip)]
    pub asked: Request,
}

impl ViewArgs {
    pub fn remember(&mut self, matches: &ArgMatches) {
        self.asked = Request::of(matches);
    }
}

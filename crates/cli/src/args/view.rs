//! The window.

use std::path::PathBuf;

use clap::{ArgMatches, Args};

use super::values::{FACTOR, number, pixels};
use super::{GlobalArgs, Input, LightArgs, QualityArgs, SurfaceArgs};
use crate::scene_file::Request;

/// Columns and rows. An alias, because the parser takes arrays for lists.
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
    /// Factor on radiance before the tone curve [default: puts the 99th percentile of luminance at 0.8]
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Output",
        value_name = "FACTOR",
        value_parser = number::<f32>(FACTOR),
        allow_negative_numbers = true
    )]
    pub exposure: Option<f32>,
    /// Width and height of the window, pixels
    #[arg(long, help_heading = "Output", default_value = "1024x768", value_name = "WxH", value_parser = pixels, allow_hyphen_values = true)]
    pub size: Pixels,
    /// Keys, drags and frames from a file, for tests
    #[arg(long, value_name = "FILE", hide = true)]
    pub script: Option<PathBuf>,
    /// Fail on messages of the validation layer
    #[arg(long, hide = true)]
    pub validate: bool,
    #[command(flatten)]
    pub global: GlobalArgs,
    /// What the user gave, to save scenes with.
    #[arg(skip)]
    pub asked: Request,
}

impl ViewArgs {
    pub fn remember(&mut self, matches: &ArgMatches) {
        self.asked = Request::of(matches);
    }
}

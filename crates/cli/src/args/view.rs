//! The window.

use std::path::PathBuf;

use clap::Args;

use super::values::{FACTOR, number, pixels};
use super::{GlobalArgs, Input, QualityArgs, SceneArgs, Size};
use crate::scene_file::Request;

#[derive(Args)]
pub struct ViewArgs {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub scene: SceneArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    /// Factor on radiance before the tone curve [default: puts the 99th percentile of luminance at 0.8]
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Output",
        value_name = "FACTOR",
        value_parser = number::<f32>(FACTOR)
    )]
    pub exposure: Option<f32>,
    /// Width and height of the window, pixels
    #[arg(long, help_heading = "Output", default_value = "1024x768", value_name = "WxH", value_parser = pixels, allow_hyphen_values = true)]
    pub size: Size,
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

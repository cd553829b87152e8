use std::path::PathBuf;

use clap::Args;

use super::values::whole;
use super::{GlobalArgs, Input, LightArgs, SurfaceArgs};

#[derive(Args)]
pub struct ReferenceArgs {
    #[command(flatten)]
    pub input: Input,
    /// Where to write: .exr with radiance (R, G, B) and its standard error (standard_error.R, …), which
    /// `trade --reference` takes
    #[arg(short, long, value_name = "OUT.exr")]
    pub output: PathBuf,
    /// Paths a sample, in batches of 64, at least 128: the error falls with their square root or faster
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = whole, allow_negative_numbers = true)]
    pub spp: u32,
    /// Times that light may be reflected on its way to the sample, 0..64; 0 is direct light alone
    #[arg(long, value_name = "B", default_value_t = 0, value_parser = whole, allow_negative_numbers = true)]
    pub bounces: u32,
    /// Ends before --spp once the standard error, that of light not yet met too, is below this share of the mean, after
    /// 512 paths at the earliest (0.01 is 1 %). Where --spp comes first the file is written, that is said,
    /// and the exit status is 1
    #[arg(long, value_name = "E", allow_negative_numbers = true)]
    pub until_error: Option<f64>,
    /// Another number, other paths: 0..4294967295
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = whole, allow_negative_numbers = true)]
    pub seed: u32,
    #[command(flatten)]
    pub lights: LightArgs,
    #[command(flatten)]
    pub surface: SurfaceArgs,
    #[command(flatten)]
    pub global: GlobalArgs,
}

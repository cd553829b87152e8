use std::path::PathBuf;

use clap::Args;

use super::values::{BOUNCES, ERROR, MILLISECONDS, count, number};
use super::{GlobalArgs, Input, SceneArgs};

#[derive(Args)]
pub struct TradeArgs {
    #[command(flatten)]
    pub input: Input,
    /// Output folder for trade.html, trade.json and trade.csv
    ///
    /// Created if it is missing; refused if it contains anything else.
    #[arg(short, long, value_name = "DIR", help_heading = "Output")]
    pub output: PathBuf,
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Ground truth of this scene, .exr
    ///
    /// The layer "standard_error" is subtracted from the errors. A header of another scene is refused, and
    /// so are bounces about flat normals. Default: brute force in many azimuths, or dense sweeps where brute force is too slow.
    #[arg(long, help_heading = "Quality", value_name = "FILE")]
    pub reference: Option<PathBuf>,
    /// Bounces of indirect light, 0 to 64; above 0 only with --reference
    #[arg(long, help_heading = "Quality", value_name = "B", default_value_t = 0, value_parser = number::<u32>(BOUNCES))]
    pub bounces: u32,
    /// Seconds after which no further settings are measured
    ///
    /// Fewer find worse settings.
    #[arg(
        long,
        help_heading = "Quality",
        value_name = "SECONDS",
        default_value_t = 120.0,
        value_parser = number::<f64>("1 to 1000000 seconds")
    )]
    pub budget: f64,
    /// Stop after this many measured settings instead of --budget
    ///
    /// Does the same work on every machine.
    #[arg(long, help_heading = "Quality", value_name = "N", conflicts_with = "budget", value_parser = count)]
    pub evaluations: Option<u32>,
    /// Recommend the fastest settings within this relative RMSE (0.01 is 1 %)
    ///
    /// Exit status 1 if no settings reach it.
    #[arg(
        long,
        help_heading = "Quality",
        value_name = "E",
        value_parser = number::<f64>(ERROR),
        conflicts_with = "time_budget"
    )]
    pub max_error: Option<f64>,
    /// Recommend the most accurate settings within this GPU time per frame, milliseconds
    ///
    /// Exit status 1 if no settings reach it.
    #[arg(long, help_heading = "Quality", value_name = "MS", value_parser = number::<f64>(MILLISECONDS))]
    pub time_budget: Option<f64>,
    #[command(flatten)]
    pub global: GlobalArgs,
}

use clap::Args;

/// What `--max-error` and `--time-budget` choose themselves.
const CHOSEN: [&str; 7] =
    ["method", "azimuths", "sun_azimuths", "lines", "fuse", "precision", "table_elevations"];

#[derive(Args)]
#[command(next_help_heading = "Quality")]
pub struct AutoArgs {
    /// Choose the cheapest settings of at most this relative RMSE (0.01 is 1 %), held against exact
    /// light at 64 to 400 samples; refused where none is that accurate
    #[arg(long, value_name = "E", allow_negative_numbers = true, conflicts_with = "time_budget", conflicts_with_all = CHOSEN)]
    pub max_error: Option<f64>,
    /// Choose the most accurate settings of at most this time a frame on this device, and state their
    /// error
    #[arg(long, value_name = "MS", allow_negative_numbers = true, conflicts_with_all = CHOSEN)]
    pub time_budget: Option<f64>,
}

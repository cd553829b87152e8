use clap::Args;
use ridgelight::scene::SETTINGS;

use super::values::{ERROR, MILLISECONDS, SEED, number, whole};

/// Settings that `--max-error` and `--time-budget` choose: all but hull storage and the number of bounces.
fn chosen() -> impl Iterator<Item = &'static str> {
    let is_free = |name: &str| matches!(name, "hull" | "bounces");
    SETTINGS.iter().map(|setting| setting.name).filter(move |name| !is_free(name))
}

#[derive(Args)]
#[command(next_help_heading = "Quality")]
pub struct AutoArgs {
    /// Choose the fastest settings within this error (0.01 is 1 %)
    ///
    /// The error is the RMSE over the mean light. It is bounded with 95 % confidence by exact light at 192 to 3000 texels
    /// that the choice does not use. With --bounces, path tracing gives the exact light.
    ///
    /// Renders up to 16 frames, or 18 if two have exact horizons, and the chosen one again. Skips settings expected to
    /// take more than 30 s. If no settings reach the error, the command is refused and names the closest ones.
    #[arg(long, value_name = "E", value_parser = number::<f64>(ERROR), conflicts_with = "time_budget", conflicts_with_all = chosen())]
    pub max_error: Option<f64>,
    /// Choose the most accurate settings within this GPU time per frame on this device
    ///
    /// Renders the chosen frame again to check the time, and reports its error. Settings that an earlier run chose are not
    /// measured again; --no-cache does.
    #[arg(long, value_name = "MS", value_parser = number::<f64>(MILLISECONDS), hide_short_help = true, conflicts_with_all = chosen())]
    pub time_budget: Option<f64>,
    /// Seed of the texels that measure the error, 0 to 4294967295; 0 by default
    ///
    /// Another seed measures at other texels. With --max-error or --time-budget.
    #[arg(long, value_name = "S", value_parser = whole(SEED), help_heading = "Expert")]
    pub seed: Option<u32>,
    /// Choose settings again, though an earlier run chose some for the same scene and goal
    ///
    /// Choices are kept in $XDG_CACHE_HOME/ridgelight, by device, driver and commit. With --max-error or --time-budget.
    #[arg(long, help_heading = "Expert")]
    pub no_cache: bool,
}

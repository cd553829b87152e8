use clap::Args;

use super::quality::SETTINGS;
use super::values::whole;

/// What `--max-error` and `--time-budget` choose themselves, or what does nothing beside them: all but where hulls
/// live, and how many bounces there are.
fn chosen() -> impl Iterator<Item = &'static str> {
    let is_asked = |s: &str| matches!(s, "hull" | "bounces");
    SETTINGS.into_iter().filter(move |s| !is_asked(s)).chain(["method"])
}

#[derive(Args)]
#[command(next_help_heading = "Quality")]
pub struct AutoArgs {
    /// Choose the cheapest settings of at most this error: RMSE over the mean of the light (0.01 is 1 %),
    /// bounded with 95 % confidence by exact light at 192 to 3000 samples that had no part in choosing. Draws
    /// up to 16 frames, where none of them holds two more of exact horizons, and the chosen once more; none
    /// that is expected to take more than 30 s; refused, with the nearest that was found, where none is that
    /// accurate. Of --bounces light paths from each of those samples tell the truth, as many as keep their chance a
    /// part of the error
    #[arg(long, value_name = "E", allow_negative_numbers = true, conflicts_with = "time_budget", conflicts_with_all = chosen())]
    pub max_error: Option<f64>,
    /// Choose the most accurate settings of at most this GPU time a frame on this device, drawn once more
    /// to hold it, and state their error
    #[arg(long, value_name = "MS", allow_negative_numbers = true, conflicts_with_all = chosen())]
    pub time_budget: Option<f64>,
    /// Another number, other samples of exact light for --max-error and --time-budget: 0..4294967295;
    /// 0 where none is given
    #[arg(long, value_name = "S", value_parser = whole, allow_negative_numbers = true)]
    pub seed: Option<u32>,
}

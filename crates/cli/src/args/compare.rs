use std::path::PathBuf;

use clap::Args;

const AFTER_HELP: &str = "\
Every channel that both files have is compared by name, in linear light (a .png is decoded from sRGB); \
channels that only one has are named, and one that A lacks is beyond any bound, given or not (but for an \
alpha that is 1 everywhere and a reference's own standard_error). Voids are NaN, or alpha 0: a void in both is masked and counted; \
a void in one only is counted and is beyond any bound, given or not.

FLIP (Andersson et al. 2020) is how different two pictures look when one takes the other's place: 0 \
nothing is seen, 1 the most there is. Its quartiles are weighted by the error itself: a quarter of all \
error lies in pixels below the first.

Exit status: 0 within all bounds, 1 beyond one (each is named with what was found) or failed, 2 wrong \
usage.

  ridgelight compare new.exr old.exr --max-rmse 0.001 --max-worst 0.05 --diff off.exr
  ridgelight compare new.png old.png --max-flip 0.02
  ridgelight compare new.npy old.npy --horizons --max-p999-deg 2";

#[derive(Args)]
#[command(after_help = AFTER_HELP)]
pub struct CompareArgs {
    /// The result: .exr, .png, .hdr or .npy
    #[arg(value_name = "A")]
    pub result: PathBuf,
    /// What it should be, of the same size
    #[arg(value_name = "B")]
    pub reference: PathBuf,
    /// Take values as elevations in radians, as `horizon` writes them, and report degrees
    #[arg(long)]
    pub horizons: bool,
    /// Factor on radiance before it is shown, clipped at 1, for FLIP; for .exr and .hdr, a .png is
    /// shown as it is
    #[arg(
        long,
        default_value_t = 1.0,
        value_name = "FACTOR",
        allow_negative_numbers = true,
        conflicts_with = "horizons"
    )]
    pub exposure: f32,
    /// How large FLIP's pixels are to the eye, 1..1000: distance · columns / width · π/180. Default
    /// 67.02, a display of 3840 columns and 0.7 m, seen from 0.7 m
    #[arg(long, value_name = "N", allow_negative_numbers = true, conflicts_with = "horizons")]
    pub pixels_per_degree: Option<f64>,
    /// Images of the differences. .exr: difference.CHANNEL (A - B) for every channel, and flip (0..1)
    /// for every picture, as flip.LAYER where it has a name; .npy: f32 [channels, rows, cols], A - B
    #[arg(long, value_name = "FILE")]
    pub diff: Option<PathBuf>,
    /// Figures for machines; null is infinite
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Prints nothing but errors
    #[arg(long)]
    pub quiet: bool,
    #[command(flatten)]
    pub bounds: Bounds,
}

#[derive(Args)]
#[command(next_help_heading = "Bounds on every channel, each 0 or more")]
pub struct Bounds {
    /// Largest RMSE relative to the mean of B (0.01 is 1 %)
    #[arg(long, value_name = "X", allow_negative_numbers = true, conflicts_with = "horizons")]
    pub max_rmse: Option<f64>,
    /// Largest |mean of A - B| relative to the mean of B: brighter or darker as a whole
    #[arg(long, value_name = "X", allow_negative_numbers = true, conflicts_with = "horizons")]
    pub max_mean_shift: Option<f64>,
    /// Largest 99th percentile of |A - B| relative to the mean of B
    #[arg(long, value_name = "X", allow_negative_numbers = true, conflicts_with = "horizons")]
    pub max_p99: Option<f64>,
    /// Largest |A - B| of any texel relative to the mean of B
    #[arg(long, value_name = "X", allow_negative_numbers = true, conflicts_with = "horizons")]
    pub max_worst: Option<f64>,
    /// Largest mean FLIP of a picture (R, G and B, or Y), 0 (looks the same) to 1
    #[arg(long, value_name = "X", allow_negative_numbers = true, conflicts_with = "horizons")]
    pub max_flip: Option<f64>,
    /// With --horizons: largest median of |A - B|, degrees
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, requires = "horizons")]
    pub max_median_deg: Option<f64>,
    /// With --horizons: largest 99.9th percentile of |A - B|, degrees
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, requires = "horizons")]
    pub max_p999_deg: Option<f64>,
    /// With --horizons: largest |A - B| of any horizon, degrees
    #[arg(long, value_name = "DEG", allow_negative_numbers = true, requires = "horizons")]
    pub max_worst_deg: Option<f64>,
}

impl Bounds {
    /// By the names that users write.
    pub fn all(&self) -> [(&'static str, Option<f64>); 8] {
        [
            ("--max-rmse", self.max_rmse),
            ("--max-mean-shift", self.max_mean_shift),
            ("--max-p99", self.max_p99),
            ("--max-worst", self.max_worst),
            ("--max-flip", self.max_flip),
            ("--max-median-deg", self.max_median_deg),
            ("--max-p999-deg", self.max_p999_deg),
            ("--max-worst-deg", self.max_worst_deg),
        ]
    }
}

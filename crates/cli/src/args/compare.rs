use std::path::PathBuf;

use clap::Args;

use super::values::{FACTOR, number};

const AFTER_HELP: &str = "\
Channels are compared in linear light; a .png is decoded from sRGB. They are paired by name; if each file has only \
one channel, these two are compared. Channels of only one file are listed. A channel that A lacks fails the command, except an alpha of 1 everywhere and a reference's \
standard_error. Voids are NaN, or alpha 0. A void in both files is masked and counted; a void in only one file fails \
the command.

FLIP (Andersson et al. 2020) measures the visible difference of two pictures when one replaces the other: 0 is none, 1 \
the most. Its quartiles are weighted by the error: a quarter of all error lies in pixels below the first.

Exit status: 0 within all bounds, 1 beyond one or failed (each bound is named with what was found), 2 wrong usage.

  ridgelight compare new.exr old.exr --max-rmse 0.001 --max-worst 0.05 --diff difference.exr
  ridgelight compare new.png old.png --max-flip 0.02
  ridgelight compare new.npy old.npy --horizons --max-p999-deg 2";

#[derive(Args)]
#[command(after_help = AFTER_HELP)]
pub struct CompareArgs {
    /// Result: .exr, .tif, .png, .hdr or .npy
    #[arg(value_name = "A", help_heading = "Input")]
    pub result: PathBuf,
    /// Expected result, of the same size
    #[arg(value_name = "B", help_heading = "Input")]
    pub reference: PathBuf,
    /// Values are elevations in radians, as `horizon` writes them; reports degrees
    #[arg(long, help_heading = "Input")]
    pub horizons: bool,
    /// Multiply radiance for FLIP, clipped at 1
    ///
    /// For .exr, .tif and .hdr; a .png is used as it is.
    #[arg(
        long,
        help_heading = "Output",
        default_value_t = 1.0,
        value_name = "FACTOR",
        value_parser = number::<f32>(FACTOR),
        conflicts_with = "horizons"
    )]
    pub exposure: f32,
    /// Pixels per degree of view for FLIP, 1 to 1000. Default 67.02
    ///
    /// distance * columns / width * pi/180. The default is a display of 3840 columns and 0.7 m width at 0.7 m.
    #[arg(
        long,
        value_name = "N",
        value_parser = number::<f64>("a number from 1 to 1000"),
        conflicts_with = "horizons",
        help_heading = "Output"
    )]
    pub pixels_per_degree: Option<f64>,
    /// Write difference images: .exr, .tif or .npy
    ///
    /// .exr and .tif have the channel difference.CHANNEL (A - B) for each channel and flip (0 to 1) for each picture, or flip.LAYER
    /// for a named layer. A .tif has the georeference of the first input that has one. .npy is f32 [channels, rows, cols], A - B.
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub diff: Option<PathBuf>,
    /// Write the figures as JSON; null is infinite
    #[arg(long, value_name = "FILE", help_heading = "Output")]
    pub json: Option<PathBuf>,
    /// Print only errors and warnings
    #[arg(long, help_heading = "Output")]
    pub quiet: bool,
    #[command(flatten)]
    pub bounds: Bounds,
}

/// Expected of a bound relative to the mean.
const SHARE: &str = "a number, 0 or more, without %: 0.01 is 1 %";

#[derive(Args)]
#[command(next_help_heading = "Bounds on every channel, each 0 or more")]
pub struct Bounds {
    /// Largest RMSE relative to the mean of B (0.01 is 1 %)
    #[arg(long, value_name = "X", value_parser = number::<f64>(SHARE), conflicts_with = "horizons")]
    pub max_rmse: Option<f64>,
    /// Largest |mean of A - B| relative to the mean of B
    #[arg(long, value_name = "X", value_parser = number::<f64>(SHARE), conflicts_with = "horizons")]
    pub max_mean_shift: Option<f64>,
    /// Largest 99th percentile of |A - B| relative to the mean of B
    #[arg(long, value_name = "X", value_parser = number::<f64>(SHARE), conflicts_with = "horizons")]
    pub max_p99: Option<f64>,
    /// Largest |A - B| of any texel relative to the mean of B
    #[arg(long, value_name = "X", value_parser = number::<f64>(SHARE), conflicts_with = "horizons")]
    pub max_worst: Option<f64>,
    /// Largest mean FLIP of a picture (R, G and B, or Y), 0 (same look) to 1
    #[arg(long, value_name = "X", value_parser = number::<f64>("a number from 0 to 1"), conflicts_with = "horizons")]
    pub max_flip: Option<f64>,
    /// With --horizons: largest median of |A - B|, degrees
    #[arg(long, value_name = "DEG", value_parser = number::<f64>("degrees, 0 or more"), requires = "horizons")]
    pub max_median_deg: Option<f64>,
    /// With --horizons: largest 99.9th percentile of |A - B|, degrees
    #[arg(long, value_name = "DEG", value_parser = number::<f64>("degrees, 0 or more"), requires = "horizons")]
    pub max_p999_deg: Option<f64>,
    /// With --horizons: largest |A - B| of any horizon, degrees
    #[arg(long, value_name = "DEG", value_parser = number::<f64>("degrees, 0 or more"), requires = "horizons")]
    pub max_worst_deg: Option<f64>,
}

impl Bounds {
    /// By flag.
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

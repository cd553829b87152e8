//! What can be asked for, and how it is spelled.

mod auto;
mod bake;
mod bounces;
mod camera;
mod compare;
mod quality;
mod reference;
mod scene;
mod values;
mod view;

use std::ffi::OsString;
use std::path::PathBuf;

use clap::{ArgMatches, Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};

use crate::scene_file::SceneFile;
pub use auto::AutoArgs;
pub use bake::BakeArgs;
pub use camera::CameraArgs;
pub use compare::CompareArgs;
pub use quality::{
    BasisName, FuseName, HullName, LevelsName, LightBasisName, LinesName, MethodName,
    PrecisionName, QualityArgs, ReceiverName, SETTINGS, SubsampleName, WedgesName, WindowName,
};
pub use reference::ReferenceArgs;
pub use scene::{BorderName, FieldArgs, LightArgs, SurfaceArgs};
use values::bytes;
#[cfg(feature = "window")]
pub use values::sun;
pub use values::{PhongArg, albedo_colour};
pub use view::ViewArgs;

/// Lights height fields: exact horizons under sky, environment, suns, key lights and balls of light, and what the
/// ground throws back, as Vulkan passes.
#[derive(Parser)]
#[command(version, max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
    /// What `--scene` gave.
    #[arg(skip)]
    pub scene: SceneFile,
}

/// Why a command line cannot be taken.
pub enum Refused {
    /// By the parser; help and version too.
    Parser(clap::Error),
    /// By a scene file.
    Scene(ridgelight::Error),
}

impl Cli {
    /// What the user wrote, and what a scene file adds to it.
    ///
    /// # Errors
    /// Clap's sentence on what cannot be read; the scene file's line and key.
    pub fn read() -> Result<Self, Refused> {
        let mut parser = Self::command();
        let mut words: Vec<OsString> = std::env::args_os().collect();
        let scene = SceneFile::add_to(&parser, &mut words).map_err(Refused::Scene)?;
        let parsed = parser.try_get_matches_from_mut(words);
        let cli = parsed.and_then(|matches| {
            let mut cli = Self::from_arg_matches(&matches).map_err(|e| e.format(&mut parser))?;
            cli.remember(&matches, &scene);
            Ok(cli)
        });
        match cli {
            Ok(cli) => Ok(Self { scene, ..cli }),
            Err(error) => Err(match scene.explain(&error) {
                Some(error) => Refused::Scene(error),
                None => Refused::Parser(error),
            }),
        }
    }

    fn remember(&mut self, matches: &ArgMatches, scene: &SceneFile) {
        let quality = match &mut self.command {
            Command::Render(args) => Some(&mut args.quality),
            Command::Horizon(args) => Some(&mut args.quality),
            Command::Bake(args) => Some(&mut args.quality),
            Command::Plan(args) => Some(&mut args.quality),
            Command::Bench(args) => Some(&mut args.quality),
            Command::View(args) => {
                if let Some((_, matches)) = matches.subcommand() {
                    args.remember(matches);
                }
                Some(&mut args.quality)
            }
            _ => None,
        };
        if let (Some(quality), Some((_, matches))) = (quality, matches.subcommand()) {
            quality.remember(matches, scene);
        }
    }
}

#[derive(Subcommand)]
pub enum Command {
    /// Light a field: one pixel a sample, seen from above, or from a camera
    Render(RenderArgs),
    /// Horizons of every sample: f32 [azimuths, rows, cols], elevation in radians
    Horizon(HorizonArgs),
    /// Which passes would run, why, their traffic and memory; runs nothing
    Plan(PlanArgs),
    /// GPU times of each pass, beside a scalar sweep on the processor; verifies before it times
    Bench(BenchArgs),
    /// Differences of two results; exit status 1 beyond a bound
    Compare(CompareArgs),
    /// What Vulkan offers here and what is missing
    Devices(DevicesArgs),
    /// Speed against accuracy: measures settings and writes table, plot, frontier, recommendation
    Trade(TradeArgs),
    /// The truth, slowly: light paths with all bounces, and how far off they may still be
    Reference(ReferenceArgs),
    /// Maps for engines, of ground that does not move: horizons, sky view, bent normals, harmonics,
    /// scattered light, BRDFs
    Bake(BakeArgs),
    /// A window: look around, move the sun, try methods
    View(ViewArgs),
}

const RENDER_HELP: &str = "\
Examples:
  ridgelight render dem.tif --sun 315,30 --sky 0.3 -o relief.png
  ridgelight render heights.png --cell 30 --env sky.hdr --bounces 2 --layers lights -o lit.exr
  ridgelight render dem.tif --sun 250,15 --camera 150,12 -o seen.png
  ridgelight render dem.tif --sun 250,15 --max-error 0.01 -o within_a_percent.exr";

#[derive(Args)]
#[command(after_help = RENDER_HELP)]
pub struct RenderArgs {
    #[command(flatten)]
    pub input: Input,
    /// Where to write: .exr (linear, named layers) or .png (sRGB), either with the settings used
    #[arg(short, long, value_name = "OUT.{exr,png}")]
    pub output: PathBuf,
    #[command(flatten)]
    pub lights: LightArgs,
    #[command(flatten)]
    pub surface: SurfaceArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    #[command(flatten)]
    pub auto: AutoArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Further layers of an .exr: lights (one a light), sky-view, horizon (the mean elevation); with --camera depth
    /// (Z, the distance along the view)
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub layers: Vec<Layer>,
    /// Factor before the picture curve of a .png, which clips at 1 and is sRGB
    #[arg(long, default_value_t = 1.0, value_name = "FACTOR", allow_negative_numbers = true)]
    pub exposure: f32,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
pub struct HorizonArgs {
    #[command(flatten)]
    pub input: Input,
    /// Where to write: .npy (f32 [azimuths, rows, cols]) or .exr (a channel an azimuth)
    #[arg(short, long, value_name = "OUT.{npy,exr}")]
    pub output: PathBuf,
    /// Also the distance to what makes each horizon, metres, 0 where nothing does (.npy)
    #[arg(long, value_name = "OUT.npy")]
    pub distances: Option<PathBuf>,
    #[command(flatten)]
    pub surface: FieldArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
pub struct PlanArgs {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub lights: LightArgs,
    #[command(flatten)]
    pub surface: SurfaceArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    /// text for people, json for machines, dot for graphviz
    #[arg(long, default_value = "text")]
    pub format: PlanFormat,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
pub struct BenchArgs {
    /// A height field; else --size
    #[arg(value_name = "INPUT")]
    pub input: Option<PathBuf>,
    /// Side of a fixed fractal field
    #[arg(long, default_value_t = 1024, value_name = "N")]
    pub size: usize,
    #[command(flatten)]
    pub lights: LightArgs,
    #[command(flatten)]
    pub surface: SurfaceArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    /// Only passes of these names
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub passes: Vec<String>,
    /// Times each pass is run after warming up
    #[arg(long, default_value_t = 20, value_name = "K")]
    pub samples: usize,
    /// Beside the frame, every form of the sweep, brute force and a scalar sweep on the processor
    #[arg(long)]
    pub forms: bool,
    /// Instead: whole frames of fractal fields of these sides
    #[arg(long, value_delimiter = ',', value_name = "N,N,…", conflicts_with_all = ["input", "forms", "trace", "passes"])]
    pub sizes: Vec<usize>,
    /// With --sizes: each with these numbers of azimuths
    #[arg(long, value_delimiter = ',', value_name = "M,M,…", requires = "sizes")]
    pub azimuth_list: Vec<u32>,
    /// A Chrome / Perfetto trace of one frame
    #[arg(long, value_name = "FILE")]
    pub trace: Option<PathBuf>,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
pub struct TradeArgs {
    #[command(flatten)]
    pub input: Input,
    /// A folder, made where it is missing, for trade.html, trade.json and trade.csv; one that holds
    /// anything else is refused
    #[arg(short, long, value_name = "DIR")]
    pub output: PathBuf,
    #[command(flatten)]
    pub lights: LightArgs,
    #[command(flatten)]
    pub surface: SurfaceArgs,
    /// The truth of this scene as .exr; its layer "standard_error" is taken off the errors, and a header of
    /// another scene is refused. Default: brute force in many azimuths, or dense sweeps where that is too dear
    #[arg(long, value_name = "FILE")]
    pub reference: Option<PathBuf>,
    /// Times that light may be reflected on its way to a sample, 0..64; above 0 only with --reference
    #[arg(long, value_name = "B", default_value_t = 0, value_parser = values::whole, allow_negative_numbers = true)]
    pub bounces: u32,
    /// Seconds after which no further settings are tried
    #[arg(long, value_name = "SECONDS", default_value_t = 120.0, allow_negative_numbers = true)]
    pub budget: f64,
    /// Stop after this many measured settings instead of after a time: the same work on every machine
    #[arg(long, value_name = "N", conflicts_with = "budget", value_parser = clap::value_parser!(u32).range(1..), allow_negative_numbers = true)]
    pub evaluations: Option<u32>,
    /// Recommend the cheapest settings of at most this relative RMSE (0.01 is 1 %); exit status 1
    /// where none were found
    #[arg(long, value_name = "E", allow_negative_numbers = true, conflicts_with = "time_budget")]
    pub max_error: Option<f64>,
    /// Recommend the most accurate settings of at most this time a frame; exit status 1 where none
    /// were found
    #[arg(long, value_name = "MS", allow_negative_numbers = true)]
    pub time_budget: Option<f64>,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
pub struct DevicesArgs {
    /// The same for machines
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
}

#[derive(Args)]
pub struct Input {
    /// Height field: PNG, EXR, TIFF or GeoTIFF, SRTM .hgt, ESRI .asc, NPY, NPZ
    #[arg(value_name = "INPUT")]
    pub path: PathBuf,
}

#[derive(Args)]
#[command(next_help_heading = "Everywhere")]
pub struct GlobalArgs {
    /// Part of a device's name, or its number in `ridgelight devices`. Default the first GPU that
    /// will do, else a software driver
    #[arg(long, value_name = "NAME|INDEX")]
    pub device: Option<String>,
    /// Most memory that images and buffers may take on the device, as 512MiB or 2GiB; default half
    /// of the device's
    #[arg(long, value_name = "SIZE", value_parser = bytes, allow_negative_numbers = true)]
    pub memory_budget: Option<u64>,
    /// Settings really used, times and figures, for machines
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Prints nothing but errors
    #[arg(long)]
    pub quiet: bool,
    /// Field, surface, lights and quality from a file (docs/scene.schema.json), as far as the command takes them;
    /// flags that are written out go before
    #[arg(long, value_name = "FILE.json")]
    pub scene: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Layer {
    Lights,
    SkyView,
    Horizon,
    Depth,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum PlanFormat {
    Text,
    Json,
    Dot,
}

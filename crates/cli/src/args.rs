//! Subcommands, their flags and help.

mod auto;
mod bake;
mod camera;
mod compare;
mod maps;
mod quality;
mod reference;
mod renamed;
mod scene;
mod tips;
mod trade;
mod values;
mod view;

use std::any::TypeId;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

use clap::error::{ContextKind, ContextValue};
use clap::{
    Arg, ArgAction, ArgMatches, Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum,
};

use crate::horizon::Fourier;
use crate::scene_file::{Request, SceneFile};
pub use auto::AutoArgs;
pub use bake::BakeArgs;
pub use camera::{CameraArgs, CameraAt, EyeArgs, Size};
pub use compare::CompareArgs;
pub use maps::{HillshadeArgs, MapArgs, OpennessArgs, ShadowArgs, SkyViewArgs};
pub use quality::{QualityArgs, flag};
pub use reference::ReferenceArgs;
pub use renamed::Renamed;
pub use scene::{BorderName, FieldArgs, LightArgs, SceneArgs};
pub use trade::TradeArgs;
use values::{AZIMUTHS, FACTOR, SIDE, bytes, fourier, number, whole};
pub use values::{SkyArg, SpecularArg, grey_or_colour, numbers};
pub use view::ViewArgs;

/// Computes the light on height fields with Vulkan: sky, environment, suns, key lights, sphere lights and bounces, with
/// shadows from horizons.
#[derive(Parser)]
#[command(name = "ridgelight", version = version(), max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
    /// The file of `--scene`.
    #[arg(skip)]
    pub scene: SceneFile,
}

/// The version, and the commit if the source was a Git repository.
fn version() -> String {
    let version = env!("CARGO_PKG_VERSION");
    match env!("RIDGELIGHT_COMMIT") {
        "unknown" => version.to_owned(),
        commit => format!("{version} ({commit})"),
    }
}

/// Why a command line is refused.
pub enum Refused {
    /// By the parser. Help and version come this way too.
    Parser(clap::Error),
    /// A value, by its flag or by its line and key in a scene file.
    Value(ridgelight::Error),
}

/// Help headings, in the order of `--help`. Others stand before "Output".
const HEADINGS: [&str; 8] =
    ["Input", "Lights", "Surface", "Quality", "Camera", "Output", "Device", "Expert"];

/// The parser: arguments sorted by heading, `-h` on one screen.
fn parser() -> clap::Command {
    let mut parser = Cli::command();
    for command in parser.get_subcommands_mut() {
        *command = arranged(std::mem::take(command));
    }
    parser
}

fn arranged(command: clap::Command) -> clap::Command {
    let help = Arg::new("help").short('h').long("help").action(ArgAction::Help);
    let help = help.help("Print help; --help describes every flag").help_heading("Output");
    let command = command.disable_help_flag(true).arg(help);
    let rank = |heading: &str| {
        let [at, output] = [heading, "Output"].map(|h| HEADINGS.iter().position(|k| *k == h));
        (at.or(output), at.is_some())
    };
    let mut args: Vec<Arg> = command.get_arguments().cloned().collect();
    args.sort_by_key(|arg| arg.get_help_heading().map(rank));
    let numbers = [TypeId::of::<u32>(), TypeId::of::<u64>(), TypeId::of::<usize>()];
    let numbers = [&numbers[..], &[TypeId::of::<f32>(), TypeId::of::<f64>()]].concat();
    let mut args = args.into_iter().map(|arg| {
        // `-5` is a value of flags of numbers.
        let is_number = numbers.iter().any(|n| arg.get_value_parser().type_id() == *n);
        let arg = if is_number { arg.allow_negative_numbers(true) } else { arg };
        match arg.get_help_heading() {
            Some("Expert") => arg.hide_short_help(true),
            _ => arg,
        }
    });
    let command = command.mut_args(|_| args.next().expect("as many as there are"));
    if !command.get_arguments().any(Arg::is_hide_short_help_set) {
        return command;
    }
    let long = command.get_after_help().cloned().unwrap_or_default();
    let has_examples = long.to_string().contains("\n  ridgelight ");
    let what = if has_examples { "all flags and examples" } else { "all flags" };
    let last = format!("`ridgelight {} --help` lists {what}.", command.get_name());
    command.after_help(last).after_long_help(long)
}

/// The error of a value that its parser refuses, as the library writes errors of settings.
fn of_value(error: &clap::Error) -> Option<ridgelight::Error> {
    let text = |kind| match error.get(kind)? {
        ContextValue::String(text) => Some(text.as_str()),
        _ => None,
    };
    let expected = std::error::Error::source(error)?.to_string();
    let flag = text(ContextKind::InvalidArg)?.split(' ').next()?;
    let value = Some(text(ContextKind::InvalidValue)?).filter(|value| !value.is_empty());
    Some(ridgelight::Error::setting(flag, value.unwrap_or("an empty value"), expected))
}

impl Cli {
    /// Reads the command line and the scene file that it names.
    ///
    /// # Errors
    /// What the parser refuses; the line and key of the scene file.
    pub fn read() -> Result<Self, Refused> {
        let mut parser = parser();
        let mut words: Vec<OsString> = std::env::args_os().collect();
        let mut renamed = Renamed::default();
        // Before, so that the command line's flags override the file's; after, as the file may have old values.
        renamed.replace(&parser, &mut words);
        let scene = SceneFile::add_to(&parser, &mut words, &mut renamed).map_err(Refused::Value)?;
        renamed.replace(&parser, &mut words);
        let parsed = parser.try_get_matches_from_mut(&words);
        let cli = parsed.and_then(|matches| {
            let mut cli = Self::from_arg_matches(&matches).map_err(|e| e.format(&mut parser))?;
            cli.remember(&matches, &scene);
            renamed.warn();
            Ok(cli)
        });
        match cli {
            Ok(cli) => Ok(Self { scene, ..cli }),
            Err(error) => Err(match scene.explain(&error).or_else(|| of_value(&error)) {
                Some(error) => Refused::Value(error),
                None => Refused::Parser(tips::add(error, &parser, &words)),
            }),
        }
    }

    fn remember(&mut self, matches: &ArgMatches, scene: &SceneFile) {
        let quality = match &mut self.command {
            Command::Render(args) => Some(&mut args.quality),
            Command::Horizon(args) => Some(&mut args.quality),
            Command::Ao(args) | Command::Svf(args) => Some(&mut args.quality),
            Command::Openness(args) => Some(&mut args.of.quality),
            Command::Bake(args) => Some(&mut args.quality),
            Command::Plan(args) => Some(&mut args.quality),
            Command::Bench(args) => Some(&mut args.quality),
            Command::View(args) => {
                args.asked =
                    matches.subcommand().map(|(_, own)| Request::of(own)).unwrap_or_default();
                Some(&mut args.quality)
            }
            Command::Reference(args) => {
                args.has_camera_of_file = scene.gave("camera");
                None
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
    /// Render a height field, from straight above or from a camera
    Render(RenderArgs),
    /// Describe a height field: size, position, heights, memory of common jobs
    Info(InfoArgs),
    /// Write the horizon of every texel: f32 [azimuths, rows, cols], elevation in radians
    Horizon(HorizonArgs),
    /// Hillshade without shadows, as `gdaldem hillshade`: f32 or 8 bits, 1 to 255
    Hillshade(HillshadeArgs),
    /// Cast shadow of a sun: the visible share of its disc, 0 to 1, and its shadow heights in metres
    Shadow(ShadowArgs),
    /// Ambient occlusion: the light of a uniform sky on white ground, 0 to 1
    ///
    /// `svf` writes the same map under another name.
    #[command(after_help = maps::AO_HELP)]
    Ao(SkyViewArgs),
    /// Sky-view factor, weighted by the cosine to the slope's normal, 0 to 1
    ///
    /// The sky-view factor of the Relief Visualization Toolbox (RVT) is another map: `ridgelight bake --what visible-sky`.
    /// `ao` writes the same map as `svf` under another name.
    #[command(after_help = maps::SVF_HELP)]
    Svf(SkyViewArgs),
    /// Openness (Yokoyama 2002): mean zenith angle of the horizon, degrees
    Openness(OpennessArgs),
    /// Print the passes, their reasons, traffic and memory; runs nothing
    Plan(PlanArgs),
    /// Time each pass on the GPU, after a check against the CPU
    Bench(BenchArgs),
    /// Find the fastest form of the sweep on this device; later commands use it; results keep the same bits
    Tune(TuneArgs),
    /// Compare two results; exit status 1 beyond a bound
    Compare(CompareArgs),
    /// List Vulkan devices and what each lacks
    Devices(DevicesArgs),
    /// Measure time against error over many settings; writes a table, a plot and a recommendation
    Trade(TradeArgs),
    /// Path-traced reference and its standard error; direct light unless --bounces is given; slow
    Reference(ReferenceArgs),
    /// Bake maps of static ground for engines: horizons, sky view, bent normals, harmonics, scattered light, BRDFs
    Bake(BakeArgs),
    /// Open a window: move the camera and the sun, try methods
    View(ViewArgs),
}

const RENDER_HELP: &str = "\
Examples:
  ridgelight render dem.tif --sun 315,30 --sky 0.3 -o relief.png
  ridgelight render heights.png --cell 30 --env sky.hdr --bounces 2 --layers lights -o lit.exr
  ridgelight render dem.tif --sun 250,15 --camera 150,12 -o view.png
  ridgelight render dem.tif --sun 250,15 --max-error 0.01 -o within_a_percent.exr";

#[derive(Args)]
#[command(
    after_help = RENDER_HELP,
    mut_arg("bounces", |arg| {
        let help = "Bounces of indirect light, 0 to 64 [default: 0, or 1 in a .png]";
        arg.hide_default_value(true).help(help).long_help(format!(
            "{help}\n\n0 is direct light. Fewer leave hollows darker; more take time in proportion. A .png with the default light gets \
             one bounce in 8 azimuths if that changes the picture."
        ))
    })
)]
pub struct RenderArgs {
    #[command(flatten)]
    pub input: Input,
    /// Output: .png (sRGB), .tif or .exr (linear, layers)
    ///
    /// All store the settings used as metadata. A .tif is a GeoTIFF with the georeference of the input. A .png of a georeferenced input has its position
    /// in files beside it (.pgw, .png.aux.xml).
    #[arg(short, long, value_name = "OUT.{png,tif,exr}", help_heading = "Output")]
    pub output: PathBuf,
    #[command(flatten)]
    pub scene: SceneArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    #[command(flatten)]
    pub auto: AutoArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Add layers to a .tif or .exr
    ///
    /// lights is one layer per light, horizon the mean elevation, depth (with --camera) the distance Z along the view.
    #[arg(
        long,
        value_delimiter = ',',
        value_name = "LIST",
        hide_short_help = true,
        help_heading = "Output"
    )]
    pub layers: Vec<Layer>,
    /// Factor on the radiance of a .png. Default: automatic
    ///
    /// By default the 99th percentile of the picture's luminance becomes 0.8. The target is lower if no ground has the
    /// lightest colour of --tint. At night (the only light is a --sun below the horizontal) it is a tenth of that. Then all pictures have the same tone curve:
    /// linear up to 0.8, compressed towards 1 above, sRGB-encoded. Give a factor to pictures that you compare.
    #[arg(
        long,
        hide_short_help = true,
        help_heading = "Output",
        value_name = "FACTOR",
        value_parser = number::<f32>(FACTOR)
    )]
    pub exposure: Option<f32>,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
#[command(mut_arg("json", |arg| {
    arg.help("Write the description as JSON to a file; without a file name, print it instead of the text")
        .num_args(0..=1)
        .default_missing_value("-")
        .hide_short_help(false)
}))]
pub struct InfoArgs {
    #[command(flatten)]
    pub input: Input,
    #[command(flatten)]
    pub surface: FieldArgs,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
pub struct HorizonArgs {
    #[command(flatten)]
    pub input: Input,
    /// Output: .tif, .npy or .exr; a layer per azimuth
    ///
    /// With --azimuths 4, a .png is a Stellarium horizon map. R, G, B, A are north, east, south, west. Each is 255 × (0.5 + 0.5 sign(s) √|s|), where s is the sine of the elevation. Voids have elevation 0.
    ///
    /// A band of a GeoTIFF, a layer of an array [azimuths, rows, cols] or a channel of an EXR, in f32. Elevations are in radians. Azimuths are in compass order: 0 is north, then clockwise. Names are azimuth_000.0, azimuth_005.625 and so on, with at least one decimal and at most seven.
    #[arg(short, long, value_name = "OUT.{tif,npy,exr,png,ktx2}", help_heading = "Output")]
    pub output: PathBuf,
    /// A Fourier series for bevy-clipmap instead: coefficients, range of heights in metres
    ///
    /// To -o OUT.ktx2: R32F, a layer for the mean and one for each coefficient (an even number of 2 to 256), of the tangent of the elevation over azimuth. The range is that of the heights in bevy-clipmap, its `max - min`. Voids have the horizons of the filled ground. The sums take at most --memory-budget of main memory; further layers take more rounds over all azimuths.
    #[arg(long, value_name = "N,RANGE", value_parser = fourier, allow_hyphen_values = true, help_heading = "Output", hide_short_help = true, conflicts_with = "distances")]
    pub fourier: Option<Fourier>,
    /// Also write the distance to each horizon's occluder, metres, 0 where there is none
    #[arg(long, value_name = "OUT.{tif,npy}", help_heading = "Output")]
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
    pub scene: SceneArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    #[command(flatten)]
    pub camera: CameraArgs,
    /// Format of the plan
    #[arg(long, default_value = "text", help_heading = "Output")]
    pub format: PlanFormat,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
pub struct TuneArgs {
    /// Height field to tune for; without one, a fractal of --size
    #[arg(value_name = "INPUT", help_heading = "Input")]
    pub input: Vec<PathBuf>,
    /// Side of the fractal field, texels
    #[arg(long, help_heading = "Input", default_value_t = 1024, value_name = "N", value_parser = whole(1..=16_384_usize))]
    pub size: usize,
    /// Azimuths of the sky, 4 to 1024
    #[arg(long, help_heading = "Quality", default_value_t = 64, value_name = "N", value_parser = whole(AZIMUTHS))]
    pub azimuths: u32,
    /// Return to the untuned form
    #[arg(long, help_heading = "Device")]
    pub reset: bool,
    #[command(flatten)]
    pub surface: FieldArgs,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
// --against reads what --json writes.
#[command(mut_arg("json", |arg| arg.hide_short_help(false)))]
pub struct BenchArgs {
    /// Height field; without one, a fractal of --size
    #[arg(value_name = "INPUT", help_heading = "Input")]
    pub input: Option<PathBuf>,
    /// Side of the fractal field, texels
    #[arg(long, help_heading = "Input", default_value_t = 1024, value_name = "N", value_parser = whole(SIDE))]
    pub size: usize,
    #[command(flatten)]
    pub scene: SceneArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    /// Time only passes of these names
    #[arg(long, help_heading = "Output", value_delimiter = ',', value_name = "LIST")]
    pub passes: Vec<String>,
    /// Maximum timed runs of each pass
    ///
    /// After one warm-up run, timing stops after 10, 20, 40 … runs if the nominal 95 % confidence interval of the median is
    /// at most 2 % wide, or after 10 s and at least 6 runs. In flow, the whole frame's time decides.
    #[arg(long, default_value_t = 200, value_name = "K", value_parser = whole(1..=100_000_usize), help_heading = "Quality")]
    pub runs: usize,
    /// Also time sweeps with every setting, brute force, and a scalar sweep on the CPU
    ///
    /// Each row has the time of one azimuth, that of the scalar sweep beside it, and their ratio. docs/choosing-settings.md
    /// explains the columns.
    #[arg(long, help_heading = "Output")]
    pub forms: bool,
    /// Time whole frames of fractal fields of these sides instead
    ///
    /// Each row has the time of a frame, its device memory, and the error of its light. Rows are printed as they are
    /// measured; --json is written after the last one.
    #[arg(long, help_heading = "Input", value_delimiter = ',', value_name = "N,N,…", value_parser = whole(SIDE), conflicts_with_all = ["input", "forms", "trace", "passes"])]
    pub sizes: Vec<usize>,
    /// Time each of --sizes with these numbers of azimuths
    #[arg(
        long,
        help_heading = "Quality",
        hide_short_help = true,
        value_delimiter = ',',
        value_name = "M,M,…",
        value_parser = whole(AZIMUTHS),
        requires = "sizes"
    )]
    pub azimuth_list: Vec<u32>,
    /// Write a Chrome / Perfetto trace of one frame
    ///
    /// Of the runs in flow, the one whose GPU time is nearest the median.
    #[arg(long, help_heading = "Output", value_name = "FILE")]
    pub trace: Option<PathBuf>,
    /// Compare with earlier --json files; exit status 1 if a pass is slower
    ///
    /// FASTER or SLOWER: the intervals of the ratio of medians and of the ratio of 10th percentiles lie entirely beyond 5 %.
    /// SAME: the interval of the ratio of medians lies entirely within 5 %. UNSURE: any other case. The interval comes from
    /// the 95 % confidence intervals of both medians. It is wider if the peak rates of the device changed by more than 5 %,
    /// or if the times of a row spread by more than 20 %. Give three files of one build: one file cannot show how much
    /// processes differ. A file of another scene is refused.
    #[arg(long, help_heading = "Output", value_delimiter = ',', value_name = "FILE,FILE,…")]
    pub against: Vec<PathBuf>,
    /// Write times in Bencher Metric Format
    #[arg(long, help_heading = "Output", hide_short_help = true, value_name = "FILE")]
    pub bencher: Option<PathBuf>,
    #[command(flatten)]
    pub global: GlobalArgs,
}

#[derive(Args)]
pub struct DevicesArgs {
    /// Write the list as JSON
    #[arg(long, help_heading = "Output", value_name = "FILE")]
    pub json: Option<PathBuf>,
}

#[derive(Args)]
pub struct Input {
    /// Height field: PNG, EXR, TIFF or GeoTIFF, SRTM .hgt, ESRI .asc, NPY, NPZ
    ///
    /// A file can be packed as .gz or .zip. Several files are joined to one field by their positions. They need the same
    /// coordinate reference system and cell size. Where they overlap, the first file with a height is used.
    #[arg(value_name = "INPUT", required = true, num_args = 1.., help_heading = "Input")]
    pub path: Vec<PathBuf>,
}

impl Input {
    /// The first file, which names windows and pictures.
    pub fn first(&self) -> &Path {
        self.path.first().map_or(Path::new(""), PathBuf::as_path)
    }

    pub fn paths(&self) -> Vec<&Path> {
        self.path.iter().map(PathBuf::as_path).collect()
    }

    /// All files, for messages and metadata.
    pub fn names(&self) -> String {
        let names = self.path.iter().map(|path| path.display().to_string());
        names.collect::<Vec<_>>().join(", ")
    }
}

#[derive(Args)]
#[command(next_help_heading = "Device")]
pub struct GlobalArgs {
    /// Device: part of its name, or its number in `ridgelight devices`
    ///
    /// Default the first GPU that meets the requirements, else a software driver.
    #[arg(long, value_name = "NAME|INDEX")]
    pub device: Option<String>,
    /// Largest memory of images and buffers, as 512MiB or 2GiB; default half of the device's,
    /// all of a software driver's
    ///
    /// With less, the planner chooses slower settings or refuses the scene.
    #[arg(long, hide_short_help = true, value_name = "SIZE", value_parser = bytes)]
    pub memory_budget: Option<u64>,
    /// Write the settings used, times and figures as JSON
    #[arg(long, hide_short_help = true, help_heading = "Output", value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Print only errors and warnings
    #[arg(short, long, hide_short_help = true, help_heading = "Output")]
    pub quiet: bool,
    /// Read field, lights and settings from a JSON file
    ///
    /// docs/scene.schema.json describes it. Keys without a flag of the command are ignored. Flags override the file.
    #[arg(long, help_heading = "Input", value_name = "FILE.json")]
    pub scene: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Layer {
    /// One layer per light
    Lights,
    /// Sky view factor
    #[value(alias = "svf")]
    SkyView,
    /// Mean elevation of the horizon
    Horizon,
    /// Distance along the view, with --camera
    Depth,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum PlanFormat {
    /// For people
    Text,
    /// For programs
    Json,
    /// For Graphviz
    Dot,
}

//! What can be asked for, and how it is spelled.

mod compare;
mod reference;

use std::path::PathBuf;

use clap::{Args, Parser, Subcommand, ValueEnum};

pub use compare::CompareArgs;
pub use reference::ReferenceArgs;

/// Lights height fields: exact horizons, sky, environment and sun, as Vulkan compute passes.
#[derive(Parser)]
#[command(version, max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Subcommand)]
pub enum Command {
    /// Light a field: one pixel a sample, seen from above
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
    /// Maps for engines (not yet)
    #[command(hide = true)]
    Bake(NotYet),
    /// A window (not yet)
    #[command(hide = true)]
    View(NotYet),
}

#[derive(Args)]
pub struct NotYet {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, hide = true)]
    pub rest: Vec<String>,
}

#[derive(Args)]
pub struct RenderArgs {
    #[command(flatten)]
    pub input: Input,
    /// Where to write: .exr (linear, named layers, settings in the header) or .png (sRGB)
    #[arg(short, long, value_name = "OUT.{exr,png}")]
    pub output: PathBuf,
    #[command(flatten)]
    pub lights: LightArgs,
    #[command(flatten)]
    pub surface: SurfaceArgs,
    #[command(flatten)]
    pub quality: QualityArgs,
    /// Further layers of an .exr: lights (one a light), sky-view, horizon (the mean elevation)
    #[arg(long, value_delimiter = ',', value_name = "LIST")]
    pub layers: Vec<Layer>,
    /// Factor before the picture curve of a .png, which clips at 1 and is sRGB
    #[arg(long, default_value_t = 1.0, value_name = "FACTOR", allow_negative_numbers = true)]
    pub exposure: f32,
    #[command(flatten)]
    pub global: GlobalArgs,
    #[command(flatten)]
    pub later: LaterArgs,
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
    #[command(flatten)]
    pub later: LaterArgs,
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
    /// text for people, json for machines, dot for graphviz
    #[arg(long, default_value = "text")]
    pub format: PlanFormat,
    #[command(flatten)]
    pub global: GlobalArgs,
    #[command(flatten)]
    pub later: LaterArgs,
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
    #[command(flatten)]
    pub later: LaterArgs,
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
    /// The truth of this scene as .exr; its layer "standard_error" is taken off the errors. Default:
    /// brute force in many azimuths, or dense sweeps where that is too dear
    #[arg(long, value_name = "FILE")]
    pub reference: Option<PathBuf>,
    /// Seconds after which no further settings are tried
    #[arg(long, value_name = "SECONDS", default_value_t = 120.0, allow_negative_numbers = true)]
    pub budget: f64,
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
#[command(next_help_heading = "Lights")]
pub struct LightArgs {
    /// Radiance of a uniform sky: one number or R,G,B. Default 1 where no other light is given
    #[arg(long, value_name = "RADIANCE", value_parser = colour, allow_negative_numbers = true)]
    pub sky: Option<[f32; 3]>,
    /// Environment at infinity: .hdr or .exr, equirectangular, angular map, cube cross or faces
    #[arg(long, value_name = "FILE")]
    pub env: Option<PathBuf>,
    /// Turns the environment clockwise, compass degrees; unturned, its middle is east
    #[arg(
        long,
        value_name = "DEG",
        default_value_t = 0.0,
        allow_negative_numbers = true,
        requires = "env"
    )]
    pub env_rotate: f64,
    /// A sun: compass azimuth, elevation, angular diameter (degrees; default 0.53), irradiance facing
    /// it (one number or R,G,B; default 1). Diameter 0 casts hard shadows. May be repeated
    #[arg(long, value_name = "AZ,EL[,ANGLE[,IRRADIANCE]]", value_parser = sun, allow_hyphen_values = true)]
    pub sun: Vec<ridgelight::scene::Sun>,
}

#[derive(Args)]
pub struct SurfaceArgs {
    #[command(flatten)]
    pub field: FieldArgs,
    /// Diffuse reflectance, 0..1: one number, R,G,B, or a picture of the field's size (.png, .exr)
    #[arg(
        long,
        value_name = "VALUE|FILE",
        default_value = "1",
        allow_negative_numbers = true,
        help_heading = "Surface"
    )]
    pub albedo: String,
}

#[derive(Args)]
#[command(next_help_heading = "Surface")]
pub struct FieldArgs {
    /// Spacing of columns and of rows in the heights' unit (metres), where the file has none or a
    /// wrong one. Default the file's, else 1
    #[arg(long, value_name = "X[,Y]", value_parser = cell, allow_negative_numbers = true)]
    pub cell: Option<[f64; 2]>,
    /// Multiplies heights; not 0
    #[arg(long, value_name = "S", default_value_t = 1.0, allow_negative_numbers = true)]
    pub z_scale: f64,
    /// Beyond the edge: the ground goes on level (plane), nothing (open), the field repeats (periodic)
    #[arg(long, default_value = "plane")]
    pub border: BorderName,
    /// The height that stands for no data, as the file has it (nan is one). Default the file's
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true)]
    pub nodata: Option<f64>,
}

#[derive(Args)]
#[command(next_help_heading = "Quality")]
pub struct QualityArgs {
    /// How horizons are found
    #[arg(long, default_value = "auto")]
    pub method: MethodName,
    /// Azimuths of sky and environment, 4..1024: more, less banding; time and memory in proportion
    #[arg(long, value_name = "M", default_value_t = 64, value_parser = whole, allow_negative_numbers = true)]
    pub azimuths: u32,
    /// Slices across a sun's disc, 1..256
    #[arg(long, value_name = "M", default_value_t = 8, value_parser = whole, allow_negative_numbers = true)]
    pub sun_azimuths: u32,
    /// Cells between the lines of a sweep; exact: every sample on a line, every crossing counted
    #[arg(long, default_value = "1")]
    pub lines: LinesName,
    /// How lines' results come back to samples
    #[arg(long, default_value = "aimed-nearest")]
    pub fuse: FuseName,
    /// What a sweep keeps: packed is f16 height + u16 distance on the hull
    #[arg(long, default_value = "f32")]
    pub precision: PrecisionName,
    /// Where a sweep's hull lives; never changes the result
    #[arg(long, default_value = "auto")]
    pub hull: HullName,
    /// Levels of a height pyramid a doubling of distance, 1..16
    #[arg(long, value_name = "K", default_value_t = 4, value_parser = whole, allow_negative_numbers = true)]
    pub level_step: u32,
    /// Doublings of resolution by which a pyramid's levels are finer than distance asks for, 0..4:
    /// more, sharper distant horizons, and more of them missed between samples
    #[arg(long, value_name = "O", default_value_t = 2, value_parser = whole, allow_negative_numbers = true)]
    pub level_offset: u32,
    /// What is stored of a pyramid's levels
    #[arg(long, default_value = "stack")]
    pub levels: LevelsName,
    /// Elevations of an environment's table, 8..4096
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = whole, allow_negative_numbers = true)]
    pub table_elevations: u32,
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
}

/// Flags of methods that are still to come: known, so that the answer is not "unexpected argument".
#[derive(Args)]
pub struct LaterArgs {
    #[arg(long, hide = true, allow_hyphen_values = true)]
    light: Vec<String>,
    #[arg(long, hide = true, allow_hyphen_values = true)]
    phong: Option<String>,
    #[arg(long, hide = true, allow_hyphen_values = true)]
    bounces: Option<String>,
    #[arg(long, hide = true, allow_hyphen_values = true)]
    subsample: Option<String>,
    #[arg(long, hide = true, allow_hyphen_values = true)]
    basis: Option<String>,
    #[arg(long, hide = true, allow_hyphen_values = true)]
    max_error: Option<String>,
    #[arg(long, hide = true, allow_hyphen_values = true)]
    time_budget: Option<String>,
    #[arg(long, hide = true, allow_hyphen_values = true)]
    scene: Option<String>,
    #[arg(long, hide = true, allow_hyphen_values = true)]
    seed: Option<String>,
    #[arg(long, hide = true, allow_hyphen_values = true)]
    camera: Option<String>,
}

impl LaterArgs {
    /// Refuses them.
    pub fn check(&self) -> ridgelight::Result<()> {
        let light = self.light.first();
        let given = [
            ("--light", light),
            ("--phong", self.phong.as_ref()),
            ("--bounces", self.bounces.as_ref()),
            ("--subsample", self.subsample.as_ref()),
            ("--basis", self.basis.as_ref()),
            ("--max-error", self.max_error.as_ref()),
            ("--time-budget", self.time_budget.as_ref()),
            ("--scene", self.scene.as_ref()),
            ("--seed", self.seed.as_ref()),
            ("--camera", self.camera.as_ref()),
        ];
        match given.into_iter().find_map(|(name, value)| Some((name, value?))) {
            Some((name, value)) => Err(ridgelight::Error::setting(
                name,
                value.as_str(),
                "nothing: it is not yet there",
            )),
            None => Ok(()),
        }
    }
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Layer {
    Lights,
    SkyView,
    Horizon,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum PlanFormat {
    Text,
    Json,
    Dot,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum BorderName {
    Plane,
    Open,
    Periodic,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum MethodName {
    /// The planner's choice
    Auto,
    /// Hull sweeps along lines
    Sweep,
    /// One sample a level of a height pyramid: soft, in error whatever the settings
    Pyramid,
    /// Every crossing of every sample's own line: exact and slow
    Brute,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum LinesName {
    #[value(name = "exact")]
    Exact,
    #[value(name = "1/4")]
    QuarterCell,
    #[value(name = "1/2")]
    HalfCell,
    #[value(name = "1")]
    Cell,
    #[value(name = "2")]
    TwoCells,
    #[value(name = "4")]
    FourCells,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum FuseName {
    /// The nearer line's slope
    Nearest,
    /// Both lines' slopes, interpolated
    Slopes,
    /// Both lines' occluders from the sample's own height, interpolated
    Own,
    /// The surface on the sample's own line where the nearer line's occluder stands
    AimedNearest,
    /// The same with both lines' occluders, the higher
    Aimed,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum PrecisionName {
    F32,
    F16,
    Packed,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum LevelsName {
    /// Each at every sample: faster
    Stack,
    /// Each at the texels it needs: a few times the field's memory in all
    Pyramid,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum HullName {
    Auto,
    Private,
    Shared,
    List,
}

/// The range is [`ridgelight::scene::Quality`]'s to check.
fn whole(text: &str) -> Result<u32, String> {
    text.parse().map_err(|_| "expected a whole number, 0 or more".to_owned())
}

fn numbers(text: &str) -> Result<Vec<f64>, String> {
    text.split(',')
        .map(|part| part.trim().parse::<f64>().map_err(|_| format!("{part:?} is no number")))
        .collect()
}

fn colour(text: &str) -> Result<[f32; 3], String> {
    match numbers(text)?.as_slice() {
        [grey] => Ok([*grey as f32; 3]),
        [r, g, b] => Ok([*r as f32, *g as f32, *b as f32]),
        other => Err(format!("{} numbers, expected one or R,G,B", other.len())),
    }
}

pub fn albedo_colour(text: &str) -> Option<[f32; 3]> {
    colour(text).ok()
}

fn cell(text: &str) -> Result<[f64; 2], String> {
    match numbers(text)?.as_slice() {
        [both] => Ok([*both; 2]),
        [x, y] => Ok([*x, *y]),
        other => Err(format!("{} numbers, expected X or X,Y", other.len())),
    }
}

fn sun(text: &str) -> Result<ridgelight::scene::Sun, String> {
    let parts = numbers(text)?;
    let irradiance = match parts.get(3..).unwrap_or_default() {
        [] => [1.0; 3],
        [grey] => [*grey as f32; 3],
        [r, g, b] => [*r as f32, *g as f32, *b as f32],
        _ => return Err("expected AZ,EL[,ANGLE[,IRRADIANCE or R,G,B]]".into()),
    };
    let [azimuth, elevation] =
        parts.get(..2).and_then(|p| p.try_into().ok()).ok_or("expected at least AZ,EL")?;
    let azimuth: f64 = azimuth;
    Ok(ridgelight::scene::Sun {
        // Compass: clockwise from north; inside: counter-clockwise from east.
        azimuth_rad: (90.0 - azimuth).to_radians(),
        elevation_rad: f64::to_radians(elevation),
        diameter_rad: parts.get(2).copied().unwrap_or(0.53).to_radians(),
        irradiance,
    })
}

fn bytes(text: &str) -> Result<u64, String> {
    let digits = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let number: f64 = number.parse().map_err(|_| format!("{text:?} is no size"))?;
    let factor = match unit.trim().to_lowercase().as_str() {
        "" | "b" => 1.0,
        "k" | "kib" => 1024.0,
        "m" | "mib" => 1024.0 * 1024.0,
        "g" | "gib" => 1024.0 * 1024.0 * 1024.0,
        "kb" => 1e3,
        "mb" => 1e6,
        "gb" => 1e9,
        _ => return Err(format!("{unit:?} is no unit: KiB, MiB, GiB, kB, MB, GB")),
    };
    Ok((number * factor) as u64)
}

use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Id, ValueEnum};

use super::bounces::BounceArgs;
use super::values::whole;
use crate::scene_file::SceneFile;

/// Flags of quality, as plans name what they really used.
pub const SETTINGS: [&str; 26] = [
    "azimuths",
    "sun_azimuths",
    "light_cutoff",
    "light_basis",
    "lines",
    "fuse",
    "precision",
    "hull",
    "level_step",
    "level_offset",
    "levels",
    "table_elevations",
    "basis",
    "sh_order",
    "wedges",
    "receiver",
    "window",
    "subsample",
    "wedge_side",
    "bounces",
    "bounce_engine",
    "bounce_azimuths",
    "bounce_cutoff",
    "bounce_level_step",
    "bounce_level_offset",
    "bounce_gloss",
];

#[derive(Args)]
#[command(next_help_heading = "Quality")]
pub struct QualityArgs {
    /// How horizons are found
    #[arg(long, default_value = "auto")]
    pub method: MethodName,
    /// Azimuths of sky and environment, 4..1024: more, less banding; time and memory in proportion
    #[arg(long, value_name = "M", default_value_t = 64, value_parser = whole, allow_negative_numbers = true)]
    pub azimuths: u32,
    /// Slices across a sun's disc, a key light or a ball of light, 1..256: more, smoother soft shadows; a
    /// wide light needs more
    #[arg(long, value_name = "M", default_value_t = 8, value_parser = whole, allow_negative_numbers = true)]
    pub sun_azimuths: u32,
    /// What a sample may lose of the brightest light of a ball, 0..1, default 1/65536, so that each ball is looked for
    /// at fewer samples: more, faster
    #[arg(long, value_name = "SHARE", default_value_t = 1.0 / 65536.0, hide_default_value = true, allow_negative_numbers = true)]
    pub light_cutoff: f64,
    /// What balls of light are lit by; sh takes --sh-order, --wedges, --receiver and --window as an environment
    /// does, and horizons from --method pyramid
    #[arg(long, default_value = "exact")]
    pub light_basis: LightBasisName,
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
    /// What an environment's light is looked up in
    #[arg(long, default_value = "auto")]
    pub basis: BasisName,
    /// Order of spherical harmonics, 2..6: its square are the numbers a sample; with --basis sh or --light-basis sh
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = whole, allow_negative_numbers = true)]
    pub sh_order: u32,
    /// How what is seen along an azimuth becomes harmonics; with --basis sh or --light-basis sh
    #[arg(long, default_value = "slices")]
    pub wedges: WedgesName,
    /// How a surface turns what it sees into light; with --basis sh or --light-basis sh
    #[arg(long, default_value = "plane")]
    pub receiver: ReceiverName,
    /// What tames the ringing of a light's series; with --basis sh or --light-basis sh
    #[arg(long, default_value = "none")]
    pub window: WindowName,
    /// What is seen is found at every so many samples, light at all of them; with --basis sh, and with --bounces,
    /// of which later ones are found at every second of those
    #[arg(long, default_value = "1")]
    pub subsample: SubsampleName,
    /// Horizons of either side of a table of wedges, 4..256; with --wedges table
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = whole, allow_negative_numbers = true)]
    pub wedge_side: u32,
    #[command(flatten)]
    pub bounces: BounceArgs,
    /// Every flag of the command that was written out, as its setting is called, and its first value.
    #[arg(skip)]
    pub written: Vec<(String, String)>,
    /// Whether --bounces were asked for, here or in a scene file.
    #[arg(skip)]
    pub has_bounces: bool,
}

impl QualityArgs {
    /// Remembers what was written out, not in a scene file, which values alone do not tell from defaults.
    pub fn remember(&mut self, matches: &ArgMatches, scene: &SceneFile) {
        let written = matches.ids().map(Id::as_str).filter_map(|id| {
            let is_word = matches.value_source(id) == Some(ValueSource::CommandLine);
            let by_user = is_word && !scene.gave(id);
            let value = matches.get_raw(id).filter(|_| by_user)?.next()?;
            Some((id.to_owned(), value.to_string_lossy().into_owned()))
        });
        self.written = written.collect();
        self.has_bounces = matches.value_source("bounces") == Some(ValueSource::CommandLine);
    }
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
    /// The same, and every crossing of the sample's own line within two steps of either: low suns
    AimedAround,
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

#[derive(Clone, Copy, ValueEnum)]
pub enum BasisName {
    /// The planner's choice
    Auto,
    /// Tables of each azimuth's light above each elevation
    Table,
    /// Spherical harmonics
    Sh,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum LightBasisName {
    /// Slices of the ball, each exact
    Exact,
    /// Spherical harmonics of what is seen up to the ball: soft, in error whatever the settings
    Sh,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum WedgesName {
    /// Exact integrals over elevation
    Slices,
    /// Normalised Legendre coefficients, as many as the order
    Nlp,
    /// A table of wedges between the horizons of two azimuths
    Table,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum ReceiverName {
    /// Its own plane hides what lies below; the cosine is exact
    Plane,
    /// A clamped cosine of three bands, whatever lies below its plane
    Lobe,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum SubsampleName {
    #[value(name = "1")]
    One,
    #[value(name = "2")]
    Two,
    #[value(name = "4")]
    Four,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum WindowName {
    /// Sharpest; may ring below 0
    None,
    Lanczos,
    Hann,
    /// The sharpest after which no light is negative
    Nonnegative,
}

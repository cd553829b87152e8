use clap::parser::ValueSource;
use clap::{ArgMatches, Args, Id, ValueEnum};

use super::bounces::BounceArgs;
use super::values::whole;
use crate::scene_file::SceneFile;

/// Quality settings by the names that plans use.
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
    /// Find horizons by this method
    ///
    /// A sweep costs O(1) a texel and azimuth. Brute force is exact and slower; the pyramid is approximate.
    #[arg(long, default_value = "auto", hide_short_help = true)]
    pub method: MethodName,
    /// Azimuths of sky and environment, 4 to 1024
    ///
    /// Fewer show banding; more take time and memory in proportion.
    #[arg(long, value_name = "M", default_value_t = 64, value_parser = whole, allow_negative_numbers = true)]
    pub azimuths: u32,
    /// Slices across a sun, key light or sphere light, 1 to 256
    ///
    /// Fewer show steps in soft shadows; more take time in proportion. A wide light needs more.
    #[arg(long, value_name = "M", default_value_t = 8, value_parser = whole, allow_negative_numbers = true, hide_short_help = true)]
    pub sun_azimuths: u32,
    /// Basis of an environment's light
    ///
    /// Tables store the light of each azimuth; spherical harmonics are smoother and approximate.
    #[arg(long, default_value = "auto", hide_short_help = true)]
    pub basis: BasisName,
    /// SH order, 2 to 6; stores order^2 coefficients per texel
    ///
    /// Lower blurs the light; higher takes more time and memory. With --basis sh or --light-basis sh.
    #[arg(long, value_name = "N", default_value_t = 4, value_parser = whole, allow_negative_numbers = true, hide_short_help = true)]
    pub sh_order: u32,
    #[command(flatten)]
    pub bounces: BounceArgs,
    /// Cells between the lines of a sweep
    ///
    /// Wider spacing is faster and less exact. "exact" puts every texel on a line and counts every crossing.
    #[arg(long, default_value = "1", help_heading = "Expert")]
    pub lines: LinesName,
    /// Interpolate the results of lines to texels in this way
    ///
    /// Listed from the fastest to the most exact.
    #[arg(long, default_value = "aimed-nearest", help_heading = "Expert")]
    pub fuse: FuseName,
    /// Precision of what a sweep stores
    ///
    /// f16 and packed take half the memory and lose accuracy. packed holds an f16 height and a u16 distance on the hull.
    #[arg(long, default_value = "f32", help_heading = "Expert")]
    pub precision: PrecisionName,
    /// Memory that stores the hull of a sweep
    ///
    /// Changes time and memory, never the result.
    #[arg(long, default_value = "auto", help_heading = "Expert")]
    pub hull: HullName,
    /// Ignore a sphere light below this fraction of the brightest one, 0 to 1, default 1/65536
    ///
    /// Higher is faster and less exact.
    #[arg(long, value_name = "SHARE", default_value_t = 1.0 / 65536.0, hide_default_value = true, allow_negative_numbers = true, help_heading = "Expert")]
    pub light_cutoff: f64,
    /// Basis of sphere lights
    ///
    /// "sh" is approximate. It uses --sh-order, --wedges, --receiver and --window, and horizons of --method pyramid.
    #[arg(long, default_value = "exact", help_heading = "Expert")]
    pub light_basis: LightBasisName,
    /// Height pyramid levels per doubling of distance, 1 to 16
    ///
    /// Fewer miss more occluders; more take time in proportion. With --method pyramid.
    #[arg(long, value_name = "K", default_value_t = 4, value_parser = whole, allow_negative_numbers = true, help_heading = "Expert")]
    pub level_step: u32,
    /// Doublings of resolution that a pyramid adds to what distance needs, 0 to 4
    ///
    /// More sharpens distant horizons, but misses more of them between grid points. With --method pyramid.
    #[arg(long, value_name = "O", default_value_t = 2, value_parser = whole, allow_negative_numbers = true, help_heading = "Expert")]
    pub level_offset: u32,
    /// Storage of a pyramid's levels
    #[arg(long, default_value = "stack", help_heading = "Expert")]
    pub levels: LevelsName,
    /// Elevations in an environment's table, 8 to 4096
    ///
    /// Fewer blur the light; more take memory in proportion. With --basis table.
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = whole, allow_negative_numbers = true, help_heading = "Expert")]
    pub table_elevations: u32,
    /// Turn the visible part of an azimuth into harmonics in this way
    ///
    /// With --basis sh or --light-basis sh.
    #[arg(long, default_value = "slices", help_heading = "Expert")]
    pub wedges: WedgesName,
    /// Horizons on either side of a table of wedges, 4 to 256
    ///
    /// Fewer are less exact; memory grows with the square. With --wedges table.
    #[arg(long, value_name = "N", default_value_t = 64, value_parser = whole, allow_negative_numbers = true, help_heading = "Expert")]
    pub wedge_side: u32,
    /// Reflection of a surface in harmonics
    ///
    /// With --basis sh or --light-basis sh.
    #[arg(long, default_value = "plane", help_heading = "Expert")]
    pub receiver: ReceiverName,
    /// SH window of a light, against ringing
    ///
    /// A stronger window blurs the light; a weaker one may ring. With --basis sh or --light-basis sh.
    #[arg(long, default_value = "none", help_heading = "Expert")]
    pub window: WindowName,
    /// Find visibility at every Nth texel of every Nth row, and light at all texels
    ///
    /// Higher is faster and blurs shadows. With --basis sh and with --bounces; bounces after the first use every second
    /// of those texels.
    #[arg(long, default_value = "1", help_heading = "Expert")]
    pub subsample: SubsampleName,
    /// Settings that the user wrote on the command line, and the first value of each.
    #[arg(skip)]
    pub written: Vec<(String, String)>,
    /// Whether the command line or the scene file sets `--bounces`.
    #[arg(skip)]
    pub has_bounces: bool,
}

impl QualityArgs {
    /// Records which settings the user wrote: values alone do not differ from defaults or from a scene file's.
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
    /// One texel per level of a height pyramid: approximate
    Pyramid,
    /// Every crossing of every texel's own line: exact and slow
    BruteForce,
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
    /// Slope of the nearer line
    Nearest,
    /// Slopes of both lines, interpolated
    Slopes,
    /// Occluders of both lines from the texel's own height, interpolated
    Own,
    /// Surface on the texel's own line at the distance of the nearer line's occluder
    AimedNearest,
    /// The same for both lines' occluders; takes the higher
    Aimed,
    /// The same, and every crossing of the texel's own line within two steps of either, for low suns
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
    /// Every level at every texel: faster
    Stack,
    /// Every level at its own resolution: a few times the field's memory in all
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
    /// Tables of the light above each elevation, for each azimuth
    Table,
    /// Spherical harmonics
    Sh,
}

#[derive(Clone, Copy, ValueEnum)]
pub enum LightBasisName {
    /// Slices of the sphere light, each exact
    Exact,
    /// Spherical harmonics of the visibility of the sphere light: approximate
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
    /// The texel's plane occludes light below it; the cosine is exact
    Plane,
    /// A clamped cosine in three SH bands, without the texel's plane
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
    /// The sharpest window without negative light
    Nonnegative,
}

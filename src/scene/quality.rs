use super::Bounces;
use crate::{Error, Result};
use std::ops::RangeInclusive;

/// What speed is traded against accuracy with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// How horizons are found.
    pub method: Method,
    /// Azimuths of sky and environment, [4..1024], default 64. Fewer: faster, banding at sharp
    /// silhouettes. Time and memory grow in proportion. Under an environment they are closest where it is
    /// brightest when the plan is made (even with exact lines and with harmonics): one that is changed
    /// later is lit by the same.
    pub azimuths: u32,
    /// Slices across a sun's disc, a key light or a ball of light, [1..256], default 8; of a ball that seems
    /// wide up to eight times as many, of one that is narrower than cells fewer. Fewer: faster, steps in
    /// soft shadows; the wider the light, the more it needs.
    pub sun_azimuths: u32,
    /// What a sample may lose, all balls of light together, of the brightest that one of them gives to the
    /// sample nearest to its foot, [0..1], default 1/65536: one step of a picture of 16 bits. More: faster, as each
    /// ball is looked for at fewer samples. 0: at all.
    pub light_cutoff: f64,
    /// What balls of light are lit by. [`LightBasis::Sh`] takes `sh_order`, `wedges`, `receiver`, `window` and
    /// `wedge_side` as an environment does, `sun_azimuths` whatever a ball's width, and horizons from a pyramid
    /// where that is the method.
    pub light_basis: LightBasis,
    /// Distance between the lines of a sweep. Wider: faster, small occluders missed between lines.
    pub lines: Lines,
    /// How the lines' results come back to the samples between them.
    pub fuse: Fuse,
    /// Bits of what the sweep keeps.
    pub precision: Precision,
    /// Where the sweep's hull lives: never changes the result.
    pub hull: Hull,
    /// Levels a doubling of distance in a height pyramid, k, [1..16], default 4. Fewer: faster and
    /// less memory, horizons of what stands between two samples smeared.
    pub level_step: u32,
    /// Doublings of resolution by which a march over a pyramid looks at finer levels than its
    /// distance asks for, o, [0..4], default 2. Fewer: soft distant horizons; more: narrow distant
    /// ridges seen or missed by chance.
    pub level_offset: u32,
    /// What is stored of a pyramid's levels.
    pub levels: Levels,
    /// Elevations of an environment table, [8..4096], default 256. Fewer: faster, the light of
    /// small bright places smeared over elevation.
    pub table_elevations: u32,
    /// What an environment is looked up in.
    pub basis: Basis,
    /// Order n of what samples see as spherical harmonics, [2..6], default 4: n² numbers a sample. Lower:
    /// faster, less memory, the environment blurred. Only with [`Basis::Sh`] or [`LightBasis::Sh`], as are those
    /// below.
    pub sh_order: u32,
    /// How what is seen along an azimuth becomes harmonics.
    pub wedges: Wedges,
    /// How a surface turns what it sees into light.
    pub receiver: Receiver,
    /// What tames the ringing of the environment's series.
    pub window: Window,
    /// What is seen is found at every so many samples along either axis, and light at all of them, each by
    /// its own normal, from the nodes around it: 1, 2 or 4, default 1. More: faster, a quarter of the memory
    /// of what is seen or a sixteenth, shadows blurred within so many samples: 0.2 % RMSE at 2 and 0.4 % at
    /// 4 on the bundled mountain under the bundled sky (`examples/soft converge`). Of [`bounces`](Self::bounces) what
    /// is thrown is found there, too, whatever the [`basis`](Self::basis), by later ones at every second of those nodes: 0.1 %
    /// RMSE of all light at 2 and 0.3 % at 4, of an albedo of 0.8 (`examples/bounce table`).
    pub subsample: u32,
    /// Horizons of either side of a table of wedges, [4..256], default 64. Fewer: less memory, horizons
    /// rounded off between them. Only with [`Wedges::Table`].
    pub wedge_side: u32,
    /// Light that the surface throws at itself.
    pub bounces: Bounces,
}

impl Default for Quality {
    fn default() -> Self {
        Self {
            method: Method::Auto,
            azimuths: 64,
            sun_azimuths: 8,
            light_cutoff: 1.0 / 65536.0,
            light_basis: LightBasis::Exact,
            lines: Lines::Cell,
            fuse: Fuse::AimedNearest,
            precision: Precision::F32,
            hull: Hull::Auto,
            level_step: 4,
            level_offset: 2,
            levels: Levels::default(),
            table_elevations: 256,
            basis: Basis::Auto,
            sh_order: 4,
            wedges: Wedges::Slices,
            receiver: Receiver::Plane,
            window: Window::None,
            subsample: 1,
            wedge_side: 64,
            bounces: Bounces::default(),
        }
    }
}

impl Quality {
    /// What [`azimuths`](Self::azimuths) may be.
    pub const AZIMUTHS: RangeInclusive<u32> = 4..=1024;
    /// What [`sun_azimuths`](Self::sun_azimuths) may be.
    pub const SUN_AZIMUTHS: RangeInclusive<u32> = 1..=256;
    /// What [`level_step`](Self::level_step) may be.
    pub const LEVEL_STEP: RangeInclusive<u32> = 1..=16;
    /// What [`level_offset`](Self::level_offset) may be.
    pub const LEVEL_OFFSET: RangeInclusive<u32> = 0..=4;
    /// What [`table_elevations`](Self::table_elevations) may be.
    pub const TABLE_ELEVATIONS: RangeInclusive<u32> = 8..=4096;
    /// What [`sh_order`](Self::sh_order) may be.
    pub const SH_ORDER: RangeInclusive<u32> = 2..=6;

    /// What [`wedge_side`](Self::wedge_side) may be.
    pub const WEDGE_SIDE: RangeInclusive<u32> = 4..=256;

    /// Order of the lights' own series: with an exact cosine one less than what is seen has.
    pub fn light_order(&self) -> usize {
        match self.receiver {
            Receiver::Plane => self.sh_order as usize - 1,
            Receiver::Lobe => self.sh_order as usize,
        }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// The first setting out of range, by its name on the command line.
    pub fn check(&self) -> Result<()> {
        within("--azimuths", self.azimuths, Self::AZIMUTHS)?;
        within("--sun-azimuths", self.sun_azimuths, Self::SUN_AZIMUTHS)?;
        if !(0.0..=1.0).contains(&self.light_cutoff) {
            let found = self.light_cutoff.to_string();
            return Err(Error::setting("--light-cutoff", found, "a share from 0 to 1"));
        }
        within("--level-step", self.level_step, Self::LEVEL_STEP)?;
        within("--level-offset", self.level_offset, Self::LEVEL_OFFSET)?;
        within("--table-elevations", self.table_elevations, Self::TABLE_ELEVATIONS)?;
        within("--sh-order", self.sh_order, Self::SH_ORDER)?;
        within("--wedge-side", self.wedge_side, Self::WEDGE_SIDE)?;
        if !matches!(self.subsample, 1 | 2 | 4) {
            return Err(Error::setting("--subsample", self.subsample.to_string(), "1, 2 or 4"));
        }
        self.bounces.check()
    }
}

pub(super) fn within(name: &str, value: u32, range: RangeInclusive<u32>) -> Result<()> {
    if range.contains(&value) {
        return Ok(());
    }
    let expected = format!("a whole number from {} to {}", range.start(), range.end());
    Err(Error::setting(name, value.to_string(), expected))
}

/// How horizons are found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The planner's choice: sweeps.
    #[default]
    Auto,
    /// Hull sweeps along lines (Timonen & Westerholm 2010): time in proportion to the samples.
    Sweep,
    /// One sample a level of a height pyramid (Nowrouzezahrai & Snyder 2009): time in proportion to
    /// the samples and the logarithm of the side, error whatever the settings.
    Pyramid,
    /// Every crossing of every sample's own line: exact, and slower in proportion to the side.
    Brute,
}

/// Distance between the lines of a sweep, across the march.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lines {
    /// Every sample on a line and every crossing on its hull: the triangulated surface's own
    /// horizons, in azimuths along grid vectors near the even ones.
    Exact,
    /// Four lines a cell.
    QuarterCell,
    /// Two lines a cell.
    HalfCell,
    /// One line a cell.
    #[default]
    Cell,
    /// A line every two cells.
    TwoCells,
    /// A line every four cells.
    FourCells,
}

impl Lines {
    /// log2 of the spacing in 1/32768 of a cell; none where lines go through every sample.
    pub fn shift(self) -> Option<u32> {
        match self {
            Lines::Exact => None,
            Lines::QuarterCell => Some(13),
            Lines::HalfCell => Some(14),
            Lines::Cell => Some(15),
            Lines::TwoCells => Some(16),
            Lines::FourCells => Some(17),
        }
    }
}

/// How the lines' results come back to the samples between them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fuse {
    /// The slope that the nearer line found.
    Nearest,
    /// Both neighbouring lines' slopes, interpolated.
    Slopes,
    /// Both lines' occluders seen from the sample's own height, interpolated.
    Own,
    /// Where the nearer line's occluder stands, the surface on the sample's *own* line; and the
    /// first crossings of that line. Never above the true horizon.
    #[default]
    AimedNearest,
    /// The same with both lines' proposals: the higher one.
    Aimed,
    /// The same, and every crossing of the sample's own line with grid lines and diagonals within two steps of
    /// either proposal: ridges between steps, which decide what low suns light. Several times the time of
    /// [`Aimed`](Self::Aimed) after the sweep; takes no edits.
    AimedAround,
}

/// Bits of what a sweep keeps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// f32 throughout.
    #[default]
    F32,
    /// Stored slopes as f16: 0.014° at most. Only where slopes are stored (fuse nearest, slopes).
    F16,
    /// Hull entries as f16 height and u16 step in one word (the paper's): heights rounded to 1/2048
    /// of the largest.
    Packed,
}

/// Where a sweep's hull lives. Every place gives the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hull {
    /// The planner's choice for the device.
    #[default]
    Auto,
    /// Private memory of the invocation: fastest on processors.
    Private,
    /// Shared memory of the workgroup (the paper's), going on in the stored occluders where a hull
    /// is deeper.
    Shared,
    /// Nowhere: the stored occluders are a linked list of hull vertices.
    List,
}

/// What is stored of a height pyramid's levels. Both hold the same B-spline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Levels {
    /// Each at every sample of the field, read bilinearly: fast, and the field's memory for each.
    #[default]
    Stack,
    /// Each at the texels it needs, its B-spline found at every look: slow, and a few times the
    /// field's memory in all.
    Pyramid,
}

impl Levels {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            Levels::Stack => "stack",
            Levels::Pyramid => "pyramid",
        }
    }
}

/// What an environment's light is looked up in. A uniform sky stays in closed form whatever it is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Basis {
    /// The planner's choice: tables.
    #[default]
    Auto,
    /// Tables of each azimuth's light above each elevation (Timonen & Westerholm 2010).
    Table,
    /// Spherical harmonics of what is seen, times those of the environment (Nowrouzezahrai & Snyder
    /// 2009). Small bright places are blurred: suns belong in suns. 1.7 % RMSE at order 4 under a real sky.
    Sh,
}

/// What balls of light are lit by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightBasis {
    /// Slices of the ball, each exact up to where the surface hides it.
    #[default]
    Exact,
    /// Spherical harmonics of what is seen up to the ball, times those of the ball (after Snyder & Nowrouzezahrai
    /// 2008): soft, in error whatever the settings.
    Sh,
}

/// How what is seen along an azimuth becomes spherical harmonics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wedges {
    /// Exact integrals over elevation.
    #[default]
    Slices,
    /// n normalised Legendre coefficients (NS09 §6): odd turns lose part of what is seen.
    Nlp,
    /// A table of wedges whose horizons rise linearly from azimuth to azimuth (Snyder & Nowrouzezahrai 2008).
    /// A little farther from the truth than slices from 8 azimuths on, and slower; at 4 nearer. Memory: 4
    /// bytes a sample and azimuth.
    Table,
}

/// How a surface turns what it sees into light, in spherical harmonics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Receiver {
    /// Its own plane hides what lies below it, and the cosine is exact. The environment has order n - 1:
    /// no product is cut off. Of the environment only what is above ground counts.
    #[default]
    Plane,
    /// A clamped cosine of three bands (NS09 §7), the environment of order n. What is seen does not
    /// depend on the normal; the product of three series that are cut off rings.
    Lobe,
}

/// One factor a band of the environment's series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Window {
    /// All 1: sharpest; light may ring below 0, where it is set to 0.
    #[default]
    None,
    /// Lanczos'.
    Lanczos,
    /// Hann's.
    Hann,
    /// The sharpest after which no light is negative.
    Nonnegative,
}

impl Wedges {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            Wedges::Slices => "slices",
            Wedges::Nlp => "nlp",
            Wedges::Table => "table",
        }
    }
}

impl LightBasis {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            LightBasis::Exact => "exact",
            LightBasis::Sh => "sh",
        }
    }
}

impl Receiver {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            Receiver::Plane => "plane",
            Receiver::Lobe => "lobe",
        }
    }
}

impl Window {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            Window::None => "none",
            Window::Lanczos => "lanczos",
            Window::Hann => "hann",
            Window::Nonnegative => "nonnegative",
        }
    }
}

impl Fuse {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            Fuse::Nearest => "nearest",
            Fuse::Slopes => "slopes",
            Fuse::Own => "own",
            Fuse::AimedNearest => "aimed-nearest",
            Fuse::Aimed => "aimed",
            Fuse::AimedAround => "aimed-around",
        }
    }
}

impl Precision {
    /// As the command line spells it.
    pub fn name(self) -> &'static str {
        match self {
            Precision::F32 => "f32",
            Precision::F16 => "f16",
            Precision::Packed => "packed",
        }
    }
}

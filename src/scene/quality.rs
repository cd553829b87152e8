use super::Bounces;
use crate::{Error, Result};
use std::ops::RangeInclusive;

/// Settings that trade speed for accuracy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// How horizons are found.
    pub method: Method,
    /// Azimuths of sky and environment, [4..1024], default 64. Fewer: faster; banding at sharp silhouettes. Time and memory
    /// grow in proportion. Under an environment they are densest where it is brightest when the plan is made (even with
    /// exact lines and with harmonics); an environment that changes later keeps them.
    pub azimuths: u32,
    /// Slices across a sun's disc, a key light or a sphere light, [1..256], default 8. A sphere light that looks wide gets
    /// up to eight times as many, one that is narrower than cells fewer. Fewer: faster; steps in soft shadows. Wider lights
    /// need more.
    pub sun_azimuths: u32,
    /// Ignore sphere lights where together they add less than this fraction of the brightest value that one of them gives to
    /// the texel nearest its foot, [0..1], default 1/65536: one step of a 16-bit image. Higher: faster, as each light
    /// reaches fewer texels. 0 ignores none.
    pub light_cutoff: f64,
    /// Integration of sphere lights. [`LightBasis::Sh`] uses `sh_order`, `wedges`, `receiver`, `window` and `wedge_side` as
    /// an environment does, `sun_azimuths` for any width, and a pyramid's horizons if that is the method.
    pub light_basis: LightBasis,
    /// Distance between the lines of a sweep. Wider: faster; small occluders between lines are missed.
    pub lines: Lines,
    /// How lines' results are combined at the texels between them.
    pub fuse: Fuse,
    /// Precision of the sweep's data.
    pub precision: Precision,
    /// Hull storage of the sweep. Does not change the result.
    pub hull: Hull,
    /// Levels per octave of distance in a height pyramid, k, [1..16], default 4. Fewer: faster, less memory; horizons of
    /// occluders between two distances blur.
    pub level_step: u32,
    /// Octaves by which a pyramid march uses finer levels than its distance requires, o, [0..4], default 2. Fewer: distant
    /// horizons blur; more: narrow distant ridges alias.
    pub level_offset: u32,
    /// Storage of a pyramid's levels.
    pub levels: Levels,
    /// Elevations of an environment table, [8..4096], default 256. Fewer: faster; light of small bright areas blurs over
    /// elevation.
    pub table_elevations: u32,
    /// Basis of an environment.
    pub basis: Basis,
    /// Order n of visibility as spherical harmonics, [2..6], default 4: n² coefficients per texel. Lower: faster, less
    /// memory; the environment blurs. Used with [`Basis::Sh`] or [`LightBasis::Sh`] only, like the fields below.
    pub sh_order: u32,
    /// How visibility along an azimuth is projected to harmonics.
    pub wedges: Wedges,
    /// How a surface integrates the light.
    pub receiver: Receiver,
    /// SH window of the environment.
    pub window: Window,
    /// Stride of the grid nodes where visibility is computed, along either axis: 1, 2 or 4, default 1. Light is computed at
    /// every texel with its own normal from the nodes around it. Higher: faster, a quarter or a sixteenth of the memory of
    /// visibility; shadows blur over the stride: 0.2 % RMSE at 2, 0.4 % at 4 on the bundled mountain under the bundled sky
    /// (`examples/soft converge`). [`bounces`](Self::bounces) use the same nodes with any [`basis`](Self::basis), later
    /// bounces every second node: 0.1 % RMSE of all light at 2, 0.3 % at 4, at an albedo of 0.8 (`examples/bounce table`).
    pub subsample: u32,
    /// Horizons along either side of a wedge table, [4..256], default 64. Fewer: less memory; less exact interpolation. Used
    /// with [`Wedges::Table`] only.
    pub wedge_side: u32,
    /// Indirect light.
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
    /// Range of [`azimuths`](Self::azimuths).
    pub const AZIMUTHS: RangeInclusive<u32> = 4..=1024;
    /// Range of [`sun_azimuths`](Self::sun_azimuths).
    pub const SUN_AZIMUTHS: RangeInclusive<u32> = 1..=256;
    /// Range of [`level_step`](Self::level_step).
    pub const LEVEL_STEP: RangeInclusive<u32> = 1..=16;
    /// Range of [`level_offset`](Self::level_offset).
    pub const LEVEL_OFFSET: RangeInclusive<u32> = 0..=4;
    /// Range of [`table_elevations`](Self::table_elevations).
    pub const TABLE_ELEVATIONS: RangeInclusive<u32> = 8..=4096;
    /// Range of [`sh_order`](Self::sh_order).
    const SH_ORDER: RangeInclusive<u32> = 2..=6;

    /// Range of [`wedge_side`](Self::wedge_side).
    const WEDGE_SIDE: RangeInclusive<u32> = 4..=256;

    /// Order of the lights' series: with an exact cosine one less than that of visibility.
    pub fn light_order(&self) -> usize {
        match self.receiver {
            Receiver::Plane => self.sh_order as usize - 1,
            Receiver::CosineLobe => self.sh_order as usize,
        }
    }

    /// Checks every range.
    ///
    /// # Errors
    /// The first setting out of range, by its name on the command line.
    pub fn check(&self) -> Result<()> {
        within("azimuths", self.azimuths, Self::AZIMUTHS)?;
        within("sun_azimuths", self.sun_azimuths, Self::SUN_AZIMUTHS)?;
        if !(0.0..=1.0).contains(&self.light_cutoff) {
            let found = self.light_cutoff.to_string();
            return Err(Error::setting("light_cutoff", found, "a share from 0 to 1"));
        }
        within("level_step", self.level_step, Self::LEVEL_STEP)?;
        within("level_offset", self.level_offset, Self::LEVEL_OFFSET)?;
        within("table_elevations", self.table_elevations, Self::TABLE_ELEVATIONS)?;
        within("sh_order", self.sh_order, Self::SH_ORDER)?;
        within("wedge_side", self.wedge_side, Self::WEDGE_SIDE)?;
        if !matches!(self.subsample, 1 | 2 | 4) {
            return Err(Error::setting("subsample", self.subsample.to_string(), "1, 2 or 4"));
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
    /// Hull sweeps along lines (Timonen & Westerholm 2010): time proportional to the texels.
    Sweep,
    /// One sample per level of a height pyramid (Nowrouzezahrai & Snyder 2009): time proportional to the texels and to the
    /// logarithm of the side. Approximate at any setting.
    Pyramid,
    /// Every crossing of every texel's own line: exact. Time per texel grows with the side of the field.
    BruteForce,
}

/// Distance between the lines of a sweep, across the march.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Lines {
    /// A line through every grid point, every crossing on its hull: the exact horizons of the triangulated surface, in
    /// azimuths along grid vectors near the even ones.
    Exact,
    /// Four lines per cell.
    QuarterCell,
    /// Two lines per cell.
    HalfCell,
    /// One line per cell.
    #[default]
    Cell,
    /// A line every two cells.
    TwoCells,
    /// A line every four cells.
    FourCells,
}

impl Lines {
    /// log2 of the spacing in 1/32768 of a cell; `None` where lines pass through every grid point.
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

/// How lines' results are combined at the texels between them (TW10's fuse).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fuse {
    /// The slope found on the nearer line.
    Nearest,
    /// Both neighbouring lines' slopes, interpolated.
    Slopes,
    /// Slopes to both lines' occluders from the texel's own height, interpolated.
    Own,
    /// The surface on the texel's *own* line at the distance of the nearer line's occluder, and the first crossings of that
    /// line. Never above the true horizon.
    #[default]
    AimedNearest,
    /// As `AimedNearest` with both lines' occluders: the higher slope.
    Aimed,
    /// As `Aimed`, with every crossing of the texel's own line with grid lines and diagonals within two steps of either
    /// occluder: finds ridges between steps, which decide the shadows of low suns. After the sweep it takes several times
    /// the time of [`Aimed`](Self::Aimed). No edits.
    AimedAround,
}

/// Precision of a sweep's data.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// f32 throughout.
    #[default]
    F32,
    /// Stored slopes as f16: error of at most 0.014°. Only where slopes are stored (fuse nearest, slopes).
    F16,
    /// Hull entries as f16 height and u16 step in one word (TW10): heights rounded to 1/2048 of the largest.
    Packed,
}

/// Hull storage of a sweep. All give the same bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Hull {
    /// The planner's choice for the device.
    #[default]
    Auto,
    /// Private memory of the invocation: fastest on CPU devices.
    Private,
    /// Shared memory of the workgroup (TW10); a deeper hull continues in the stored occluders.
    Shared,
    /// No hull: the stored occluders are a linked list of hull vertices.
    OccluderList,
}

/// Storage of a height pyramid's levels. Both hold the same B-spline.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Levels {
    /// Every level at the field's resolution, read bilinearly: fast; each level takes the memory of the field.
    #[default]
    Stack,
    /// Every level at its own resolution, its B-spline evaluated at every read: slow; a few times the memory of the field in
    /// all.
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

/// Basis of an environment. A uniform sky is always in closed form.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Basis {
    /// The planner's choice: tables.
    #[default]
    Auto,
    /// Tables of each azimuth's light above each elevation (Timonen & Westerholm 2010).
    Table,
    /// Spherical harmonics of visibility times those of the environment (Nowrouzezahrai & Snyder 2009). Small bright areas
    /// blur: use suns for suns. 1.7 % RMSE at order 4 under a real sky.
    Sh,
}

/// Integration of sphere lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LightBasis {
    /// Slices of the sphere, each exact up to where the surface occludes it.
    #[default]
    Exact,
    /// Spherical harmonics of visibility up to the sphere, times those of the sphere (after Snyder & Nowrouzezahrai 2008):
    /// approximate at any setting.
    Sh,
}

/// How visibility along an azimuth is projected to spherical harmonics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Wedges {
    /// Exact integrals over elevation.
    #[default]
    Slices,
    /// n normalised Legendre coefficients (NS09 §6): odd azimuthal orders lose part of the visibility.
    Nlp,
    /// A table of wedges whose horizons rise linearly from azimuth to azimuth (Snyder & Nowrouzezahrai 2008). Slower than
    /// slices, with a slightly larger error from 8 azimuths on; smaller at 4. Memory: 4 bytes per texel and azimuth.
    Table,
}

/// How a surface integrates light in spherical harmonics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Receiver {
    /// The texel's own plane limits visibility and the cosine is exact. The environment has order n - 1, so no product is
    /// truncated. Only its part above ground counts.
    #[default]
    Plane,
    /// A clamped cosine of three bands (NS09 §7), the environment of order n. Visibility does not depend on the normal. The
    /// product of three truncated series rings.
    CosineLobe,
}

/// SH window: one factor per band of the environment's series.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Window {
    /// All 1: sharpest. Light may ring below 0 and is then set to 0.
    #[default]
    None,
    /// Lanczos'.
    Lanczos,
    /// Hann's.
    Hann,
    /// The sharpest window after which no light is negative.
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
            Receiver::CosineLobe => "lobe",
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

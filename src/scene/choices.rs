//! Words that settings take. The first paragraph of a variant's comment is its help.

use super::settings::{Text, Values, Word, words};

words! {
    /// How horizons are found.
    pub enum Method = Auto {
        /// The planner's choice: a sweep, and exact shadows of suns
        ///
        /// Where `lines` and `precision` have their defaults, suns and key lights that span at most 5 degrees of elevation
        /// have exact shadows.
        Auto = "auto",
        /// Hull sweeps along lines
        ///
        /// Timonen & Westerholm 2010. Time is proportional to the texels.
        Sweep = "sweep",
        /// One texel per level of a height pyramid: approximate
        ///
        /// Nowrouzezahrai & Snyder 2009. Time is proportional to the texels and to the logarithm of the side.
        Pyramid = "pyramid",
        /// Every crossing of every texel's own line: exact and slow
        ///
        /// Time per texel grows with the side of the field.
        BruteForce = "brute-force",
    }
}

words! {
    /// Distance between the lines of a sweep, across the march, in cells.
    pub enum Lines = Cell {
        /// A line through every grid point, every crossing on its hull
        ///
        /// The exact horizons of the triangulated surface, in azimuths along grid vectors near the even ones.
        Exact = "exact",
        /// Four lines per cell
        QuarterCell = "1/4",
        /// Two lines per cell
        HalfCell = "1/2",
        /// One line per cell
        Cell = "1",
        /// A line every two cells
        TwoCells = "2",
        /// A line every four cells
        FourCells = "4",
    }
}

impl Lines {
    /// log2 of the spacing in 1/32768 of a cell; `None` where lines pass through every grid point.
    pub fn shift(self) -> Option<u32> {
        (self != Lines::Exact).then_some(12 + self as u32)
    }
}

words! {
    /// How the results of lines are interpolated to the texels between them (TW10's fuse).
    pub enum Fuse = AimedAround {
        /// Slope of the nearer line
        Nearest = "nearest",
        /// Slopes of both lines, interpolated
        Slopes = "slopes",
        /// Occluders of both lines from the texel's own height, interpolated
        Own = "own",
        /// Surface on the texel's own line at the distance of the nearer line's occluder
        ///
        /// Also the first crossings of that line. Never above the true horizon.
        AimedNearest = "aimed-nearest",
        /// The same for the occluders of both lines; takes the higher
        Aimed = "aimed",
        /// The same, and every crossing of the texel's own line beside the nearer line's occluder
        ///
        /// Crossings with grid lines and diagonals, a step to either side and one more towards the other line's occluder. Finds
        /// ridges between steps. Shading takes 2.5 times as long as with [`Aimed`](Self::Aimed) (llvmpipe).
        AimedAround = "aimed-around",
    }
}

words! {
    /// Precision of a sweep's data.
    pub enum Precision = F32 {
        /// f32 throughout
        F32 = "f32",
        /// Stored slopes as f16: error of at most 0.014 degrees
        ///
        /// Only where slopes are stored (fuse nearest, slopes).
        F16 = "f16",
        /// Hull entries as f16 height and u16 distance in one word
        ///
        /// As in TW10: heights are rounded to 1/2048 of the largest.
        Packed = "packed",
    }
}

words! {
    /// Hull storage of a sweep. All give the same bits.
    pub enum Hull = Auto {
        /// The planner's choice for the device
        Auto = "auto",
        /// Private memory of the invocation: fastest on CPU devices
        Private = "private",
        /// Shared memory of the workgroup; where a GPU sweeps one line per invocation, older entries in private memory
        ///
        /// As in TW10; a deeper hull continues in the stored occluders.
        Shared = "shared",
        /// No hull: the stored occluders are a linked list of hull vertices
        OccluderList = "occluder-list",
    }
}

words! {
    /// Storage of a height pyramid's levels. Both hold the same B-spline.
    pub enum Levels = Stack {
        /// Every level at every texel: faster
        ///
        /// Read bilinearly; each level takes the memory of the field.
        Stack = "stack",
        /// Every level at its own resolution: a few times the memory of the field in all
        ///
        /// Its B-spline is evaluated at every read: slow.
        Pyramid = "pyramid",
    }
}

words! {
    /// Basis of an environment. A uniform sky is always in closed form.
    pub enum Basis = Auto {
        /// The planner's choice: table; sh for a specular map whose tables do not fit
        Auto = "auto",
        /// Tables of the light above each elevation, for each azimuth
        ///
        /// Timonen & Westerholm 2010.
        Table = "table",
        /// Spherical harmonics: approximate
        ///
        /// Visibility times environment (Nowrouzezahrai & Snyder 2009). Small bright areas blur: use suns for suns. 2.4 %
        /// RMSE at order 4 under the bundled sky (benches/results/soft_converge.txt).
        Sh = "sh",
    }
}

words! {
    /// Integration of sphere lights.
    pub enum LightBasis = Exact {
        /// Slices of the sphere light, each exact up to where the surface occludes it
        Exact = "exact",
        /// Spherical harmonics of the visibility of the sphere light: approximate
        ///
        /// Visibility up to the sphere times the sphere's own series (after Snyder & Nowrouzezahrai 2008).
        Sh = "sh",
    }
}

words! {
    /// How visibility along an azimuth is projected to spherical harmonics.
    pub enum Wedges = Slices {
        /// Exact integrals over elevation
        Slices = "slices",
        /// Normalised Legendre coefficients, as many as the order
        ///
        /// NS09 §6: odd azimuthal orders lose part of the visibility.
        Nlp = "nlp",
        /// A table of wedges between the horizons of two azimuths
        ///
        /// Horizons rise linearly from azimuth to azimuth (Snyder & Nowrouzezahrai 2008). With more than four
        /// azimuths it is slower than `slices`; its error has not been measured. Memory: 4 bytes per texel and azimuth.
        Table = "table",
    }
}

words! {
    /// How a surface integrates light in spherical harmonics.
    pub enum Receiver = Plane {
        /// The texel's plane occludes light below it; the cosine is exact
        ///
        /// The environment has order n - 1, so no product is truncated. Only its part above ground counts.
        Plane = "plane",
        /// A clamped cosine in three SH bands, without the texel's plane
        ///
        /// NS09 §7, the environment of order n. Visibility does not depend on the normal. The product of three truncated
        /// series rings.
        Cosine = "cosine",
    }
}

words! {
    /// SH window: one factor per band of the environment's series.
    pub enum Window = None {
        /// Sharpest; may ring below 0
        ///
        /// Negative light is set to 0.
        None = "none",
        /// Lanczos' window
        Lanczos = "lanczos",
        /// Hann's window
        Hann = "hann",
        /// The sharpest window without negative light
        Nonnegative = "nonnegative",
    }
}

words! {
    /// How the surface visible from each texel is found. Numbers of the C ABI are in this order.
    pub enum BounceEngine = Auto {
        /// Every visible interval along each azimuth: exact in each azimuth, and slow
        ///
        /// In closed form. Time per texel grows with the side of the field.
        BruteForce = "brute-force",
        /// The ground up to the horizon of a sweep along lines: near by at every march step, farther away in blocks
        ///
        /// Blocks of swept lines, at most a quarter of their distance long. Time grows with the logarithm of the
        /// distance. Needs such a sweep.
        Sweep = "sweep",
        /// One texel per level of pyramids of heights and light: approximate
        ///
        /// Heights as [`Method::Pyramid`], and a pyramid of exit radiance (Nowrouzezahrai & Snyder 2009). Time is
        /// proportional to the texels and to the logarithm of the side.
        Pyramid = "pyramid",
        /// The planner's choice: pyramid with specular, else sweep where horizons come from a sweep along lines, else
        /// brute-force
        ///
        /// On four real fields under two environments `Sweep` took 0.06 to 0.24 of the time of `BruteForce`. Its error is larger
        /// on steep ground: 9.8 % of the indirect light of one bounce on moss instead of 2.8 % (`cargo measure bounce`).
        Auto = "auto",
    }
}

words! {
    /// How specular exit radiance is stored at every texel of its pyramid.
    pub enum BounceSpecular = Vector {
        /// Radiance by direction, as spherical harmonics of the SH order at every texel
        ///
        /// Each texel receives what leaves towards it (Nowrouzezahrai & Snyder 2009, §5.3). Memory: n² colours per texel.
        Vector = "vector",
        /// The same, stored in f16: half the memory
        ///
        /// Rounded to 1/2048, below 65504.
        VectorF16 = "vector-f16",
        /// Radiance towards the zenith, one colour per texel, as if it were diffuse
        ///
        /// Its error depends on direction.
        Scalar = "scalar",
    }
}

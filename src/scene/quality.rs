/// How a sample's horizon is made of what the two sweep lines beside it found.
///
/// The number is the shaders' constant. Mean error on a DEM with lines a cell apart, per azimuth, and
/// what is read per sample: the further down, the more true and the more is read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Fuse {
    /// The slope that the nearer line found: 0.23°; one word of the lattice.
    Nearest = 1,
    /// Both lines' slopes, interpolated: 0.17°, steps smoothed; two words.
    Slopes = 2,
    /// Both lines' occluders seen from the sample's own height, interpolated: 0.18°; two words, four
    /// heights.
    Own = 3,
    /// The surface on the sample's own line where the nearer line's occluder stands, and the first
    /// crossings of its own line: 0.036°, never above the true horizon; one word, two heights.
    AimedNearest = 4,
    /// The same with both lines' proposals, the higher one: 0.023°, never above the true horizon; two
    /// words, four heights.
    #[default]
    Aimed = 5,
}

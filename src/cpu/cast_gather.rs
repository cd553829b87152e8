//! What a node sees of one more bounce, by the casting set that the first one has left.

/// A stretch of surface that a node sees along an azimuth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cast {
    /// The sample where it is in the mean, row-major.
    pub sample: usize,
    /// What it counts for.
    pub weight: f64,
}

/// Radiance times weight; not yet divided by what whole hemispheres would give.
///
/// # Panics
/// A cast of a sample that is none.
pub fn cast_gather<'a>(casts: impl IntoIterator<Item = &'a Cast>, exit: &[[f64; 3]]) -> [f64; 3] {
    casts
        .into_iter()
        .fold([0.0; 3], |sum, cast| [0, 1, 2].map(|c| sum[c] + cast.weight * exit[cast.sample][c]))
}

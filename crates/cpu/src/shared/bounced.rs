//! What the surface throws at a sample, as every engine of bounces adds it up: along each azimuth what is seen of
//! the surface, from below upwards.

/// What is hidden by no more than this, radians, is named as well: rounding may show it.
pub const NEARLY_RAD: f64 = 1e-3;

/// What is seen along one azimuth.
#[derive(Clone, Debug, PartialEq)]
pub struct Along {
    /// The azimuth, radians.
    pub azimuth_rad: f64,
    /// Elevation of the sample's own plane.
    pub low_rad: f64,
    /// Weight of all directions above that plane.
    pub whole: f64,
    /// From below upwards.
    pub casts: Vec<Cast>,
}

/// A part of the surface that counts as one.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cast {
    /// Elevations between which it is seen: none where it is nearly seen.
    pub low_rad: f64,
    /// The upper one.
    pub high_rad: f64,
    /// Weight of these elevations.
    pub weight: f64,
    /// Weight of a radian at the upper one.
    pub facing: f64,
    /// R, G, B.
    pub radiance: [f64; 3],
    /// By how much it may differ from that, where it is seen a bit nearer or farther.
    pub spread: [f64; 3],
    /// How far away its upper end is found: metres of stretches, else march steps.
    pub distance: f64,
    /// Of stretches: the largest rise from the sample to the land around, and the steepest slope of that land.
    pub rise_m: f64,
    /// That slope.
    pub steepest: f64,
}

/// Radiance times weight, and the weight of whole hemispheres.
pub fn thrown(all: &[Along]) -> ([f64; 3], f64) {
    let casts = all.iter().flat_map(|along| &along.casts);
    let sum = casts
        .fold([0.0; 3], |sum, cast| [0, 1, 2].map(|c| sum[c] + cast.weight * cast.radiance[c]));
    (sum, all.iter().map(|along| along.whole).sum())
}

/// Exit radiance for albedo 1. Weights of a whole hemisphere sum to 1: light of equal radiance all around
/// arrives as it is.
pub fn radiance(all: &[Along]) -> [f64; 3] {
    let (sum, whole) = thrown(all);
    sum.map(|s| s.max(0.0) / whole)
}

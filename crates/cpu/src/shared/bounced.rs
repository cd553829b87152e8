//! Indirect light at a grid point, as every method of bounces sums it: along each azimuth the visible surface, from
//! below upwards.

use crate::Rgb;

/// Surface hidden by no more than this, radians, is included without weight: rounding may make it visible.
pub const NEARLY_RAD: f64 = 1e-3;

/// Visible surface along one azimuth.
#[derive(Clone, Debug, PartialEq)]
pub struct Along {
    /// The azimuth, radians.
    pub azimuth_rad: f64,
    /// Elevation of the grid point's own plane.
    pub low_rad: f64,
    /// Weight of all directions above that plane.
    pub whole: f64,
    /// From below upwards.
    pub casts: Vec<Cast>,
}

/// A part of the surface with one radiance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cast {
    /// Elevations of its visible interval: equal where it is nearly visible.
    pub low_rad: f64,
    /// The upper one.
    pub high_rad: f64,
    /// Weight of these elevations.
    pub weight: f64,
    /// Weight of a radian at the upper one.
    pub facing: f64,
    /// R, G, B.
    pub radiance: Rgb,
    /// Possible difference of that radiance, where the surface point is slightly nearer or farther.
    pub spread: Rgb,
    /// Distance of its upper end: metres for visible intervals of the exact march, else march steps.
    pub distance: f64,
    /// For the exact march: the largest rise from the grid point to the terrain around, and the steepest slope of
    /// that terrain.
    pub rise_m: f64,
    /// That slope.
    pub steepest: f64,
    /// For walks: whether it is a block of a line, with its distance that of its middle.
    pub is_block: bool,
}

/// Radiance times weight, and the weight of whole hemispheres.
pub fn light_and_weight(all: &[Along]) -> (Rgb, f64) {
    let casts = all.iter().flat_map(|along| &along.casts);
    let sum = casts
        .fold([0.0; 3], |sum, cast| [0, 1, 2].map(|c| sum[c] + cast.weight * cast.radiance[c]));
    (sum, all.iter().map(|along| along.whole).sum())
}

/// Exit radiance for albedo 1. Weights of a whole hemisphere sum to 1: uniform incident radiance is preserved.
pub fn radiance(all: &[Along]) -> Rgb {
    let (sum, whole) = light_and_weight(all);
    sum.map(|s| s.max(0.0) / whole)
}

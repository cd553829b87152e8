//! How far a pass in f32 may be from the truth in f64: formulas, each derived beside it.
//!
//! ε = 2^-24 is the largest relative error of one rounding, H the largest |height|, R the relief
//! (highest minus lowest, R ≤ 2 H), s the world length of a march step. What a sample's own line
//! meets first stands half a step away or more: grid lines across the march at whole steps, a
//! diagonal at 1/(1 + shear) of the first. Slopes err the most there, by the error of the rise over
//! s/2. An elevation errs by no more than the slope: d atan(x) = dx / (1 + x²).

/// The largest relative error of one rounding to f32.
pub const EPSILON: f64 = 1.0 / (1 << 24) as f64;

/// Slope of a march with all crossings (`horizon_march`).
///
/// A crossing's place (u, f) is off by (ε, 3ε): f0 and the shear are exact. The rise takes differences
/// first: (h00 - own) 1 rounding of R, u's term 1 + 1 + 1 (difference, place, product), f's term
/// 1 + 3 + 1, two sums of at most 2 R: 13 ε R. Distance, product, quotient and the step itself err by
/// 6 ε of the slope, R / (s/2) at most: (13 + 6) ε R / (s/2).
pub fn march_slope(relief_m: f64, step_m: f64) -> f64 {
    38.0 * EPSILON * relief_m / step_m
}

/// Slope that a line of `horizon_sweep` finds, against all samples of the line.
///
/// A height of the line errs by 5 ε H (difference 2, product 2, sum 1), the rise between two by
/// 2 · 5 + 2, seen one step away or more: 12 ε H / s; its quotient by 3 roundings of 2 H / s. Which of two
/// is higher is decided by products with 2 roundings a side of 2 H: 8 ε H / s. Heights take part twice,
/// chosen and missed: (2 · 12 + 6 + 8) ε H / s. A vertex popped in error may pop another in error; each
/// has its own place in the line, and no test shows them adding up.
pub fn sweep_slope(largest_m: f64, step_m: f64) -> f64 {
    38.0 * EPSILON * largest_m / step_m
}

/// Slope of `surface_sweep`.
///
/// What was found is then seen as by a march: [`march_slope`] with R ≤ 2 H, 76 ε H / s. Which of two
/// crossings is higher is decided from heights that err by 22 ε H each (as a march's rise, with `own` 0,
/// differences of 2 H, and f off by 4 ε: 1 + 6 + 12 + 3), the sample's own by 0, and by products with 2
/// roundings a side of 2 H: (2 · 22 + 8) ε H / (s/2) = 104 ε H / s.
pub fn surface_slope(largest_m: f64, step_m: f64) -> f64 {
    180.0 * EPSILON * largest_m / step_m
}

/// Slope by which the aimed modes of `sweep_fuse` may exceed the true horizon.
///
/// A first crossing errs as in [`march_slope`] with R ≤ 2 H; a proposal a step away or more by
/// (5 + 2 + 6) ε H / s, which is less.
pub fn aimed_slope(largest_m: f64, step_m: f64) -> f64 {
    2.0 * march_slope(largest_m, step_m)
}

//! Tolerances of f32 passes against the ground truth and their CPU references in f64: formulas, each with its
//! derivation.
//!
//! ε = 2^-24 is the largest relative error of one rounding, H the largest |height|, R the relief (highest minus
//! lowest, R ≤ 2 H), s the world length of a march step. The first surface on a grid point's own line is half a step
//! away or more: grid lines across the march at whole steps, a diagonal at 1/(1 + shear) of the first. Slopes err the
//! most there, by the error of the rise over s/2. An elevation errs by no more than the slope: d atan(x) = dx / (1 +
//! x²).

mod bend;
mod bounce;
mod light;
pub mod near;
mod points;
mod specular;

use crate::bounce_shade::LEAST_SHARE;
pub use bend::{bent, fan_weight, over, way};
pub use bounce::{
    BounceError, CastError, Gathered, Land, Slices, block_error, march_error, place_error,
    walk_error,
};
pub use light::{ShadeError, SphereGeometry, shadow_ground, shadow_stored};
pub use points::{
    MET_SHARE, crossing_elevation, ellipse_moment, ellipse_reach, ellipse_start, facet_elevation,
    gathered, visible_elevation,
};
pub use specular::{
    device_arriving, device_specular_exit, device_specular_visibility, device_sun_arriving,
    stored_f16,
};
use std::f64::consts::PI;

/// The largest relative error of one rounding to f32.
pub const EPSILON: f64 = 1.0 / (1 << 24) as f64;

/// Slope of a march with all crossings (`horizon_march`).
///
/// A crossing's place (u, f) has an error of (ε, 3ε): f0 and the shear are exact. The rise takes differences
/// first: (h00 - own) 1 rounding of R, u's term 1 + 1 + 1 (difference, place, product), f's term
/// 1 + 3 + 1, two sums of at most 2 R: 13 ε R. Distance, product, quotient and the step itself err by
/// 6 ε of the slope, R / (s/2) at most: (13 + 6) ε R / (s/2).
pub fn march_slope(relief_m: f64, step_m: f64) -> f64 {
    38.0 * EPSILON * relief_m / step_m
}

/// Slope of a line of `horizon_sweep`, against all steps of the line.
///
/// A height of the line errs by 5 ε H (difference 2, product 2, sum 1), the rise between two by
/// 2 · 5 + 2, from one step away or more: 12 ε H / s; its quotient by 3 roundings of 2 H / s. Which of two
/// is higher is decided by products with 2 roundings a side of 2 H: 8 ε H / s. Heights take part twice,
/// chosen and missed: (2 · 12 + 6 + 8) ε H / s. A vertex popped in error may pop another in error; each
/// has its own place in the line, and no test shows them adding up.
pub fn sweep_slope(largest_m: f64, step_m: f64) -> f64 {
    38.0 * EPSILON * largest_m / step_m
}

/// Slope of `surface_sweep`.
///
/// What was found then errs as by a march: [`march_slope`] with R ≤ 2 H, 76 ε H / s. Which of two
/// crossings is higher is decided from heights that err by 22 ε H each (as a march's rise, with `own` 0,
/// differences of 2 H, and f in error by 4 ε: 1 + 6 + 12 + 3), the grid point's own by 0, and by products with 2
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

// The functions below are tolerances of a pass on a device against its CPU reference, both with the same inputs. A
// device may err more than the CPU reference, which rounds as the CPU does: Vulkan rounds sums and products
// correctly, but allows a quotient an error of 2.5 ulp (5 ε) and `inversesqrt` one of 2 ulp (4 ε), and fuses products
// with sums unless `precise` forbids it. Most CPU references are f64 with negligible error.

/// `arc_tangent` of the shaders, radians.
///
/// Abramowitz & Stegun 4.4.49: 2e-8. Its argument, a quotient z ≤ 1, errs by 5 ε z, which turns the
/// angle by z / (1 + z²) of that, 2.5 ε; the last products and sums of at most π/4, 2 ε; π/2 itself
/// 0.75 ε and the difference from it π/2 ε.
pub const ARC_TANGENT: f64 = 2e-8 + 7.0 * EPSILON;

/// Slope that `horizon_sweep` stores, against its CPU reference.
///
/// The choice of occluder depends on sums and products that are not fused (`precise`): it has no tolerance. The slope
/// is their difference over a distance with equal roundings: a quotient, 5 ε, and the CPU reference's own ε.
pub fn device_slope(slope: f64) -> f64 {
    6.0 * EPSILON * slope.abs()
}

/// The same stored as f16: slopes that differ by rounding may have neighbouring f16: one step of f16
/// apart, 2^-10 of the slope, or of the smallest numbers, 2^-24.
pub fn device_slope_f16(slope: f64) -> f64 {
    device_slope(slope) + slope.abs() / 1024.0 + 1.0 / (1 << 24) as f64
}

/// Slope of a line of `horizon_sweep` with packed entries, against its CPU reference.
///
/// A kept height is rounded either way, to 2^-11 of H, and divided by its scale, 6 ε: each of the two is
/// that far from the true value at what is chosen and at what is missed, a step or more away, and errs as
/// [`sweep_slope`] besides.
pub fn device_slope_packed(largest_m: f64, step_m: f64) -> f64 {
    let kept = (1.0 / 2048.0 + 6.0 * EPSILON) * largest_m;
    2.0 * (2.0 * kept / step_m + sweep_slope(largest_m, step_m))
}

/// Slope of `horizon_march` against its CPU reference.
///
/// The CPU reference errs as [`march_slope`]. With quotients in error by 5 ε, a device's crossing has an error of
/// (6 ε, 8 ε): the rise by 1 + 8 + 10 + 4 = 23 ε R, distance, product, quotient and the step by 10 ε of
/// the slope: (23 + 10) ε R / (s/2).
pub fn device_march_slope(relief_m: f64, step_m: f64) -> f64 {
    march_slope(relief_m, step_m) + 66.0 * EPSILON * relief_m / step_m
}

/// Slope of `surface_sweep` against its CPU reference, along the grid vector (`march`, `lane`).
///
/// Each errs as [`surface_slope`]; a device besides by its quotients: f0 = k / march has an error of 5 ε, so a
/// crossing (1 - f0) / shear by 5 ε march / lane of a step, across which the surface rises by 2 H at
/// most, from s/2 away, at what is chosen and at what is missed; likewise by the crossing's own 5 ε.
pub fn device_surface_slope(largest_m: f64, step_m: f64, [march, lane]: [i32; 2]) -> f64 {
    let shallow = if lane == 0 { 0.0 } else { f64::from(march) / f64::from(lane) };
    2.0 * surface_slope(largest_m, step_m) + 40.0 * (1.0 + shallow) * EPSILON * largest_m / step_m
}

/// Slope that `fuse.glsl` finds at a grid point from a given lattice, against its CPU reference.
///
/// A first crossing: differences 2 + 2, product 2, sum 2, of which u = 1 / (1 + shear), 5 ε of a rise of
/// 2 H: 18 ε H, over half a step; its reciprocal distance and products 7 ε of a slope of 4 H / s: 64 ε H / s
/// at most. A proposal, whole steps away, errs by 29 and two slopes interpolated by 24. The CPU reference errs
/// by no more.
pub fn device_fused_slope(largest_m: f64, step_m: f64) -> f64 {
    128.0 * EPSILON * largest_m / step_m
}

/// `bounce_shade` from given shares and light, of the light's own magnitude.
///
/// What nodes are counted for errs as in `sh_shade`, in the light and in the share around. A share, what is given subtracted from
/// one, errs by 2 ε. The ratio of two shares errs by that over the larger one below 1, and by that over [`LEAST_SHARE`] at most above,
/// for each of them. Sums of four and quotients, 16 ε.
pub fn device_bounce_shade(error: &ShadeError) -> f64 {
    2.0 * error.node_weight() + (2.0 * 2.0 / LEAST_SHARE + 16.0) * EPSILON
}

/// Level of a height pyramid that `height_reduce` makes of a given one.
///
/// Places are equal (`precise`). A bilinear sample is three interpolations, each of a difference of
/// 2 H, a product, up to 2 beyond an end, and a sum: 5 ε H, and passes on what it is given: 15 ε H. Four
/// of them: 3 ε H. The CPU reference errs by as much.
pub fn device_level(largest_m: f64) -> f64 {
    2.0 * 18.0 * EPSILON * largest_m
}

/// Height that a level's B-spline has at a place.
///
/// A weight is a sum of at most 4, products and powers, over 6: 4 ε. Four of them along either axis err
/// by 32 ε H in all, sums of four by 4 ε H each: 40 ε H. The CPU reference errs by as much.
pub fn device_spline(largest_m: f64) -> f64 {
    2.0 * 40.0 * EPSILON * largest_m
}

/// Slope of `pyramid_march` on a plane, where every level is the plane itself, against ground truth.
///
/// After j octaves of reductions, 18 ε H each, and a spline, 40 ε H, an end errs by (18 j + 40) ε H, from
/// 2^j steps away or more: 58 ε H at most, at j = 1. A place errs by 2 ε of the whole side along either
/// axis, across which a plane rises by 2 H: 8 ε H. Two ends; product and quotient 6 ε of a slope of 2 H / s.
pub fn pyramid_plane_slope(largest_m: f64, step_m: f64) -> f64 {
    (2.0 * (58.0 + 8.0) + 12.0) * EPSILON * largest_m / step_m
}

/// What an elevation of `pyramid_march` errs by besides its slopes' errors, radians.
///
/// A spline of angles, 12 ε; a tangent, 3e-8 and 12 ε of itself, which turns an angle by slope / (1 +
/// slope²) of that; a steep one's complement errs by 2 ε.
pub fn pyramid_angle(slope: f64) -> f64 {
    let angle = slope.abs().atan();
    12.0 * EPSILON * angle + (3e-8 + 14.0 * EPSILON) * angle.min(1.0)
}

/// Slope of `pyramid_march` against its CPU reference, from given levels; `slope` is what is found.
///
/// A rise: two ends of a level ([`device_spline`]; bilinear samples of a stack and the surface itself err
/// by less), at equal places a step or more away; product and quotient 6 ε of a slope of R / s at most,
/// on both sides 12 ε. An angle errs by no more, by an arc tangent, and by 2 ε of the CPU reference's; the
/// spline's weights are positive and sum to 1: 12 ε. A tangent grows by 1 + slope² of that, and errs by
/// 3e-8 and 12 ε of itself (a complement's 2 ε, in 1 + slope²).
pub fn device_pyramid_slope(slope: f64, largest_m: f64, relief_m: f64, step_m: f64) -> f64 {
    let rise = (2.0 * device_spline(largest_m) + 12.0 * EPSILON * relief_m) / step_m;
    let angle = rise + ARC_TANGENT + 16.0 * EPSILON;
    let steepest = slope.abs() + angle;
    (1.0 + steepest * steepest) * angle + steepest * (3e-8 + 12.0 * EPSILON)
}

/// Elevation that a whole pyramid finds (`height_reduce`, `height_expand`, `pyramid_march`, `sweep_fuse`),
/// against its CPU references from the same heights, radians.
///
/// Weights of a reduction and of a spline are positive and sum to 1, so that what a level errs by is passed on,
/// no more: after j octaves j [`device_level`], at two ends, from 2^(j-1) steps away or more: j / 2^(j-1) ≤ 1.
/// The rest of a rise as in [`device_pyramid_slope`]. No slope is steeper than R / s: arc tangents, in
/// proportion below slope 1 (A&S 4.4.49 bounds the error of atan(x) / x), a spline's 12 ε and the CPU reference's 4 ε,
/// then [`pyramid_angle`] on the way to a slope and back, all on both sides.
pub fn device_pyramid_angle(largest_m: f64, relief_m: f64, step_m: f64) -> f64 {
    let steepest = relief_m / step_m;
    let end = device_spline(largest_m) + device_level(largest_m);
    let rise = 2.0 * end / step_m + 12.0 * EPSILON * steepest;
    let turned = 2.0 * ARC_TANGENT * steepest.min(1.0) + 16.0 * EPSILON * steepest.atan();
    rise + turned + 2.0 * pyramid_angle(steepest)
}

/// Elevation of a slope with an error of `slope_error`, radians.
pub fn device_angle(slope: f64, slope_error: f64) -> f64 {
    let flattest = (slope.abs() - slope_error).max(0.0);
    ARC_TANGENT + slope_error / (1.0 + flattest * flattest)
}

/// World length to what makes a horizon, from the same march steps: the steps' quotient 5 ε, a product
/// on each side.
pub fn device_distance(distance_m: f64) -> f64 {
    8.0 * EPSILON * distance_m
}

/// One row of one wedge of `env_wedges`, of `columns` columns of at most `brightest`, all three moments.
///
/// Angles of at most 4 π, summed and scaled: a wedge's ends have an error of 140 ε rad, where radiance may
/// begin or end, in two moments at once. Within it, turns err by 150 ε, sines by 6e-8 = ε, chords by
/// 10 ε; n sums by n ε; turning by the wedge's middle by 20 ε more.
pub fn device_wedge_row(brightest: f64, wedge_rad: f64, columns: f64) -> f64 {
    EPSILON * brightest * (2.0 * 140.0 * 2.0_f64.sqrt() + wedge_rad * (185.0 + columns))
}

/// A texel of `env_tables`, from wedge rows whose magnitudes sum to `sum` and reach `largest`, in `pieces`:
/// rows and nodes.
///
/// Elevations, sums, products and quotients within π, err by 25 ε, moments from them by 6 ε: a row by
/// 62 ε between its two ends. A piece of a row costs a difference, a product and a sum: 1.6 ε each. All
/// over π.
pub fn device_table(sum: f64, largest: f64, pieces: f64) -> f64 {
    EPSILON * (20.0 * sum + (0.6 * pieces + 2.0) * largest)
}

/// An integral of `env_rotation` around a row of `columns`, for a mean radiance of 1.
///
/// Weights are at most 2 √π / columns. Each is rounded, as are its product, 32 sums within a block and one
/// a block.
pub fn device_turn(columns: usize) -> f64 {
    2.0 * PI.sqrt() * (35.0 + columns as f64 / 32.0) * EPSILON
}

/// An entry of `light_matrix` from sums of `rows` rows: of the magnitudes of all products that it sums.
///
/// A coefficient rounds as [`device_turn`]; its weight, product and 36 sums besides.
pub fn device_light_matrix(rows: usize) -> f64 {
    (73.0 + rows as f64 / 32.0) * EPSILON
}

/// `sh_shade` from a given series of `order` and matrix, whose products' magnitudes sum to 1, of normals
/// turned by `normal_error`.
///
/// Polynomials of the normal are 2 at most, change by 6 a radian and cost 4 roundings; then 9 products and
/// sums in a column, and one of each for every coefficient.
pub fn device_sh_shade(order: usize, normal_error: f64) -> f64 {
    2.0 * (24.0 + (order * order) as f64) * EPSILON + 6.0 * normal_error
}

/// The same of the Phong specular: Y_lm of its direction are 1 at most, change by 4 a radian of it, as it turns twice as far as
/// the normal, and err by 100 ε: polynomials of degree 5 whose coefficients sum to 15, six roundings each. What the
/// lobe keeps of a band is a product of 3 quotients at most, 8 ε each. Rows are as many as columns.
pub fn device_sh_specular(order: usize, normal_error: f64) -> f64 {
    (135.0 + 3.0 * (order * order) as f64) * EPSILON + 8.0 * normal_error
}

/// `sun_specular` from a given sun's sum, for irradiance 1, at a grid point that the sun faces by `facing`, the cosine.
///
/// The lobe is (n + 1)/2π at most and changes by √(n/e) of that a radian; its direction turns by twice the
/// normal's error, and the difference of two directions, the sun's rounded to f32, by 6 ε. Its power errs by
/// 40 ε: n m e^(-n m) ≤ 1/e of a series' and quotients' 10 ε, and `exp` by 2^-22 and less. The part that is visible
/// is a quotient by a cosine that errs as the normal does and by 6 ε: at most 1, of which that is the share.
/// The mean over a disc is one of such values, whose directions err by another 6 ε, with up to 8 + 32 sums; besides
/// [`disc_rings`]. Lobes below 1e-7 of their peak are skipped: another 2 ε.
pub fn device_sun_specular(exponent: f64, normal_error: f64, facing: f64) -> f64 {
    let peak = (exponent + 1.0) / (2.0 * PI);
    let turned = (exponent / std::f64::consts::E).sqrt() * (2.0 * normal_error + 12.0 * EPSILON);
    let part = ((normal_error + 6.0 * EPSILON) / facing.max(1e-30)).min(1.0);
    peak * (turned + part + 86.0 * EPSILON)
}

/// Error of the mean of a lobe over a disc by the rings of `sun_specular`, and by those of the CPU reference, for irradiance 1,
/// where `cosine` is that between the mirror direction and the sun.
///
/// Of the lobe's peak, 2.5e-4 and 6e-5; where the disc, twice as wide, reaches the lobe's end, a power of 1 or more has a
/// kink: 8e-4. These three are not derived: they bound what was measured against 250 rings, which the test of
/// `sun_specular` repeats. A lower power is a sum of steps, of which the highest is its largest value on the disc. Across a
/// step a ring of 32 directions errs by one, and rings by half of the heaviest's weight, 0.18, as the share beyond it grows
/// by one half; the reference's by one of 48, and half of a 128th.
pub fn disc_rings(exponent: f64, sun: &ridgelight::scene::Sun, cosine: f64) -> f64 {
    if sun.is_point() {
        return 0.0;
    }
    let (radius, peak) = (0.5 * sun.diameter_rad, (exponent + 1.0) / (2.0 * PI));
    let share = if cosine.abs() > 2.0 * radius.sin() + 12.0 * EPSILON {
        3.1e-4
    } else if exponent >= 1.0 {
        8e-4
    } else {
        let nearest = (cosine.clamp(-1.0, 1.0).acos() - radius).max(0.0);
        nearest.cos().max(0.0).powf(exponent)
            * (1.0 / 32.0 + 0.5 * 0.182 + 1.0 / 48.0 + 0.5 / 128.0)
    };
    peak * share
}

/// `light_resolve` from given sums: two products a light, whose colours' own are the CPU reference's, and a sum for each of
/// `lights`.
pub fn device_resolved(radiance: f64, lights: usize) -> f64 {
    (2.0 + lights as f64) * EPSILON * radiance.abs()
}

/// Two devices: each within the tolerance of the CPU reference, on either side.
pub fn two_devices(one: f64) -> f64 {
    2.0 * one
}

//! The BRDF of V-shaped grooves with walls at right angles, along the columns, without scattered light: a closed form.

use std::f64::consts::{PI, SQRT_2};

use glam::DVec3;

/// The visible share of a wall in a direction, from its top, and the share of the view that the wall fills over
/// its own plan; `side` is 1 for walls that face east, -1 for walls that face west.
///
/// Over a length of plan w the wall fills w (z + side · x) of the view where it is not hidden. Once the other wall is
/// turned away, |x| > z, both fill 2 w z together: this one's visible part is 2 z / (z + |x|), at its top.
pub fn wall(e: DVec3, side: f64) -> [f64; 2] {
    let share = (e.z + side * e.x).max(0.0);
    let visible = if e.x.abs() > e.z { 2.0 * e.z / (e.z + e.x.abs()) } else { 1.0 };
    [if share > 0.0 { visible } else { 0.0 }, share]
}

/// For ρ = 1: the jointly visible part of each wall, min(u_l, u_v), of half the plan: f = 1/(π l_z v_z) Σ ½
/// min(u_l, u_v) s_l s_v n_z.
pub fn groove_brdf(light: DVec3, view: DVec3) -> f64 {
    let of = |side: f64| {
        let ([u, s], [v, t]) = (wall(light, side), wall(view, side));
        0.5 * u.min(v) * s * t / SQRT_2
    };
    (of(1.0) + of(-1.0)) / (PI * light.z * view.z)
}

/// The visible share u of a wall is counted in triangles, whose middles stand at (j + 1/3)/n and (j + 2/3)/n of
/// n columns: an error of ε = 1/3n at most. Where light or view sees all of a wall, the other's error is scaled
/// away; where both see a part, u_l u_v / min(u_l, u_v) = max(u_l, u_v) = U is counted: f errs by ε / (U - ε)
/// of itself, and twice that where a middle lies on the very edge.
pub fn groove_bound(columns: usize, light: DVec3, view: DVec3) -> f64 {
    let step = 1.0 / (3.0 * columns as f64);
    let of = |side: f64| wall(light, side)[0].max(wall(view, side)[0]);
    let least = [of(1.0), of(-1.0)].into_iter().filter(|u| *u > 0.0).fold(1.0, f64::min);
    if least < 1.0 { 2.0 * step / (least - step) } else { 0.0 }
}

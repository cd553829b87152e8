//! Directions on a curved base surface (Heidrich et al. 2000, §5).

use glam::{DVec2, DVec3};

use super::Curvature;
use crate::basis::triangles::Triangles;

/// Cells after which rays over periodic fields stop.
pub const REACH_CELLS: u32 = 16384;

/// Largest rotation of the frame along a path, radians: a right angle.
pub const MAX_TURN_RAD: f64 = std::f64::consts::FRAC_PI_2;

/// Unit direction, in the texel's own frame, towards the point that lies `away_m` metres away along `e` on the flat
/// field; the texel is at height `own_m`. A path that would turn further stops at [`MAX_TURN_RAD`].
pub fn bent_direction(e: DVec3, away_m: f64, own_m: f64, curvature: Curvature) -> DVec3 {
    bent_direction_within(e, away_m, own_m, (curvature, MAX_TURN_RAD))
}

/// Like [`bent_direction`], with a limit `most_turn` in radians.
pub fn bent_direction_within(
    e: DVec3,
    away_m: f64,
    own_m: f64,
    (curvature, most_turn): (Curvature, f64),
) -> DVec3 {
    let o = e.truncate();
    let per_m = DVec2::from_array(curvature.per_m) * o;
    let rate = per_m.length();
    if rate == 0.0 {
        return e;
    }
    let way_m = away_m.min(most_turn / rate);
    let height_m = own_m + way_m * e.z;
    let turn = rate * way_m;
    let along = per_m / rate;
    // Per metre of the path, so that near points keep a direction: sin(v)/v and (1 - cos v)/v of v = turn.
    let [arc, fall] = match turn {
        0.0 => [1.0, 0.0],
        _ => [turn.sin() / turn, 2.0 * (0.5 * turn).sin().powi(2) / turn],
    };
    let of_o = o.dot(along);
    let plan = o + along * (of_o * (arc - 1.0) + height_m * rate * arc);
    let up = e.z - of_o * fall - height_m * rate * fall;
    DVec3::new(plan.x, plan.y, up).normalize()
}

/// For each direction on the flat field, the triangles around it and their solid angle.
pub struct Fans {
    /// For each direction, the two other corners of its triangles, counter-clockwise.
    pub pairs: Vec<Vec<[u32; 2]>>,
    /// Solid angle of those triangles, sr.
    pub flat_sr: Vec<f64>,
}

impl Fans {
    /// From a triangulation of directions.
    pub fn of(triangles: &Triangles, vectors: &[DVec3]) -> Self {
        let mut pairs = vec![Vec::new(); vectors.len()];
        for [a, b, c] in triangles.corners() {
            for (of, pair) in [(a, [*b, *c]), (b, [*c, *a]), (c, [*a, *b])] {
                pairs[*of as usize].push(pair);
            }
        }
        let flat_sr = triangles.fans_sr(vectors).iter().map(|third| 3.0 * third).collect();
        Self { pairs, flat_sr }
    }
}

//! Direct light of suns, key lights and sphere lights at a path vertex.

use super::place::Place;
use super::{Tracer, colour, given, one};
use crate::shared::random::{direction_about, on_circle};
use crate::tolerance::near::{Near, Near3, dot, minus, product};
use std::f64::consts::PI;

/// A direction of a light and its possible contribution.
pub(super) struct ActiveLights {
    pub(super) e: Near3,
    pub(super) brought: Near3,
    /// Whether it faces the vertex.
    pub(super) reflected: Option<bool>,
    pub(super) shines: Option<bool>,
    /// Where the light begins, for sphere lights.
    pub(super) end_m: Option<Near>,
}

impl Tracer<'_> {
    /// Possible contribution of a light; none where rounding decides which point of it a ray targets.
    pub(super) fn light(
        &self,
        place: &Place,
        centre: Near3,
        r: usize,
        u: [Near; 2],
    ) -> Option<ActiveLights> {
        let [suns, keys, _] = self.counts();
        let source = given(self.lights[2 * r]);
        let colour = colour(self.lights[2 * r + 1]);
        let axis = [source[0], source[1], source[2]];
        let mut end_m = None;
        let mut shines = Some(true);
        let mut solid = one();
        let e = if (suns..suns + keys).contains(&r) {
            towards_key(source, u)
        } else {
            let is_far = r < suns;
            let to = if is_far { axis } else { minus(axis, centre) };
            let away = dot(to, to).sqrt();
            let sine = source[3] / away;
            let sine2 = sine * sine;
            let root = (one() - sine2).max(Near::ZERO).sqrt();
            let cone = if is_far { source[3] } else { sine2 / (one() + root) };
            let off = u[0] * cone;
            let is_apart = away.above(Near::ZERO)?;
            let above = [Near::ZERO, Near::ZERO, one()];
            let towards = if is_apart { to.map(|t| t / away) } else { above };
            if !is_far {
                shines = one().above(sine2);
                let two = Near::of(2.0);
                let beside2 = off * (two - off) * away * away;
                let half = (source[3] * source[3] - beside2).max(Near::ZERO).sqrt();
                end_m = Some(((one() - off) * away - half).max(Near::ZERO));
                solid = Near::of(2.0 * PI) * cone;
                // From inside no shadow ray is traced.
                if shines == Some(false) {
                    let (reflected, brought) = (Some(false), [Near::ZERO; 3]);
                    return Some(ActiveLights { e: above, brought, reflected, shines, end_m });
                }
            }
            direction_about(towards, off, u[1])?
        };
        let of = self.reflected(place, e);
        let brought = product(of.light, colour).map(|l| l * solid);
        let reflected = of.facing.above(Near::ZERO);
        Some(ActiveLights { e, brought, reflected, shines, end_m })
    }
}

/// A direction of `turn` turns, at 1 - cos of its zenith angle.
pub(super) fn at_turn(turn: Near, below: Near) -> Near3 {
    let root = (below * (Near::of(2.0) - below)).max(Near::ZERO).sqrt();
    let [cos, sin] = on_circle(turn - Near::of(turn.v.floor())).map(|c| c * root);
    [cos, sin, one() - below]
}

pub(super) fn mix(a: Near, b: Near, share: Near) -> Near {
    a * (one() - share) + b * share
}

/// A direction of a key light, uniform over its solid angle.
fn towards_key(key: [Near; 4], u: [Near; 2]) -> Near3 {
    at_turn(key[0] + key[1] * u[1], Near::of(2.0) * mix(key[2], key[3], u[0]))
}

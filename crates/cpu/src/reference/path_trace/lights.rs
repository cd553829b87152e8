//! Direct light of suns, key lights, sphere lights and an environment at a path vertex.

use super::place::Place;
use super::{Traced, Tracer, colour, given, one};
use crate::shared::random::{direction_about, on_circle};
use crate::tolerance::near::{Near, Near3, angle, dot, minus, plus, product, times};
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
fn at_turn(turn: Near, below: Near) -> Near3 {
    let root = (below * (Near::of(2.0) - below)).max(Near::ZERO).sqrt();
    let [cos, sin] = on_circle(turn - Near::of(turn.v.floor())).map(|c| c * root);
    [cos, sin, one() - below]
}

fn mix(a: Near, b: Near, share: Near) -> Near {
    a * (one() - share) + b * share
}

/// A direction of a key light, uniform over its solid angle.
fn towards_key(key: [Near; 4], u: [Near; 2]) -> Near3 {
    at_turn(key[0] + key[1] * u[1], Near::of(2.0) * mix(key[2], key[3], u[0]))
}

/// An environment's radiance and sampling density.
pub(super) struct Environment {
    pub(super) size: [i32; 2],
    pub(super) texels: Vec<[f32; 4]>,
    pub(super) cdf: Vec<f32>,
    pub(super) rotation_turns: Near,
}

impl Environment {
    /// First entry above u among n entries of the CDF from `at` on, `step` apart: in f32 as the shader.
    fn picked(&self, u: Near, at: usize, step: usize, n: i32) -> i32 {
        let (mut low, mut high) = (0, n - 1);
        while low < high {
            let middle = (low + high) >> 1;
            if f64::from(self.cdf[at + middle as usize * step]) > u.v {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        low
    }

    /// A direction drawn in proportion to its texels' light, and its texel.
    pub(super) fn towards_light(&self, u: [Near; 2], v: [Near; 2]) -> (Near3, [f32; 4]) {
        let [width, height] = self.size;
        let across = width as usize + 1;
        let row = self.picked(u[0], 0, across, height);
        let col = self.picked(u[1], row as usize * across + 1, 1, width);
        let half_row = Near::of(0.25) / Near::given(height as f32);
        let sine2 = |row: i32| {
            let [_, sine] = on_circle(Near::given(row as f32) * half_row);
            sine * sine
        };
        let below = Near::of(2.0) * mix(sine2(row), sine2(row + 1), v[1]);
        let across = (Near::given(col as f32) + v[0]) / Near::given(width as f32);
        let turn = Near::of(0.5) - across + self.rotation_turns;
        (at_turn(turn, below), self.texels[(row * width + col) as usize])
    }

    /// Adds the radiance along e, weighted by the balance heuristic: where rounding decides between texels, that of
    /// f64, with the largest difference to any other of them in doubt. Straight above, e may belong to any column.
    pub(super) fn towards(&self, e: Near3, density: Near, traced: &mut Traced) {
        let [width, height] = self.size;
        let length = (e[0] * e[0] + e[1] * e[1]).sqrt();
        let [azimuth, zenith] = [angle(e[1], e[0]), angle(length, e[2])];
        let turn = Near::of(0.5) - azimuth / Near::of(2.0 * PI) + self.rotation_turns;
        let down = zenith / Near::of(PI);
        let texels = |of: Near, n: i32| {
            let place = of * Near::given(n as f32);
            [0.0, -1.0, 1.0].map(|side| (place.v + side * place.off).floor() as i32)
        };
        let [col, west, east] = texels(turn, width);
        let [row, top, bottom] = texels(down, height).map(|row| row.clamp(0, height - 1));
        let at = |col: i32, row: i32| {
            let from_there = self.texels[(row * width + col.rem_euclid(width)) as usize];
            let weight = density / (density + Near::given(from_there[3])).max(Near::of(1e-30));
            times(weight, colour(from_there))
        };
        let light = at(col, row);
        traced.light = plus(traced.light, light);
        let mut apart = [0.0_f64; 3];
        // Once around covers all of them.
        let cols = west..=east.min(west.saturating_add(width - 1));
        for other in cols.flat_map(|c| (top..=bottom).map(move |r| (c, r))) {
            let other = at(other.0, other.1);
            for c in 0..3 {
                let more_off = (other[c].off - light[c].off).max(0.0);
                apart[c] = apart[c].max((light[c].v - other[c].v).abs() + more_off);
            }
        }
        if apart != [0.0; 3] {
            traced.doubt(apart);
        }
    }
}

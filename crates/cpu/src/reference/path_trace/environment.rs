//! An environment: importance sampling, and radiance by direction.

use super::lights::{at_turn, mix};
use super::{Traced, colour};
use crate::shared::random::on_circle;
use crate::tolerance::near::{Near, Near3, angle, plus, times};
use std::f64::consts::PI;

/// Radiance and sampling density.
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

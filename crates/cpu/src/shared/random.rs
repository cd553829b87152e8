//! `random.glsl`: random numbers that are a function of where they are used. Words are the shader's own, bit by bit.

use crate::tolerance::EPSILON;
use crate::tolerance::near::{Near, Near3, normalize, plus, times};
use std::f64::consts::TAU;

/// Four words mixed (Jarzynski & Olano 2020, "Hash functions for GPU rendering", pcg4d).
fn mixed(v: [u32; 4]) -> [u32; 4] {
    let stirred = |[mut x, mut y, mut z, mut w]: [u32; 4]| {
        x = x.wrapping_add(y.wrapping_mul(w));
        y = y.wrapping_add(z.wrapping_mul(x));
        z = z.wrapping_add(x.wrapping_mul(y));
        w = w.wrapping_add(y.wrapping_mul(z));
        [x, y, z, w]
    };
    let v = stirred(v.map(|v| v.wrapping_mul(1_664_525).wrapping_add(1_013_904_223)));
    stirred(v.map(|v| v ^ (v >> 16)))
}

/// Words for a grid point.
pub fn words_of(place: [u32; 4]) -> [u32; 4] {
    let [x, y, z, w] = mixed(place);
    mixed([y, z, w, x])
}

/// A random permutation of words in which each bit is flipped by lower bits only (Laine & Karras 2011 with the
/// constants of Vegdahl 2021).
fn nested(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^= x.wrapping_mul(0x53a2_2864);
    x
}

/// Point of an Owen-scrambled Sobol' net of 2^bits points in [0, 1)²: numbers of 24 bits.
pub fn net_point(order: u32, bits: u32, words: [u32; 4]) -> [f32; 2] {
    let reversed = (order << (32 - bits)).reverse_bits();
    let mask = (1 << bits) - 1;
    let i = nested(reversed, words[0]) & mask;
    let x = (nested(i, words[3]) & !mask) | reversed;
    let mut y = i ^ ((i & 0xaa) >> 1);
    y ^= (y & 0xcc) >> 2;
    y ^= (y & 0xf0) >> 4;
    let y = nested(y, words[1]);
    [x, y].map(|word| (word.reverse_bits() >> 8) as f32 / 16_777_216.0)
}

/// Position of `order` in a shuffled row of 2^bits.
pub fn shuffled(order: u32, bits: u32, word: u32) -> u32 {
    nested((order << (32 - bits)).reverse_bits(), word) & ((1 << bits) - 1)
}

/// (cos, sin) of `turn` turns. Series to 2e-9 of an angle that is a difference and a product, 2 ε of π/4; sums and
/// products of theirs round by less than 6 ε.
pub fn on_circle(turn: Near) -> [Near; 2] {
    let (sin, cos) = (TAU * turn.v).sin_cos();
    let off = TAU * turn.off + 2e-9 + 8.0 * EPSILON;
    [cos, sin].map(|v| Near { v, off: off.min(2.0) })
}

/// The direction at `up` = 1 - cos of the angle to a unit vector, `turn` turns around it (basis of Duff et al. 2017,
/// "Building an orthonormal basis, revisited"); none where rounding decides between its two bases.
pub fn direction_about(axis: Near3, up: Near, turn: Near) -> Option<Near3> {
    let one = Near::of(1.0);
    let is_below = Near::ZERO.above(axis[2])?;
    let side = if is_below { -one } else { one };
    let a = -one / (side + axis[2]);
    let b = axis[0] * axis[1] * a;
    let u = [one + side * axis[0] * axis[0] * a, side * b, -side * axis[0]];
    let v = [b, side + axis[1] * axis[1] * a, -axis[1]];
    let root = (up * (Near::of(2.0) - up)).max(Near::ZERO).sqrt();
    let round = on_circle(turn).map(|c| c * root);
    Some(normalize(plus(plus(times(round[0], u), times(round[1], v)), times(one - up, axis))))
}

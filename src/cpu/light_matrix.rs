//! What the environment makes of what is seen: its series, and the matrix from that.

use crate::basis::light::{fit_above_ground, lobe, plane};
use crate::basis::product::triples;
use crate::basis::slice::{Slices, slice_index};
use crate::basis::{bands, window};
use crate::scene::{Quality, Receiver, Window};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// ∫ L Y_lm over the directions above `lowest_rad` of an environment of `height` rows, whose first rows'
/// sums are `turns` ([`super::env_turns`]).
///
/// # Panics
/// When the sums are of another order.
pub fn integrals(turns: &[Vec<DVec3>], height: usize, order: usize, lowest_rad: f64) -> Vec<DVec3> {
    let slices = Slices::new(order);
    let edge = |row: usize| (FRAC_PI_2 - PI * row as f64 / height as f64).max(lowest_rad);
    let rows: Vec<Vec<f64>> =
        (0..turns.len()).map(|row| slices.between(edge(row + 1), edge(row))).collect();
    bands(order)
        .map(|(l, m)| {
            let part = slice_index(l, m.unsigned_abs());
            let turn = (order - 1).wrapping_add_signed(m);
            rows.iter().zip(turns).map(|(slice, sums)| slice[part] * sums[turn]).sum()
        })
        .collect()
}

/// Exit radiance's matrix `[receiver][coefficient]` from the integrals: above ground alone where
/// `is_fitted`, else of all directions.
///
/// # Panics
/// When the integrals are not those of the receiver's order.
pub fn light_matrix(quality: &Quality, integrals: &[DVec3], is_fitted: bool) -> Vec<Vec<DVec3>> {
    let order = quality.sh_order as usize;
    let light_order = integrals.len().isqrt();
    let triples = triples(order);
    let factors = match quality.window {
        Window::None => vec![1.0; light_order],
        Window::Lanczos => window::lanczos(light_order, light_order as f64),
        Window::Hann => window::hann(light_order, light_order as f64),
        Window::Nonnegative => window::nonnegative(light_order),
    };
    let channel = |c: usize| {
        let projected: Vec<f64> = integrals.iter().map(|i| i[c]).collect();
        let light: Vec<f64> = match is_fitted {
            true => fit_above_ground(light_order)
                .iter()
                .map(|row| row.iter().zip(&projected).map(|(f, b)| f * b).sum())
                .collect(),
            false => window::apply(&factors, &projected),
        };
        match quality.receiver {
            Receiver::Plane => plane(&triples, order, &light),
            Receiver::Lobe => lobe(&triples, order, &light),
        }
    };
    let [red, green, blue] = [channel(0), channel(1), channel(2)];
    let rows = red.iter().zip(&green).zip(&blue);
    rows.map(|((r, g), b)| (0..r.len()).map(|k| DVec3::new(r[k], g[k], b[k])).collect()).collect()
}

//! Fourier sums of each environment row.

use glam::DVec3;
use ridgelight::scene::Environment;
use std::f64::consts::{FRAC_1_PI, PI, TAU};

/// ∫ over azimuth of L times 1/√2π, cos mφ/√π and sin mφ/√π, m below `order`, of the first `rows` rows:
/// `[row][m + order - 1]`, each column's integral exact.
pub fn env_rotation(environment: &Environment, rows: usize, order: usize) -> Vec<Vec<DVec3>> {
    let step = TAU / environment.width() as f64;
    let weight = |turn: isize, col: usize| {
        // From the column's end to its begin: columns run clockwise from azimuth π.
        let begin = PI + environment.rotation_rad() - step * col as f64;
        let m = turn as f64;
        let inner = |phi: f64| match turn {
            0 => phi / TAU.sqrt(),
            1.. => (m * phi).sin() / m * FRAC_1_PI.sqrt(),
            // ∫ sin |m|φ = -cos mφ / |m|.
            _ => (m * phi).cos() / m * FRAC_1_PI.sqrt(),
        };
        inner(begin) - inner(begin - step)
    };
    let turns = 1 - order as isize..order as isize;
    (0..rows)
        .map(|row| {
            let of_row = &environment.texels()[row * environment.width()..];
            let sum = |turn| {
                let all = of_row[..environment.width()].iter().enumerate();
                all.map(|(col, l)| weight(turn, col) * DVec3::from_array(l.map(f64::from))).sum()
            };
            turns.clone().map(sum).collect()
        })
        .collect()
}

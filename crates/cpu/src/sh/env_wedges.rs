//! The environment summed over each azimuth's wedge, row by row: three azimuthal moments.

use glam::{DVec2, DVec3};
use ridgelight::plan::azimuths::Azimuth;
use ridgelight::scene::{Border, Environment};
use std::f64::consts::{PI, TAU};

/// Integrals over an azimuth's wedge of L cos φ, L sin φ and L in one row of the environment.
pub fn wedge_row(env: &Environment, azimuth: &Azimuth, row: usize) -> [DVec3; 3] {
    let width = env.width() as i64;
    // Columns run clockwise from west: column x begins at azimuth pi + rotation - 2 pi x / width.
    let per_rad = width as f64 / TAU;
    let middle = (PI + env.rotation_rad() - f64::from(azimuth.centre_rad)) * per_rad;
    let half_wedge = 0.5 * f64::from(azimuth.wedge_rad) * per_rad;
    let (mut along, mut across, mut plain) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
    for x in (middle - half_wedge).floor() as i64..(middle + half_wedge).ceil() as i64 {
        let low = (x as f64 - middle).max(-half_wedge);
        let high = ((x + 1) as f64 - middle).min(half_wedge);
        let texel = env.texels()[row * env.width() + x.rem_euclid(width) as usize];
        let radiance = DVec3::from_array(texel.map(f64::from));
        // Counter-clockwise from the wedge's middle, at the middle of the covered part.
        let turn = -0.5 * (low + high) / per_rad;
        let width_rad = (high - low) / per_rad;
        // The integral of cos over an arc is its chord, 2 sin(half), times cos of its middle.
        let chord = 2.0 * (0.5 * width_rad).sin();
        along += radiance * (turn.cos() * chord);
        across += radiance * (turn.sin() * chord);
        plain += radiance * width_rad;
    }
    // The mean direction of a wedge is its middle.
    let wedge = DVec2::new(azimuth.wedge_cos.into(), azimuth.wedge_sin.into());
    let centre = wedge.normalize_or_zero();
    [centre.x * along - centre.y * across, centre.y * along + centre.x * across, plain]
}

/// `wedge_rows` as `[azimuth][row][moment]`, of the rows with light that can arrive.
pub fn env_wedges(env: &Environment, border: Border, azimuths: &[Azimuth]) -> Vec<[DVec3; 3]> {
    let rows = |a| (0..env.rows_above_ground(border)).map(move |row| wedge_row(env, a, row));
    azimuths.iter().flat_map(rows).collect()
}

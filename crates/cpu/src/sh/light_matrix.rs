//! SH series of the environment, and the matrix from visibility to exit radiance.

use glam::DVec3;
use ridgelight::basis::light::{cosine_lobe, fit_above_ground, plane};
use ridgelight::basis::product;
use ridgelight::basis::product::{Triple, triples};
use ridgelight::basis::slice::{Slices, slice_index};
use ridgelight::basis::{bands, window};
use ridgelight::scene::{Border, Quality, Receiver, Window};
use std::f64::consts::{FRAC_PI_2, PI};

/// Whether the environment's series is fitted to directions above ground: all that a plane can see where the border
/// is not open; a window needs a series of all directions.
pub fn is_fitted(quality: &Quality, border: Border) -> bool {
    let is_plain = quality.receiver == Receiver::Plane && quality.window == Window::None;
    is_plain && border != Border::Open
}

/// Weights of the first `rows` of an environment's `height` rows in each coefficient, times the Fourier term of its
/// m: ∫ Θ_lm dz, or where `is_fitted` the best fit above ground of those. `[coefficient][row]`.
pub fn row_weights((height, rows): (usize, usize), order: usize, is_fitted: bool) -> Vec<Vec<f64>> {
    let slices = Slices::new(order);
    let lowest_rad = if is_fitted { 0.0 } else { -FRAC_PI_2 };
    let edge = |row: usize| (FRAC_PI_2 - PI * row as f64 / height as f64).max(lowest_rad);
    let rows: Vec<Vec<f64>> =
        (0..rows).map(|row| slices.between(edge(row + 1), edge(row))).collect();
    let part = |(l, m): (usize, isize)| slice_index(l, m.unsigned_abs());
    if !is_fitted {
        return bands(order).map(|b| rows.iter().map(|s| s[part(b)]).collect()).collect();
    }
    let fit = fit_above_ground(order);
    let of = |(i, (_, m)): (usize, (usize, isize)), slice: &[f64]| {
        let alike = bands(order).enumerate().filter(|(_, b)| b.1 == m);
        alike.map(|(k, b)| fit[i][k] * slice[part(b)]).sum()
    };
    bands(order).enumerate().map(|at| rows.iter().map(|s| of(at, s)).collect()).collect()
}

/// The series of an environment of `height` rows, whose first rows' sums are `turns`
/// ([`crate::env_rotation`]): its integrals with Y_lm, or where `is_fitted` the best fit above ground.
pub fn series(turns: &[Vec<DVec3>], height: usize, order: usize, is_fitted: bool) -> Vec<DVec3> {
    let weights = row_weights((height, turns.len()), order, is_fitted);
    bands(order)
        .zip(weights)
        .map(|((_, m), weights)| {
            let turn = (order - 1).wrapping_add_signed(m);
            weights.iter().zip(turns).map(|(w, sums)| *w * sums[turn]).sum()
        })
        .collect()
}

/// The same of a uniform sky of this radiance.
pub fn add_sky(series: &mut [DVec3], sky: [f32; 3]) {
    series[0] += (4.0 * PI).sqrt() * DVec3::from_array(sky.map(f64::from));
}

/// Exit radiance's matrix `[receiver][coefficient]` from the environment's series.
pub fn light_matrix(quality: &Quality, series: &[DVec3]) -> Vec<Vec<DVec3>> {
    matrix(quality, series, |triples, order, light| match quality.receiver {
        Receiver::Plane => plane(triples, order, light),
        Receiver::Cosine => cosine_lobe(triples, order, light),
    })
}

/// The matrix from visibility to incident light, both as series: `[incident coefficient][visibility coefficient]`.
pub fn specular_matrix(quality: &Quality, series: &[DVec3]) -> Vec<Vec<DVec3>> {
    matrix(quality, series, |triples, _, light| product::light_matrix(triples, light))
}

fn matrix(
    quality: &Quality,
    series: &[DVec3],
    of: impl Fn(&[Triple], usize, &[f64]) -> Vec<Vec<f64>>,
) -> Vec<Vec<DVec3>> {
    let order = quality.sh_order as usize;
    let light_order = series.len().isqrt();
    let triples = triples(order);
    let factors = match quality.window {
        Window::None => vec![1.0; light_order],
        Window::Lanczos => window::lanczos(light_order, light_order as f64),
        Window::Hann => window::hann(light_order, light_order as f64),
        Window::Nonnegative => window::nonnegative(light_order),
    };
    let channel = |c: usize| {
        let light: Vec<f64> = series.iter().map(|s| s[c]).collect();
        of(&triples, order, &crate::basis::apply_window(&factors, &light))
    };
    let [red, green, blue] = [channel(0), channel(1), channel(2)];
    let rows = red.iter().zip(&green).zip(&blue);
    rows.map(|((r, g), b)| (0..r.len()).map(|k| DVec3::new(r[k], g[k], b[k])).collect()).collect()
}

//! Light below each elevation of an azimuth's slice, weighted by a Phong lobe. By Gauss' rule, where the shader has a closed
//! form.

use crate::tolerance::EPSILON;
use glam::DVec3;
use ridgelight::basis::quadrature::integral;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Geometry of the tables.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slices {
    /// Phong exponent.
    pub exponent: f64,
    /// Elevations of the lobe's peak, from `first_rad` to π: 2 or more.
    pub peaks: usize,
    /// Elevation of the first peak.
    pub first_rad: f64,
    /// Elevations up to which light counts, from `bottom_rad` to the zenith; 1 for the zenith alone.
    pub nodes: usize,
    /// The lowest elevation.
    pub bottom_rad: f64,
}

/// A table's value, and its tolerance.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tabulated {
    /// Radiance for specular of scale 1.
    pub light: DVec3,
    /// Of the device.
    pub tolerance: DVec3,
}

/// ∫ (n + 1) / 2π max(0, cos(ω - `peak_rad`))ⁿ cos ω dω from `low_rad` to `high_rad`, within [-π/2, π/2].
pub fn phong_between(n: f64, peak_rad: f64, low_rad: f64, high_rad: f64) -> f64 {
    // Twelve deviations from the peak the lobe is below e^-72 of it.
    let reach = (12.0 / n.max(1e-9).sqrt()).min(FRAC_PI_2);
    let mut sum = 0.0;
    for peak in [peak_rad - TAU, peak_rad, peak_rad + TAU] {
        let (low, high) = (low_rad.max(peak - reach), high_rad.min(peak + reach));
        if low >= high {
            continue;
        }
        let panels = ((high - low) * (n + 1.0).sqrt()).ceil().max(1.0) as usize;
        let width = (high - low) / panels as f64;
        for i in 0..panels {
            let first = low + width * i as f64;
            let at = |w: f64| (w - peak).cos().max(0.0).powf(n) * w.cos();
            sum += integral(first, first + width, at);
        }
    }
    (n + 1.0) / TAU * sum
}

/// Error of the shader's antiderivative of [`phong_between`].
///
/// Of (n + 1) / 2π cosⁿ⁺¹ over half its range, at most √(π / 2q) with q = n + 3/2: the expansion ends before q^-3, whose factor
/// was fitted: 3.5e-3 at n = 0, less above (the test of this function finds no larger one than 4e-3); the error function errs by
/// 1.5e-7, and the exponential, of which x e^-x ≤ 1/e counts, with quotients and roots by 16 ε. Below n = 5 it is that of n + 4,
/// and two steps of recursion multiply it by (n + 5) / (n + 4) and (n + 3) / (n + 2), 1.9 at most. Directions err by 6 ε, where the
/// lobe is (n + 1) / 2π at most.
pub fn phong_error(n: f64) -> f64 {
    let (q, steps) = if n < 5.0 { (n + 5.5, 1.9) } else { (n + 1.5, 1.0) };
    let whole = (FRAC_PI_2 / q).sqrt();
    let share = 4e-3 / (q * q * q) + 2.0 * 1.5e-7 + 16.0 * EPSILON;
    (n + 1.0) / TAU * (steps * whole * share + 6.0 * EPSILON) + 12.0 * EPSILON / TAU
}

/// `specular_tables` as `[azimuth][node][peak]`: of a sky's `sky_light`, radiance times width, in each azimuth, and of `wedge_rows`, where
/// given, of an environment of `height` rows.
pub fn specular_tables(
    slices: &Slices,
    sky_light: &[DVec3],
    (height, rows): (usize, usize),
    wedge_rows: Option<&[[DVec3; 3]]>,
) -> Vec<Tabulated> {
    let Slices { exponent, peaks, first_rad, nodes, bottom_rad } = *slices;
    let step = (PI - first_rad) / (peaks - 1) as f64;
    let elevation = |node: usize| match nodes {
        1 => FRAC_PI_2,
        _ => bottom_rad + (FRAC_PI_2 - bottom_rad) * node as f64 / (nodes - 1) as f64,
    };
    let row_top = |row: usize| FRAC_PI_2 - PI * row as f64 / height as f64;
    // Pieces of one row between two nodes: node, row, ends.
    let mut pieces = Vec::new();
    let (mut row, mut lower) = (rows - 1, bottom_rad);
    for node in 0..nodes {
        while lower < elevation(node) - 1e-12 {
            let upper = row_top(row).min(elevation(node));
            pieces.push((node, row, lower, upper));
            if row_top(row) <= elevation(node) + 1e-12 {
                row = row.saturating_sub(1);
            }
            lower = upper;
        }
    }
    let mut all = vec![Tabulated::default(); sky_light.len() * nodes * peaks];
    for peak in 0..peaks {
        let peak_rad = first_rad + step * peak as f64;
        let shares: Vec<f64> =
            pieces.iter().map(|p| phong_between(exponent, peak_rad, p.2, p.3)).collect();
        for (k, sky) in sky_light.iter().enumerate() {
            let (mut sum, mut off, mut next) = (DVec3::ZERO, DVec3::ZERO, 0);
            for node in 0..nodes {
                while next < pieces.len() && pieces[next].0 == node {
                    let row = pieces[next].1;
                    let light = *sky + wedge_rows.map_or(DVec3::ZERO, |all| all[k * rows + row][2]);
                    sum += light * shares[next];
                    // Both ends, and a sum.
                    off += light * 2.0 * phong_error(exponent) + 2.0 * EPSILON * sum;
                    next += 1;
                }
                let tolerance = off + 4.0 * EPSILON * sum;
                all[(k * nodes + node) * peaks + peak] = Tabulated { light: sum, tolerance };
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The shader's antiderivative in f64 is within its stated error of the quadrature.
    #[test]
    fn the_closed_form_keeps_its_error() {
        let cosine_integral = |n: f64, s: f64, y2: f64| {
            let q = if n < 5.0 { n + 4.0 } else { n } + 1.5;
            let (y, e) = (y2.sqrt(), (-0.5 * q * y2).exp());
            let t = 1.0 / (1.0 + 0.327_591_1 * (0.5 * q).sqrt() * y);
            let series = 1.421_413_741 + t * (-1.453_152_027 + t * 1.061_405_429);
            let erf = 1.0 - e * t * (0.254_829_592 + t * (-0.284_496_736 + t * series));
            let mut c = (FRAC_PI_2 / q).sqrt() * (1.0 - 1.0 / (16.0 * q * q)) * erf
                + e * y * (y2 + 3.0 / q) / (48.0 * q);
            c = c.copysign(s);
            if n < 5.0 {
                c = ((n + 5.0) * c - (-0.5 * (n + 4.0) * y2).exp() * s) / (n + 4.0);
                c = ((n + 3.0) * c - (-0.5 * (n + 2.0) * y2).exp() * s) / (n + 2.0);
            }
            c
        };
        let below = |n: f64, peak: f64, w: f64| {
            let (up, along) = peak.sin_cos();
            let u = w - peak;
            let s = if u.cos() <= 0.0 { if up > 0.0 { -1.0 } else { 1.0 } } else { u.sin() };
            let y2 = -(1.0 - s * s).max(1e-30).ln();
            ((n + 1.0) * along * cosine_integral(n, s, y2) + up * (-0.5 * (n + 1.0) * y2).exp())
                / TAU
        };
        for n in [0.0, 0.5, 1.0, 3.0, 4.9, 5.0, 8.0, 20.0, 100.0, 1000.0, 1e4] {
            let mut worst = 0.0_f64;
            for (i, j) in (0..61).flat_map(|i| (0..19).map(move |j| (i, j))) {
                let peak = (-89.7 + 4.4 * f64::from(i)).to_radians();
                let w = (5.0 * f64::from(j)).to_radians();
                let got = below(n, peak, w) - below(n, peak, 0.0);
                worst = worst.max((got - phong_between(n, peak, 0.0, w)).abs());
            }
            let bound = 2.0 * phong_error(n);
            println!("{n}: {worst:.2e} of {bound:.2e}");
            assert!(worst <= bound, "{n}: {worst:e} of {bound:e}");
        }
    }

    /// The whole lobe has integral 1: over all slices of a lobe that points straight up, half of it above every elevation.
    #[test]
    fn a_lobe_straight_up_is_whole() {
        for n in [0.0, 1.0, 20.0, 1e4] {
            let whole = TAU * phong_between(n, FRAC_PI_2, 0.0, FRAC_PI_2);
            assert!((whole - 1.0).abs() < 1e-12, "{n}: {whole}");
        }
    }
}

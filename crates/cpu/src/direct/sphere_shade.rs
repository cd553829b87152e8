//! Direct light of a sphere light: the shader's own slices, each from the oracle's profile in f64, where the shader
//! marches over blocks of cells.

use crate::light::{Receiver, Site, diffuse_at};
use crate::oracle::Oracle;
use crate::shared::field::towards_m;
use crate::specular_tables::phong_error;
use crate::tolerance::{EPSILON, SphereGeometry};
use glam::DVec3;
use ridgelight::basis::harmonics::evaluate;
use ridgelight::scene::SphereLight;
use std::f64::consts::{E, FRAC_PI_2, PI, TAU};

/// Exit radiance of a grid point for a sphere light of radiance 1 and albedo 1; `slices` is the setting.
pub fn sphere_at(oracle: &Oracle, light: &SphereLight, slices: u32, row: usize, col: usize) -> f64 {
    let counts = light.slices(slices, oracle.field().cell_m());
    sphere_with(oracle, light, counts, [row, col], &diffuse_at(oracle, row, col))[0]
}

/// Exit radiance of receivers at a grid point, diffuse of albedo 1 or specular of scale 1. The two counts are the slices where the
/// sphere is narrow as viewed from there, and where it surrounds the grid point.
pub fn sphere_with(
    oracle: &Oracle,
    light: &SphereLight,
    [narrow, around]: [u32; 2],
    [row, col]: [usize; 2],
    receivers: &[Receiver],
) -> Vec<f64> {
    let count = count_at(oracle, light, [narrow, around], [row, col]);
    Site::of(oracle, [row, col], receivers).sphere(light, count)
}

/// The number of slices from a grid point.
fn count_at(
    oracle: &Oracle,
    light: &SphereLight,
    [narrow, around]: [u32; 2],
    [row, col]: [usize; 2],
) -> usize {
    let [east, north] = towards_m(oracle.field(), row, col, light);
    let away = east.hypot(north);
    if light.radius_m < away {
        let wide = f64::from(around) * (light.radius_m / away).asin() / PI;
        narrow.max((wide - 0.001).ceil() as u32) as usize
    } else {
        around as usize
    }
}

/// Incident light of a sphere light of radiance 1 at a grid point, as a series of n², by the same slices as [`sphere_with`]. What is
/// visible of each quarter of a slice arrives from its middle.
pub fn arriving(
    oracle: &Oracle,
    light: &SphereLight,
    counts: [u32; 2],
    place: [usize; 2],
    order: usize,
) -> Vec<f64> {
    let receivers = diffuse_at(oracle, place[0], place[1]);
    let site = Site::of(oracle, place, &receivers);
    let mut series = vec![0.0; order * order];
    for slice in site.slices(light, count_at(oracle, light, counts, place)) {
        let plane_rad = receivers[0].slice(slice.azimuth_rad).low;
        let [low, high] = slice.ends_rad;
        let quarter = 0.25 * (high - low);
        for part in 0..4 {
            let begin = low + quarter * f64::from(part);
            let (mut visible, mut moment) = (0.0, 0.0);
            for [low, high] in &slice.visible_rad {
                let low = low.max(plane_rad).clamp(begin, begin + quarter);
                let high = high.clamp(begin, begin + quarter);
                if high > low {
                    visible += high - low;
                    moment += 0.5 * (high - low) * (high + low);
                }
            }
            if visible > 0.0 {
                let middle = moment / visible;
                let along = middle.cos();
                let (sin, cos) = slice.azimuth_rad.sin_cos();
                let weight = slice.weight * along * visible * (1.0 - visible * visible / 24.0);
                let y = evaluate(order, DVec3::new(along * cos, along * sin, middle.sin()));
                series.iter_mut().zip(y).for_each(|(sum, y)| *sum += weight * y);
            }
        }
    }
    series
}

/// Tolerance of a coefficient of [`arriving`], of order 6 at most.
///
/// An end that moves by an angle changes a part by |Y_lm| ≤ 1 of it, and moves its middle by half of it, where the product of cosine
/// and Y_lm changes by 6 a radian and the part is π/4 at most: by 3.5 in all. Ends have the errors of diffuse light, and so have
/// those of all four parts. The middle is a quotient: its error, 24 ε of an angle over the part, times the part and 6, in four
/// parts. Y_lm errs by 100 ε, directions by the sine's 1e-7.
pub fn device_sphere_arriving(geometry: &SphereGeometry) -> f64 {
    let [weights, angle, touch] = geometry.of_slices();
    let ends = 3.5 * (10.0 * angle + touch) + 4.0 * 6.0 * 24.0 * FRAC_PI_2 * EPSILON;
    weights * (ends + geometry.height_rad() * (120.0 * EPSILON + 6e-7))
}

/// Tolerance of the specular of `sphere_shade`, for radiance and scale 1 and a mirror direction that errs by `off_rad`.
///
/// Ends of slices have the errors of diffuse light, where the lobe is (n + 1) / 2π at most. Its antiderivative errs at both ends;
/// where the surface cuts the sphere, at those of four pieces. Elsewhere the lobe changes by √(n/e) of that per radian. Over the
/// sphere's solid angle it errs by 20 ε and by x e^-x ≤ 1/e of a series' 1e-7. A narrow interval, at most 1/20 of the lobe's
/// standard deviation wide, uses the lobe in its middle: an error of 1/24 of the square, 1.1e-4.
pub fn device_sphere_specular(geometry: &SphereGeometry, exponent: f64, off_rad: f64) -> f64 {
    let n = exponent;
    let peak = (n + 1.0) / TAU;
    let [weights, angle, touch] = geometry.of_slices();
    let pieces = if geometry.is_cut { 4.0 } else { 1.0 };
    let solid = weights * geometry.height_rad();
    let ends = peak * (2.0 * angle + touch) + 2.0 * pieces * phong_error(n);
    let inside = (n / E).sqrt() * off_rad + 20.0 * EPSILON + 1e-7 + 1.1e-4;
    weights * ends + peak * solid * inside
}

/// [`sphere_at`] of every grid point, row-major.
pub fn sphere_shade(oracle: &Oracle, sphere: &SphereLight, slices: u32) -> Vec<f64> {
    let (rows, cols) = (oracle.field().rows(), oracle.field().cols());
    let of = |i: usize| sphere_at(oracle, sphere, slices, i / cols, i % cols);
    (0..rows * cols).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::basis::legendre::{legendre, value};
    use ridgelight::scene::{Border, HeightField};

    /// An unoccluded sphere is a cap, whose series is zonal: 2π ∫ P_l over it times Y_lm of its centre. Quarters of a slice, p high,
    /// err by (l p)²/24 of the solid angle, and their lengths by p⁴/1920. Slices, w wide, err by (l w)²/24, and by the cosine's spacing
    /// as much again. From beside it and from below.
    #[test]
    fn the_series_of_an_unoccluded_sphere_is_that_of_a_cap() {
        const ORDER: usize = 6;
        let level = HeightField::new(9, 9, &[0.0; 81], [1.0; 2], None).expect("a field");
        let oracle = Oracle::new(&level, Border::Open);
        let mut checked = 0;
        for (position_m, radius_m) in [
            ([30.0, 4.0, 20.0], 1.0),
            ([-9.0, -7.0, 12.0], 5.0),
            ([4.0, 4.0, 20.0], 6.0),
            ([5.0, 9.0, 9.0], 6.0),
        ] {
            let light = SphereLight { position_m, radius_m, radiance: [1.0; 3] };
            let apart = DVec3::from_array(position_m) - DVec3::new(4.0, 4.0, 0.0);
            let half_rad = (radius_m / apart.length()).asin();
            let depth = 2.0 * (0.5 * half_rad).sin().powi(2);
            let found = arriving(&oracle, &light, [64, 512], [4, 4], ORDER);
            let towards = evaluate(ORDER, apart.normalize());
            for l in 0..ORDER {
                let p = legendre(l);
                let steps = 2000;
                let width = depth / f64::from(steps);
                let cap: f64 = (0..steps)
                    .map(|i| TAU * width * value(&p, 1.0 - width * (f64::from(i) + 0.5)))
                    .sum();
                for k in l * l..(l + 1) * (l + 1) {
                    let part = 0.5 * half_rad * l as f64;
                    let slices = 2.0 * TAU / 64.0 * l as f64;
                    let length = (0.5 * half_rad).powi(4) / 1920.0;
                    let bound =
                        TAU * depth * ((part * part + slices * slices) / 24.0 + length) + 1e-9;
                    let want = cap * towards[k];
                    assert!(
                        (found[k] - want).abs() <= bound,
                        "{position_m:?} {l} {k}: {} for {want} ± {bound}",
                        found[k]
                    );
                    checked += usize::from(want.abs() > 3.0 * bound);
                }
            }
        }
        assert!(checked > 40, "{checked}");
    }
}

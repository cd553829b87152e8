//! `key_specular.glsl`: Phong specular reflection of a key light's wedge, by Gauss' rule. The shader has a closed form.

use crate::specular_tables::{phong_between, phong_error};
use crate::tolerance::EPSILON;
use glam::DVec3;
use ridgelight::plan::Azimuth;
use std::f64::consts::{PI, TAU};

/// The device may leave out a lobe where it is below this share of its peak.
const LEAST_SHARE: f64 = 1e-7;

/// Light of a wedge of radiance 1 in a Phong lobe about `mirror`, above the slope `lowest`, and its tolerance.
///
/// The mirror direction errs by `off_rad`, the slope by `off_slope`.
///
/// aⁿ errs as in [`Tables::light`](crate::mirror_map::Tables::light). The peak's angle turns by the direction's error over a, and by
/// 12 ε from products and `inversesqrt`; an end turns by the slope's error and by 8 ε. The lobe is (n + 1) / 2π at most: at two
/// ends, and twice more over all elevations, whose cosine changes by 2 in all. Both ends have the error of the antiderivative.
/// Where the lobe ends, the cosine to the peak is the root of a difference from 1 of 8 ε, to the power of n + 1.
pub fn key_specular(
    exponent: f64,
    azimuth: &Azimuth,
    (mirror, lowest): (DVec3, f64),
    [off_rad, off_slope]: [f64; 2],
) -> [f64; 2] {
    let n = exponent;
    let (cos, sin) = (f64::from(azimuth.cos_phi), f64::from(azimuth.sin_phi));
    let along = mirror.x * cos + mirror.y * sin;
    let across = mirror.x * sin - mirror.y * cos;
    let short2 = (1.0 - across * across).max(1e-30);
    let x = -0.5 * n * short2.ln();
    let power = (-x).exp();
    let weight = power * f64::from(azimuth.wedge_rad);
    let low = lowest.max(azimuth.low_slope.into()).atan();
    let high = f64::from(azimuth.high_slope).atan();
    let slice = if low < high { phong_between(n, mirror.z.atan2(along), low, high) } else { 0.0 };
    let power_off = (n * across.abs() * off_rad / short2
        + x * (1e-7 + 12.0 * EPSILON)
        + (3.0 + 2.0 * x) * 2.0 * EPSILON)
        .min(1.0);
    let turned = (off_rad / short2.sqrt() + 12.0 * EPSILON).min(PI);
    let ends = 4.0 * turned + 2.0 * (off_slope + 8.0 * EPSILON);
    let at_rim = 2.0 / TAU * (8.0 * EPSILON).powf(0.5 * (n + 1.0));
    let slice_off = (n + 1.0) / TAU * ends + 2.0 * phong_error(n) + at_rim;
    let light = weight * slice;
    let mut tolerance = light * (power_off + 10.0 * EPSILON) + weight * slice_off;
    if power * (1.0 - power_off) <= LEAST_SHARE {
        tolerance += light;
    }
    [light, tolerance]
}

#[cfg(test)]
mod tests {
    use super::*;
    use ridgelight::plan::azimuths::{across_key, even};
    use ridgelight::scene::KeyLight;
    use std::f64::consts::FRAC_PI_2;

    /// A mirror direction of this elevation, in the plane of azimuth 0.3.
    fn mirror(elevation_rad: f64) -> DVec3 {
        let (up, flat) = elevation_rad.sin_cos();
        DVec3::new(flat * 0.3_f64.cos(), flat * 0.3_f64.sin(), up)
    }

    fn sum(n: f64, azimuths: &[Azimuth], mirror: DVec3, lowest: f64) -> f64 {
        azimuths.iter().map(|a| key_specular(n, a, (mirror, lowest), [0.0; 2])[0]).sum()
    }

    /// A key light of the whole upper hemisphere is a sky of radiance 1: it gives the part of a lobe above horizontal. For an axis at
    /// an elevation of 30 degrees that is 3/4 at exponent 1. Even azimuths err by less than the digits given; wedges and slopes are f32.
    #[test]
    fn a_key_of_the_whole_sky_leaves_the_part_above_horizontal() {
        let all: Vec<Azimuth> = even(512, [1.0; 2])
            .into_iter()
            .map(|a| Azimuth { low_slope: 0.0, high_slope: 1e9, weight: 1.0, ..a })
            .collect();
        for (n, elevation_deg, want) in
            [(1.0, 30.0_f64, 0.75), (5.0, 30.0, 0.896_484), (20.0, 10.0, 0.785_934)]
        {
            let found = sum(n, &all, mirror(elevation_deg.to_radians()), -1e9);
            assert!((found - want).abs() < 2e-6, "{n}: {found} for {want}");
        }
    }

    /// Patches of all sizes about the mirror direction and beside it, cut by a horizon in all azimuths, against the midpoint rule over
    /// 500 × 500 equal cells of azimuth and sine of the elevation.
    #[test]
    fn patches_match_the_sum_over_their_cells() {
        let keys = [
            (0.3, 0.02, [0.5, 0.52]),
            (0.3, 0.7, [0.2, 0.9]),
            (0.9, 1.5, [-0.3, 0.6]),
            (2.0, 6.2, [0.1, FRAC_PI_2]),
        ];
        let mut checked = 0;
        for (azimuth_rad, width_rad, elevations_rad) in keys {
            let key = KeyLight { azimuth_rad, width_rad, elevations_rad, radiance: [1.0; 3] };
            let slices = across_key(&key, 256, [1.0; 2]);
            for (n, lowest) in
                [1.0, 20.0, 100.0, 1000.0].into_iter().flat_map(|n| [(n, -1e9), (n, 0.57)])
            {
                let mirror = mirror(0.55);
                let [low, high] = elevations_rad.map(f64::sin);
                let cut = low.max(f64::atan(lowest).sin());
                let (rings, around) = (500, 500);
                let step =
                    [(high - cut).max(0.0) / f64::from(rings), width_rad / f64::from(around)];
                let mut want = 0.0;
                for (i, j) in (0..rings).flat_map(|i| (0..around).map(move |j| (i, j))) {
                    let up = cut + step[0] * (f64::from(i) + 0.5);
                    let flat = (1.0 - up * up).sqrt();
                    let phi = azimuth_rad - width_rad / 2.0 + step[1] * (f64::from(j) + 0.5);
                    let e = DVec3::new(flat * phi.cos(), flat * phi.sin(), up);
                    let density = e.dot(mirror).max(0.0).powf(n);
                    want += (n + 1.0) / TAU * density * step[0] * step[1];
                }
                let found = sum(n, &slices, mirror, lowest);
                // The midpoint rule errs by h² / 24 times the variation of the slope. That is 2.43 σ^-2 of a lobe's integral over
                // √2π at most, σ = 1 / √(n + 1): by h² (n + 1) / 25 of it for slices, and a quarter of that for cells. Where a patch ends
                // within the lobe, of a part of it: twice that. Slopes and wedges are rounded to f32.
                let wedge = width_rad / 256.0;
                let bound = (wedge * wedge * (n + 1.0) / 10.0).min(1.0) * want + 2e-6;
                assert!(
                    (found - want).abs() <= bound,
                    "{n} {width_rad} {lowest}: {found} for {want}"
                );
                checked += usize::from(want > 10.0 * bound);
            }
        }
        assert!(checked >= 16, "{checked}");
    }
}

//! DESIGN §4: numbers must hold at the extremes. Each answer is derived.

use ridgelight::cpu::oracle;
use ridgelight::scene::{Border, Environment, Fuse, Lines, Method, Quality, Sun};

use crate::{Device, field, under_sky};

#[test]
fn a_centimetre_on_a_summit_survives() {
    // A step of 1 cm at 8 848 m seen from one metre: atan(0.01).
    let mut gpu = Device::new();
    let summit = field(3, 3, [1.0, 1.0], |_, c| 8848.0 + if c == 2 { 0.01 } else { 0.0 });
    for method in [Method::Sweep, Method::Brute] {
        let found = gpu.horizons(
            &summit,
            Border::Plane,
            &Quality { azimuths: 4, method, ..Quality::default() },
        );
        // One f64 subtraction at 8 848 (1.8e-12) and f32 roundings of 0.01 (1e-9).
        assert!((f64::from(found[3 + 1]) - 0.01_f64.atan()).abs() < 5e-9, "{}", found[4]);
    }
}

#[test]
fn relief_from_a_millionth_to_a_million_cells_keeps_its_angle() {
    let mut gpu = Device::new();
    for scale in [1e-6, 1.0, 1e6] {
        let spike = field(9, 9, [1.0, 1.0], |r, c| if (r, c) == (4, 4) { scale } else { 0.0 });
        for (lines, method) in [
            (Lines::Cell, Method::Sweep),
            (Lines::Exact, Method::Sweep),
            (Lines::Cell, Method::Brute),
        ] {
            let found = gpu.horizons(
                &spike,
                Border::Plane,
                &Quality { azimuths: 8, lines, method, ..Quality::default() },
            );
            for c in 0..4 {
                let expected = (scale / (4 - c) as f64).atan();
                let at = f64::from(found[4 * 9 + c]);
                // Relative rounding of slope, and 1.2e-7 rad of arc tangent (relative below 1).
                assert!(
                    (at - expected).abs() < 3e-7 * expected.min(1.0) + 1e-12,
                    "{scale} {lines:?} {method:?}: {at} {expected}"
                );
            }
        }
    }
}

#[test]
fn thin_and_odd_fields_agree_with_the_oracle() {
    let mut gpu = Device::new();
    for (rows, cols) in [(1, 1), (1, 40), (40, 1), (2, 3), (3, 2), (13, 7), (3, 257)] {
        let f = field(rows, cols, [1.5, 1.0], |r, c| ((r * 37 + c * 101) % 11) as f64 * 0.5);
        for border in [Border::Plane, Border::Open] {
            let quality = Quality { azimuths: 16, method: Method::Brute, ..Quality::default() };
            let found = gpu.horizons(&f, border, &quality);
            for k in [0, 4, 8, 12] {
                // Directions along the axes: no rounding of the azimuth.
                let phi = std::f64::consts::TAU * k as f64 / 16.0;
                for i in 0..rows * cols {
                    let expected = oracle::elevation_rad(&f, border, i / cols, i % cols, phi);
                    let at = f64::from(found[k * rows * cols + i]);
                    assert!(
                        (at - expected).abs() < 1e-6,
                        "{rows}×{cols} {border:?} azimuth {k} sample {i}: {at} {expected}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_long_thin_field_is_swept_along_and_across() {
    let mut gpu = Device::new();
    let long = field(3, 8191, [1.0, 1.0], |_, c| if c == 8190 { 819.0 } else { 0.0 });
    let found = gpu.horizons(&long, Border::Plane, &Quality { azimuths: 4, ..Quality::default() });
    // From the west end the wall in the east stands 819 / 8190 high.
    assert!((f64::from(found[8191]) - 0.1_f64.atan()).abs() < 3e-8, "{}", found[8191]);
}

#[test]
fn sawteeth_plateaus_and_ties() {
    let mut gpu = Device::new();
    // A sawtooth whose teeth all touch one line: every tooth ties; the horizon is the line's slope.
    let teeth =
        field(
            5,
            65,
            [1.0, 1.0],
            |_, c| if c % 2 == 0 { 0.25 * c as f64 } else { 0.25 * c as f64 - 3.0 },
        );
    let found = gpu.horizons(&teeth, Border::Plane, &Quality { azimuths: 4, ..Quality::default() });
    for c in (0..62).step_by(2) {
        assert!(
            (f64::from(found[2 * 65 + c]) - 0.25_f64.atan()).abs() < 1e-6,
            "{c}: {}",
            found[2 * 65 + c]
        );
    }
    let plateau =
        field(
            33,
            33,
            [1.0, 1.0],
            |r, c| if r > 8 && r < 24 && c > 8 && c < 24 { 2.0 } else { 0.0 },
        );
    let found =
        gpu.horizons(&plateau, Border::Plane, &Quality { azimuths: 16, ..Quality::default() });
    for k in 0..16 {
        assert_eq!(found[k * 33 * 33 + 16 * 33 + 16], 0.0, "on top of a plateau nothing rises");
    }
}

#[test]
fn suns_at_the_horizon_and_at_the_zenith() {
    let mut gpu = Device::new();
    let mut scene = under_sky(field(9, 9, [1.0, 1.0], |_, _| 0.0), Border::Plane);
    scene.lights.sky = None;
    for diameter in [0.0, 0.0092] {
        let mut at = |elevation_rad: f64| {
            scene.lights.suns = vec![Sun {
                azimuth_rad: 0.4,
                elevation_rad,
                diameter_rad: diameter,
                irradiance: [1.0; 3],
            }];
            f64::from(
                gpu.picture(&scene, &Quality { sun_azimuths: 32, ..Quality::default() }).values[40],
            )
        };
        let zenith = at(std::f64::consts::FRAC_PI_2);
        // Irradiance 1 from straight above, over π; midpoint rule over 32 chords: 2^-7.5.
        assert!((zenith * std::f64::consts::PI - 1.0).abs() < 5.6e-3, "{diameter}: {zenith}");
        let level = at(0.0);
        // Half a disc above the ground: E r 4 / (3 π) / 2 / π at most, and nothing from a point.
        let bound = 2.0 * diameter / 2.0 / 3.0 / std::f64::consts::PI.powi(2);
        assert!(level >= 0.0 && level <= bound * 1.05, "{diameter}: {level} {bound}");
        assert!((level > 0.0) == (diameter > 0.0));
    }
}

#[test]
fn environments_of_nothing_of_peaks_and_beyond_f16() {
    let mut gpu = Device::new();
    let ground = under_sky(field(5, 5, [1.0, 1.0], |_, _| 3.0), Border::Plane);
    for value in [0.0, 1.0, 65_504.0, 1e6] {
        let mut scene = ground.clone();
        scene.lights.sky = None;
        scene.lights.environment =
            Some(Environment::new(64, 32, vec![[value; 3]; 64 * 32], 1.0).expect("an environment"));
        for azimuths in [7, 64] {
            let picture = gpu.picture(&scene, &Quality { azimuths, ..Quality::default() });
            // A constant environment is a uniform sky: exit radiance its radiance. Sums of 32 rows and
            // `azimuths` wedges in f32, and 6e-8 of sine: 1e-5 relative.
            let v = picture.values[12 * 4];
            assert!((v - value).abs() <= 1e-5 * value, "{value} in {azimuths}: {v}");
        }
    }
    // One texel of 1e6: its light and no more.
    let mut texels = vec![[0.0; 3]; 64 * 32];
    texels[8 * 64 + 10] = [1e6, 0.0, 1e6];
    let mut scene = ground;
    scene.lights.sky = None;
    scene.lights.environment = Some(Environment::new(64, 32, texels, 0.0).expect("an environment"));
    let picture = gpu.picture(&scene, &Quality { table_elevations: 1024, ..Quality::default() });
    let (top, bottom) = (std::f64::consts::PI * 8.0 / 32.0, std::f64::consts::PI * 9.0 / 32.0);
    let expected =
        1e6 * (std::f64::consts::TAU / 64.0) * (bottom.sin().powi(2) - top.sin().powi(2))
            / 2.0
            / std::f64::consts::PI;
    let texel = &picture.values[12 * 4..12 * 4 + 3];
    assert!(
        (f64::from(texel[0]) / expected - 1.0).abs() < 1e-5 && texel[1] == 0.0,
        "{texel:?} {expected}"
    );
}

#[test]
fn albedo_of_nothing_is_black_and_of_one_loses_nothing() {
    let mut gpu = Device::new();
    let mut scene = under_sky(field(6, 6, [1.0, 1.0], |_, _| 0.0), Border::Plane);
    for (albedo, expected) in [(0.0, 0.0), (1.0, 1.0)] {
        scene.surface.albedo = ridgelight::scene::Albedo::Constant([albedo; 3]);
        let picture =
            gpu.picture(&scene, &Quality { azimuths: 16, fuse: Fuse::Aimed, ..Quality::default() });
        assert!(picture.values.iter().all(|v| (v - expected).abs() < 16.0 * f32::EPSILON));
    }
}

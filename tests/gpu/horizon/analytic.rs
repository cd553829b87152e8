//! Scenes with closed forms (BEYOND B5, DESIGN §4), through whole plans on the device.

use ridgelight::scene::{Border, Fuse, Lines, Method, Quality, Sun};

use crate::{Device, field, under_sky};

#[test]
fn flat_ground_under_the_sky_is_its_albedo() {
    let mut gpu = Device::new();
    for (rows, cols) in [(1, 1), (1, 5), (2, 3), (17, 16)] {
        for border in [Border::Plane, Border::Open, Border::Periodic] {
            let scene = under_sky(field(rows, cols, [1.0, 2.0], |_, _| 7.0), border);
            for method in [Method::Sweep, Method::Pyramid, Method::BruteForce] {
                let quality = Quality { azimuths: 16, method, ..Quality::default() };
                let picture = gpu.picture(&scene, &quality);
                for (i, v) in picture.values.iter().enumerate() {
                    // A sum of 16 terms, each rounded: 16 half-ulps.
                    let is_one = (v - 1.0).abs() < 16.0 * f32::EPSILON;
                    assert!(is_one, "{rows}×{cols} {border:?} {method:?} texel {i}: {v}");
                }
            }
        }
    }
}

#[test]
fn a_ramp_has_its_slope_in_every_azimuth() {
    // tan h = s cos(φ - uphill). Uphill is east; a plane is its own horizon where it rises.
    let mut gpu = Device::new();
    for slope in [1e-6, 0.3, 5.0, 1e6] {
        let ramp = field(41, 41, [30.0, 10.0], |_, c| slope * 30.0 * c as f64);
        for (lines, fuse) in [
            (Lines::Cell, Fuse::AimedNearest),
            (Lines::Cell, Fuse::Slopes),
            (Lines::TwoCells, Fuse::Aimed),
        ] {
            let quality =
                Quality { azimuths: 24, method: Method::Sweep, lines, fuse, ..Quality::default() };
            let found = gpu.horizons(&ramp, Border::Plane, &quality);
            for k in 0..24 {
                let phi = std::f64::consts::TAU * f64::from(k) / 24.0;
                let expected = (slope * phi.cos()).max(0.0).atan();
                // The middle: its line reaches the edge in every azimuth.
                let at = found[k as usize * 41 * 41 + 20 * 41 + 20];
                // Heights reach 1200 slope, each rounded to 2^-24 of that, visible across 10 m at least;
                // 1.6e-5 rad of azimuth; 1.2e-7 rad of arc tangent.
                let rounding = 4.0 * 1200.0 * slope * 2.0_f64.powi(-24)
                    / 10.0
                    / (1.0 + slope * slope * phi.cos().powi(2));
                let bound = rounding
                    + 1.6e-5 * slope * phi.sin().abs() / (1.0 + slope * slope * phi.cos().powi(2))
                        * 9.0
                    + 3e-7;
                assert!(
                    (f64::from(at) - expected).abs() <= bound,
                    "slope {slope} azimuth {k} {fuse:?}: {at} {expected} {bound}"
                );
            }
        }
    }
}

#[test]
fn a_tilted_plane_under_an_open_sky_sees_all_of_its_hemisphere() {
    // Nothing occludes: with `open` borders the plane receives π L whatever its tilt.
    let mut gpu = Device::new();
    let scene = under_sky(field(9, 9, [1.0, 1.0], |_, c| 0.8 * c as f64), Border::Open);
    let picture = gpu.picture(&scene, &Quality { azimuths: 256, ..Quality::default() });
    let middle = picture.values[4 * 9 + 4];
    // The hemisphere's limit is taken at each wedge's middle: second order in its width,
    // tan(tilt) (π/256)² / 2 of the light at most.
    assert!(
        (f64::from(middle) - 1.0).abs() < 0.8 * (std::f64::consts::PI / 256.0).powi(2),
        "{middle}"
    );
}

#[test]
fn a_tilted_plane_on_level_ground_sees_the_sky_of_its_tilt() {
    // (1 + cos tilt) / 2 where the ground cuts the sky at horizontal (BEYOND B5).
    let mut gpu = Device::new();
    let slope = 0.75_f64;
    let scene = under_sky(field(9, 9, [1.0, 1.0], |r, _| slope * r as f64), Border::Plane);
    let picture = gpu.picture(&scene, &Quality { azimuths: 256, ..Quality::default() });
    let expected = (1.0 + 1.0 / (1.0 + slope * slope).sqrt()) / 2.0;
    let middle = f64::from(picture.values[4 * 9 + 4]);
    assert!(
        (middle - expected).abs() < slope * (std::f64::consts::PI / 256.0).powi(2) * 2.0,
        "{middle} {expected}"
    );
}

#[test]
fn a_wall_has_its_horizon() {
    // A wall one texel thick, height 10, at column 20: from column c < 20, looking east along the row, tan h = 10 /
    // (20 - c).
    let mut gpu = Device::new();
    let wall = field(15, 31, [2.0, 2.0], |_, c| if c == 20 { 10.0 } else { 0.0 });
    for method in [Method::Sweep, Method::BruteForce] {
        for lines in [Lines::Cell, Lines::Exact] {
            let quality = Quality { azimuths: 8, method, lines, ..Quality::default() };
            let found = gpu.horizons(&wall, Border::Plane, &quality);
            for row in 0..15 {
                for c in 0..20 {
                    let expected = (10.0 / (2.0 * (20 - c) as f64)).atan();
                    let at = f64::from(found[row * 31 + c]);
                    assert!(
                        (at - expected).abs() < 3e-7,
                        "{method:?} {lines:?} row {row} column {c}: {at} {expected}"
                    );
                }
                // Behind the wall nothing rises to the east.
                assert!(found[row * 31 + 25] == 0.0);
            }
        }
    }
}

#[test]
fn a_sun_lights_what_faces_it_and_shades_what_is_behind() {
    // A ridge along the columns; sun in the west at 30°: a point casts a shadow of height / tan 30°.
    let mut gpu = Device::new();
    let ridge = field(21, 61, [1.0, 1.0], |_, c| if c == 20 { 10.0 } else { 0.0 });
    let mut scene = under_sky(ridge, Border::Plane);
    scene.lights.sky = None;
    let elevation = 30.0_f64.to_radians();
    for diameter_rad in [0.0, 0.01] {
        scene.lights.suns = vec![Sun {
            azimuth_rad: std::f64::consts::PI,
            elevation_rad: elevation,
            diameter_rad,
            irradiance: [2.0; 3],
        }];
        let picture = gpu.picture(&scene, &Quality { sun_azimuths: 64, ..Quality::default() });
        let row = &picture.values[10 * 61..11 * 61];
        // Level ground in the open: E sin(elevation) / π. Midpoint rule over 64 chords: 2.5e-3 at most.
        let open = 2.0 * elevation.sin() / std::f64::consts::PI;
        let shadow_end = 20.0 + 10.0 / elevation.tan();
        for (c, v) in row.iter().enumerate().filter(|(c, _)| !(18..=22).contains(c)) {
            let distance = c as f64 - shadow_end;
            if c < 18 || distance > 1.0 {
                assert!((f64::from(*v) / open - 1.0).abs() < 2.5e-3, "column {c}: {v} {open}");
            } else if distance < -1.0 {
                assert_eq!(*v, 0.0, "column {c} lies in the shadow");
            }
        }
    }
}

#[test]
fn quarter_turns_of_a_field_turn_its_horizons() {
    // Along rows and columns only: a quarter turn also flips the cells' diagonals.
    let mut gpu = Device::new();
    let height = |r: usize, c: usize| ((r * 7919 + c * 104_729) % 61) as f64 * 0.37;
    let n = 23;
    let a = gpu.horizons(
        &field(n, n, [1.0, 1.0], height),
        Border::Plane,
        &Quality { azimuths: 4, ..Quality::default() },
    );
    // Turned counter-clockwise: east becomes north; texel (r, c) goes to (n - 1 - c, r).
    let turned = field(n, n, [1.0, 1.0], |r, c| height(c, n - 1 - r));
    let b = gpu.horizons(&turned, Border::Plane, &Quality { azimuths: 4, ..Quality::default() });
    let plane = n * n;
    for k in 0..4 {
        for r in 0..n {
            for c in 0..n {
                let to = ((k + 1) % 4) * plane + (n - 1 - c) * n + r;
                assert_eq!(
                    a[k * plane + r * n + c].to_bits(),
                    b[to].to_bits(),
                    "azimuth {k}, row {r}, column {c}"
                );
            }
        }
    }
}

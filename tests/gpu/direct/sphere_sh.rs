//! Sphere lights by spherical harmonics: against closed forms, against the CPU reference at the extremes, towards the
//! error of their order, and moving.

use std::f64::consts::{FRAC_PI_2, PI};

use ridgelight::basis::bands;
use ridgelight::basis::legendre::{legendre, value};
use ridgelight::basis::slice::{Slices, slice_index};
use ridgelight::basis::zonal::clamped_cosine;
use ridgelight::scene::fractal;
use ridgelight::scene::{Border, HeightField, LightBasis, Quality, Receiver, Scene, Wedges};
use ridgelight_cpu::basis::sphere as zonal_sphere;
use ridgelight_cpu::light::normal;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::soft_sphere::SphereShError;
use ridgelight_cpu::sphere::sphere_of;
use ridgelight_cpu::sphere_sh_shade::{BEYOND, SphereSh, half_width, light_of};
use ridgelight_cpu::tolerance::SphereGeometry;

use super::spheres::awkward;
use super::spheres::{sphere_light, under, values};
use crate::direct::cpu_reference::sphere_sh::slope_error;
use crate::{Device, field, random};

fn by_sh(sh_order: u32, sun_azimuths: u32) -> Quality {
    Quality {
        light_basis: LightBasis::Sh,
        light_cutoff: 0.0,
        sh_order,
        sun_azimuths,
        ..Quality::default()
    }
}

/// The bound of the device's error against the CPU reference at a texel, for radiance 1.
fn reference_bound(scene: &Scene, quality: &Quality, texel: usize, visible: &[f64]) -> f64 {
    let (field, light) = (&scene.field, &scene.lights.sphere_lights[0]);
    let at = SphereGeometry::of(field, light, texel);
    let n = normal(field, scene.surface.border, texel / field.cols(), texel % field.cols());
    let slope = slope_error(&at, quality, false);
    SphereShError::new(quality).tolerance(&at, slope, n, visible)
}

/// Σ of a sphere light's coefficients times those of the clamped cosine's first bands times P_l of the angle between:
/// the light of a free level texel, over π.
fn closed_form(quality: &Quality, radius_m: f64, to: glam::DVec3) -> f64 {
    let count = match quality.receiver {
        Receiver::Plane => quality.light_order(),
        Receiver::Cosine => quality.light_order().min(3),
    };
    let light = zonal_sphere(count, radius_m, to.length());
    let cosine = clamped_cosine(count);
    let up = if to.length() > 0.0 { to.z / to.length() } else { 1.0 };
    let band = |l: usize| light[l] * cosine[l] * value(&legendre(l), up);
    (0..count).map(band).sum::<f64>() / PI
}

/// The error of slices with equal horizons in turns m > 0, which should be 0: sums of cos mφ over the middles of
/// wedges, across the sphere light and beyond, times their widths. As light from above `low_rad`.
fn uneven(quality: &Quality, radius_m: f64, to: glam::DVec3, low_rad: f64) -> f64 {
    let half = half_width(radius_m, to.x.hypot(to.y));
    let sum = |m: f64, from: f64, to: f64, count: usize| -> f64 {
        let width = (to - from) / count as f64;
        (0..count).map(|k| width * (m * (from + width * (k as f64 + 0.5))).cos()).sum()
    };
    let across = quality.sun_azimuths as usize;
    let left = |m: f64| {
        let both = sum(m, -half, half, across) + 2.0 * sum(m, half, PI, BEYOND / 2);
        both.abs() / PI.sqrt()
    };
    let order = quality.sh_order as usize;
    let above = Slices::new(order).above(low_rad);
    let light = |place: usize| {
        let mut visible = vec![0.0; order * order];
        visible[place] = 1.0;
        light_of(quality, radius_m, to, glam::DVec3::Z, &visible).abs()
    };
    bands(order)
        .enumerate()
        .filter(|(_, (_, m))| *m != 0)
        .map(|(i, (l, m))| {
            let m = m.unsigned_abs();
            left(m as f64) * above[slice_index(l, m)].abs() * light(i)
        })
        .sum()
}

/// A free texel gets the closed form of the series, from any distance, from below, from above and from within. By a
/// table, even wedges add only the table's own error, which is 0 between equal horizons at its texels.
#[test]
fn free_light_is_its_series_in_closed_form() {
    let mut gpu = Device::new();
    let one = field(1, 1, [2.0, 3.0], |_, _| 71.0);
    let places = [
        ([9.0, 14.0, 79.0], 1.5),
        ([-4.0, 50.0, 73.0], 0.01),
        ([1.0, 0.5, 76.0], 2.0),
        ([0.0, 0.0, 75.0], 3.0),
        ([0.5, 0.0, 71.5], 4.0),
        ([0.0, 0.0, 71.0], 1.0),
        ([5.0, -3.0, 64.0], 2.0),
    ];
    let base = by_sh(4, 8);
    let by_table = Quality { wedges: Wedges::Table, wedge_side: 9, ..base };
    for quality in [base, Quality { receiver: Receiver::Cosine, ..by_sh(6, 12) }, by_table] {
        let reference_of = |scene: &Scene| {
            let oracle = Oracle::new(&one, Border::Open);
            SphereSh::new(oracle, None, quality).at(&scene.lights.sphere_lights[0], 0, 0)
        };
        for (place, radius) in places {
            let scene = under(&one, Border::Open, vec![sphere_light(place, radius)]);
            let got = values(&gpu.picture(&scene, &quality))[0];
            let to = glam::DVec3::from_array(place) - glam::DVec3::new(0.0, 0.0, 71.0);
            let want = closed_form(&quality, radius, to).max(0.0);
            let low = if quality.receiver == Receiver::Plane { 0.0 } else { -FRAC_PI_2 };
            let rule = match quality.wedges {
                Wedges::Table => 0.0,
                Wedges::Slices | Wedges::Nlp => uneven(&quality, radius, to, low),
            };
            let bound =
                rule + reference_bound(&scene, &quality, 0, &reference_of(&scene).visibility);
            assert!((got - want).abs() <= bound, "{place:?}, {radius}: {got} {want} {bound:e}");
            let all = (radius / to.length()).min(1.0).powi(2);
            assert!(bound < 0.02 * all, "{place:?}, {radius}: {bound:e} of {all}");
        }
    }
}

/// A texel on a peak sees below horizontal: a sphere light at its foot lights it over the falling ground. On ground
/// that is level up to the sphere light, one below is not visible.
#[test]
fn horizons_are_below_horizontal_where_the_ground_falls_away() {
    let land = field(21, 21, [1.0, 1.0], |r, c| -1.5 * ((r as f64 - 10.0).hypot(c as f64 - 10.0)));
    let oracle = Oracle::new(&land, Border::Plane);
    // Half way down the cone of slope 1.5 and 1 above it.
    let to_there = oracle.slope_within(10, 10, 0.0, 5.0);
    assert!((to_there + 1.5).abs() < 1e-12, "{to_there}");
    // A wall beyond the sphere light has no effect.
    let walled = field(21, 21, [1.0, 1.0], |_, c| if c == 16 { 9.0 } else { 0.0 });
    let oracle = Oracle::new(&walled, Border::Plane);
    assert_eq!(oracle.slope_within(10, 10, 0.0, 5.0), 0.0);
    assert!((oracle.slope_within(10, 10, 0.0, 5.5) - 4.5 / 5.5).abs() < 1e-12);
    assert!((oracle.slope_within(10, 10, 0.0, 7.0) - 1.5).abs() < 1e-12);
}

/// Extreme positions and sizes, as for the exact form, against the CPU reference.
#[test]
fn sphere_sh_at_the_extremes_matches_the_cpu_reference() {
    let mut gpu = Device::new();
    let mut next = random(5);
    let noise: Vec<f64> = (0..99).map(|_| next()).collect();
    let rough = |rows: usize, cols: usize, relief: f64| {
        field(rows, cols, [2.0, 3.0], |r, c| 500.0 + relief * noise[(r * 11 + c) % 99])
    };
    let quality = by_sh(4, 4);
    for (rows, cols, relief) in [(9, 11, 6.0), (9, 11, 1e-6), (9, 11, 2e6), (1, 9, 3.0)] {
        let land = rough(rows, cols, relief);
        let height = f64::from(land.heights_m()[(rows / 2) * cols + cols / 2]);
        let [x, y, z] =
            [(cols / 2) as f64 * 2.0, (rows - 1 - rows / 2) as f64 * 3.0, land.base_m() + height];
        let sphere_lights = awkward([x, y, z], relief);
        for border in [Border::Plane, Border::Periodic] {
            let reference = SphereSh::new(Oracle::new(&land, border), None, quality);
            for (name, light) in &sphere_lights {
                let scene = under(&land, border, vec![*light]);
                let found = values(&gpu.picture(&scene, &quality));
                // The oracle's profiles have no surface on a line of texels.
                if rows == 1 {
                    continue;
                }
                for (i, got) in found.iter().enumerate() {
                    let visible = SphereGeometry::of(&land, light, i);
                    // Rounding decides whether it is inside or outside.
                    if (visible.distance_m / light.radius_m - 1.0).abs() < 1e-6 {
                        continue;
                    }
                    let want = reference.at(light, i / cols, i % cols);
                    let bound = reference_bound(&scene, &quality, i, &want.visibility);
                    let light = want.light.max(0.0);
                    assert!(
                        (got - light).abs() <= bound,
                        "{relief}, {border:?}, {name}, {i}: {got} {light} {bound:e}"
                    );
                }
            }
        }
    }
}

fn cones() -> HeightField {
    // Of three sizes on a circle, as in the thesis' figures 6.1 and 6.2.
    field(33, 33, [1.0, 1.0], |r, c| {
        let [x, y] = [c as f64 - 16.0, 16.0 - r as f64];
        let cone = |k: usize| {
            let (angle, radius) = (2.1 * k as f64, 2.0 + k as f64);
            let apart = (x - 9.0 * angle.cos()).hypot(y - 9.0 * angle.sin());
            3.0 * (radius - apart).max(0.0)
        };
        (0..3).map(cone).fold(0.0, f64::max)
    })
}

fn rmse(a: &[f64], b: &[f64]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
    let sum: f64 = b.iter().sum();
    (squares / a.len() as f64).sqrt() / (sum / b.len() as f64)
}

/// With more azimuths the light tends to the error of its order alone: four times as many at least halve the distance.
/// That error falls with the order. Wedges over the whole circle converge more slowly.
#[test]
fn more_azimuths_tend_to_the_floor_of_the_order() {
    let mut gpu = Device::new();
    let land = cones();
    let scene = under(&land, Border::Plane, vec![sphere_light([16.0, 16.0, 4.0], 1.5)]);
    let oracle = Oracle::new(&land, Border::Plane);
    let light = scene.lights.sphere_lights[0];
    let ground_truth: Vec<f64> =
        (0..33 * 33).map(|i| sphere_of(&oracle, i / 33, i % 33, &light, 64)).collect();
    let mut floors = Vec::new();
    for order in [2, 4, 6] {
        let mut drawn = |azimuths| values(&gpu.picture(&scene, &by_sh(order, azimuths)));
        let floor = drawn(256);
        let off: Vec<f64> = [2, 8, 32].map(|m| rmse(&drawn(m), &floor)).into();
        println!("order {order}: {off:.4?} from the floor, {:.4} off", rmse(&floor, &ground_truth));
        assert!(off.windows(2).all(|w| w[1] <= 0.5 * w[0]), "order {order}: {off:?}");
        floors.push(rmse(&floor, &ground_truth));
    }
    assert!(floors.windows(2).all(|w| w[1] < w[0]), "{floors:?}");
}

/// The largest change of a texel from step to step beyond that of the ground truth plus a tenth, the error of
/// harmonics of order 4; where the sphere light's surface passes the texel, beyond a tenth of its light. The sphere
/// light comes from beyond the edge, crosses the ground, passes through it under texels that it contains, over others,
/// and leaves.
fn popped(gpu: &mut Device, quality: &Quality, steps: usize) -> f64 {
    let land = fractal(16, 2).unwrap();
    let oracle = Oracle::new(&land, Border::Plane);
    let (mut before, mut most): (Vec<([f64; 2], bool)>, f64) = (Vec::new(), 0.0);
    for step in 0..=steps {
        let t = step as f64 / steps as f64;
        let up = 6.0 * (4.0 * FRAC_PI_2 * t).cos() + 1.0;
        let light = sphere_light([-3.0 + 21.0 * t, 11.0 - 6.0 * t, land.base_m() + up], 2.2);
        let found = values(&gpu.picture(&under(&land, Border::Plane, vec![light]), quality));
        let ground_truth = |i: usize| sphere_of(&oracle, i / 16, i % 16, &light, 24);
        let is_within = |i: usize| SphereGeometry::of(&land, &light, i).distance_m < light.radius_m;
        let state = |i: usize| ([found[i], ground_truth(i)], is_within(i));
        let now: Vec<_> = (0..256).step_by(7).map(state).collect();
        for ((a, was_within), (b, is_within)) in before.iter().zip(&now) {
            let [by_sh, ground_truth] = [0, 1].map(|k| (b[k] - a[k]).abs());
            let off = if was_within == is_within { ground_truth } else { a[1].max(b[1]) };
            most = most.max(by_sh - ground_truth - 0.1 * off);
        }
        before = now;
    }
    most
}

/// Pops of the method would stay in shorter steps; an error that follows the sphere light, and only blurs it, shrinks
/// with them: in an eighth of the length, to half at most.
#[test]
fn a_moving_sphere_light_by_sh_pops_no_more_than_the_ground_truth() {
    let mut gpu = Device::new();
    for quality in [by_sh(4, 8), Quality { wedges: Wedges::Table, wedge_side: 17, ..by_sh(4, 16) }]
    {
        let [long, short] = [40, 320].map(|steps| popped(&mut gpu, &quality, steps));
        println!("{long:.4} more than the ground truth, {short:.4} in steps an eighth as long");
        assert!(short <= 0.5 * long, "{:?}: {long} {short}", quality.wedges);
    }
}

/// The comparison fails at most texels for a sphere light a fifth of a metre away, another radius, another order, or
/// the surface of another field.
#[test]
fn wrong_harmonics_are_not_within_their_bound() {
    let mut gpu = Device::new();
    let land = field(9, 11, [2.0, 3.0], |r, c| ((r * 7 + c * 5) % 11) as f64 * 0.4);
    let (quality, light) = (by_sh(4, 4), sphere_light([11.0, 8.0, 9.0], 2.0));
    let scene = under(&land, Border::Plane, vec![light]);
    let oracle = Oracle::new(&land, Border::Plane);
    let other = field(9, 11, [2.0, 3.0], |r, c| ((r * 7 + c * 5) % 11) as f64 * 0.5);
    let moved = sphere_light([11.2, 8.0, 9.0], 2.0);
    let wrong = [
        (&oracle, sphere_light([11.0, 8.0, 9.0], 2.005), quality),
        (&oracle, moved, quality),
        (&oracle, light, by_sh(5, 4)),
        (&Oracle::new(&other, Border::Plane), light, quality),
    ];
    let found = values(&gpu.picture(&scene, &quality));
    for (which, (oracle, light, settings)) in wrong.into_iter().enumerate() {
        let reference = SphereSh::new(*oracle, None, settings);
        let right = SphereSh::new(Oracle::new(&land, Border::Plane), None, quality);
        let visible = found.iter().enumerate().filter(|(i, got)| {
            let bound =
                reference_bound(&scene, &quality, *i, &right.at(&light, i / 11, i % 11).visibility);
            (*got - reference.at(&light, i / 11, i % 11).light.max(0.0)).abs() > bound
        });
        let visible = visible.count();
        assert!(visible > 60, "{which}: {visible} of 99");
    }
}

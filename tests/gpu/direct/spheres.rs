//! Sphere lights: against closed forms, against the f64 oracle, moving, and many.

use std::f64::consts::{FRAC_PI_2, PI};

use ridgelight::gpu::Pixels;
use ridgelight::plan::{self, Limits, Picture, Plan};
use ridgelight::scene::fractal;
use ridgelight::scene::{Border, HeightField, Lights, Quality, Scene, SphereLight, Surface};
use ridgelight_cpu::lit::Lit;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere::sphere_of;
use ridgelight_cpu::sphere_shade::sphere_at;
use ridgelight_cpu::tolerance::SphereGeometry;

use crate::{Device, bundled, field, random};

pub(crate) fn sphere_light(position_m: [f64; 3], radius_m: f64) -> SphereLight {
    SphereLight { position_m, radius_m, radiance: [1.0; 3] }
}

pub(crate) fn under(field: &HeightField, border: Border, sphere_lights: Vec<SphereLight>) -> Scene {
    Scene {
        field: field.clone(),
        surface: Surface { border, ..Surface::default() },
        lights: Lights { sphere_lights, ..Lights::default() },
    }
}

/// No cutoff, in so many slices.
fn all(slices: u32) -> Quality {
    Quality { sun_azimuths: slices, light_cutoff: 0.0, ..Quality::default() }
}

/// One value of each texel, which is finite and not negative.
pub(crate) fn values(pixels: &Pixels) -> Vec<f64> {
    assert_eq!(pixels.channels, 1);
    let all: Vec<f64> = pixels.values.iter().map(|v| f64::from(*v)).collect();
    assert!(all.iter().all(|v| v.is_finite() && *v >= 0.0), "{all:?}");
    all
}

/// RMSE of a picture over the mean of the oracle's, at some texels.
fn relative_rmse(pixels: &Pixels, scene: &Scene, texels: usize) -> f64 {
    let (values, lit) = (values(pixels), Lit::of(scene));
    let (cols, mut next) = (scene.field.cols(), random(3));
    let (mut squares, mut sum) = (0.0, 0.0);
    for _ in 0..texels {
        let i = (next() * values.len() as f64) as usize;
        let ground_truth = lit.at(i / cols, i % cols)[0];
        squares += (values[i] - ground_truth).powi(2);
        sum += ground_truth;
    }
    (squares / texels as f64).sqrt() / (sum / texels as f64)
}

/// Sphere lights with the hardest numbers, about a texel of rough ground of a relief over 500 m.
pub(crate) fn awkward([x, y, z]: [f64; 3], relief: f64) -> [(&'static str, SphereLight); 10] {
    [
        ("at a texel", sphere_light([x, y, z], 2.5)),
        ("touching a texel", sphere_light([x, y, z + 1.0], 1.0)),
        ("in the ground", sphere_light([x + 0.3, y - 0.4, 500.0 - 20.0], 4.0)),
        ("over the ground", sphere_light([x, y, 500.0 + relief + 9.0], 3.0)),
        ("tiny", sphere_light([x + 0.7, y + 0.2, z + 0.5], 1e-5)),
        ("far", sphere_light([2e6, -1e6, 3e5], 1e5)),
        ("far and small", sphere_light([-3e6, 2e6, 4e6], 3.0)),
        ("all around", sphere_light([x, y, z], 3e6)),
        ("beyond the edge and below", sphere_light([-40.0, y, 480.0], 8.0)),
        ("as far as may be", sphere_light([1e15, 1e15, 1e15], 1e15)),
    ]
}

/// A whole sphere light over level ground: irradiance π r² h / d³ (as that of its middle, facing it π r² / d²). The
/// slices' midpoint rule errs by (r/away)^(2 slices) or less; there are 16.
#[test]
fn a_sphere_light_over_level_ground() {
    let mut gpu = Device::new();
    let level = field(12, 17, [2.0, 3.0], |_, _| 71.0);
    for (place, radius) in [([9.0, 14.0, 79.0], 1.5), ([-4.0, 50.0, 73.0], 0.01)] {
        let light = sphere_light(place, radius);
        let scene = under(&level, Border::Plane, vec![light]);
        let found = values(&gpu.picture(&scene, &all(16)));
        for (i, got) in found.iter().enumerate() {
            let visible = SphereGeometry::of(&level, &light, i);
            let up = place[2] - 71.0;
            let want = radius * radius * up / visible.distance_m.powi(3);
            let bound = visible.tolerance() + 1e-6 * want;
            assert!((got - want).abs() <= bound, "{place:?} {i}: {got} {want} {bound:e}");
        }
    }
}

/// A sphere light whose middle lies in level ground: the half of its disc above. With c towards the middle, up n and a
/// = asin(r/d), half a cap gives along n ∫ sin²θ dθ ∫ cos φ dφ = a - sin a cos a, over π. From within the whole
/// hemisphere is bright: 1.
#[test]
fn a_sphere_light_half_in_the_ground_and_samples_inside_it() {
    let mut gpu = Device::new();
    let level = field(21, 23, [1.0, 1.0], |_, _| 0.0);
    let light = sphere_light([11.3, 9.8, 0.0], 4.4);
    let scene = under(&level, Border::Plane, vec![light]);
    let found = values(&gpu.picture(&scene, &all(64)));
    let mut inside = 0;
    for (i, got) in found.iter().enumerate() {
        let visible = SphereGeometry::of(&level, &light, i);
        let a = (light.radius_m / visible.distance_m).min(1.0).asin();
        let is_inside = visible.distance_m < light.radius_m;
        let want = if is_inside { 1.0 } else { (a - a.sin() * a.cos()) / PI };
        // Midpoints of a chord's half angle, whose third derivative is 1/√ at a graze: 1/slices^1.5.
        let rule = if is_inside { 0.0 } else { want / 64_f64.powf(1.5) };
        let bound = visible.tolerance() + rule;
        assert!((got - want).abs() <= bound, "{i}: {got} {want} {bound:e}");
        inside += usize::from(is_inside);
    }
    assert!(inside > 50, "{inside}");
}

/// A long wall's top and the texel span a plane through the sphere light's middle: it cuts its disc in half. Half a
/// cap of radius a about c, on the side of n, gives c π sin²a / 2 + n (a - sin a cos a).
#[test]
fn a_wall_hides_half_of_a_sphere_light() {
    const COLS: usize = 81;
    let mut gpu = Device::new();
    let wall = field(COLS, 41, [1.0, 1.0], |_, c| if c == 20 { 4.0 } else { 0.0 });
    for radius in [0.05, 2.0] {
        // Twice as far as the wall and twice as high, from column 10.
        let light = sphere_light([30.0, 40.0, 8.0], radius);
        let scene = under(&wall, Border::Plane, vec![light]);
        let found = values(&gpu.picture(&scene, &all(32)));
        let i = 40 * 41 + 10;
        let visible = SphereGeometry::of(&wall, &light, i);
        let a = (radius / visible.distance_m).asin();
        // Up is the sine of the elevation along c, its cosine along n.
        let [sin, cos] = [8.0 / visible.distance_m, 20.0 / visible.distance_m];
        let half = sin * PI * a.sin().powi(2) / 2.0 + cos * (a - a.sin() * a.cos());
        let (got, want) = (found[i], half / PI);
        let bound = visible.tolerance() + want / 32_f64.powi(2);
        assert!((got - want).abs() <= bound, "{radius}: {got} {want} {bound:e}");
        // From half as far the wall hides it, from twice as far it hides nothing.
        assert!(found[40 * 41 + 17] == 0.0, "{}", found[40 * 41 + 17]);
    }
}

/// Houses of 5 × 5 texels, up to 40 m, with streets between.
fn city() -> HeightField {
    let mut next = random(8);
    let heights: Vec<f64> = (0..144).map(|_| (10.0 + 30.0 * next()).round()).collect();
    field(96, 96, [2.0, 2.0], |r, c| {
        let in_house = r % 8 < 5 && c % 8 < 5;
        if in_house { heights[r / 8 * 12 + c / 8] } else { 0.0 }
    })
}

/// Bound on the error of sphere lights: half of the middle one of 64 slices, a 64th of the diameter wide, of a disc of π/4
/// of its square. So large is the error where an upright edge ends within that slice, which is visible whole or not at all.
const HALF_SLICE: f64 = 0.5 * (1.0 / 64.0) / (0.25 * PI);

/// Relative RMSE against the ground truth, within half a slice: on mountains with default settings; among houses, each with
/// four upright edges, with 64 slices where a sphere light is wide, from hard to soft.
#[test]
fn sphere_lights_are_within_a_percent_of_the_ground_truth() {
    let mut gpu = Device::new();
    let mountain = bundled();
    let height = |c: usize, r: usize| {
        mountain.base_m() + f64::from(mountain.heights_m()[r * mountain.cols() + c])
    };
    let over = |c: usize, r: usize, up: f64, radius: f64| {
        let north = (mountain.rows() - 1 - r) as f64 * 92.6;
        sphere_light([c as f64 * 66.0, north, height(c, r) + up], radius)
    };
    let (city, fine) = (city(), Quality { sun_azimuths: 64, ..Quality::default() });
    let cases = [
        ("a high sphere light", &mountain, Quality::default(), vec![over(128, 128, 1500.0, 400.0)]),
        ("a small sphere light", &mountain, Quality::default(), vec![over(90, 60, 700.0, 20.0)]),
        (
            "a sphere light in a slope",
            &mountain,
            Quality::default(),
            vec![over(60, 150, 100.0, 900.0)],
        ),
        (
            "two sphere lights",
            &mountain,
            Quality::default(),
            vec![over(60, 50, 900.0, 300.0), over(200, 160, 1200.0, 100.0)],
        ),
        ("a small light", &city, Quality::default(), vec![sphere_light([60.0, 75.0, 8.0], 0.3)]),
        ("a lantern", &city, Quality::default(), vec![sphere_light([92.0, 75.0, 12.0], 1.5)]),
        ("a globe", &city, fine, vec![sphere_light([92.0, 75.0, 12.0], 5.0)]),
        ("a moon", &city, fine, vec![sphere_light([100.0, 100.0, 120.0], 20.0)]),
    ];
    for (name, field, quality, spheres) in cases {
        let scene = under(field, Border::Plane, spheres);
        let picture = gpu.picture(&scene, &quality);
        let error = relative_rmse(&picture, &scene, if field.cols() > 96 { 120 } else { 400 });
        println!("{name}: {:.4} %", 100.0 * error);
        assert!(error <= HALF_SLICE, "{name}: {error}");
    }
}

/// The comparison fails for light without shadows, a sphere light a cell away, or another radius.
#[test]
fn wrong_light_is_not_within_a_percent() {
    let mut gpu = Device::new();
    let city = city();
    let right = sphere_light([92.0, 75.0, 12.0], 5.0);
    let scene = under(&city, Border::Plane, vec![right]);
    let flat = field(96, 96, [2.0, 2.0], |_, _| 0.0);
    let mut moved = right;
    moved.position_m[0] += 2.0;
    let wrong = [
        under(&flat, Border::Plane, vec![right]),
        under(&city, Border::Plane, vec![moved]),
        under(&city, Border::Plane, vec![SphereLight { radius_m: 5.1, ..right }]),
    ];
    for (i, wrong) in wrong.iter().enumerate() {
        let error = relative_rmse(&gpu.picture(wrong, &Quality::default()), &scene, 200);
        assert!(error > 1.5 * HALF_SLICE, "{i}: {error}");
    }
}

/// Extreme positions and sizes, against the oracle in as many slices: at a texel, in the ground, far away, tiny and
/// all around, on fields of one texel and of lines, of gentle and of wild relief.
#[test]
fn sphere_lights_at_the_extremes_match_the_oracle() {
    let mut gpu = Device::new();
    let mut next = random(5);
    let noise: Vec<f64> = (0..99).map(|_| next()).collect();
    let rough = |rows: usize, cols: usize, relief: f64| {
        field(rows, cols, [2.0, 3.0], |r, c| 500.0 + relief * noise[(r * 11 + c) % 99])
    };
    for (rows, cols, relief) in
        [(9, 11, 6.0), (1, 1, 1.0), (1, 9, 3.0), (9, 1, 3.0), (2, 3, 1e-6), (9, 11, 2e6)]
    {
        let field = rough(rows, cols, relief);
        let at = |r: usize, c: usize| {
            let height = field.base_m() + f64::from(field.heights_m()[r * cols + c]);
            [c as f64 * 2.0, (rows - 1 - r) as f64 * 3.0, height]
        };
        let [x, y, z] = at(rows / 2, cols / 2);
        let sphere_lights = awkward([x, y, z], relief);
        for border in [Border::Plane, Border::Open, Border::Periodic] {
            let oracle = Oracle::new(&field, border);
            for (name, light) in &sphere_lights {
                let scene = under(&field, border, vec![*light]);
                let found = values(&gpu.picture(&scene, &all(4)));
                // The oracle's profiles have no surface on a line of texels.
                if (rows == 1) != (cols == 1) {
                    continue;
                }
                for (i, got) in found.iter().enumerate() {
                    let visible = SphereGeometry::of(&field, light, i);
                    // Rounding decides whether it is inside or outside.
                    if (visible.distance_m / light.radius_m - 1.0).abs() < 1e-6 {
                        continue;
                    }
                    let want = sphere_at(&oracle, light, 4, i / cols, i % cols);
                    let bound = visible.tolerance() + 1e-6 * want;
                    assert!(
                        (got - want).abs() <= bound,
                        "{rows} × {cols}, {relief}, {border:?}, {name}, {i}: {got} {want} {bound:e}"
                    );
                }
            }
        }
    }
}

/// A sphere light that comes from beyond the edge, crosses the ground, passes through it under texels that it
/// contains, and leaves: in every step each texel changes as the oracle's does, and the error of the whole picture
/// stays as small.
#[test]
fn a_moving_sphere_light_pops_no_more_than_the_ground_truth() {
    const STEPS: usize = 40;
    // Weber's fraction: smaller changes of a light are invisible.
    const VISIBLE_AT_ONCE: f64 = 0.01;
    let mut gpu = Device::new();
    let land = fractal(16, 2).unwrap();
    let oracle = Oracle::new(&land, Border::Plane);
    let quality = Quality { light_cutoff: 0.0, ..Quality::default() };
    let slices = quality.sun_azimuths;
    let (mut before, mut squares, mut sum, mut popped): (Vec<[f64; 3]>, _, _, _) =
        (Vec::new(), 0.0, 0.0, 0.0_f64);
    for step in 0..STEPS {
        let t = step as f64 / (STEPS - 1) as f64;
        // Down into the ground at a quarter and at three quarters of the way.
        let up = 6.0 * (4.0 * FRAC_PI_2 * t).cos() + 1.0;
        let light = sphere_light([-3.0 + 21.0 * t, 11.0 - 6.0 * t, land.base_m() + up], 2.2);
        let scene = under(&land, Border::Plane, vec![light]);
        let found = values(&gpu.picture(&scene, &quality));
        let mut now = Vec::new();
        for i in (0..256).step_by(3) {
            let visible = SphereGeometry::of(&land, &light, i);
            let same = sphere_at(&oracle, &light, slices, i / 16, i % 16);
            let ground_truth = sphere_of(&oracle, i / 16, i % 16, &light, 64);
            let bound = visible.tolerance() + 1e-6 * same;
            assert!((found[i] - same).abs() <= bound, "step {step}, {i}: {} {same}", found[i]);
            squares += (found[i] - ground_truth).powi(2);
            sum += ground_truth;
            now.push([found[i], ground_truth, bound]);
        }
        for (a, b) in before.iter().zip(&now) {
            popped = popped.max((b[0] - a[0]).abs() - (b[1] - a[1]).abs());
        }
        before = now;
    }
    let count = (STEPS * 256_usize.div_ceil(3)) as f64;
    let error = (squares / count).sqrt() / (sum / count);
    println!(
        "{:.3} % RMSE, pops {popped:.4} of its radiance more than the ground truth",
        100.0 * error
    );
    assert!(error <= HALF_SLICE, "{error}");
    assert!(popped <= VISIBLE_AT_ONCE, "{popped}");
}

/// A narrow sphere light over level ground gives (r / d)² cos θ, with however few slices: a disc of half-width w is
/// cos u wide, and its squared midpoints sum exactly. The difference from a disc falls with the square of its
/// half-width in azimuth.
#[test]
fn few_slices_hold_all_of_a_narrow_sphere_light() {
    let mut gpu = Device::new();
    let (level, side, radius) = (field(33, 33, [1.0; 2], |_, _| 0.0), 33, 0.5);
    let scene = under(&level, Border::Plane, vec![sphere_light([16.4, 16.4, 12.0], radius)]);
    for slices in [1, 2, 3] {
        let found = values(&gpu.picture(&scene, &all(slices)));
        for (i, found) in found.iter().enumerate() {
            let [x, y] = [i % side, side - 1 - i / side].map(|n| n as f64 - 16.4);
            let away = x.hypot(y);
            if away > 4.0 * radius {
                let squared = x * x + y * y + 144.0;
                let want = radius * radius / squared * 12.0 / squared.sqrt();
                let off = (found / want - 1.0).abs();
                assert!(off <= (radius / away).powi(2) + 1e-5, "{slices} slices, {i}: {off}");
            }
        }
    }
}

/// 64 sphere lights over mountains of 512²: their sum, at some texels, against the oracle in as many slices, less at
/// most the loss that the plan states.
#[test]
fn sixty_four_lights_add_up() {
    let mut gpu = Device::new();
    let land = fractal(512, 1).unwrap();
    let small_light = |i: usize| {
        let [x, y] = [i % 8, i / 8].map(|k| 32.0 + 64.0 * k as f64);
        let at = (511 - y as usize) * 512 + x as usize;
        let ground = land.base_m() + f64::from(land.heights_m()[at]);
        SphereLight {
            radiance: [1.0 + i as f32 / 64.0; 3],
            ..sphere_light([x, y, ground + 12.0], 0.3)
        }
    };
    let scene = under(&land, Border::Plane, (0..64).map(small_light).collect());
    let quality = Quality { light_cutoff: 0.5, ..all(1) };
    let plan = plan::picture(&scene, &quality, &Limits::lavapipe(), Picture::default()).unwrap();
    let lost = said_lost(&plan);
    let found = values(&gpu.picture(&scene, &quality));
    let (oracle, mut next) = (Oracle::new(&land, Border::Plane), random(6));
    for i in (0..40).map(|_| (next() * found.len() as f64) as usize) {
        let (mut want, mut bound) = (0.0, 0.0);
        for light in &scene.lights.sphere_lights {
            let radiance = f64::from(light.radiance[0]);
            want += radiance * sphere_at(&oracle, light, 1, i / 512, i % 512);
            // A rounding of the sum for each light besides.
            bound +=
                radiance * SphereGeometry::of(&land, light, i).tolerance() + 2_f64.powi(-23) * want;
        }
        let less = want - found[i];
        assert!(-bound <= less && less <= lost + bound, "{i}: {} {want} {bound:e}", found[i]);
    }
}

/// The largest loss of a texel, from a plan's notes.
fn said_lost(plan: &Plan) -> f64 {
    let after = plan.notes.iter().find_map(|n| n.split("loses more than ").nth(1));
    after.and_then(|text| text.split(',').next()?.parse().ok()).expect("a note with a number")
}

/// The cutoff drops at most the stated light and saves texels; other texels are unchanged.
#[test]
fn no_sample_loses_more_than_the_cutoff() {
    let mut gpu = Device::new();
    let land = fractal(64, 4).unwrap();
    let over = |x: f64, y: f64| sphere_light([x, y, land.base_m() + 8.0], 1.0);
    let lights = vec![over(12.0, 15.0), over(40.0, 50.0), over(70.0, 20.0), over(12.3, 40.0)];
    let scene = under(&land, Border::Plane, lights);
    let whole = values(&gpu.picture(&scene, &all(8)));
    let cutoff = 0.2;
    let cut = Quality { light_cutoff: cutoff, ..all(8) };
    let plan = plan::picture(&scene, &cut, &Limits::lavapipe(), Picture::default()).unwrap();
    let groups = |p: &&plan::Pass| p.name() == "sphere_shade" && p.groups[0] * p.groups[1] < 64;
    assert!(plan.passes.iter().filter(groups).count() == 3, "{plan}");
    // At most the brightest: a texel under the sphere light's middle.
    let brightest = whole.iter().copied().fold(0.0, f64::max);
    let lit = values(&gpu.picture(&scene, &cut));
    let lost = whole.iter().zip(&lit).map(|(a, b)| a - b);
    let (least, most) = lost.fold((0.0_f64, 0.0_f64), |(l, m), v| (l.min(v), m.max(v)));
    assert!(most > 0.0 && least > -1e-6 * brightest, "{least} {most}");
    let said = said_lost(&plan);
    assert!(most <= said && said <= cutoff * brightest * 1.1, "{most} {said}");
}

//! More lights than llvmpipe's limit of loop iterations of one invocation: a batch of paths comes in parts.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan;
use ridgelight::scene::fractal;
use ridgelight::scene::{Border, Lights, Normals, Scene, SphereLight};
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::sphere::sphere_of;

use crate::reference::quadrature::{traced, traced_by};
use crate::scenes::Agreement;
use crate::{Device, random, under_sky};

const SIDE: usize = 9;

/// Sphere lights over a fractal, some of them hidden by others and by the ground.
fn under_sphere_lights(count: usize) -> Scene {
    let field = fractal(SIDE, 3).expect("a field");
    let top = field.base_m() + f64::from(field.heights_m().iter().copied().fold(0.0, f32::max));
    let mut next = random(5);
    let spheres = (0..count).map(|_| SphereLight {
        position_m: [8.0 * next(), 8.0 * next(), top + 2.0 * next() - 0.5],
        radius_m: 0.1 + 0.4 * next(),
        radiance: [next() as f32, 1.0, 0.0],
    });
    let mut scene = under_sky(field, Border::Plane);
    scene.lights = Lights { sphere_lights: spheres.collect(), ..Lights::default() };
    scene
}

/// 120 sphere lights, and a sky in the blue channel, which no sphere light has: the sum is that of the f64 quadrature
/// over the sphere lights, plus the sky's own light. In one dispatch it exceeds the limit on iterations, where there
/// is one: rays are lost, and counted.
#[test]
fn many_sphere_lights_are_their_sum() {
    const BATCHES: usize = 4;
    let mut device = Device::new();
    let mut scene = under_sphere_lights(120);
    let oracle = Oracle::new(&scene.field, Border::Plane);
    scene.lights.sky = Some([0.0, 0.0, 1.0]);
    let plan =
        plan::reference(&scene, 0, Normals::Flat, None, 1, &device.limits()).expect("a plan");
    let parts = plan.passes.iter().filter(|p| p.name() == "path_trace").count();
    assert!(parts > 1, "{parts} parts");
    let [light, error] = traced(&mut device, &scene, 0, 1, BATCHES);
    let of = |i: usize, strips: usize| -> [f64; 3] {
        let mut sum = [0.0; 3];
        for sphere_light in &scene.lights.sphere_lights {
            let light = sphere_of(&oracle, i / SIDE, i % SIDE, sphere_light, strips);
            (0..2).for_each(|c| sum[c] += light * f64::from(sphere_light.radiance[c]));
        }
        sum
    };
    let mut sky = scene.clone();
    sky.lights = Lights { sky: scene.lights.sky, ..Lights::default() };
    let [open, open_error] = traced(&mut device, &sky, 0, 2, BATCHES);
    let (mut ground_truth, mut stated) = (Vec::new(), Vec::new());
    for i in 0..SIDE * SIDE {
        let (fine, coarse) = (of(i, 16), of(i, 8));
        ground_truth.push([fine[0], fine[1], open[i][2]]);
        stated.push([0, 1, 2].map(|c| {
            // Three standard errors of the other trace.
            (fine[c] - coarse[c]).abs() + 3.0 * if c == 2 { open_error[i][2] } else { 0.0 }
        }));
    }
    let paths = (BATCHES as u32 * plan::REFERENCE_BATCH) as f64;
    let agrees = |ground_truth: &[[f64; 3]]| {
        Agreement::of([&light, &error], [ground_truth, &stated], paths, 1e-5)
    };
    let found = agrees(&ground_truth);
    println!(
        "{parts} parts: rms {:.3}, worst {:.2}, mean {:.2}",
        found.rms, found.worst, found.mean
    );
    assert!(found.holds(), "{found:?}");
    // The comparison fails for one sphere light of 120 less.
    let sphere_light = scene.lights.sphere_lights[17];
    let mut less = ground_truth.clone();
    for (i, sum) in less.iter_mut().enumerate() {
        let light = sphere_of(&oracle, i / SIDE, i % SIDE, &sphere_light, 16);
        (0..2).for_each(|c| sum[c] -= light * f64::from(sphere_light.radiance[c]));
    }
    assert!(!agrees(&less).holds(), "a missing sphere light is not detected");
}

/// The split of a batch, by its lights and by its paths, changes only the order of sums, 64 paths of as many terms,
/// and nothing is lost.
#[test]
fn parts_of_a_batch_are_the_batch() {
    const LAST_LIGHT: usize = offset("PathTracePush", "last_light");
    const LAST_PATH: usize = offset("PathTracePush", "last_path");
    const SPHERE_LIGHTS: usize = 30;
    let mut device = Device::new();
    let scene = under_sphere_lights(SPHERE_LIGHTS);
    let plan =
        plan::reference(&scene, 1, Normals::Flat, None, 1, &device.limits()).expect("a plan");
    let parts = || plan.passes.iter().filter(|p| p.name() == "path_trace");
    let cuts = |at: usize, last: u32| parts().any(|p| p.push[at..at + 4] != last.to_ne_bytes());
    let lasts = [(LAST_LIGHT, SPHERE_LIGHTS as u32), (LAST_PATH, plan::REFERENCE_BATCH)];
    assert!(lasts.iter().all(|(at, last)| cuts(*at, *last)), "not cut");
    let first = plan.passes.len() - parts().count();
    let mut whole = plan.clone();
    whole.passes.truncate(first + 1);
    for (at, last) in lasts {
        whole.passes[first].push[at..at + 4].copy_from_slice(&last.to_ne_bytes());
    }
    let [in_parts, at_once] = [plan, whole].map(|p| traced_by(&mut device, &scene, p, 2, &[]));
    assert_eq!([in_parts.1, at_once.1], [0, 0], "rays were lost");
    let both = in_parts.0[0].iter().flatten().zip(at_once.0[0].iter().flatten());
    let rounded = 64.0 * (SPHERE_LIGHTS as f64 + 1.0) * f64::from(f32::EPSILON);
    for (i, (a, b)) in both.enumerate() {
        assert!((a - b).abs() <= rounded * b, "{i}: {a} for {b}");
    }
    assert!(in_parts.0[0].iter().flatten().any(|v| *v > 0.1), "dark");
}

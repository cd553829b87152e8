//! The passes of the path tracer.

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::{Pass, REFERENCE_BATCH, unsampled_light_error};
use ridgelight::scene::{
    Albedo, Border, Lights, Normals, PhongSpecular, Quality, Scene, Specular, SphereLight, Sun,
    Surface,
};
use ridgelight_cpu::indirect::{Fineness, ground_truth as expected_light, smooth_ground_truth};
use ridgelight_cpu::path_trace::{Traced, Tracer};
use ridgelight_cpu::tolerance::EPSILON;
use ridgelight_cpu::tolerance::near::Near;

use crate::cpu_reference::{
    Case, Pair, Reference, Run, Wanted, check_all, constant, key, noisy_environment, pushed, rough,
    worst,
};
use crate::specular::cpu_reference::slices::eye_of;
use crate::{Device, random};

/// The passes of this room and their CPU references.
pub(crate) const REFERENCES: &[Reference] = &[("path_trace", path_trace)];

/// Path by path, and then a second batch, from which the device has a mean and a standard error.
pub(crate) fn path_trace(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    let mut pairs = Vec::new();
    let is_last = run.plan.passes.last().is_some_and(|last| last.label() == pass.label());
    let sums = run.floats(pass, "batch_mean").expect("bound").len() / 4;
    let begun = vec![0.0; 4 * sums];
    one_part(run, pass, &begun, &begun, &mut pairs);
    if is_last {
        let before = run.floats(pass, "batch_mean").expect("written");
        let spread = run.floats(pass, "batch_spread").expect("written");
        let passes = run.plan.passes.clone();
        for (i, pass) in passes.iter().enumerate().filter(|(_, p)| p.name() == "path_trace") {
            run.gpu.draw_passes(&mut run.frame, &[i]).expect("drawn on");
            one_part(run, pass, &before, &spread, &mut pairs);
        }
        assert_eq!(run.words(pass, "lost_rays").expect("written")[0], 0, "rays were lost");
    }
    pairs
}

fn normals_of(pass: &Pass) -> Normals {
    if constant(pass, "smooth_normals") == 1 { Normals::Smooth } else { Normals::Flat }
}

/// The sums added by one dispatch, given those before the batch.
fn one_part(run: &mut Run, pass: &Pass, before: &[f32], spread: &[f32], pairs: &mut Vec<Pair>) {
    let [bounces, seed, first_path, last_path, first_light, last_light, lights] = [
        const { offset("PathTracePush", "bounces") },
        const { offset("PathTracePush", "seed") },
        const { offset("PathTracePush", "first_path") },
        const { offset("PathTracePush", "last_path") },
        const { offset("PathTracePush", "first_light") },
        const { offset("PathTracePush", "last_light") },
        const { offset("PathTracePush", "light_count") },
    ]
    .map(|o| pushed(pass, o));
    let [cols, rows] = run.size();
    let ground = run.floats(pass, "ground").expect("bound");
    let ground = ground.chunks_exact(4).map(|g| [g[0], g[1], g[2]]).collect();
    let is_listed = run.listed.is_some();
    let listed = run.listed.clone().unwrap_or_else(|| (0..cols * rows).collect());
    let scene = run.scene;
    let eye = eye_of(pass, const { offset("PathTracePush", "eye_m") });
    let eye_m = (eye[3] > 0.0).then(|| [0, 1, 2].map(|i| eye[i] as f32));
    let tracer =
        Tracer::of(scene, ground, (bounces, normals_of(pass), seed), !is_listed).viewed_from(eye_m);
    let is_begun = first_path == 0 && first_light == 0;
    if is_begun {
        run.batches = vec![Traced::default(); listed.len()];
    }
    let is_whole = last_path == REFERENCE_BATCH && last_light == lights;
    let parts = run.floats(pass, "part_sum");
    let [light, mean, error, kept] = ["radiance", "batch_mean", "standard_error", "batch_spread"]
        .map(|name| run.floats(pass, name).expect("written"));
    let mut add = |slot: usize, c: usize, got: f32, want: Near| {
        let at = [c, slot / cols, slot % cols];
        pairs.push(Pair { got: got.into(), want: want.v, tolerance: want.off, at });
    };
    for (slot, texel) in listed.iter().enumerate() {
        let batch = before[4 * slot + 3];
        let ranges = (first_path..last_path, first_light..last_light);
        let more = tracer.traced(*texel, (slot as u32, batch as u32), ranges);
        let all = &mut run.batches[slot];
        all.join(&more);
        let rays = all.rays;
        if !is_whole {
            let got = &parts.as_ref().expect("sums of parts")[4 * slot..];
            (0..3).for_each(|c| add(slot, c, got[c], all.light[c]));
            add(slot, 3, got[3], rays);
            continue;
        }
        let n = Near::given(batch + 1.0);
        let paths = Near::given(REFERENCE_BATCH as f32);
        for c in 0..3 {
            let of_batch = all.light[c] / paths;
            let before = Near::given(before[4 * slot + c]);
            let off = of_batch - before;
            let mean_now = before + off / n;
            let spread = Near::given(spread[4 * slot + c]) + off * (of_batch - mean_now);
            add(slot, c, mean[4 * slot + c], mean_now);
            add(slot, c, light[4 * slot + c], mean_now);
            add(slot, c, kept[4 * slot + c], spread);
            let of_mean = spread.max(Near::ZERO) / (n * (n - Near::of(1.0)));
            let unknown = Near { v: f64::INFINITY, off: 0.0 };
            let error_now = if batch == 0.0 { unknown } else { of_mean.sqrt() };
            add(slot, c, error[4 * slot + c], error_now);
        }
        add(slot, 3, mean[4 * slot + 3], n);
        add(slot, 3, light[4 * slot + 3], Near::of(1.0));
        let rays = Near { v: rays.v + f64::from(spread[4 * slot + 3]), ..rays };
        add(slot, 3, kept[4 * slot + 3], rays);
        add(slot, 3, error[4 * slot + 3], rays);
    }
    if is_whole {
        held(run);
    }
}

/// The error in height of a ray from a texel, in ε of the relief a cell: its direction errs by 30 ε, two quotients to
/// cells a unit add 10 and the larger's own 30 again: 70 to 80 ε of its length. Its rise errs by that, and so does its
/// place, which moves the surface by no more than the relief a cell; and once more as much where the place may be in
/// the next cell.
const HEIGHT_OFF: f64 = 3.0 * 80.0;
/// The factor of that error after a hit: the height at the ends of a piece of the surface, 3 times in all, over its
/// fall in between, is the error along the ray; that moves both coordinates, each the rise and the surface. For rays
/// weighted by their cosine it falls by a third of the relief a cell on average, or more: 3 · 3 · 4.
const HIT_OFF: f64 = 36.0;

/// The comparison can fail, by numbers that do not depend on the CPU reference's own bounds.
///
/// Uncertain decisions are no more than expected for heights spread evenly over the relief, of which that share is
/// uncertain on either side, twice that for decisions about other quantities, plus three standard deviations of such
/// rare events. Their light is less than an even share of the scene's lights, so that none may be missing. And half of
/// the pixels have tolerances below the light of one of a batch's paths.
fn held(run: &Run) {
    let sum = |of: &dyn Fn(&Traced) -> f64| run.batches.iter().map(of).sum::<f64>();
    for (i, off) in [1.0, HIT_OFF, HIT_OFF * HIT_OFF].into_iter().enumerate() {
        let (doubts, crossed) = (sum(&|b| b.doubts[i].into()), sum(&|b| b.crossed[i]));
        let expected = 2.0 * EPSILON * HEIGHT_OFF * off * crossed;
        println!("reflected {i} times: {doubts} decisions in doubt, {expected:.1} expected");
        let most = 2.0 * expected + 3.0 * expected.sqrt().max(1.0);
        assert!(doubts <= most, "{doubts} decisions in doubt of {expected} expected, {i}");
    }
    let (light, in_doubt) = (sum(&|b| b.light[1].v), sum(&|b| b.in_doubt[1]));
    let lit = run.batches.iter().map(|b| b.light[1]).filter(|l| l.v > 0.0);
    let mut off: Vec<f64> = lit.map(|l| l.off / l.v).collect();
    off.sort_by(f64::total_cmp);
    let middle = off.get(off.len() / 2).copied().unwrap_or(0.0);
    println!(
        "{:.4} of all light in doubt; half of the pixels held to {middle:.2e}",
        in_doubt / light
    );
    let of = &run.scene.lights;
    let even = [of.sky.is_some(), of.environment.is_some()].map(usize::from).iter().sum::<usize>();
    let lights = even + of.suns.len() + of.keys.len() + of.sphere_lights.len();
    assert!(in_doubt * lights as f64 <= light, "{in_doubt} of {light} in doubt");
    assert!(
        middle * f64::from(REFERENCE_BATCH) < 1.0,
        "half of all pixels are held to {middle} alone"
    );
}

/// Against the quadrature, which has no Monte Carlo noise: six standard errors, as in `Agreement` and with that of
/// unsampled light, plus three times the quadrature's stated error, as single texels may exceed it.
pub(crate) fn quadrature(run: &mut Run, pass: &Pass) -> Vec<Pair> {
    const BATCHES: u32 = 64;
    let last = run.plan.passes.len() - 1;
    let drawn = run.floats(pass, "batch_mean").expect("written")[3] as u32;
    for _ in drawn..BATCHES {
        run.gpu.draw_passes(&mut run.frame, &[last]).expect("drawn on");
    }
    let bounces = pushed(pass, const { offset("PathTracePush", "bounces") }) as usize;
    let fineness = Fineness { azimuths: 24, divisions: 1, strips: 8 };
    let expected_light = match normals_of(pass) {
        Normals::Flat => expected_light(run.scene, bounces, fineness),
        Normals::Smooth => {
            let Fineness { azimuths, strips, .. } = fineness;
            smooth_ground_truth(run.scene, bounces, azimuths, strips)
        }
    };
    let expected_light = expected_light.expect("a ground truth");
    let (want, stated) = (&expected_light.radiance[bounces], &expected_light.error[bounces]);
    let light = run.floats(pass, "radiance").expect("written");
    let error = run.floats(pass, "standard_error").expect("written");
    let [cols, _] = run.size();
    let unsampled = unsampled_light_error(run.scene, bounces as u32, BATCHES * REFERENCE_BATCH);
    let pair = |i: usize, c: usize| {
        let (got, want) = (f64::from(light[4 * i + c]), want[i][c]);
        let sigma = f64::from(error[4 * i + c]).hypot(unsampled[c]);
        let tolerance = 6.0 * sigma + 3.0 * stated[i][c] + 1e-5 * want;
        Pair { got, want, tolerance, at: [c, i / cols, i % cols] }
    };
    (0..want.len()).flat_map(|i| [0, 1, 2].map(|c| pair(i, c))).collect()
}

/// Every kind of light on an open field, and a periodic field, with two levels of blocks.
fn of_all_lights() -> [Scene; 2] {
    let sun = |diameter_rad| Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.6,
        diameter_rad,
        irradiance: [1.0, 0.5, 0.2],
    };
    let sphere_light =
        SphereLight { position_m: [9.0, 7.0, 912.0], radius_m: 3.0, radiance: [0.1, 0.4, 2.0] };
    let mut next = random(21);
    let map = (0..7 * 9).map(|_| [0.8 * next() as f32, 0.5, 0.1]).collect();
    let sky = Lights { sky: Some([0.3, 0.5, 0.9]), ..Lights::default() };
    let all = Scene {
        field: rough(7, 9, 22),
        surface: Surface { border: Border::Open, albedo: Albedo::Map(map), specular: None },
        lights: Lights {
            environment: Some(noisy_environment(23)),
            suns: vec![sun(0.2), sun(0.0)],
            keys: vec![key(-0.4, 0.5, [1.0, 0.3, 0.0]), key(0.9, 1.2, [0.0, 0.4, 2.0])],
            sphere_lights: vec![sphere_light],
            ..sky
        },
    };
    let repeated = Scene {
        field: rough(6, 10, 24),
        surface: Surface {
            border: Border::Periodic,
            albedo: Albedo::Constant([0.6, 0.3, 0.9]),
            specular: None,
        },
        lights: Lights {
            sky: Some([1.0; 3]),
            suns: vec![sun(0.3)],
            keys: vec![key(-0.4, 0.5, [1.0, 0.3, 2.0])],
            ..Lights::default()
        },
    };
    [all, repeated]
}

fn reference(name: &'static str, scene: Scene, wanted: Wanted) -> Case {
    Case { name, scene, quality: Quality::default(), wanted, loses_lines: false }
}

fn with_specular_maps(mut scene: Scene) -> Scene {
    let phong_specular =
        |i: usize| PhongSpecular { exponent: (i % 12) as f32, scale: (i % 3) as f32 * 0.05 };
    let count = scene.field.heights_m().len();
    scene.surface.specular = Some(Specular::Map((0..count).map(phong_specular).collect()));
    scene
}

/// Paths whose light the quadrature also computes: every kind of light, specular and a map; a periodic field.
pub(crate) fn references() -> Vec<Case> {
    let [all, repeated] = of_all_lights();
    // The quadrature does not model specular at hit points.
    let phong_maps = with_specular_maps(all.clone());
    vec![
        reference("all lights", all.clone(), Wanted::Reference(1, Normals::Flat)),
        reference("lobes in all lights", phong_maps, Wanted::Reference(0, Normals::Flat)),
        reference("periodic", repeated.clone(), Wanted::Reference(2, Normals::Flat)),
        reference("periodic, smooth", repeated, Wanted::Reference(2, Normals::Smooth)),
        reference("all lights, smooth", all, Wanted::Reference(1, Normals::Smooth)),
    ]
}

/// Paths whose light nothing else computes: specular at hit points; specular viewed from an eye beside the field, so low
/// that facets turn away from it; batches in parts, by paths and by lights; a list of texels; ground that continues
/// level; a line.
pub(crate) fn paths() -> Vec<Case> {
    let [all, repeated] = of_all_lights();
    let on = |field, border, lights: &Lights| Scene {
        field,
        surface: Surface { border, albedo: Albedo::Constant([0.7, 0.4, 0.2]), specular: None },
        lights: lights.clone(),
    };
    let level = on(rough(17, 13, 25), Border::Plane, &all.lights);
    let line = on(rough(1, 11, 26), Border::Plane, &repeated.lights);
    let mut many = on(rough(5, 4, 27), Border::Open, &Lights::default());
    many.lights.suns = (0..40)
        .map(|i| Sun {
            azimuth_rad: 0.1 + 0.7 * f64::from(i),
            elevation_rad: 0.1 + 0.03 * f64::from(i),
            diameter_rad: 0.01,
            irradiance: [0.01, 0.02, 0.03],
        })
        .collect();
    let mut shiny = with_specular_maps(level.clone());
    shiny.surface.specular =
        Some(Specular::Constant(PhongSpecular { exponent: 100.0, scale: 0.05 }));
    vec![
        reference(
            "specular maps that are met",
            with_specular_maps(all.clone()),
            Wanted::Reference(1, Normals::Flat),
        ),
        reference(
            "a specular map that repeats",
            with_specular_maps(repeated.clone()),
            Wanted::Reference(1, Normals::Flat),
        ),
        reference("sharp specular on a plane", shiny.clone(), Wanted::Reference(1, Normals::Flat)),
        reference("by smooth normals", shiny.clone(), Wanted::Reference(1, Normals::Smooth)),
        reference(
            "specular maps viewed from an eye",
            with_specular_maps(all.clone()),
            Wanted::ReferenceFrom(1, Normals::Flat, [40.0, -20.0, 903.0]),
        ),
        reference(
            "sharp specular viewed from an eye",
            shiny,
            Wanted::ReferenceFrom(1, Normals::Smooth, [80.0, -60.0, 910.0]),
        ),
        reference("bounced light of a list", all, Wanted::ReferenceAt(1, Normals::Smooth, 40)),
        reference("many suns", many, Wanted::Reference(1, Normals::Smooth)),
        reference("on a plane", level, Wanted::Reference(2, Normals::Flat)),
        reference("a line", line, Wanted::Reference(1, Normals::Smooth)),
    ]
}

#[test]
fn paths_of_the_quadrature_match_pass_by_pass() {
    check_all(&references());
}

#[test]
fn paths_match_pass_by_pass() {
    check_all(&paths());
}

#[test]
fn paths_are_the_quadrature() {
    let mut device = Device::new();
    for case in references() {
        let mut run = Run::new(device.gpu.as_mut().expect("alive"), &case);
        let last = run.plan.passes.last().expect("paths").clone();
        let pairs = quadrature(&mut run, &last);
        run.gpu.end(run.frame);
        let worst = worst(&pairs).expect("values");
        assert!(worst.ratio() <= 1.0, "{}: {worst:?}", case.name);
    }
}

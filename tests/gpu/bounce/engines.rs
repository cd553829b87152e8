//! Indirect light: against the CPU reference, closed forms, the f64 quadrature and conservation of energy.

use std::path::Path;

use ridgelight::gpu::Pixels;
use ridgelight::plan::pyramid::Pyramid;
use ridgelight::scene::fractal;
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, HeightField, Levels, Lights, Method, Normals, Quality,
    Receiver, Scene, Sun, Surface,
};
use ridgelight_cpu::bounce_gather::BounceGather;
use ridgelight_cpu::bounce_march::{bounce_march, visible_intervals_along};
use ridgelight_cpu::height_expand::height_expand;
use ridgelight_cpu::height_reduce::height_levels;
use ridgelight_cpu::indirect;
use ridgelight_cpu::indirect::Fineness;
use ridgelight_cpu::oracle::Oracle;
use ridgelight_cpu::pyramid_march::Stored;
use ridgelight_cpu::shade_reduce::shade_levels;
use ridgelight_cpu::shared::bounced::{Along, radiance};
use ridgelight_cpu::shared::levels::LevelTexels;
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::tolerance::{BounceError, EPSILON, Gathered, Land, Slices, march_error};
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

use crate::reference::quadrature::traced_on;
use crate::{Device, colours, field, random, under_sky};

/// A number of bounces in so many azimuths, without cutoff, of direct light by brute force in as many.
fn brute(count: u32, azimuths: u32) -> Quality {
    let bounces = Bounces { count, azimuths, cutoff: 0.0, ..Bounces::default() };
    Quality { method: Method::BruteForce, azimuths, bounces, ..Quality::default() }
}

/// The whole, and the layer of each bounce.
fn drawn(gpu: &mut Device, scene: &Scene, quality: &Quality) -> Vec<Vec<[f64; 3]>> {
    let limits = gpu.limits();
    let outputs = gpu.light_layers(scene, quality, &limits);
    let is_wanted = |p: &&Pixels| p.name == "radiance" || p.name.starts_with("indirect.");
    outputs.iter().filter(is_wanted).map(colours).collect()
}

/// The light before the last bounces: the whole less those bounces.
fn less(whole: &[[f64; 3]], bounces: &[Vec<[f64; 3]>]) -> Vec<[f64; 3]> {
    let at =
        |i: usize| [0, 1, 2].map(|c| whole[i][c] - bounces.iter().map(|b| b[i][c]).sum::<f64>());
    (0..whole.len()).map(at).collect()
}

fn albedo_of(scene: &Scene, at: usize) -> [f64; 3] {
    match &scene.surface.albedo {
        Albedo::Constant(c) => c.map(f64::from),
        Albedo::Map(map) => map[at].map(f64::from),
    }
}

fn brightest(light: &[[f64; 3]]) -> f64 {
    light.as_flattened().iter().fold(0.0, |m, v| v.max(m))
}

/// Fields of every shape, under a sky and a sun of other colours, each with an albedo of its own.
fn scenes(border: Border) -> Vec<(&'static str, Scene)> {
    let mut next = random(4);
    let noise: Vec<f64> = (0..143).map(|_| next()).collect();
    let rough = |relief: f64| field(11, 13, [1.0, 1.5], |r, c| 90.0 + relief * noise[r * 13 + c]);
    let map = (0..143).map(|i| [1.0, (i % 5) as f32 / 4.0, (i % 7) as f32 / 6.0]).collect();
    let sun = Sun {
        azimuth_rad: 0.7,
        elevation_rad: 0.5,
        diameter_rad: 0.0,
        irradiance: [0.0, 3.0, 1.0],
    };
    let lights = Lights { sky: Some([1.0, 0.5, 0.0]), suns: vec![sun], ..Lights::default() };
    let of = |field: HeightField, albedo| Scene {
        field,
        surface: Surface { border, albedo, specular: None },
        lights: lights.clone(),
    };
    let grey = || Albedo::Constant([0.8, 0.8, 0.8]);
    vec![
        ("rough", of(rough(3.0), Albedo::Map(map))),
        ("wild", of(rough(100.0), grey())),
        ("tilted", of(field(6, 7, [2.0, 1.0], |r, c| c as f64 - 0.5 * r as f64), grey())),
        ("fractal", of(fractal(16, 2).unwrap(), grey())),
        ("one texel", of(field(1, 1, [1.0, 1.0], |_, _| 3.0), grey())),
        ("two rows", of(field(2, 5, [1.0, 1.0], |r, c| ((r * 3 + c) % 4) as f64), grey())),
    ]
}

/// A bounce compared with the CPU reference: the largest ratio of an error to its bound.
fn beside(
    layer: &[[f64; 3]],
    scene: &Scene,
    reference: impl Fn(usize) -> (Vec<Along>, BounceError),
) -> f64 {
    let mut largest = 0.0_f64;
    for (i, got) in layer.iter().enumerate() {
        let (all, error) = reference(i);
        let (want, albedo) = (radiance(&all), albedo_of(scene, i));
        for c in 0..3 {
            let (want, off) = (albedo[c] * want[c], albedo[c] * error.light[c]);
            let bound = off + 4.0 * EPSILON * want;
            let ratio = if got[c] == want { 0.0 } else { (got[c] - want).abs() / bound };
            assert!(ratio <= 1.0, "{i} {c}: {got:?} for {want}, {ratio} of {bound:e}");
            largest = largest.max(ratio);
        }
    }
    largest
}

/// Each bounce is the CPU reference's from the device's previous bounce.
#[test]
fn brute_force_matches_the_cpu_reference() {
    let mut gpu = Device::new();
    for (border, azimuths) in [(Border::Plane, 8), (Border::Open, 4), (Border::Periodic, 4)] {
        // Each is a pipeline of its own, and rays over repetitions are long.
        let is_drawn = |(name, _): &(&str, Scene)| match border {
            Border::Plane => ["rough", "fractal", "two rows", "one texel"].contains(name),
            Border::Open => ["wild", "tilted"].contains(name),
            Border::Periodic => *name == "rough",
        };
        for (name, scene) in scenes(border).into_iter().filter(is_drawn) {
            let all = drawn(&mut gpu, &scene, &brute(2, azimuths));
            let direct = drawn(&mut gpu, &scene, &brute(0, azimuths)).swap_remove(0);
            let oracle = Oracle::new(&scene.field, border);
            let (cols, cell) = (scene.field.cols(), scene.field.cell_m());
            let mut from = direct;
            for layer in &all[1..] {
                let brightest = brightest(&from);
                let ratio = beside(layer, &scene, |i| {
                    let at = [i / cols, i % cols];
                    let all = visible_intervals_along(&oracle, &from, azimuths, at);
                    let normal = Land::normal_at(&scene.field, border, at);
                    let slices = Slices { normal, wedge: 1.0, brightest };
                    let error = |along: &Along, cast: &_| march_error(cell, along, cast);
                    let error = BounceError::of(&all, error, &slices);
                    (all, error)
                });
                println!("{border:?} {name}: {ratio:.3} of the bound");
                from.clone_from(layer);
            }
        }
    }
}

/// Pyramids likewise, with either storage and receiver; their levels match the CPU reference, too.
#[test]
fn pyramids_match_the_cpu_reference() {
    let mut gpu = Device::new();
    for (border, levels, receiver, azimuths) in [
        (Border::Plane, Levels::Stack, Receiver::Plane, 8),
        (Border::Open, Levels::Pyramid, Receiver::Cosine, 5),
        (Border::Periodic, Levels::Stack, Receiver::Cosine, 4),
        (Border::Periodic, Levels::Pyramid, Receiver::Plane, 4),
    ] {
        // Each is a pipeline of its own.
        let name = if azimuths == 5 { "two rows" } else { "rough" };
        let are_few = |(of, _): &(&str, Scene)| *of == name;
        for (name, scene) in scenes(border).into_iter().filter(are_few) {
            let bounces = Bounces {
                engine: BounceEngine::Pyramid,
                level_step: 3,
                level_offset: 1,
                ..brute(2, azimuths).bounces
            };
            let quality = Quality {
                bounces,
                levels,
                receiver,
                level_step: 2,
                level_offset: 0,
                ..brute(2, azimuths)
            };
            let all = drawn(&mut gpu, &scene, &quality);
            let mut from = drawn(&mut gpu, &scene, &brute(0, azimuths)).swap_remove(0);
            let field = &scene.field;
            let size = [field.cols() as u32, field.rows() as u32];
            let heights = Heights::of(field, border);
            let pyramid = Pyramid::new(&quality, size, border);
            let shade = Pyramid { level_step: 3, level_offset: 1, ..pyramid };
            let texels = height_levels(&heights, &pyramid);
            let of = LevelTexels { pyramid: &pyramid, texels: &texels };
            let stack: Vec<f32> =
                (1..=pyramid.levels()).flat_map(|l| height_expand(&of, l)).collect();
            let stored = match levels {
                Levels::Stack => Stored::Stack(&stack),
                Levels::Pyramid => Stored::Levels(&texels),
            };
            let land = Land::of(field, border);
            for layer in &all[1..] {
                let brightest = brightest(&from);
                let shade_texels = &shade_levels(&from, &shade);
                let (shade, pyramid, exit) = (&shade, &pyramid, &from[..]);
                let reference = BounceGather {
                    field,
                    heights,
                    pyramid,
                    stored,
                    shade,
                    shade_texels,
                    exit,
                    receiver,
                    azimuths,
                };
                let gathered = Gathered {
                    land,
                    step_m: land.cell_m,
                    is_stack: levels == Levels::Stack,
                    own_levels: true,
                    receiver,
                    brightest,
                    spread: brightest,
                };
                let ratio = beside(layer, &scene, |i| {
                    let at = [i / field.cols(), i % field.cols()];
                    let all = reference.casts_along(at);
                    let normal = Land::normal_at(field, border, at);
                    let slices = Slices { normal, wedge: 1.0, brightest };
                    let error = BounceError::of(&all, |_, cast| gathered.error(cast), &slices);
                    (all, error)
                });
                println!("{border:?} {levels:?} {receiver:?} {name}: {ratio:.3} of the bound");
                from.clone_from(layer);
            }
        }
    }
}

/// White ground under a white sky: each bounce adds, and the sum rises to 1.
///
/// Sky and indirect light are two rules over azimuths: where a texel's shares s of sky and t of ground, by the CPU
/// reference, sum to 1 + d, light that is nowhere more than 1 + D stays so if s + t (1 + D) ≤ 1 + D: D = d / (1 - t),
/// and likewise from below. f32 adds 16 roundings a bounce. After k bounces at most the largest tᵏ is missing.
#[test]
fn a_furnace_comes_up_to_one() {
    const AZIMUTHS: u32 = 8;
    let mut gpu = Device::new();
    let mut next = random(9);
    let noise: Vec<f64> = (0..72).map(|_| next()).collect();
    // Rays over repetitions are long.
    for (border, count) in [(Border::Open, 64), (Border::Periodic, 4)] {
        let scene = under_sky(field(8, 9, [1.0, 1.5], |r, c| 1.5 * noise[r * 9 + c]), border);
        let all = drawn(&mut gpu, &scene, &brute(count, AZIMUTHS));
        let direct = drawn(&mut gpu, &scene, &brute(0, AZIMUTHS)).swap_remove(0);
        let oracle = Oracle::new(&scene.field, border);
        let (mut above, mut below, mut darkest) = (0.0_f64, 0.0_f64, 0.0_f64);
        let white = vec![[1.0; 3]; 72];
        for (i, [sky, ..]) in direct.iter().enumerate() {
            let [ground, ..] = bounce_march(&oracle, &white, AZIMUTHS, i / 9, i % 9);
            let off = (sky + ground - 1.0) / (1.0 - ground);
            (above, below) = (above.max(off), below.max(-off));
            darkest = darkest.max(ground);
        }
        let rounded = 16.0 * EPSILON * f64::from(count);
        let (slack, below) = (above + rounded, below + rounded);
        let mut sum = direct;
        for layer in &all[1..] {
            for (sum, more) in sum.iter_mut().zip(layer) {
                assert!(more[0] >= 0.0, "{border:?}: {more:?}");
                sum[0] += more[0];
                assert!(sum[0] <= 1.0 + slack, "{border:?}: {} beyond {slack:e}", sum[0]);
            }
        }
        let left = darkest.powi(count as i32) + below;
        let least = all[0].iter().fold(f64::MAX, |m, v| m.min(v[0]));
        assert!(least >= 1.0 - left, "{border:?}: {least}, {left}");
        println!("{border:?}: {least:.4} to 1 + {slack:.2e}");
    }
}

/// RMSE over the mean of the quadrature.
fn relative(got: &[[f64; 3]], want: &[[f64; 3]]) -> f64 {
    let squares: f64 = got.iter().zip(want).map(|(a, b)| (a[0] - b[0]).powi(2)).sum();
    let mean = want.iter().map(|v| v[0]).sum::<f64>() / want.len() as f64;
    (squares / want.len() as f64).sqrt() / mean
}

/// The same surface with every cell cut into four, as in the quadrature: light between texels is linear, so the error
/// falls at least as fast as a cell's side.
fn halved(field: &HeightField) -> HeightField {
    let (rows, cols) = (field.rows(), field.cols());
    let h =
        |r: usize, c: usize| f64::from(field.heights_m()[r.min(rows - 1) * cols + c.min(cols - 1)]);
    crate::field(2 * rows - 1, 2 * cols - 1, field.cell_m().map(|c| c / 2.0), |r, c| {
        // A cell's middle lies on its diagonal.
        field.base_m() + 0.5 * (h(r / 2, c / 2) + h(r.div_ceil(2), c.div_ceil(2)))
    })
}

/// Mountains against the quadrature, which has no texels between its triangles: the bounces' error halves with the
/// cells, and without bounces the error is far larger.
#[test]
fn bounces_tend_to_the_quadrature() {
    let mut gpu = Device::new();
    let land = fractal(12, 3).unwrap();
    let steep = field(12, 12, [1.0, 1.0], |r, c| 3.0 * f64::from(land.heights_m()[r * 12 + c]));
    let scene_of = |field: HeightField| {
        let mut scene = under_sky(field, Border::Plane);
        scene.surface.albedo = Albedo::Constant([0.8; 3]);
        scene
    };
    let ground_truth = scene_of(halved(&steep));
    let fineness = Fineness { azimuths: 32, divisions: 2, strips: 8 };
    let pictures = indirect::light(&ground_truth, 3, fineness).unwrap();
    let bounced: Vec<[f64; 3]> =
        (0..23 * 23).map(|i| [0, 1, 2].map(|c| pictures[3][i][c] - pictures[0][i][c])).collect();
    let at = |every: usize, of: &[[f64; 3]], side: usize| -> Vec<[f64; 3]> {
        (0..144).map(|i| of[i / 12 * every * side + i % 12 * every]).collect()
    };
    let want = at(2, &bounced, 23);
    let errors: Vec<f64> = [(steep.clone(), 1, 12), (halved(&steep), 2, 23)]
        .into_iter()
        .map(|(field, every, side)| {
            let all = drawn(&mut gpu, &scene_of(field), &brute(3, 32));
            let none = less(&all[0], &all[1..]);
            let got: Vec<[f64; 3]> =
                (0..side * side).map(|i| [0, 1, 2].map(|c| all[0][i][c] - none[i][c])).collect();
            relative(&at(every, &got, side), &want)
        })
        .collect();
    println!(
        "errors of bounces: {:.2} % and, with half the cell, {:.2} %",
        100.0 * errors[0],
        100.0 * errors[1]
    );
    assert!(errors[1] <= 0.7 * errors[0], "{errors:?}");
    // The comparison fails for two bounces of three.
    let short = drawn(&mut gpu, &scene_of(halved(&steep)), &brute(2, 32));
    let none = less(&short[0], &short[1..]);
    let got: Vec<[f64; 3]> =
        (0..23 * 23).map(|i| [0, 1, 2].map(|c| short[0][i][c] - none[i][c])).collect();
    assert!(relative(&at(2, &got, 23), &want) > errors[1]);
}

fn rms(a: &[[f64; 3]], b: &[[f64; 3]]) -> f64 {
    let squares: f64 = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]).powi(2)).sum();
    (squares / a.len() as f64).sqrt()
}

/// A piece of the bundled mountain, three times as steep, against the path-traced reference with as many bounces. With
/// smooth normals both have the same surface. They differ by Monte Carlo noise, at most twice its standard error, and by the
/// error of the azimuths. That error falls with their number, so it is at most twice the change from doubling them. The
/// reference of flat triangles and light without bounces differ more.
#[test]
fn a_mountain_matches_the_path_traced_reference() {
    const SIDE: usize = 16;
    let mut gpu = Device::new();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mt_washington_256.png");
    let cell = HeightOptions { cell_m: Some([66.0, 92.6]), ..HeightOptions::default() };
    let whole = files::read_heights(&path, &cell).expect("the bundled field");
    let land = field(SIDE, SIDE, whole.cell_m(), |r, c| {
        3.0 * f64::from(whole.heights_m()[(100 + r) * whole.cols() + 110 + c])
    });
    let mut scene = under_sky(land, Border::Plane);
    let facing = [3.0; 3];
    let sun = Sun { azimuth_rad: 0.9, elevation_rad: 0.6, diameter_rad: 0.0, irradiance: facing };
    scene.lights.suns = vec![sun];
    scene.surface.albedo = Albedo::Constant([0.8; 3]);
    let [ours, finer, direct] = [brute(2, 64), brute(2, 128), brute(0, 64)]
        .map(|quality| drawn(&mut gpu, &scene, &quality).swap_remove(0));
    let [smooth, flat] = [Normals::Smooth, Normals::Flat]
        .map(|normals| traced_on(&mut gpu, &scene, normals, (2, 1), 256));
    let [light, error] = smooth;
    let noise = rms(&error, &vec![[0.0; 3]; error.len()]);
    let bound = 2.0 * rms(&ours, &finer) + 2.0 * noise;
    let [off, of_flat, without] =
        [(&ours, &light), (&ours, &flat[0]), (&direct, &light)].map(|(a, b)| rms(a, b));
    println!(
        "{off:.5} off, of {bound:.5}; Monte Carlo noise {noise:.5}, flat {of_flat:.5}, without bounces {without:.5}"
    );
    assert!(off <= bound && of_flat > bound && without > 2.0 * bound, "{off} {bound} {of_flat}");
}

fn by_pyramids(step: u32, offset: u32, receiver: Receiver, count: u32) -> Quality {
    let bounces = Bounces {
        engine: BounceEngine::Pyramid,
        level_step: step,
        level_offset: offset,
        ..brute(count, 16).bounces
    };
    Quality { bounces, level_step: step, level_offset: offset, receiver, ..brute(count, 16) }
}

/// More and finer levels tend to brute force: from the defaults to eight an octave, none of them coarse, the error
/// halves at least. Three bands of a cosine do not.
#[test]
fn pyramids_tend_to_brute_force() {
    let mut gpu = Device::new();
    let land = fractal(33, 5).unwrap();
    let steep = field(33, 33, [1.0, 1.0], |r, c| 2.0 * f64::from(land.heights_m()[r * 33 + c]));
    let mut scene = under_sky(steep, Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.8; 3]);
    let want = drawn(&mut gpu, &scene, &brute(1, 16)).swap_remove(1);
    let mut error = |step, offset, receiver| {
        let quality = by_pyramids(step, offset, receiver, 1);
        let off = relative(&drawn(&mut gpu, &scene, &quality)[1], &want);
        println!("k {step}, o {offset}, {}: {:.1} %", receiver, 100.0 * off);
        off
    };
    let [usual, fine] = [(4, 2), (8, 4)].map(|(k, o)| error(k, o, Receiver::Plane));
    assert!(fine <= 0.5 * usual, "{fine} {usual}");
    assert!(error(8, 4, Receiver::Cosine) > fine);
}

/// No texel bounces more than the brightest did before, whatever the slopes and borders.
#[test]
fn pyramids_gain_no_energy() {
    let mut gpu = Device::new();
    for (border, relief) in [(Border::Plane, 1e-3), (Border::Open, 60.0), (Border::Periodic, 3.0)] {
        let mut next = random(7);
        let noise: Vec<f64> = (0..143).map(|_| next()).collect();
        let scene = under_sky(field(11, 13, [1.0, 1.5], |r, c| relief * noise[r * 13 + c]), border);
        let all = drawn(&mut gpu, &scene, &by_pyramids(2, 0, Receiver::Plane, 4));
        let direct = drawn(&mut gpu, &scene, &brute(0, 16)).swap_remove(0);
        let most = |of: &[[f64; 3]]| of.iter().fold(0.0_f64, |m, v| m.max(v[0]));
        let mut before = most(&direct);
        for layer in &all[1..] {
            assert!(layer.iter().all(|v| v[0] >= 0.0));
            // A spline's weights, moments and the sums of 16 azimuths round.
            assert!(most(layer) <= before * (1.0 + 100.0 * EPSILON), "{border:?} {relief}");
            before = most(layer);
        }
    }
}

/// Voids are filled ground: they bounce light and occlude like the same field without voids. A field one texel wide
/// has no indirect light.
#[test]
fn voids_are_ground_and_lines_bounce_nothing() {
    let mut gpu = Device::new();
    let height = |i: usize| ((i * 7) % 5) as f64;
    let mut heights: Vec<f64> = (0..63).map(height).collect();
    heights[31] = f64::NAN;
    let voids = (0..63).map(|i| i == 31).collect();
    let marked = HeightField::new(7, 9, &heights, [1.0, 1.0], Some(voids)).unwrap();
    let filled: Vec<f64> =
        marked.heights_m().iter().map(|h| marked.base_m() + f64::from(*h)).collect();
    let plain = HeightField::new(7, 9, &filled, [1.0, 1.0], None).unwrap();
    let of = |field: HeightField| under_sky(field, Border::Plane);
    let [with, without] = [marked, plain].map(|f| drawn(&mut gpu, &of(f), &brute(2, 8)));
    for (a, b) in with.iter().flatten().zip(without.iter().flatten()) {
        assert!((a[0] - b[0]).abs() <= 1e-5, "{a:?} {b:?}");
    }
    for (border, rows, cols) in
        [(Border::Plane, 1, 9), (Border::Open, 9, 1), (Border::Periodic, 1, 9)]
    {
        let line = field(rows, cols, [1.0, 1.0], |r, c| height(r + c));
        let scene = under_sky(line, border);
        let all = drawn(&mut gpu, &scene, &brute(1, 8));
        let bounced = all[1].iter().fold(0.0_f64, |m, v| m.max(v[0]));
        assert_eq!(bounced == 0.0, border != Border::Periodic, "{border:?} {bounced}");
    }
}

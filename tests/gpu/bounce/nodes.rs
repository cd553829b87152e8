//! Bounces at every second and every fourth texel, and later bounces of walks from every texel.

use std::f64::consts::TAU;
use std::path::Path;

use ridgelight::gpu::Pixels;
use ridgelight::plan::{self, Limits, Nodes, Picture};
use ridgelight::scene::{Albedo, Border, BounceEngine, Bounces, HeightField, Quality, Scene, Sun};
use ridgelight_cpu::tolerance::EPSILON;
use ridgelight_io as files;
use ridgelight_io::HeightOptions;

use crate::{Device, field, random, under_sky};

fn quality(engine: BounceEngine, count: u32, azimuths: u32, subsample: u32) -> Quality {
    let bounces = Bounces { count, engine, azimuths, cutoff: 0.0, ..Bounces::default() };
    Quality { azimuths: 16, bounces, subsample, ..Quality::default() }
}

/// The first channel of the light without bounces, then that of each bounce.
fn layers_within(gpu: &mut Device, scene: &Scene, of: &Quality, limits: &Limits) -> Vec<Vec<f64>> {
    let outputs = gpu.light_layers(scene, of, limits);
    let red = |p: &Pixels| -> Vec<f64> {
        p.values.chunks_exact(p.channels).map(|t| t[0].into()).collect()
    };
    let bounces = outputs.iter().filter(|p| p.name.starts_with("indirect."));
    let bounces: Vec<Vec<f64>> = bounces.map(red).collect();
    let mut direct = red(&outputs[0]);
    for (i, sum) in direct.iter_mut().enumerate() {
        *sum -= bounces.iter().map(|b| b[i]).sum::<f64>();
    }
    std::iter::once(direct).chain(bounces).collect()
}

fn layers(gpu: &mut Device, scene: &Scene, of: &Quality) -> Vec<Vec<f64>> {
    let limits = gpu.limits();
    layers_within(gpu, scene, of, &limits)
}

fn brightest(light: &[f64]) -> f64 {
    light.iter().fold(0.0, |m, v| v.max(m))
}

/// White ground of noise under a sky.
fn rough(rows: usize, cols: usize, border: Border, relief: f64) -> Scene {
    let mut next = random(5);
    let noise: Vec<f64> = (0..rows * cols).map(|_| next()).collect();
    under_sky(field(rows, cols, [3.0, 2.0], |r, c| relief * noise[r * cols + c]), border)
}

const ENGINES: [BounceEngine; 3] =
    [BounceEngine::Sweep, BounceEngine::BruteForce, BounceEngine::Pyramid];

/// At a node only its own light and share of ground count: the first bounce is that of every texel, the last ones too,
/// but for the rounding of a quotient. Also on flat ground about a spike, where the sky's azimuths and those of the bounce have
/// different shares of ground, or none.
#[test]
fn nodes_are_lit_as_they_are_by_themselves() {
    let mut gpu = Device::new();
    for (engine, border, stride) in [
        (BounceEngine::Sweep, Border::Plane, 2),
        (BounceEngine::BruteForce, Border::Open, 4),
        (BounceEngine::Pyramid, Border::Periodic, 2),
    ] {
        let mut spike = rough(10, 15, border, 0.0);
        spike.field = field(10, 15, [3.0, 2.0], |r, c| if (r, c) == (5, 7) { 7.0 } else { 0.0 });
        for scene in [rough(10, 15, border, 7.0), spike] {
            let whole = layers(&mut gpu, &scene, &quality(engine, 1, 16, 1));
            let found = layers(&mut gpu, &scene, &quality(engine, 1, 16, stride));
            let nodes = Nodes { stride };
            let [across, along] = nodes.size([15, 10]);
            for (y, x) in (0..along).flat_map(|y| (0..across).map(move |x| (y, x))) {
                let at = (nodes.place(y, 10) * 15 + nodes.place(x, 15)) as usize;
                let off = (found[1][at] - whole[1][at]).abs();
                let bound = 16.0 * EPSILON * whole[1][at];
                assert!(off <= bound, "{engine:?} {stride}: {at}: {off:e} of {bound:e}");
            }
            let off =
                found[1].iter().zip(&whole[1]).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
            assert!(off > 1e-3, "{engine:?}: every texel is as at nodes");
        }
    }
}

/// Nodes gather means of radiance, and shares are at most 1: no texel bounces more than the brightest did, but for the
/// difference of two rules over azimuths in equal parts h, h² or less of all visible ground. Also where only later bounces are
/// found at nodes.
#[test]
fn no_energy_is_gained_between_nodes() {
    let mut gpu = Device::new();
    for (engine, stride) in ENGINES.map(|e| (e, 2)).into_iter().chain([(BounceEngine::Sweep, 1)]) {
        let (border, relief) = match engine {
            BounceEngine::Sweep => (Border::Periodic, 40.0),
            BounceEngine::BruteForce => (Border::Open, 7.0),
            _ => (Border::Plane, 1e-3),
        };
        let scene = rough(11, 13, border, relief);
        let all = layers(&mut gpu, &scene, &quality(engine, 4, 32, stride));
        let mut most = brightest(&all[0]);
        for layer in &all[1..] {
            assert!(layer.iter().all(|v| *v >= 0.0 && v.is_finite()));
            let slack = 1.0 + (TAU / 32.0).powi(2);
            assert!(brightest(layer) <= slack * most, "{engine:?}: {} {most}", brightest(layer));
            most = brightest(layer);
        }
    }
}

/// A piece of the bundled mountain, steep, under a sky and a low sun.
fn mountain() -> Scene {
    const SIDE: usize = 48;
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/mt_washington_256.png");
    let cell = HeightOptions { cell_m: Some([66.0, 92.6]), ..HeightOptions::default() };
    let whole: HeightField = files::read_heights(&path, &cell).expect("the bundled field");
    let land = field(SIDE, SIDE, whole.cell_m(), |r, c| {
        2.0 * f64::from(whole.heights_m()[(100 + r) * whole.cols() + 110 + c])
    });
    let mut scene = under_sky(land, Border::Plane);
    let sun = Sun { azimuth_rad: 0.9, elevation_rad: 0.6, diameter_rad: 0.0, irradiance: [3.0; 3] };
    scene.lights.suns = vec![sun];
    scene.surface.albedo = Albedo::Constant([0.8; 3]);
    scene
}

/// RMSE over the mean of the reference.
fn off(found: &[f64], want: &[f64]) -> f64 {
    let squares: f64 = found.iter().zip(want).map(|(a, b)| (a - b).powi(2)).sum();
    (squares / want.len() as f64).sqrt() / (want.iter().sum::<f64>() / want.len() as f64)
}

/// Light interpolated between nodes without normals.
fn interpolated(whole: &[f64], side: u32, nodes: Nodes) -> Vec<f64> {
    let at = |i: u32| {
        let (([left, right], x), ([top, bottom], y)) =
            (nodes.around(i % side, side), nodes.around(i / side, side));
        let of =
            |y: u32, x: u32| whole[(nodes.place(y, side) * side + nodes.place(x, side)) as usize];
        let along = |y| of(y, left) * (1.0 - x) + of(y, right) * x;
        along(top) * (1.0 - y) + along(bottom) * y
    };
    (0..side * side).map(at).collect()
}

/// Radiance weighted by every texel's own share of ground has an error smaller by a third or more than interpolated
/// light, and more nodes have a smaller one; a second bounce as well, against that of every visible interval. Visibility caches take
/// the light of a visible interval from one texel: they change a second bounce by less than it differs from that of every visible
/// interval.
#[test]
fn on_terrain_shares_are_better_than_light() {
    let mut gpu = Device::new();
    let scene = mountain();
    let side = scene.field.cols() as u32;
    let of = |stride| quality(BounceEngine::Sweep, 2, 16, stride);
    let whole = layers(&mut gpu, &scene, &of(1));
    let [exact, fine] = [16, 128].map(|azimuths| {
        layers(&mut gpu, &scene, &quality(BounceEngine::BruteForce, 2, azimuths, 1))
    });
    let mut second_before = off(&whole[2], &exact[2]);
    // Later bounces lose no light beyond what the first one's own error is, and three standard errors of 13² nodes.
    let mean = |light: &[f64]| light.iter().sum::<f64>() / light.len() as f64;
    let lost = (mean(&whole[2]) / mean(&exact[2]) - 1.0).abs();
    let allowed = off(&whole[1], &exact[1]) + 3.0 * second_before / 13.0;
    println!("second bounce: {lost} of its light lost or gained, {allowed} allowed");
    assert!(lost <= allowed, "{lost} {allowed}");
    let mut before = 0.0;
    for stride in [2, 4] {
        let found = layers(&mut gpu, &scene, &of(stride));
        let by_shares = off(&found[1], &whole[1]);
        let by_light = off(&interpolated(&whole[1], side, Nodes { stride }), &whole[1]);
        let second = off(&found[2], &exact[2]);
        println!(
            "{stride}: {:.2} % of a bounce, {:.2} % by light, {:.2} % of the second",
            100.0 * by_shares,
            100.0 * by_light,
            100.0 * second
        );
        assert!(
            before < by_shares && 3.0 * by_shares < 2.0 * by_light,
            "{stride}: {by_shares} {by_light}"
        );
        assert!(second_before < second, "{stride}: {second_before} {second}");
        (before, second_before) = (by_shares, second);
        if stride == 2 {
            // A cache takes at most a quarter of the budget.
            let of = quality(BounceEngine::Sweep, 2, 128, 2);
            let limits = gpu.report().limits;
            let found = layers_within(&mut gpu, &scene, &of, &limits);
            let wanted = Picture { light_layers: true, ..Picture::default() };
            let plan = plan::picture(&scene, &of, &limits, wanted).expect("a plan");
            let bytes = |id: plan::ResourceId| plan.resources[id.0].bytes();
            let sets = bytes(plan.find("visibility_cache").expect("kept"));
            let limits = Limits { memory_budget: 3 * sets, ..limits };
            let walked = layers_within(&mut gpu, &scene, &of, &limits);
            let [moved, second] = [&walked, &fine].map(|other| off(&found[2], &other[2]));
            println!(
                "visibility caches change the second by {:.2} % of {:.2} %",
                100.0 * moved,
                100.0 * second
            );
            assert!(0.0 < moved && moved < second, "{moved} {second}");
        }
    }
}

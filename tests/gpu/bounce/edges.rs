//! Bounces at edges, across the seam of periodic fields, at voids and on single lines of texels, by every engine.

use ridgelight::plan::Limits;
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, HeightField, Levels, Lights, Quality, Scene, Sun,
};
use ridgelight_cpu::tolerance::EPSILON;

use crate::{Device, field, random, under_sky};

const ENGINES: [BounceEngine; 3] =
    [BounceEngine::BruteForce, BounceEngine::Sweep, BounceEngine::Pyramid];

const LOW: Sun =
    Sun { azimuth_rad: 0.3, elevation_rad: 1.4, diameter_rad: 0.0, irradiance: [3.0; 3] };

/// A number of bounces without cutoff; one level an octave, whose texels lie on the field's.
fn quality(engine: BounceEngine, count: u32, azimuths: u32) -> Quality {
    let (level_step, level_offset) = (1, 1);
    let bounces = Bounces {
        count,
        engine,
        azimuths,
        cutoff: 0.0,
        level_step,
        level_offset,
        ..Bounces::default()
    };
    let levels = Levels::Pyramid;
    Quality { azimuths, bounces, levels, level_step, level_offset, ..Quality::default() }
}

/// First channel of the layer of each bounce.
fn bounced(gpu: &mut Device, scene: &Scene, quality: &Quality) -> Vec<Vec<f32>> {
    let limits = gpu.limits();
    bounced_within(gpu, scene, quality, &limits)
}

fn bounced_within(
    gpu: &mut Device,
    scene: &Scene,
    quality: &Quality,
    limits: &Limits,
) -> Vec<Vec<f32>> {
    let outputs = gpu.light_layers(scene, quality, limits);
    let layers = outputs.iter().filter(|p| p.name.starts_with("indirect."));
    layers.map(|p| p.values.iter().step_by(p.channels).copied().collect()).collect()
}

/// A periodic field has no edge. Rolled by half its size, with its light, it has the same indirect light, rolled: within
/// 200 roundings, as sums round in another order. The second bounce of a walk is found at nodes, of which the last one does not
/// roll: it is compared at every fourth texel, and at all where it walks from all, as the visibility cache has no room. A wall at one edge bounces light across the other edge of a periodic
/// field only.
#[test]
fn periodic_fields_bounce_across_the_seam() {
    const SIDE: usize = 16;
    let mut gpu = Device::new();
    let mut next = random(3);
    let noise: Vec<f64> = (0..SIDE * SIDE).map(|_| next()).collect();
    let scene = |[down, right]: [usize; 2], border| {
        let from = |r: usize, c: usize| (r + down) % SIDE * SIDE + (c + right) % SIDE;
        let land = field(SIDE, SIDE, [1.0, 1.5], |r, c| 3.0 * noise[from(r, c)]);
        let mut scene = under_sky(land, border);
        let zenith = Sun { elevation_rad: std::f64::consts::FRAC_PI_2, ..LOW };
        scene.lights = Lights { suns: vec![zenith], ..Lights::default() };
        let map =
            (0..SIDE * SIDE).map(|i| [((from(i / SIDE, i % SIDE) % 5) as f32 + 1.0) / 6.0; 3]);
        scene.surface.albedo = Albedo::Map(map.collect());
        scene
    };
    let roomy = gpu.limits();
    let no_cache = Limits { image_layers: 3, ..roomy };
    let all = ENGINES.map(|engine| (engine, roomy));
    for (engine, limits) in all.into_iter().chain([(BounceEngine::Sweep, no_cache)]) {
        let is_cached = engine == BounceEngine::Sweep && limits == roomy;
        let quality = quality(engine, 2, 4);
        let [still, rolled] = [0, 8].map(|by| {
            bounced_within(&mut gpu, &scene([by, by], Border::Periodic), &quality, &limits)
        });
        let brightest = still[0].iter().fold(0.0_f32, |m, v| m.max(*v));
        let bound = f64::from(brightest) * 200.0 * EPSILON;
        for (k, (still, rolled)) in still.iter().zip(&rolled).enumerate() {
            let is_compared = |i: usize| {
                let is_node = [i % SIDE, i / SIDE].iter().all(|place| place.is_multiple_of(4));
                k == 0 || !is_cached || is_node
            };
            for (i, there) in rolled.iter().enumerate().filter(|(i, _)| is_compared(*i)) {
                let here = still[(i / SIDE + 8) % SIDE * SIDE + (i + 8) % SIDE];
                let off = f64::from((here - there).abs());
                assert!(off <= bound, "{engine:?} {k} {i}: {here} {there}, {off:e}");
            }
        }
        // The last row is a wall: 3 cells before the third row across the seam, 13 within the field.
        let walled = |border| {
            let mut scene = scene([0, 0], border);
            scene.field = field(SIDE, SIDE, [1.0; 2], |r, _| if r == SIDE - 1 { 3.0 } else { 0.0 });
            scene
        };
        let third =
            |all: &[f32]| -> f64 { all[2 * SIDE..3 * SIDE].iter().map(|v| f64::from(*v)).sum() };
        // Fine levels, which a wall one texel thick takes.
        let (level_step, level_offset) = (8, 4);
        let bounces = Bounces { level_step, level_offset, ..quality.bounces };
        let quality = Quality { bounces, level_step, level_offset, ..quality };
        let [over, within] = [Border::Periodic, Border::Plane]
            .map(|border| third(&bounced(&mut gpu, &walled(border), &quality)[0]));
        assert!(over > 2.0 * within, "{engine:?}: {over} beside {within}");
    }
}

/// Voids are filled ground: they bounce light and occlude like the same heights without voids. The base differs, so
/// heights are rounded again, by ε of the relief, 3, at either end: 6 ε of a slope, on either side of at most 30
/// intervals.
#[test]
fn voids_are_filled_ground() {
    const SIDE: usize = 12;
    let mut gpu = Device::new();
    let mut next = random(5);
    let noise: Vec<f64> = (0..SIDE * SIDE).map(|_| 3.0 * next()).collect();
    let is_void = |i: usize| (3..6).contains(&(i / SIDE)) && (4..9).contains(&(i % SIDE)) || i == 0;
    let heights: Vec<f64> =
        (0..SIDE * SIDE).map(|i| if is_void(i) { f64::NAN } else { noise[i] }).collect();
    let voids = (0..SIDE * SIDE).map(is_void).collect();
    let marked = HeightField::new(SIDE, SIDE, &heights, [1.0; 2], Some(voids)).unwrap();
    let base = marked.base_m();
    let filled: Vec<f64> = marked.heights_m().iter().map(|h| base + f64::from(*h)).collect();
    let plain = HeightField::new(SIDE, SIDE, &filled, [1.0; 2], None).unwrap();
    for engine in ENGINES {
        let quality = quality(engine, 2, 6);
        let [with, without] = [&marked, &plain]
            .map(|f| bounced(&mut gpu, &under_sky(f.clone(), Border::Plane), &quality));
        for (a, b) in with.iter().flatten().zip(without.iter().flatten()) {
            let off = f64::from((a - b).abs());
            assert!(off <= 360.0 * EPSILON, "{engine:?}: {a} {b}");
        }
        // They occlude and reflect: level ground in their place gives another light.
        let level: Vec<f64> =
            (0..SIDE * SIDE).map(|i| if is_void(i) { base - 9.0 } else { filled[i] }).collect();
        let level = HeightField::new(SIDE, SIDE, &level, [1.0; 2], None).unwrap();
        let other = bounced(&mut gpu, &under_sky(level, Border::Plane), &quality);
        let beside = 6 * SIDE + 6;
        let off = (with[0][beside] - other[0][beside]).abs();
        assert!(off > 0.05 * with[0][beside], "{engine:?}: {off}");
    }
}

/// A row of texels, or a column, is a line. Without repetition rays across it do not hit it; walks and pyramids also
/// look along it and find its ground. A periodic one is grooves, of which one row has the same light as many.
#[test]
fn fields_one_sample_wide() {
    const LONG: usize = 16;
    let mut gpu = Device::new();
    let height = |i: usize| [0.0, 2.0, 1.0, 3.0, 0.5, 1.5, 2.5, 0.25][i % 8];
    let lit = |land: HeightField, border| {
        let mut scene = under_sky(land, border);
        scene.lights = Lights { suns: vec![LOW], ..Lights::default() };
        scene
    };
    for engine in ENGINES {
        for border in [Border::Plane, Border::Open] {
            for [rows, cols] in [[1, LONG], [LONG, 1], [1, 1]] {
                let line = field(rows, cols, [1.0, 1.0], |r, c| height(r + c));
                let all = bounced(&mut gpu, &lit(line, border), &quality(engine, 1, 4));
                let most = all[0].iter().fold(0.0_f32, |m, v| m.max(*v));
                let is_visible = engine == BounceEngine::Sweep && rows * cols > 1;
                assert_eq!(most > 0.0, is_visible, "{engine:?} {border:?} {rows} × {cols}: {most}");
            }
        }
        let row = field(1, LONG, [1.0, 1.0], |_, c| height(c));
        let grooves = field(LONG, LONG, [1.0, 1.0], |_, c| height(c));
        let [row, grooves] = [row, grooves].map(|f| {
            bounced(&mut gpu, &lit(f, Border::Periodic), &quality(engine, 1, 4)).remove(0)
        });
        let most = grooves.iter().fold(0.0_f32, |m, v| m.max(*v));
        for (i, (one, many)) in row.iter().zip(&grooves[5 * LONG..]).enumerate() {
            let off = f64::from((one - many).abs());
            assert!(off <= 200.0 * EPSILON * f64::from(most), "{engine:?} {i}: {one} {many}");
        }
        assert!(most > 0.01, "{engine:?}: {most}");
    }
}

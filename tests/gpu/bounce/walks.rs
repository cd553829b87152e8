//! Bounces by walks over swept occluders: against closed forms, brute force over every crossing, and conservation of
//! energy.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use ridgelight::plan::azimuths::even;
use ridgelight::plan::{self, Axis, Limits, Picture};
use ridgelight::scene::fractal;
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, HeightField, Lines, Method, Quality, Scene,
};
use ridgelight_cpu::bounce_shade::LEAST_SHARE;
use ridgelight_cpu::bounce_walk::bounce_walk;
use ridgelight_cpu::horizon_sweep::{SweepOptions, horizon_sweep};
use ridgelight_cpu::lattice::{Lattices, number_layers};
use ridgelight_cpu::shared::gather::Swept;
use ridgelight_cpu::shared::sweep::Heights;
use ridgelight_cpu::tolerance::EPSILON;

use crate::{Device, field, random, under_sky};

/// A number of bounces in so many azimuths, without cutoff, of direct light by sweeps in as many.
fn swept(count: u32, azimuths: u32, engine: BounceEngine) -> Quality {
    let bounces = Bounces { count, azimuths, engine, cutoff: 0.0, ..Bounces::default() };
    Quality { azimuths, bounces, ..Quality::default() }
}

/// The first channel of the picture, of a scene under a sky alone.
fn drawn(gpu: &mut Device, scene: &Scene, quality: &Quality) -> Vec<f64> {
    let limits = gpu.limits();
    drawn_within(gpu, scene, quality, &limits)
}

fn drawn_within(gpu: &mut Device, scene: &Scene, quality: &Quality, limits: &Limits) -> Vec<f64> {
    gpu.picture_within(scene, quality, limits).values.into_iter().map(f64::from).collect()
}

/// The share of ground of radiance 1 in a texel's view, by the CPU reference.
fn ground_shares(field: &HeightField, border: Border, count: u32) -> Vec<f64> {
    let mut azimuths = even(count, field.cell_m());
    number_layers(&mut azimuths);
    let size = [field.cols() as u32, field.rows() as u32];
    let warm_up = [false, true].map(|by_row| Axis::of(by_row, size, border).warm_up as i32);
    let heights = Heights::of(field, border);
    let mut lattices = Lattices::new(&azimuths, [field.cols(), field.rows()], 15, border);
    for azimuth in &azimuths {
        let warm_up = warm_up[usize::from(azimuth.marches_rows())];
        let options = SweepOptions { warm_up, ..SweepOptions::default() };
        horizon_sweep(heights, azimuth, &options, lattices.of_mut(azimuth));
    }
    let (azimuths, lattices) = (azimuths.as_slice(), &lattices);
    let swept = Swept { heights, azimuths, lattices, fuse: None, line_shift: 15, warm_up };
    let white = vec![[1.0; 3]; field.heights_m().len()];
    swept.per_grid_point(|col, row| bounce_walk(&swept, &white, col, row).radiance()[0])
}

/// White ground under a white sky: each bounce adds, and the sum rises to 1. Sky and ground are found separately:
/// where a texel's shares s and t sum to 1 + d, light that is nowhere more than 1 + D stays so if s + t (1 + D) ≤ 1 +
/// D: D = d / (1 - t), and likewise from below; 16 roundings a bounce. All bounces are walked from every texel: the visibility cache has
/// no room, as it needs a layer per azimuth.
#[test]
fn a_furnace_comes_up_to_one() {
    const COUNT: u32 = 64;
    let mut gpu = Device::new();
    let limits = Limits { image_layers: 31, ..gpu.limits() };
    let mut next = random(9);
    let noise: Vec<f64> = (0..72).map(|_| next()).collect();
    for border in [Border::Open, Border::Periodic] {
        let scene = under_sky(field(8, 9, [1.0, 1.5], |r, c| 1.5 * noise[r * 9 + c]), border);
        let ground = ground_shares(&scene.field, border, 32);
        let mut before =
            drawn_within(&mut gpu, &scene, &swept(0, 32, BounceEngine::Sweep), &limits);
        let (mut above, mut below, mut darkest) = (0.0_f64, 0.0_f64, 0.0_f64);
        for (sky, ground) in before.iter().zip(&ground) {
            let off = (sky + ground - 1.0) / (1.0 - ground);
            (above, below) = (above.max(off), below.max(-off));
            darkest = darkest.max(*ground);
        }
        let slack = above + 16.0 * EPSILON * f64::from(COUNT);
        for count in [1, 2, 5, COUNT] {
            let now =
                drawn_within(&mut gpu, &scene, &swept(count, 32, BounceEngine::Sweep), &limits);
            for (a, b) in before.iter().zip(&now) {
                assert!(a <= b && *b <= 1.0 + slack, "{border:?} {count}: {a} {b} {slack:e}");
            }
            before = now;
        }
        let least = before.iter().fold(f64::MAX, |m, v| m.min(*v));
        println!("{border:?}: {least:.4} to 1 + {slack:.2e}");
        let left = darkest.powi(COUNT as i32) + below + 16.0 * EPSILON * f64::from(COUNT);
        assert!(least >= 1.0 - left, "{border:?}: {least} {left}");
    }
}

/// The same with later bounces at nodes: each bounce adds, and none gains energy. 16 roundings a bounce.
///
/// First bounce: sky and ground are found separately. Where a texel's shares s and t sum to 1 + d, light that is nowhere more than 1 +
/// D stays so if s + t (1 + D) ≤ 1 + D: D = d / (1 - t).
///
/// Later bounces: a texel takes its share t of the nodes' mean radiance, which is at most the largest of the bounce before. With the
/// first bounce's largest radiance B and the largest share T, all of them add t B / (1 - T) at most. A visibility cache rounds the
/// weights of four rings to half a part of 65535 of π / 2 an azimuth, of π in all. That moves the ground's share of a node, where it is
/// not 0, and with it t, by as much times t over the node's share or [`LEAST_SHARE`]. How much they lose is tested by `on_terrain_shares_are_better_than_light`.
#[test]
fn a_furnace_gains_no_energy() {
    const COUNT: u32 = 64;
    let mut gpu = Device::new();
    let mut next = random(9);
    let noise: Vec<f64> = (0..72).map(|_| next()).collect();
    // Nodes of later bounces: every fourth texel, and the last.
    let nodes = [0, 4, 7].into_iter().flat_map(|r| [0, 4, 8].map(|c| 9 * r + c));
    for border in [Border::Open, Border::Periodic] {
        let scene = under_sky(field(8, 9, [1.0, 1.5], |r, c| 1.5 * noise[r * 9 + c]), border);
        let ground = ground_shares(&scene.field, border, 32);
        let largest = |of: &[f64]| of.iter().fold(0.0_f64, |most, v| most.max(*v));
        let lit =
            |gpu: &mut Device, count| drawn(gpu, &scene, &swept(count, 32, BounceEngine::Sweep));
        let [sky, first] = [0, 1].map(|count| lit(&mut gpu, count));
        let above = sky.iter().zip(&ground).map(|(s, t)| (s + t - 1.0) / (1.0 - t));
        let slack = above.fold(0.0, f64::max) + 16.0 * EPSILON;
        for (a, b) in sky.iter().zip(&first) {
            assert!(a <= b && *b <= 1.0 + slack, "{border:?}: {a} {b} {slack:e}");
        }
        let of_nodes = nodes.clone().map(|i| ground[i]).filter(|share| *share > 0.0);
        let least = of_nodes.fold(1.0, f64::min).max(LEAST_SHARE);
        let rings = 4.0 * 0.5 * FRAC_PI_2 * TAU / 65535.0 / PI;
        let shares: Vec<f64> = ground.iter().map(|t| t * (1.0 + rings / least)).collect();
        let bounced: Vec<f64> = first.iter().zip(&sky).map(|(a, b)| a - b).collect();
        let later = largest(&bounced) / (1.0 - largest(&shares));
        let mut before = first.clone();
        for count in [2, 5, COUNT] {
            let now = lit(&mut gpu, count);
            for (i, (a, b)) in before.iter().zip(&now).enumerate() {
                let most = first[i] + shares[i] * later + 16.0 * EPSILON * f64::from(count);
                assert!(a <= b && *b <= most, "{border:?} {count}: {a} {b} {most}");
            }
            before = now;
        }
        println!("{border:?}: at most {:.4}, first {:.4}", largest(&before), largest(&first));
    }
}

/// Against brute force over every crossing, on a fractal. The same land at twice the texels a cell has its crossings
/// half as far apart, and lines two and four cells apart are as much farther from a texel's own: the errors rise in
/// this order, and even the largest is smaller than that of no bounce at all.
#[test]
fn walks_are_near_every_crossing() {
    let mut gpu = Device::new();
    let land = fractal(12, 3).unwrap();
    let h = |r: usize, c: usize| f64::from(land.heights_m()[r.min(11) * 12 + c.min(11)]);
    let fine = field(23, 23, land.cell_m().map(|c| c / 2.0), |r, c| {
        0.5 * (h(r / 2, c / 2) + h(r.div_ceil(2), c.div_ceil(2)))
    });
    let ways = [
        (&fine, Lines::Cell),
        (&land, Lines::Cell),
        (&land, Lines::TwoCells),
        (&land, Lines::FourCells),
    ];
    let errors = ways.map(|(field, lines)| {
        let mut scene = under_sky(field.clone(), Border::Plane);
        scene.surface.albedo = Albedo::Constant([0.8; 3]);
        let mut alone = |engine| {
            let [none, one] = [0, 1].map(|count| {
                let quality = Quality { lines, ..swept(count, 48, engine) };
                drawn(&mut gpu, &scene, &quality)
            });
            one.iter().zip(&none).map(|(a, b)| a - b).collect::<Vec<f64>>()
        };
        let (walked, every) = (alone(BounceEngine::Sweep), alone(BounceEngine::BruteForce));
        let rms = |values: &mut dyn Iterator<Item = f64>| values.map(|v| v * v).sum::<f64>().sqrt();
        let off = rms(&mut walked.iter().zip(&every).map(|(a, b)| a - b));
        off / rms(&mut every.iter().copied())
    });
    println!("off by {:.2?} % of a bounce", errors.map(|e| 100.0 * e));
    assert!(errors.windows(2).all(|two| two[0] < two[1]) && errors[3] < 1.0, "{errors:?}");
}

/// Methods without lines have nothing to walk over and are refused with that reason, except where the ground is black.
#[test]
fn walks_without_lines_are_refused() {
    let mut scene = under_sky(fractal(8, 1).unwrap(), Border::Plane);
    let of = |scene: &Scene, method, lines| {
        let quality = Quality { method, lines, ..swept(1, 8, BounceEngine::Sweep) };
        plan::picture(scene, &quality, &Limits::lavapipe(), Picture::default())
    };
    let ways = [
        (Method::BruteForce, Lines::Cell, "method brute-force"),
        (Method::Pyramid, Lines::Cell, "method pyramid"),
        (Method::Auto, Lines::Exact, "lines exact"),
    ];
    for (method, lines, name) in ways {
        let said = of(&scene, method, lines).unwrap_err().to_string();
        assert!(said.contains("bounce_engine sweep") && said.contains(name), "{said}");
    }
    scene.surface.albedo = Albedo::Constant([0.0; 3]);
    assert!(of(&scene, Method::BruteForce, Lines::Cell).is_ok());
}

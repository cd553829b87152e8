//! Bounces by walks over blocks of swept lines.

use ridgelight::plan::{self, Limits, Picture, Plan, missing_barriers};
use ridgelight::scene::{BounceEngine, Bounces, Fuse, Lights, Quality, Scene};

use crate::{flat, under_sky};

fn drawn(scene: &Scene, quality: Quality, keeps_horizons: bool) -> Plan {
    drawn_within(&Limits::lavapipe(), scene, quality, keeps_horizons)
}

fn drawn_within(limits: &Limits, scene: &Scene, quality: Quality, keeps_horizons: bool) -> Plan {
    let wanted = Picture { keeps_horizons, ..Picture::default() };
    plan::picture(scene, &quality, limits, wanted).expect("a plan")
}

fn walked(count: u32, azimuths: u32) -> Quality {
    let engine = BounceEngine::Sweep;
    let bounces = Bounces { count, engine, azimuths, cutoff: 0.0, ..Bounces::default() };
    Quality { azimuths: 8, bounces, ..Quality::default() }
}

fn labels(plan: &Plan) -> Vec<String> {
    plan.passes.iter().map(plan::Pass::label).filter(|l| l.contains("bounce")).collect()
}

/// A batch an axis, each swept and walked. Later bounces read caches. Where those have no room, they sweep again where batches
/// share a lattice, and only walk where each batch keeps its own. Blocks for rays are made for nodes alone.
#[test]
fn sweeps_and_walks() {
    let mut scene = under_sky(flat(9, 14));
    let once = [
        "bounce_ground bounce1",
        "horizon_sweep bounce1 8+4",
        "line_blocks bounce1 8+4",
        "bounce_walk bounce1 8+4",
    ];
    let of = |plan: &Plan, name: &str| {
        plan.passes.iter().filter(|p| p.name() == name && p.part.contains("bounce")).count()
    };
    let one = drawn(&scene, walked(1, 8), false);
    assert!(labels(&one).starts_with(&once.map(String::from)), "{:?}", labels(&one));
    assert_eq!([of(&one, "horizon_sweep"), of(&one, "bounce_walk")], [2, 2]);
    assert_eq!(one.azimuths.len(), 16);
    assert!(one.find("ground").is_none() && one.edit_passes.is_empty());
    let [cached, kept] = [false, true].map(|keeps| drawn(&scene, walked(3, 8), keeps));
    for plan in [&cached, &kept] {
        // Nodes with a cache, the others of their lanes, and the rest.
        assert_eq!([of(plan, "horizon_sweep"), of(plan, "bounce_walk")], [2, 6]);
        assert_eq!(of(plan, "cache_gather"), 2);
    }
    // A layer an azimuth.
    let few_layers = Limits { image_layers: 7, ..Limits::lavapipe() };
    let [shared, alone] =
        [false, true].map(|keeps| drawn_within(&few_layers, &scene, walked(3, 8), keeps));
    assert_eq!([of(&shared, "horizon_sweep"), of(&shared, "bounce_walk")], [6, 6]);
    assert_eq!([of(&alone, "horizon_sweep"), of(&alone, "bounce_walk")], [2, 6]);
    for plan in [&one, &cached, &kept, &shared, &alone] {
        assert_eq!(missing_barriers(&plan.passes), vec![]);
    }
    // Slopes alone are not enough.
    let slopes = drawn(&scene, Quality { fuse: Fuse::Slopes, ..walked(1, 8) }, false);
    assert!(slopes.find("lattice_occluders").is_some());
    // A change of light alone sweeps nothing, and walks again.
    let before = kept.clone();
    scene.lights = Lights { sky: Some([2.0; 3]), ..Lights::default() };
    let after = drawn(&scene, walked(3, 8), true);
    let again = after.passes_after(&before, &[]);
    let names: Vec<&str> = again.iter().map(|i| after.passes[*i].name()).collect();
    assert!(!names.contains(&"horizon_sweep") && names.contains(&"bounce_walk"), "{names:?}");
}

/// The blocks of up to 8 azimuths are made at once, if they fit 64 MiB, or 4 MiB on a CPU. With grey light, 1024² heights take
/// 8.25 MiB an azimuth, so seven fit. 2 × 4096 heights take 1 MiB an azimuth along the columns, so eight fit, in an image of their
/// own. The first walk clears and the last divides.
#[test]
fn blocks_are_made_of_azimuths_that_fit() {
    let of = |rows, cols, is_cpu| {
        let limits = Limits::lavapipe();
        let limits = if is_cpu { limits } else { crate::on_gpu(limits) };
        let scene = under_sky(flat(rows, cols));
        plan::picture(&scene, &walked(1, 64), &limits, Picture::default()).expect("a plan")
    };
    let counts = |plan: &Plan, name: &str, by_row: bool| -> Vec<usize> {
        let passes = plan.passes.iter().filter(|p| p.name() == name).map(|p| p.azimuths.clone());
        let along = passes.filter(|a| plan.azimuths[a.start as usize].marches_rows() == by_row);
        along.map(|a| a.len()).collect()
    };
    for (rows, cols, at_once) in [(1024, 1024, 1), (2, 4096, 4)] {
        let plan = of(rows, cols, true);
        assert!(counts(&plan, "line_blocks", false).iter().all(|n| *n == at_once));
    }
    let square = of(1024, 1024, false);
    assert!(counts(&square, "line_blocks", true).iter().all(|n| (1..=8).contains(n)));
    let plan = of(2, 4096, false);
    for by_row in [false, true] {
        assert_eq!(counts(&plan, "line_blocks", by_row), counts(&plan, "bounce_walk", by_row));
    }
    assert_eq!(counts(&plan, "line_blocks", false), [8; 4]);
    let walks: Vec<_> = plan.passes.iter().filter(|p| p.name() == "bounce_walk").collect();
    assert_eq!(walks.iter().map(|p| p.azimuths.len()).sum::<usize>(), 64);
    let room = |name: &str| plan.resources[plan.find(name).expect(name).0].bytes();
    assert!(room("line_blocks") <= 72 << 20 && room("line_blocks_across") <= 72 << 20);
    let word = |i: usize, at: usize| {
        let push = &walks[i].push;
        u32::from_ne_bytes(push[4 * at..4 * at + 4].try_into().unwrap())
    };
    for i in 0..walks.len() {
        assert_eq!(word(i, 7), u32::from(i == 0));
        assert_eq!(word(i, 8), u32::from(i + 1 == walks.len()));
    }
}

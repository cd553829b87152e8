//! The passes of bounces: engines, nodes, and none on black ground.

use ridgelight::plan::{self, Limits, Pass, Picture, Plan, missing_barriers};
use ridgelight::scene::{
    Albedo, Border, BounceEngine, Bounces, Environment, LightBasis, Lights, Lines, Method, Quality,
    Scene, SphereLight, Surface,
};

use crate::{flat, under_sky};

const ENGINES: [BounceEngine; 3] =
    [BounceEngine::BruteForce, BounceEngine::Sweep, BounceEngine::Pyramid];

fn quality(engine: BounceEngine, count: u32, subsample: u32) -> Quality {
    let bounces = Bounces { count, engine, azimuths: 8, cutoff: 0.0, ..Bounces::default() };
    Quality { azimuths: 8, bounces, subsample, ..Quality::default() }
}

fn drawn(scene: &Scene, quality: &Quality, memory_budget: u64) -> Plan {
    let limits = Limits { memory_budget, ..Limits::lavapipe() };
    plan::picture(scene, quality, &limits, Picture::default()).expect("a plan")
}

fn count(plan: &Plan, name: &str) -> usize {
    plan.passes.iter().filter(|p| p.name() == name).count()
}

const ROOMY: u64 = 2 << 30;

/// Walks where lines are swept, else brute force with a note; no passes on black ground.
#[test]
fn the_planner_takes_walks_where_there_are_lines() {
    let mut scene = under_sky(flat(9, 14));
    let auto = quality(BounceEngine::Auto, 1, 1);
    for (method, lines, pass, why) in [
        (Method::Auto, Lines::Cell, "bounce_walk", "bounce engine sweep: "),
        (Method::Sweep, Lines::FourCells, "bounce_walk", "bounce engine sweep: "),
        (Method::Sweep, Lines::Exact, "bounce_march", "bounce engine brute-force: lines exact "),
        (
            Method::BruteForce,
            Lines::Cell,
            "bounce_march",
            "bounce engine brute-force: method brute-force ",
        ),
        (
            Method::Pyramid,
            Lines::Cell,
            "bounce_march",
            "bounce engine brute-force: method pyramid ",
        ),
    ] {
        let plan = drawn(&scene, &Quality { method, lines, ..auto }, ROOMY);
        assert!(count(&plan, pass) > 0, "{method:?} {lines:?}");
        assert!(plan.notes.iter().any(|n| n.starts_with(why)), "{:?}", plan.notes);
        let engine = &plan.settings.iter().find(|s| s.0 == "bounce_engine").unwrap().1;
        assert!(why.contains(engine.as_str()), "{engine}");
    }
    scene.surface = Surface { albedo: Albedo::Constant([0.0; 3]), ..scene.surface };
    let dark = drawn(&scene, &auto, ROOMY);
    assert!(!dark.notes.iter().any(|n| n.contains("engine")), "{:?}", dark.notes);
}

/// An engine works at nodes, later bounces at every second of them, and every texel is lit from them. Later
/// bounces of sweeps use visibility caches, which take no more than a quarter of the memory left; otherwise
/// each is swept and walked, from every texel without sub-sampling.
#[test]
fn bounces_at_nodes() {
    let scene = under_sky(flat(13, 18));
    let nodes = |stride: u32| {
        u64::from(12_u32.div_ceil(stride) + 1) * u64::from(17_u32.div_ceil(stride) + 1)
    };
    for stride in [2, 4] {
        let engines = [
            (BounceEngine::Sweep, "bounce_walk"),
            (BounceEngine::BruteForce, "bounce_march"),
            (BounceEngine::Pyramid, "bounce_gather"),
        ];
        for (engine, name) in engines {
            let plan = drawn(&scene, &quality(engine, 3, stride), ROOMY);
            let grid_points = plan.passes.iter().filter(|p| p.name() == name).map(|p| p.texels);
            let walks_once = engine == BounceEngine::Sweep;
            let later = if walks_once { 0 } else { 2 * nodes(2 * stride) };
            assert_eq!(grid_points.sum::<u64>(), (nodes(stride) + later) * 8, "{name} {stride}");
            assert_eq!(count(&plan, "bounce_shade"), 3);
            assert_eq!(count(&plan, "cache_gather"), if walks_once { 2 } else { 0 });
            assert_eq!(missing_barriers(&plan.passes), vec![]);
            let bytes = |name: &str| plan.resources[plan.find(name).expect(name).0].bytes();
            assert_eq!(bytes("node_sum"), nodes(stride) * 16);
            assert_eq!(bytes("later_node_sum"), nodes(2 * stride) * 16);
            let has = |s: &(String, String)| *s == ("subsample".into(), stride.to_string());
            assert!(plan.settings.iter().any(has), "{:?}", plan.settings);
            if walks_once {
                assert_eq!(bytes("visibility_cache"), nodes(2 * stride) * 8 * 16);
            }
        }
    }
    // Walks from every texel find the share of ground, and keep a cache of every fourth texel. The other engines do neither.
    let plan = drawn(&scene, &quality(BounceEngine::Sweep, 3, 1), ROOMY);
    let bytes = |name: &str| plan.resources[plan.find(name).expect(name).0].bytes();
    assert_eq!(bytes("visibility_cache"), nodes(4) * 8 * 16);
    assert_eq!(["bounce_shade", "cache_gather"].map(|name| count(&plan, name)), [2, 2]);
    assert!(
        plan.find("node_sum").is_none() && !labels(&plan).join(" ").contains("sky_shade bounce")
    );
    // Interpolation reads the ground. No pass traces rays, so there are no cells.
    assert!(plan.find("ground").is_some() && plan.find("cells").is_none());
    assert_eq!(missing_barriers(&plan.passes), vec![]);
    let says = |plan: &Plan| plan.notes.iter().any(|note| note.contains("every 4th grid point"));
    assert!(says(&plan), "{:?}", plan.notes);
    for engine in [BounceEngine::BruteForce, BounceEngine::Pyramid] {
        let plan = drawn(&scene, &quality(engine, 3, 1), ROOMY);
        assert!(count(&plan, "bounce_shade") == 0 && plan.find("sky_share").is_none());
        assert!(plan.find("visibility_cache").is_none() && !says(&plan));
    }
    // With many azimuths the caches take most of the memory.
    let few = quality(BounceEngine::Sweep, 3, 2);
    let walks = Quality { bounces: Bounces { azimuths: 128, ..few.bounces }, ..few };
    let large = under_sky(flat(50, 70));
    let plan = drawn(&large, &walks, ROOMY);
    let sets = plan.resources[plan.find("visibility_cache").expect("kept").0].bytes();
    // A cache takes at most a quarter of the budget.
    let tight = drawn(&large, &walks, 3 * sets);
    assert!(tight.find("visibility_cache").is_none() && count(&tight, "cache_gather") == 0);
    let walked = |plan: &Plan| -> u64 {
        plan.passes.iter().filter(|p| p.name() == "bounce_walk").map(|p| p.texels).sum()
    };
    let found = |stride: u32| {
        u64::from(49_u32.div_ceil(stride) + 1) * u64::from(69_u32.div_ceil(stride) + 1)
    };
    assert_eq!(walked(&plan), found(2) * 128);
    assert_eq!(walked(&tight), (found(2) + 2 * found(4)) * 128);
    assert!(tight.notes.iter().any(|n| n.starts_with("no visibility cache")), "{:?}", tight.notes);
    let all = Quality { subsample: 1, ..walks };
    let tight = drawn(&large, &all, 3 * sets);
    assert_eq!((walked(&tight), count(&tight, "bounce_shade")), (3 * 50 * 70 * 128, 0));
    assert!(tight.notes.iter().any(|n| n.starts_with("no visibility cache")), "{:?}", tight.notes);
    // A single bounce needs no cache, and no bounce needs no ground share.
    let once = drawn(&scene, &quality(BounceEngine::Sweep, 1, 2), ROOMY);
    assert!(once.find("visibility_cache").is_none() && once.find("node_sum").is_some());
    let none = drawn(&scene, &quality(BounceEngine::Sweep, 0, 2), ROOMY);
    assert!(none.find("node_sum").is_none() && none.find("ground").is_none());
}

/// A picture that fits a memory budget fits every larger one. If the visibility cache leaves too little memory, the plan omits it and
/// adds a note.
#[test]
fn a_larger_budget_never_refuses_a_picture() {
    let scene = under_sky(flat(50, 70));
    let few = quality(BounceEngine::Sweep, 3, 1);
    let mut without = 0;
    for azimuths in [8, 16, 32] {
        let quality = Quality { bounces: Bounces { azimuths, ..few.bounces }, ..few };
        let plans = (1..200).map(|bytes_a_texel| {
            let memory_budget = bytes_a_texel * 50 * 70;
            let limits = Limits { memory_budget, ..Limits::lavapipe() };
            let plan = plan::picture(&scene, &quality, &limits, Picture::default()).ok()?;
            assert!(plan.bytes() <= memory_budget, "{azimuths}: {}", plan.bytes());
            Some(plan)
        });
        let drawn: Vec<Plan> =
            plans.skip_while(Option::is_none).map(|plan| plan.expect("fits")).collect();
        assert!(drawn[0].find("visibility_cache").is_none());
        assert!(drawn.last().expect("some").find("visibility_cache").is_some());
        let says =
            |plan: &&Plan| plan.notes.iter().any(|n| n.ends_with("exceeds the memory budget"));
        without += drawn.iter().filter(says).count();
    }
    assert!(without > 0);
}

/// Passes that fill the ground are in a plan once, if anything reads it; those of the blocks only if rays are traced.
#[test]
fn the_ground_is_made_once_and_blocks_for_rays_alone() {
    let sphere = SphereLight { position_m: [4.0, 4.0, 30.0], radius_m: 1.0, radiance: [1.0; 3] };
    let lights = [
        None,
        Some((LightBasis::Exact, Method::Sweep)),
        Some((LightBasis::Sh, Method::Sweep)),
        Some((LightBasis::Sh, Method::Pyramid)),
    ];
    for light in lights {
        for engine in [None].into_iter().chain(ENGINES.map(Some)) {
            let (light_basis, method) = light.unwrap_or((LightBasis::Exact, Method::Sweep));
            if engine == Some(BounceEngine::Sweep) && method == Method::Pyramid {
                continue;
            }
            let mut scene = under_sky(flat(13, 18));
            scene.lights.sphere_lights = light.map(|_| sphere).into_iter().collect();
            let bounces = engine.map_or(0, |_| 2);
            let base = quality(engine.unwrap_or(BounceEngine::Auto), bounces, 1);
            let plan = drawn(&scene, &Quality { light_basis, method, ..base }, ROOMY);
            let of = format!("{light:?} {engine:?}");
            let has_ground = light.is_some() || engine.is_some();
            assert_eq!(count(&plan, "height_cells"), usize::from(has_ground), "{of}");
            let by_rays =
                light.is_some() && (light_basis, method) != (LightBasis::Sh, Method::Pyramid);
            let has_rays = by_rays || engine == Some(BounceEngine::BruteForce);
            assert_eq!(count(&plan, "height_bounds") > 0, has_rays, "{of}");
            assert_eq!(plan.find("cells").is_some(), has_rays, "{of}");
            assert_eq!(missing_barriers(&plan.passes), vec![], "{of}");
        }
    }
}

/// Walks compute the share of ground on their own lines, once; other engines use that of a sky's light, and
/// sweep a circle of azimuths for it where nothing else needs one.
#[test]
fn ground_shares_are_computed_once() {
    let mut scene = under_sky(flat(9, 14));
    let environment = Environment::new(4, 2, vec![[1.0, 0.5, 0.2]; 8], 0.0).unwrap();
    scene.lights = Lights { environment: Some(environment), ..Lights::default() };
    let walked = drawn(&scene, &quality(BounceEngine::Sweep, 2, 2), ROOMY);
    assert!(walked.find("sky_share").is_some() && walked.find("sky_sum").is_none());
    let shares = walked.passes.iter().filter(|p| p.label().starts_with("sky_shade bounce"));
    assert_eq!(shares.map(|p| p.azimuths.len()).sum::<usize>(), 8);
    let marched = drawn(&scene, &quality(BounceEngine::BruteForce, 2, 2), ROOMY);
    assert!(marched.find("sky_share").is_none() && marched.find("sky_sum").is_some());
}

fn planned(albedo: [f32; 3], count: u32, engine: BounceEngine) -> Plan {
    let surface =
        Surface { albedo: Albedo::Constant(albedo), border: Border::Plane, specular: None };
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let scene = Scene { field: flat(9, 14), surface, lights };
    let bounces = Bounces { count, engine, azimuths: 8, cutoff: 0.0, ..Bounces::default() };
    let quality = Quality { azimuths: 8, bounces, ..Quality::default() };
    let wanted = Picture { light_layers: true, ..Picture::default() };
    plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).expect("a plan")
}

fn labels(plan: &Plan) -> Vec<String> {
    plan.passes.iter().map(Pass::label).collect()
}

/// Ground with albedo 0 has the passes, images and outputs of a picture without bounces, and a note; the
/// smallest albedo above 0 in one colour has them all.
#[test]
fn black_ground_drops_every_pass_of_bounces() {
    for engine in ENGINES {
        let [black, none, faint] = [([0.0; 3], 3), ([0.0; 3], 0), ([0.0, 1e-30, 0.0], 3)]
            .map(|(albedo, count)| planned(albedo, count, engine));
        assert_eq!(labels(&black), labels(&none), "{engine:?}");
        let names = |plan: &Plan| -> Vec<String> {
            plan.resources.iter().map(|r| r.name.clone()).collect()
        };
        assert_eq!(names(&black), names(&none), "{engine:?}");
        assert!(black.notes.contains(&"no bounces: the surface reflects nothing".to_owned()));
        let of_bounces = |plan: &Plan| {
            let is_one = |l: &&String| l.contains("bounce") || l.contains("shade_reduce");
            labels(plan).iter().filter(is_one).count()
        };
        assert_eq!(of_bounces(&black), 0, "{engine:?}");
        let faint_ones = labels(&faint).join(" ");
        for k in 1..=3 {
            assert!(faint_ones.contains(&format!("bounce{k}")), "{engine:?}: {faint_ones}");
        }
        assert!(of_bounces(&faint) >= 6, "{engine:?}: {faint_ones}");
    }
}

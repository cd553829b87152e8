//! The plan as text, without a device: odd sizes, fields in bands, and the audit of its barriers.

mod bounces;
mod edits;
mod points;
mod reference;
mod shadows;
mod sizes;
mod specular;
mod unknown;
mod walks;

use std::collections::HashSet;

use ridgelight::gpu::shaders::offset;
use ridgelight::plan::azimuths::{FLIPS_LANES, FLIPS_MARCH};
use ridgelight::plan::{
    self, Kind, Limits, Owner, Pass, Picture, Plan, Reach, SweepForm, missing_barriers,
};
use ridgelight::scene::{
    Albedo, Basis, Border, BounceEngine, Bounces, Environment, Fuse, HeightField, Hull, KeyLight,
    Levels, LightBasis, Lights, Lines, Method, Normals, Precision, Quality, Receiver, Scene,
    SphereLight, Sun, Surface, Wedges,
};

fn flat(rows: usize, cols: usize) -> HeightField {
    HeightField::new(rows, cols, &vec![0.0; rows * cols], [1.0, 1.0], None).expect("a good field")
}

fn under_sky(field: HeightField) -> Scene {
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    Scene { field, surface: Surface::default(), lights }
}

/// Sky, environment, a point sun and a disc, a key light, with an albedo map.
fn under_everything(field: HeightField, border: Border) -> Scene {
    let map = vec![[0.5, 0.4, 0.3]; field.rows() * field.cols()];
    let sun = |diameter_rad| Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.5,
        diameter_rad,
        irradiance: [1.0, 0.9, 0.8],
    };
    let environment = Environment::new(8, 4, vec![[0.5, 0.4, 0.3]; 32], 0.3);
    let lights = Lights {
        sky: Some([1.0; 3]),
        environment: Some(environment.expect("an environment")),
        suns: vec![sun(0.0), sun(0.02)],
        keys: vec![KeyLight {
            azimuth_rad: 4.0,
            width_rad: 0.4,
            elevations_rad: [0.2, 0.5],
            radiance: [2.0; 3],
        }],
        ..Lights::default()
    };
    Scene {
        field,
        surface: Surface { border, albedo: Albedo::Map(map), ..Surface::default() },
        lights,
    }
}

/// One line a pass: `|` where a barrier stands before it, label, workgroups. Then the plan's own images
/// and buffers: columns × rows × layers, or bytes.
fn short(plan: &Plan) -> String {
    let passes = plan.passes.iter().map(|pass| {
        let mark = if pass.barrier_before { '|' } else { ' ' };
        let [x, y, z] = pass.groups;
        format!("{mark} {} {x}×{y}×{z}\n", pass.label())
    });
    let own = plan.resources.iter().filter(|r| r.owner == Owner::Internal);
    let resources = own.map(|r| match r.kind {
        Kind::Image { width, height, layers, .. } => {
            format!("{} {width}×{height}×{layers}\n", r.name)
        }
        Kind::Buffer { bytes, .. } => format!("{} {bytes}\n", r.name),
    });
    passes.chain(resources).collect()
}

fn sky(rows: usize, cols: usize, azimuths: u32, limits: &Limits) -> Plan {
    let quality = Quality { azimuths, ..Quality::default() };
    let scene = under_sky(flat(rows, cols));
    plan::picture(&scene, &quality, limits, Picture::default()).expect("a plan")
}

fn is(plan: &Plan, text: &str) {
    let lines: Vec<&str> = text.lines().map(|l| l.strip_prefix("        ").unwrap_or(l)).collect();
    let kept = lines[1..lines.len() - 1].join("\n") + "\n";
    assert_eq!(short(plan), kept, "now:\n{}", short(plan));
    assert_eq!(missing_barriers(&plan.passes), []);
}

/// Plans with every form of every pass, at sizes that make groups, lanes and layers odd.
fn plans() -> Vec<Plan> {
    let base = Quality { azimuths: 12, ..Quality::default() };
    let by_sh = Quality { basis: Basis::Sh, ..base };
    let bounced = |engine| {
        let bounces = Bounces { count: 3, engine, azimuths: 8, cutoff: 0.0, ..Bounces::default() };
        Quality { bounces, ..base }
    };
    let qualities = [
        base,
        Quality { hull: Hull::Shared, fuse: Fuse::Slopes, ..base },
        Quality { hull: Hull::OccluderList, fuse: Fuse::Own, ..base },
        Quality { lines: Lines::TwoCells, fuse: Fuse::Aimed, ..base },
        Quality { fuse: Fuse::Nearest, precision: Precision::F16, ..base },
        Quality { precision: Precision::Packed, ..base },
        Quality { method: Method::BruteForce, ..base },
        Quality { lines: Lines::Exact, ..base },
        Quality { method: Method::Pyramid, ..base },
        Quality { method: Method::Pyramid, levels: Levels::Pyramid, level_offset: 0, ..base },
        by_sh,
        Quality { wedges: Wedges::Nlp, receiver: Receiver::Cosine, ..by_sh },
        Quality { wedges: Wedges::Table, light_basis: LightBasis::Sh, ..by_sh },
        Quality { method: Method::Pyramid, light_basis: LightBasis::Sh, subsample: 4, ..by_sh },
        bounced(BounceEngine::BruteForce),
        bounced(BounceEngine::Sweep),
        bounced(BounceEngine::Pyramid),
        Quality { subsample: 2, basis: Basis::Sh, ..bounced(BounceEngine::Sweep) },
        Quality { subsample: 2, basis: Basis::Sh, ..bounced(BounceEngine::BruteForce) },
    ];
    let graphics = on_gpu(Limits::lavapipe());
    let mut all = Vec::new();
    for (rows, cols) in [(1, 1), (1, 7), (7, 1), (2, 3), (31, 37), (3, 1021), (1021, 3)] {
        for border in [Border::Plane, Border::Open, Border::Periodic] {
            let scene = under_everything(flat(rows, cols), border);
            all.push(
                plan::reference(&scene, 1, Normals::Smooth, None, 0, &Limits::lavapipe())
                    .expect("a plan"),
            );
            all.push(
                plan::reference_at(&scene, 1, Normals::Smooth, None, 0, 1, &Limits::lavapipe())
                    .expect("a plan"),
            );
            for quality in &qualities {
                let mut scene = under_everything(flat(rows, cols), border);
                // Sphere lights do not support edits; other lights do.
                if quality.basis == Basis::Sh || quality.bounces.count > 0 {
                    let (position_m, radius_m) = ([1.0, 1.0, 2.0], 0.5);
                    scene.lights.sphere_lights =
                        vec![SphereLight { position_m, radius_m, radiance: [3.0; 3] }];
                }
                if quality.lines == Lines::Exact {
                    scene.lights.suns.clear();
                    scene.lights.keys.clear();
                }
                let wanted = Picture { light_layers: true, sky_view: true, ..Picture::default() };
                let mut plan = |limits: &Limits| {
                    let picture = plan::picture(&scene, quality, limits, wanted);
                    let circle = (0, quality.azimuths);
                    let horizons =
                        plan::horizons(&scene.field, border, quality, limits, circle, false);
                    let bytes = picture.as_ref().map_or(0, Plan::bytes);
                    let count = all.len();
                    all.extend(picture.into_iter().chain(horizons));
                    (all.len() - count, bytes)
                };
                let (count, bytes) = plan(&Limits::lavapipe());
                assert_eq!((count, plan(&graphics).0), (2, 2));
                // Less memory than all of it: in bands, where one azimuth still fits.
                plan(&Limits { memory_budget: bytes * 9 / 10, ..Limits::lavapipe() });
                // And with passes for edits, where edits are supported.
                let wanted = Picture { keeps_horizons: true, ..wanted };
                let kept = plan::picture(&scene, quality, &Limits::lavapipe(), wanted);
                all.push(kept.expect("a plan"));
            }
        }
    }
    all
}

#[test]
fn every_plan_has_all_its_barriers_and_needs_each() {
    let plans = plans();
    let batches = |plan: &Plan| plan.passes.iter().filter(|p| p.name() == "sky_shade").count();
    assert!(plans.iter().any(|p| batches(p) > 2), "some plan is cut into bands");
    let (mut audited, mut removed) = (0, 0);
    assert!(plans.iter().any(|p| !p.edit_passes.is_empty()), "some plan takes edits");
    let lists = plans.iter().flat_map(|p| [(p, &p.passes), (p, &p.edit_passes)]);
    // The audit reads shaders, bindings and barriers alone, so that plans of other sizes are often the same to it.
    let mut known = HashSet::new();
    for (plan, list) in lists {
        assert_eq!(missing_barriers(list), [], "{plan}");
        audited += 1;
        let read = |p: &Pass| (p.shader.name, p.bindings.clone(), p.barrier_before);
        if !known.insert(list.iter().map(read).collect::<Vec<_>>()) {
            continue;
        }
        for i in 0..list.len() {
            let mut passes = list.clone();
            if std::mem::take(&mut passes[i].barrier_before) {
                let missing = missing_barriers(&passes);
                assert!(
                    missing.iter().any(|m| m.1 >= i),
                    "none visible missing before {i} of\n{plan}"
                );
                removed += 1;
            }
        }
    }
    println!("{audited} lists of passes, {removed} barriers removed, each missed");
}

/// The same limits on a GPU.
fn on_gpu(limits: Limits) -> Limits {
    let Limits { sweep, untuned_sweep, .. } = Limits::boundless(false, 0);
    Limits { is_cpu: false, sweep, untuned_sweep, ..limits }
}

/// A workgroup with four lines per invocation sweeps 128 lines, so an azimuth needs a multiple of four layers of 32 lines. With
/// one line per invocation it sweeps one layer.
#[test]
fn an_azimuths_layers_are_whole_groups() {
    let wide = on_gpu(Limits::lavapipe());
    let one_each = sky(256, 256, 64, &wide);
    let size = |p: &plan::Pass| p.constant("local_size_x");
    let lines: Vec<_> =
        one_each.passes.iter().filter(|p| p.constant("one_line") == Some(1)).collect();
    assert!(lines.len() == 2 && lines.iter().all(|p| size(p) == Some(32)));
    // docs/methods.md states these.
    let entries = |p: &plan::Pass| [p.constant("hull_depth"), p.constant("line_private_entries")];
    assert!(lines.iter().all(|p| entries(p) == [Some(8), Some(64)]));
    // Both batches are swept before either is shaded, and neither sweep waits for the other.
    assert!(one_each.passes.iter().position(|p| p.name() == "sky_shade") > Some(3));
    assert!(!lines[1].barrier_before);
    let quality = Quality { azimuths: 64, precision: Precision::Packed, ..Quality::default() };
    let scene = under_sky(flat(256, 256));
    let plan = plan::picture(&scene, &quality, &wide, Picture::default()).expect("a plan");
    let sweeps: Vec<_> = plan.passes.iter().filter(|p| p.name() == "horizon_sweep").collect();
    assert!(!sweeps.is_empty() && sweeps.iter().all(|p| size(p) == Some(32)));
    assert!(plan.azimuths.iter().all(|a| a.layer % 4 == 0));
    let lattices = plan.resources.iter().filter(|r| r.name.starts_with("lattice_occluders"));
    let layers: Vec<u32> = lattices
        .map(|lattice| match lattice.kind {
            Kind::Image { layers, .. } => layers,
            Kind::Buffer { .. } => unreachable!("an image"),
        })
        .collect();
    assert!(layers.len() == 2 && layers.iter().all(|l| l % 4 == 0), "{layers:?}");
}

/// Sizes that a device cannot make or dispatch are refused by name before they reach it.
#[test]
fn devices_limits_are_kept() {
    let all = Limits::lavapipe();
    let refused = |limits: &Limits, scene: &Scene, quality: &Quality| {
        let plan = plan::picture(scene, quality, limits, Picture::default());
        plan.expect_err("beyond the limits").to_string()
    };
    let quality = Quality { azimuths: 64, ..Quality::default() };
    let scene = under_sky(flat(40, 50));
    let groups = Limits { groups: 1, ..all };
    assert!(refused(&groups, &scene, &quality).contains("workgroups"));
    for (lines_each, group_size, hull_depth) in [(2, 32, 8), (1, 8, 8), (1, 256, 8), (4, 8, 48)] {
        let sweep = SweepForm { lines_each, group_size, hull_depth, ..all.sweep };
        let said = refused(&Limits { sweep, ..all }, &scene, &quality);
        assert!(said.contains("a multiple of 32"), "{said}");
    }
    let texels = Limits { texels: 255, ..all };
    let said = refused(&texels, &scene, &quality);
    assert!(said.contains("azimuths") && said.contains("256 texels"), "{said}");
    let wide = Environment::new(20_000, 10, vec![[1.0; 3]; 200_000], 0.0).expect("an environment");
    let lights = Lights { environment: Some(wide), ..Lights::default() };
    let said = refused(&all, &Scene { lights, ..scene }, &quality);
    assert!(said.contains("environment") && said.contains("20000 texels a side"), "{said}");
    let few = Limits { image_layers: 16, ..all };
    let sky = Environment::new(8, 4, vec![[1.0; 3]; 32], 0.0).expect("an environment");
    let lights = Lights { environment: Some(sky), ..Lights::default() };
    let said = refused(&few, &Scene { lights, ..under_sky(flat(4, 4)) }, &quality);
    assert!(said.contains("env_tables") && said.contains("64 layers"), "{said}");
}

/// A lattice that batches share is as large as the largest of them. On a GPU each has its own, and at 1024² on an H100 a batch of one azimuth
/// took 0.31 ms, one of 23 took 0.39. An azimuth of 512 lanes has 16 to 32 layers of lines.
#[test]
fn batches_along_an_axis_are_of_equal_size() {
    let scene = under_sky(flat(512, 512));
    let sizes = |azimuths: u32, image_layers: u32| {
        let limits = Limits { image_layers, ..Limits::lavapipe() };
        let quality = Quality { azimuths, ..Quality::default() };
        let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
        let shaded = plan.passes.iter().filter(|p| p.name() == "sky_shade");
        shaded.map(|p| p.azimuths.len()).collect::<Vec<_>>()
    };
    // 16 along each axis.
    assert_eq!(sizes(32, 2048), [16, 16]);
    for image_layers in 64..400 {
        let found = sizes(32, image_layers);
        assert_eq!(found.iter().sum::<usize>(), 32, "{found:?}");
        // No more batches than the layers of all azimuths need, if each batch lacks less than one more azimuth.
        assert!(found.len() as u32 <= 2 * (16 * 32_u32).div_ceil(image_layers - 31), "{found:?}");
    }
    assert_eq!(sizes(32, 300), [8, 8, 8, 8]);
    assert_eq!(sizes(36, 200), [6; 6]);
}

/// n² numbers a texel, four a GPU texel, beside 3 rows of the light's matrix (9 of a lobe, 4 at order 2); the
/// sky stays in closed form, and edits recompute everything.
#[test]
fn harmonics() {
    let scene = under_everything(flat(7, 13), Border::Plane);
    let limits = Limits::lavapipe();
    for (receiver, rows) in [(Receiver::Plane, [3; 5]), (Receiver::Cosine, [4, 9, 9, 9, 9])] {
        for (sh_order, rows) in (2..=6).zip(rows) {
            let quality = Quality { basis: Basis::Sh, sh_order, receiver, ..Quality::default() };
            let wanted = Picture { keeps_horizons: true, ..Picture::default() };
            let plan = plan::picture(&scene, &quality, &limits, wanted).expect("a plan");
            let bytes = |name: &str| plan.resources[plan.find(name).expect(name).0].bytes();
            let count = u64::from(sh_order * sh_order);
            assert_eq!(bytes("visibility"), 7 * 13 * 16 * count.div_ceil(4));
            assert_eq!(bytes("light_matrix"), 16 * rows * count);
            assert_eq!(bytes("constants"), 4 * plan.constants.len() as u64);
            assert!(plan.find("env_tables").is_none() && plan.find("sky_sum").is_some());
            assert!(plan.edit_passes.is_empty() && missing_barriers(&plan.passes).is_empty());
            let setting =
                |name: &str| plan.settings.iter().find(|s| s.0 == name).map(|s| s.1.as_str());
            assert_eq!(setting("sh_order"), Some(sh_order.to_string().as_str()));
            assert_eq!((setting("basis"), setting("table_elevations")), (Some("sh"), None));
        }
    }
    let tables = plan::picture(&scene, &Quality::default(), &limits, Picture::default());
    assert!(tables.expect("a plan").constants.is_empty());
}

fn key(high: f64, radiance: [f32; 3]) -> KeyLight {
    KeyLight { azimuth_rad: 0.3, width_rad: 0.5, elevations_rad: [-0.4, high], radiance }
}

/// Key lights add what suns do: sweeps of their own azimuths, a shading pass, a layer. Black key lights, and
/// those below horizontal where there is ground, add nothing.
#[test]
fn key_lights() {
    let picture = |keys: &[KeyLight], border| {
        let mut scene = under_sky(flat(9, 14));
        scene.surface.border = border;
        scene.lights.keys = keys.to_vec();
        let wanted = Picture { light_layers: true, ..Picture::default() };
        let quality = Quality { azimuths: 8, ..Quality::default() };
        plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).expect("a plan")
    };
    let labels = |plan: &Plan| plan.passes.iter().map(plan::Pass::label).collect::<Vec<_>>();
    let none = picture(&[], Border::Plane);
    assert!(!short(&none).contains("sun") && !short(&none).contains("key"), "{}", short(&none));
    assert!(none.settings.iter().all(|(name, _)| name != "sun_azimuths"));
    let dropped = [key(0.5, [0.0; 3]), key(-0.1, [1.0; 3])];
    let dark = picture(&dropped, Border::Plane);
    assert_eq!(short(&dark), short(&none));
    for note in ["key 1 dropped: its radiance is 0", "key 2 dropped: all of it is below horizontal"]
    {
        assert!(dark.notes.iter().any(|n| n == note), "{:?}", dark.notes);
    }
    let lit = picture(&dropped, Border::Open);
    // 28.6° wide: 8 × 28.6 / 25 = 9 slices.
    assert_eq!(lit.azimuths.len(), 8 + 9);
    let wide = "key 2: 9 slices for its width of 28.6°; 8 are for 25°";
    assert!(lit.notes.iter().any(|n| n == wide), "{:?}", lit.notes);
    // 11.5° wide: half of 8.
    let few = picture(&[KeyLight { width_rad: 0.2, ..key(0.5, [1.0; 3]) }], Border::Open);
    assert_eq!(few.azimuths.len(), 8 + 4);
    let narrow = "key 1: 4 slices for its width of 11.5°; 8 are for 25°";
    assert!(few.notes.iter().any(|n| n == narrow), "{:?}", few.notes);
    let visible: Vec<_> = labels(&lit).into_iter().filter(|l| l.contains("key")).collect();
    assert_eq!(visible, ["horizon_sweep key2", "sun_shade key2", "light_resolve key2"]);
    let outputs: Vec<&str> = lit.outputs().map(|(_, r)| r.name.as_str()).collect();
    assert_eq!(outputs, ["radiance", "direct.sky", "direct.key2"]);
    assert!(lit.settings.contains(&("sun_azimuths".into(), "8".into())));
    assert_eq!(missing_barriers(&lit.passes), []);
    // Another colour resolves again, by its share of the picture, and sweeps nothing.
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let kept = |radiance| {
        let mut scene = under_sky(flat(9, 14));
        scene.lights.keys = vec![key(0.5, radiance)];
        let limits = Limits::lavapipe();
        plan::picture(&scene, &Quality::default(), &limits, wanted).expect("a plan")
    };
    let after = kept([2.0; 3]);
    let again = after.passes_after(&kept([1.0; 3]), &[]);
    assert!(again.iter().all(|p| after.passes[*p].name() == "light_resolve") && !again.is_empty());
}

/// Edits continue from occluders; a sweep whose fuse reads slopes stores none.
#[test]
fn fuses_that_store_occluders_take_edits() {
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let edits = |fuse| {
        let quality = Quality { azimuths: 8, fuse, ..Quality::default() };
        let plan = plan::picture(&under_sky(flat(9, 14)), &quality, &Limits::lavapipe(), wanted);
        plan.expect("a plan").edit_passes.len()
    };
    assert!(edits(Fuse::Aimed) > 0 && edits(Fuse::AimedAround) > 0);
    assert_eq!(edits(Fuse::Slopes), 0);
}

/// Sky, key lights and horizons use the quality's fuse. An edit grows by as many grid points as that fuse reads.
#[test]
fn all_sweeps_have_one_fuse() {
    let key = KeyLight {
        azimuth_rad: 1.0,
        width_rad: 0.1,
        elevations_rad: [0.2, 0.6],
        radiance: [1.0; 3],
    };
    let mut scene = under_sky(flat(9, 14));
    scene.lights.keys.push(key);
    let (limits, wanted) = (Limits::lavapipe(), Picture::default());
    let fuses = |quality: &Quality| {
        let lit = plan::picture(&scene, quality, &limits, wanted).expect("a plan");
        let found = plan::horizons(&scene.field, Border::Plane, quality, &limits, (0, 4), false);
        let all = [lit.passes, found.expect("a plan").passes].concat();
        ["sky_shade", "sun_shade", "sweep_fuse"].map(|name| {
            let pass = all.iter().find(|pass| pass.name() == name).expect("planned");
            pass.constant("fuse").expect("a fuse")
        })
    };
    let base = Quality { azimuths: 8, ..Quality::default() };
    let of = |fuse: Fuse| 1 + fuse as u32;
    assert_eq!(fuses(&base), [of(Fuse::AimedAround); 3]);
    assert_eq!(fuses(&Quality { method: Method::Sweep, ..base }), [of(Fuse::AimedAround); 3]);
    assert_eq!(fuses(&Quality { fuse: Fuse::Aimed, ..base }), [of(Fuse::Aimed); 3]);

    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let margins = |fuse| {
        let quality = Quality { fuse, ..base };
        let edited = plan::picture(&scene, &quality, &limits, wanted).expect("a plan");
        let margin = |pass: &Pass| match pass.reach {
            Some(Reach::Lines { margin, .. }) => Some(margin),
            _ => None,
        };
        edited.edit_passes.iter().filter_map(margin).collect::<HashSet<_>>()
    };
    assert_eq!(margins(Fuse::AimedAround), HashSet::from([2]));
    assert_eq!(margins(Fuse::Aimed), HashSet::from([0]));
}

/// Shading has a loop for the azimuths that follow the diagonals of the cells and one for the others: of each batch the first ones, and
/// as many as it is given. Some batches hold both.
#[test]
fn batches_begin_with_azimuths_that_follow_the_diagonals() {
    const FIRST_AZIMUTH: usize = offset("ShadePush", "first_azimuth");
    const AZIMUTH_COUNT: usize = offset("ShadePush", "azimuth_count");
    const ALONG_COUNT: usize = offset("ShadePush", "along_count");
    let scene = under_everything(flat(70, 90), Border::Plane);
    let follows = |flags: u32| (flags & FLIPS_MARCH != 0) == (flags & FLIPS_LANES != 0);
    let mut mixed = 0;
    for azimuths in [4, 7, 64, 101] {
        let quality = Quality { azimuths, ..Quality::default() };
        let plan = plan::picture(&scene, &quality, &Limits::lavapipe(), Picture::default());
        let plan = plan.expect("a plan");
        let shaded = plan.passes.iter().filter(|p| ["sky_shade", "sun_shade"].contains(&p.name()));
        for pass in shaded {
            let [first, count, along] = [FIRST_AZIMUTH, AZIMUTH_COUNT, ALONG_COUNT].map(|at| {
                u32::from_le_bytes(pass.push[at..at + 4].try_into().expect("four bytes")) as usize
            });
            let found: Vec<bool> =
                plan.azimuths[first..first + count].iter().map(|a| follows(a.flags)).collect();
            let want: Vec<bool> = (0..count).map(|k| k < along).collect();
            assert_eq!(found, want, "{azimuths} {}", pass.label());
            mixed += usize::from(along > 0 && along < count);
        }
    }
    assert!(mixed >= 4, "{mixed}");
}

/// One pass a bounce, after the arriving light is resolved; exit radiance in one image used in turn, or in a
/// layer each. Bounces below the cutoff are left out with a note.
#[test]
fn bounces() {
    let drawn = |count, albedo: f32, cutoff, light_layers| {
        let mut scene = under_sky(flat(9, 14));
        scene.surface.albedo = Albedo::Constant([albedo; 3]);
        let engine = BounceEngine::BruteForce;
        let bounces = Bounces { count, cutoff, engine, ..Bounces::default() };
        let quality = Quality { azimuths: 8, bounces, ..Quality::default() };
        let wanted = Picture { light_layers, keeps_horizons: true, ..Picture::default() };
        plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).expect("a plan")
    };
    let labels = |plan: &Plan| -> Vec<String> {
        let all = plan.passes.iter().map(plan::Pass::label);
        all.filter(|l| l.contains("bounce")).collect()
    };
    let none = drawn(0, 0.8, 0.0, true);
    assert!(labels(&none).is_empty() && none.find("ground").is_none());
    assert!(!none.edit_passes.is_empty());
    let [one, three] = [1, 3].map(|count| drawn(count, 0.8, 0.0, false));
    assert_eq!(labels(&one), ["bounce_march bounce1", "light_resolve bounce1"]);
    assert_eq!(labels(&three).len(), 6);
    assert!(one.find("exit_radiance").is_none() && one.edit_passes.is_empty());
    assert_eq!(three.bytes() - one.bytes(), 4 * 9 * 14);
    assert_eq!((missing_barriers(&one.passes), missing_barriers(&three.passes)), (vec![], vec![]));
    // The pass before a bounce has written its light.
    assert!(three.passes.iter().filter(|p| p.name() == "bounce_march").all(|p| p.barrier_before));
    let layers = drawn(2, 0.8, 0.0, true);
    let outputs: Vec<&str> = layers.outputs().map(|(_, r)| r.name.as_str()).collect();
    assert_eq!(outputs, ["radiance", "direct.sky", "indirect.1", "indirect.2"]);
    let setting =
        |plan: &Plan| plan.settings.iter().find(|s| s.0 == "bounces").map(|s| s.1.clone());
    let black = drawn(3, 0.0, 0.0, true);
    assert_eq!((short(&black), setting(&black)), (short(&none), Some("0".to_owned())));
    assert!(black.notes.iter().any(|n| n.starts_with("no bounces")), "{:?}", black.notes);
    // 2⁻⁵ + … + 2⁻⁹ is below 1/16.
    let short = drawn(9, 0.5, 1.0 / 16.0, false);
    assert_eq!(setting(&short), Some("4".to_owned()));
    let note = "bounces 5 to 9 dropped: of a surface that reflects at most 0.5 they carry at most 6.055e-2";
    assert!(short.notes.iter().any(|n| n.starts_with(note)), "{:?}", short.notes);
}

/// Without shadows no horizon is swept and nothing bounces: whatever the method, only each texel's own ground
/// counts, and the picture has the same images.
#[test]
fn without_shadows_nothing_is_swept() {
    let ridges: Vec<f64> = (0..9 * 14).map(|i| f64::from(i % 5)).collect();
    let field = HeightField::new(9, 14, &ridges, [1.0, 1.0], None).expect("a good field");
    let scene = under_everything(field, Border::Plane);
    let bounces = Bounces { count: 2, ..Bounces::default() };
    for method in [Method::Sweep, Method::Pyramid, Method::BruteForce] {
        let quality = Quality { method, azimuths: 8, bounces, ..Quality::default() };
        let drawn = |unshadowed| {
            let wanted = Picture { unshadowed, ..Picture::default() };
            plan::picture(&scene, &quality, &Limits::lavapipe(), wanted).expect("a plan")
        };
        let [usual, off] = [false, true].map(drawn);
        let outputs = |plan: &Plan| plan.outputs().map(|(_, r)| r.clone()).collect::<Vec<_>>();
        assert_eq!(outputs(&usual), outputs(&off));
        let visible = ["horizon_sweep", "horizon_march", "pyramid_march", "bounce"];
        let sweeps = |plan: &Plan| {
            let names = plan.passes.iter().map(plan::Pass::name);
            names.filter(|name| visible.iter().any(|s| name.starts_with(s))).count()
        };
        assert!(sweeps(&usual) > 0 && sweeps(&off) == 0, "{method:?}: {:?}", short(&off));
        assert!(missing_barriers(&off.passes).is_empty());
    }
}

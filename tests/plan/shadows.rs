//! Which suns and key lights are lit by shadow heights, and which by hull sweeps.

use ridgelight::plan::{self, Limits, Pass, Picture, Plan, missing_barriers};
use ridgelight::scene::{
    Border, Fuse, KeyLight, Lights, Lines, Method, Precision, Quality, Scene, Sun, Surface,
};

use crate::flat;
use ridgelight::gpu::shaders::offset;

/// A sun, a key light of five degrees of elevation and a taller one.
fn scene(side: usize) -> Scene {
    let sun =
        Sun { azimuth_rad: 2.0, elevation_rad: 0.5, diameter_rad: 0.02, irradiance: [1.0; 3] };
    let key = |degrees: f64| KeyLight {
        azimuth_rad: 4.0,
        width_rad: 0.4,
        elevations_rad: [0.2, 0.2 + degrees.to_radians()],
        radiance: [2.0; 3],
    };
    let lights = Lights { suns: vec![sun], keys: vec![key(5.1), key(4.9)], ..Lights::default() };
    Scene { field: flat(side, side), surface: Surface::default(), lights }
}

/// What sweeps for each light.
fn sweeps(plan: &Plan) -> Vec<String> {
    assert_eq!(missing_barriers(&plan.passes), []);
    let swept = plan.passes.iter().filter(|p| p.name().ends_with("_sweep"));
    let mut labels: Vec<String> =
        swept.map(|p| format!("{} {}", p.name(), p.part.split(' ').next().unwrap())).collect();
    labels.dedup();
    labels
}

fn picture(scene: &Scene, quality: &Quality, limits: &Limits) -> Plan {
    plan::picture(scene, quality, limits, Picture::default()).expect("a plan")
}

#[test]
fn suns_and_narrow_keys_have_shadow_heights() {
    let (scene, limits) = (scene(40), Limits::lavapipe());
    let by_default = ["shadow_sweep sun1", "horizon_sweep key1", "shadow_sweep key2"];
    assert_eq!(sweeps(&picture(&scene, &Quality::default(), &limits)), by_default);
    let hulls = ["horizon_sweep sun1", "horizon_sweep key1", "horizon_sweep key2"];
    let quality = Quality::default();
    for other in [
        Quality { method: Method::Sweep, ..quality },
        Quality { lines: Lines::HalfCell, ..quality },
        Quality { precision: Precision::Packed, ..quality },
    ] {
        let plan = picture(&scene, &other, &limits);
        assert_eq!(sweeps(&plan), hulls, "{other:?}");
        // `method sweep` gives no note.
        let is_said = plan.notes.iter().any(|n| n.contains("by hull sweeps"));
        assert_eq!(is_said, other.method == Method::Auto, "{:?}", plan.notes);
    }
    let other = Quality { fuse: Fuse::Aimed, ..quality };
    assert_eq!(sweeps(&picture(&scene, &other, &limits)), by_default);
}

/// A field one grid point wide has no cells to walk over, unless it repeats: a line of suns is swept by hulls.
#[test]
fn a_line_of_ground_is_swept_by_hulls() {
    let scene = Scene { field: flat(1, 40), ..scene(40) };
    for border in [Border::Plane, Border::Open] {
        let scene = Scene { surface: Surface { border, ..Surface::default() }, ..scene.clone() };
        let plan = picture(&scene, &Quality::default(), &Limits::lavapipe());
        assert!(sweeps(&plan).iter().all(|s| s.starts_with("horizon_sweep")));
    }
}

/// The heights decide how many texels `shadow_settle` walks from, and how far. Every other pass counts its traffic.
#[test]
fn traffic_that_depends_on_the_heights_is_not_counted() {
    let plan = picture(&scene(40), &Quality::default(), &Limits::lavapipe());
    let is_uncounted = |p: &Pass| p.name() == "shadow_settle";
    assert!(plan.passes.iter().any(is_uncounted));
    for pass in &plan.passes {
        assert_eq!(pass.bytes == 0, is_uncounted(pass), "{}", pass.label());
        assert!(!is_uncounted(pass) || pass.texels == 0, "{}", pass.label());
    }
    let printed = plan.to_string();
    let mut rows = printed.lines().filter(|line| line.contains("shadow_settle "));
    assert!(rows.all(|row| row.contains("  -  ")), "{printed}");
}

/// Where half of the memory does not hold what they need, the plan states it in a note and fits.
#[test]
fn short_memory_takes_hull_sweeps_with_a_note() {
    let scene = scene(256);
    let limits = |bytes: u64| Limits { memory_budget: 256 * 256 * bytes, ..Limits::lavapipe() };
    let (short, enough) = (limits(40), limits(80));
    let plan = picture(&scene, &Quality::default(), &short);
    assert!(sweeps(&plan).iter().all(|s| s.starts_with("horizon_sweep")));
    let is_said = |n: &String| n.starts_with("suns and key lights by hull sweeps: ");
    assert!(plan.notes.iter().any(is_said), "{:?}", plan.notes);
    let plan = picture(&scene, &Quality::default(), &enough);
    assert!(sweeps(&plan).iter().any(|s| s.starts_with("shadow_sweep")));
    assert!(!plan.notes.iter().any(is_said), "{:?}", plan.notes);
    let bytes: u64 = plan.resources.iter().map(plan::Resource::bytes).sum();
    assert!(bytes <= enough.memory_budget, "{bytes}");
}

/// A storage buffer may be too small for a field's heights, from which one line per invocation reads.
#[test]
fn a_large_field_on_a_gpu_of_small_buffers_has_shadows_by_four_lines() {
    let limits = crate::on_gpu(Limits { memory_budget: 16 << 30, ..Limits::lavapipe() });
    let one_line = |side| {
        let plan = picture(&scene(side), &Quality::default(), &limits);
        plan.passes.iter().find_map(|p| p.constant("written_words")).map(|words| words > 1)
    };
    assert_eq!([one_line(4000), one_line(6000)], [Some(true), Some(false)]);
}

/// Small fields get more segments per line and fewer texels per workgroup of `shadow_settle` on a GPU. The size of a workgroup and half of its shared
/// memory limit the segments, as do the slices of a light. The sun's azimuth does not count, so a sun that moves keeps its pipelines.
#[test]
fn small_fields_have_more_segments_and_smaller_tiles_on_a_gpu() {
    let base = crate::on_gpu(Limits { memory_budget: 16 << 30, ..Limits::lavapipe() });
    let whole = Limits { shared_bytes: 48 << 10, buffer_bytes: 1 << 30, ..base };
    let scenes = [256, 1024, 4096].map(|side| {
        let mut scene = scene(side);
        scene.lights.keys.clear();
        scene
    });
    let of = |side: usize, azimuth_rad: f64, sun_azimuths: u32, limits: &Limits| {
        let mut scene = scenes.iter().find(|s| s.field.cols() == side).expect("made").clone();
        scene.lights.suns[0].azimuth_rad = azimuth_rad;
        let quality = Quality { sun_azimuths, ..Quality::default() };
        let plan = picture(&scene, &quality, limits);
        let constants = |pass: &str, name: &str| {
            let mut found: Vec<_> =
                plan.passes.iter().filter(|p| p.name() == pass).map(|p| p.constant(name)).collect();
            found.dedup();
            assert_eq!(found.len(), 1, "{pass} {found:?}");
            found[0].expect("a constant")
        };
        let shadows = plan::shadow_heights(&scene.field, &scene.lights.suns[0], None, 1, limits);
        let shadows = shadows.expect("a plan").passes;
        [
            constants("shadow_sweep", "local_size_y"),
            constants("shadow_settle", "tile_fours"),
            shadows[0].constant("local_size_y").expect("a constant"),
        ]
    };
    for degrees in [3.0_f64, 45.0, 100.0, 200.0] {
        assert_eq!(of(1024, degrees.to_radians(), 64, &whole), [1, 2, 8]);
        let of = |side, limits: &Limits| of(side, degrees.to_radians(), 8, limits);
        assert_eq!(of(256, &whole), [16, 1, 8]);
        assert_eq!(of(1024, &whole), [16, 2, 8]);
        assert_eq!(of(4096, &whole), [1, 8, 8]);
        assert_eq!(of(256, &Limits { shared_bytes: 16 << 10, ..whole }), [4, 1, 2]);
        assert_eq!(of(256, &Limits { group_invocations: 128, ..whole }), [4, 1, 2]);
        assert_eq!(of(256, &Limits::lavapipe()), [1, 8, 1]);
    }
}

/// A key light alone has segments for its own slices, not for `sun_azimuths`: half of them up to 12.5° wide.
#[test]
fn narrow_keys_have_segments_for_their_slices() {
    let base = crate::on_gpu(Limits { memory_budget: 16 << 30, ..Limits::lavapipe() });
    let limits = Limits { shared_bytes: 48 << 10, buffer_bytes: 1 << 30, ..base };
    let segments = |degrees: f64, sun_azimuths: u32| {
        let mut scene = scene(1024);
        scene.lights.suns.clear();
        scene.lights.keys.remove(0);
        scene.lights.keys[0].width_rad = degrees.to_radians();
        let plan = picture(&scene, &Quality { sun_azimuths, ..Quality::default() }, &limits);
        let pass = plan.passes.iter().find(|p| p.name() == "shadow_sweep").expect("a sweep");
        pass.constant("local_size_y").expect("a constant")
    };
    assert_eq!(segments(12.0, 32), segments(25.0, 16));
    // Twice as many slices have fewer segments.
    assert!(segments(25.0, 32) < segments(25.0, 16));
}

/// Lattices along both axes share the memory by what all azimuths along each need: none is cut for want of it.
#[test]
fn suns_have_one_batch_an_axis_on_a_gpu() {
    let sun = |azimuth_rad, diameter_rad| Sun {
        azimuth_rad,
        elevation_rad: 0.5,
        diameter_rad,
        irradiance: [1.0; 3],
    };
    // A disc along one axis, and a point along the other.
    let suns = vec![sun(0.1, 0.02), sun(1.5, 0.0)];
    let lights = Lights { sky: Some([1.0; 3]), suns, ..Lights::default() };
    let scene = Scene { field: flat(256, 256), surface: Surface::default(), lights };
    let plan = picture(&scene, &Quality::default(), &crate::on_gpu(Limits::lavapipe()));
    let sweeps = plan.passes.iter().filter(|p| p.name() == "shadow_sweep");
    assert_eq!(sweeps.map(|p| p.azimuths.len()).collect::<Vec<_>>(), [8, 1]);
}

/// In a GPU plan the first sweeps of the sky and both sweeps of the first sun have no barrier between them. In a CPU plan each batch
/// is shaded right after its sweep, while its lattice is cached.
#[test]
fn sweeps_run_side_by_side_on_a_gpu() {
    let sun = |azimuth_rad| Sun {
        azimuth_rad,
        elevation_rad: 0.5,
        diameter_rad: 0.02,
        irradiance: [1.0; 3],
    };
    // Each sun's azimuths straddle a diagonal, so each needs both axes.
    let suns = vec![sun(0.75 * std::f64::consts::PI), sun(0.25 * std::f64::consts::PI)];
    let lights = Lights { sky: Some([1.0; 3]), suns, ..Lights::default() };
    let scene = Scene { field: flat(256, 256), surface: Surface::default(), lights };
    // For each pass, the barriers before it, and its label.
    let staged = |limits: &Limits| -> Vec<(usize, String)> {
        let plan = picture(&scene, &Quality::default(), limits);
        assert_eq!(missing_barriers(&plan.passes), []);
        let mut barriers = 0;
        let stage = |p: &Pass| {
            barriers += usize::from(p.barrier_before);
            (barriers, p.label())
        };
        plan.passes.iter().map(stage).collect()
    };
    let beside = |staged: &[(usize, String)], name: &str| {
        let of_name = staged.iter().filter(|(_, label)| label.starts_with(name));
        of_name.map(|(barriers, _)| *barriers).collect::<Vec<_>>()
    };
    let gpu = staged(&crate::on_gpu(Limits::lavapipe()));
    assert_eq!(beside(&gpu, "horizon_sweep sky 0"), [1, 2], "{gpu:?}");
    assert_eq!(beside(&gpu, "shadow_sweep sun1"), [1, 1]);
    let lavapipe = staged(&Limits::lavapipe());
    let first = beside(&lavapipe, "shadow_sweep sun1");
    assert!(first[0] < first[1], "{lavapipe:?}");
    assert_eq!(gpu.len(), lavapipe.len());
    assert!(gpu.last().unwrap().0 < lavapipe.last().unwrap().0);
}

#[test]
fn shadow_heights_have_a_pass_for_each_part() {
    let sun = |azimuth_rad, elevation_rad, diameter_rad| Sun {
        azimuth_rad,
        elevation_rad,
        diameter_rad,
        irradiance: [1.0; 3],
    };
    let (inner, outer) = (flat(100, 70), flat(120, 120));
    let plan = |sun, place| {
        let outer = Some((&outer, place));
        plan::shadow_heights(&inner, &sun, outer, 2, &Limits::lavapipe()).expect("a plan")
    };
    let first = plan(sun(0.3, 0.5, 0.01), [0.0, 0.0]);
    assert_eq!(first.passes.len(), 2);
    assert_eq!(missing_barriers(&first.passes), []);
    let names =
        |plan: &Plan| plan.inputs().chain(plan.outputs()).map(|(_, r)| r.name.clone()).collect();
    let all: Vec<String> = names(&first);
    assert_eq!(
        all,
        ["heights", "outer_lit_above", "outer_penumbra", "lit_above", "penumbra", "sun_share"]
    );
    for (other, place) in [
        (sun(2.0, 0.1, 0.0), [0.0, 0.0]),
        (sun(-1.0, 1.5, 0.2), [50.0, 19.5]),
        (sun(4.0, 0.0, 0.1), [3.0, 0.0]),
    ] {
        let of = plan(other, place);
        assert_eq!(of.passes_after(&first, &[]), [0, 1], "{other:?}");
        // Each group of lines is in one part.
        let first = |pass: &Pass| {
            const AT: usize = offset("ShadowHeightPush", "first_group");
            u32::from_ne_bytes(pass.push[AT..AT + 4].try_into().expect("a number"))
        };
        let mut next = 0;
        for pass in &of.passes {
            assert!(pass.groups[0] > 0 && first(pass) == next, "{other:?}");
            next += pass.groups[0];
        }
        assert!(next * 63 >= 70, "{next} groups");
    }
}

#[test]
fn shadow_heights_reject_invalid_arguments() {
    let good =
        Sun { azimuth_rad: 1.0, elevation_rad: 0.5, diameter_rad: 0.0, irradiance: [1.0; 3] };
    let (field, outer) = (flat(64, 200), flat(64, 200));
    let error = |sun: Sun, place, parts| {
        let outer = Some((&outer, place));
        let plan = plan::shadow_heights(&field, &sun, outer, parts, &Limits::lavapipe());
        plan.expect_err("refused").to_string()
    };
    for (place, parts, words) in [
        ([0.0, 0.0], 0, "1 to 2"),
        ([0.0, 0.0], 3, "1 to 2"),
        ([0.5, 0.0], 1, "contains this one"),
        ([0.0, -0.5], 1, "contains this one"),
        ([f64::NAN, 0.0], 1, "contains this one"),
    ] {
        let found = error(good, place, parts);
        assert!(found.contains(words), "{found}");
    }
    let beyond = error(Sun { elevation_rad: 2.0, ..good }, [0.0, 0.0], 1);
    assert!(beyond.contains("elevation"), "{beyond}");
    let same =
        plan::shadow_heights(&field, &good, Some((&outer, [0.0, 0.0])), 1, &Limits::lavapipe());
    assert!(same.is_ok());
}

//! Tables of an environment and of a Phong lobe are computed once for many frames of new heights, and again after a change of what
//! they depend on. The pictures have the bits of new renderers.

use std::cell::RefCell;

use ridgelight::gpu::{Frame, Headless, Renderer};
use ridgelight::plan::{self, Picture, Plan, Rectangle};
use ridgelight::scene::{
    Albedo, Basis, Border, Bounces, Lights, PhongSpecular, Quality, Scene, Specular, Sun, fractal,
};

use crate::cpu_reference::noisy_environment;
use crate::{Device, bits, under_sky};

const SIDE: usize = 24;

/// The passes that depend on neither heights nor suns.
const TABLES: [&str; 7] = [
    "env_tables",
    "env_wedges",
    "env_wedges fine",
    "mirror_map swept",
    "mirror_map unoccluded",
    "specular_tables",
    "specular_tables fine",
];

fn scene(exponent: f32) -> Scene {
    let sun = Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.3,
        diameter_rad: 0.02,
        irradiance: [1.0, 0.9, 0.8],
    };
    let environment = Some(noisy_environment(3));
    let mut scene = under_sky(fractal(SIDE, 1).expect("a field"), Border::Plane);
    scene.surface.albedo = Albedo::Constant([0.5; 3]);
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.5 }));
    scene.lights = Lights { environment, suns: vec![sun], ..Lights::default() };
    scene
}

fn planned(gpu: &Headless, scene: &Scene) -> Plan {
    planned_with(gpu, scene, 0)
}

fn planned_with(gpu: &Headless, scene: &Scene, count: u32) -> Plan {
    let bounces = Bounces { count, ..Bounces::default() };
    let quality = Quality { azimuths: 12, table_elevations: 32, bounces, ..Quality::default() };
    let wanted = Picture { keeps_horizons: true, light_layers: true, ..Picture::default() };
    plan::picture(scene, &quality, &crate::limits_of(gpu), wanted).expect("a plan")
}

/// Texels of the inputs, with the heights of another field.
fn contents(scene: &Scene, seed: u64) -> Vec<Vec<f32>> {
    let mut all = plan::picture_inputs(scene);
    all[0] = fractal(SIDE, seed).expect("a field").heights_m().to_vec();
    all
}

/// The outputs of all passes of a new renderer.
fn from_nothing(gpu: &mut Headless, plan: &Plan, contents: &[Vec<f32>]) -> Vec<u32> {
    let mut frame = gpu.frame(plan.clone(), contents).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let all = bits(gpu, &frame);
    gpu.end(frame);
    all
}

/// The labels of all other passes, sorted.
fn left_out(plan: &Plan, passes: &[usize]) -> Vec<String> {
    let others = (0..plan.passes.len()).filter(|pass| !passes.contains(pass));
    let mut labels: Vec<String> = others.map(|pass| plan.passes[pass].label()).collect();
    labels.sort_unstable();
    labels
}

/// Gives a drawn frame other texels of the environment, by the azimuths of the old one. The picture has the bits of a new renderer,
/// and no horizon is swept again. Returns the labels of the passes that were left out.
fn relit(
    gpu: &mut Headless,
    frame: &mut Frame,
    plan: &Plan,
    (scene, contents): (&Scene, &mut [Vec<f32>]),
) -> Vec<String> {
    let environment = plan.find("environment").expect("an input");
    let first = bits(gpu, frame);
    let mut other = scene.clone();
    other.lights.environment = Some(noisy_environment(4));
    contents[1] = plan::picture_inputs(&other).swap_remove(1);
    gpu.refill(frame, 1, &contents[1]).expect("refilled");
    let passes = frame.renderer().passes_after(&[environment]);
    let kept = left_out(plan, &passes);
    assert!(kept.iter().any(|label| label.starts_with("horizon_sweep")), "{kept:?}");
    gpu.draw_passes(frame, &passes).expect("drawn");
    let lit = bits(gpu, frame);
    assert!(lit != first && lit == from_nothing(gpu, plan, contents));
    kept
}

#[test]
fn only_the_first_frame_of_new_heights_computes_tables() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let scene = scene(5.0);
    let plan = planned(gpu, &scene);
    let heights = plan.find("heights").expect("an input");
    let mut frame = gpu.frame(plan.clone(), &contents(&scene, 1)).expect("a frame");
    let mut last = Vec::new();
    for seed in 1..4 {
        let contents = contents(&scene, seed);
        gpu.refill(&frame, 0, &contents[0]).expect("refilled");
        let passes = frame.renderer().passes_after(&[heights]);
        let expected = if seed == 1 { &[][..] } else { &TABLES[..] };
        assert_eq!(left_out(&plan, &passes), expected, "{seed}");
        let times = gpu.draw_passes(&mut frame, &passes).expect("drawn");
        if gpu.report().timestamp_period_ns > 0.0 {
            assert_eq!(times.len(), plan.passes.len() - expected.len(), "{seed}");
        }
        let found = bits(gpu, &frame);
        assert!(found != last, "{seed}: the heights of the frame before");
        assert!(found == from_nothing(gpu, &plan, &contents), "{seed}");
        last = found;
    }
    assert_eq!(frame.renderer().passes_after(&[]), [0_usize; 0]);
    // The same heights again.
    let passes = frame.renderer().passes_after(&[heights]);
    gpu.draw_passes(&mut frame, &passes).expect("drawn");
    assert!(bits(gpu, &frame) == last);
    gpu.end(frame);
}

/// Two frames in one submission: the second reads the tables that the first computes.
#[test]
fn frames_in_flight_share_tables() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let scene = scene(5.0);
    let plan = planned(gpu, &scene);
    let heights = plan.find("heights").expect("an input");
    let contents = [1, 2].map(|seed| contents(&scene, seed));
    let alone = contents.each_ref().map(|contents| from_nothing(gpu, &plan, contents));
    assert!(alone[0] != alone[1]);
    let frames =
        contents.each_ref().map(|contents| gpu.frame(plan.clone(), contents).expect("a frame"));
    let mut renderer = Renderer::new(gpu.host(), plan.clone(), 2).expect("a renderer");
    for round in 0..2 {
        let shared = RefCell::new(&mut renderer);
        let records = [0, 1].map(|slot| {
            let (inputs, outputs) = (frames[slot].inputs(), frames[slot].outputs());
            let shared = &shared;
            move |commands| {
                let mut renderer = shared.borrow_mut();
                let passes = renderer.passes_after(&[heights]);
                renderer.record_passes(commands, slot, &inputs, &outputs, &passes)
            }
        });
        gpu.run_all(records).expect("recorded and run");
        for (slot, (frame, alone)) in frames.iter().zip(&alone).enumerate() {
            assert!(bits(gpu, frame) == *alone, "{round} {slot}");
            if gpu.report().timestamp_period_ns > 0.0 {
                let kept = if round + slot == 0 { 0 } else { TABLES.len() };
                let count = renderer.timings(slot).map(|times| times.len());
                assert_eq!(count, Some(plan.passes.len() - kept), "{round} {slot}");
            }
        }
    }
    renderer.destroy();
    frames.into_iter().for_each(|frame| gpu.end(frame));
}

/// After each change, what depends on it is recomputed. The next frame of new heights computes no tables.
#[test]
fn tables_follow_the_environment_and_the_exponent() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = scene(5.0);
    let plan = planned(gpu, &scene);
    let heights = plan.find("heights").expect("an input");
    let mut contents = contents(&scene, 1);
    let mut frame = gpu.frame(plan.clone(), &contents).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let kept = relit(gpu, &mut frame, &plan, (&scene, &mut contents));
    assert!(!TABLES.iter().any(|table| kept.iter().any(|label| label == table)), "{kept:?}");

    // Another exponent with tables of the same size, and new heights in the same frame.
    scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent: 6.0, scale: 0.5 }));
    let plan = planned(gpu, &scene);
    let due = gpu.replace_plan(&mut frame, plan.clone()).expect("the same passes");
    let kept = left_out(&plan, &due);
    let is_specular = |table: &&str| !table.starts_with("env_");
    assert!(TABLES.iter().all(|table| kept.iter().any(|k| k == table) != is_specular(table)));
    contents[0] = fractal(SIDE, 2).expect("a field").heights_m().to_vec();
    gpu.refill(&frame, 0, &contents[0]).expect("refilled");
    let passes = frame.renderer().passes_after(&[heights]);
    assert!(due.iter().all(|pass| passes.contains(pass)), "{due:?} in {passes:?}");
    gpu.draw_passes(&mut frame, &passes).expect("drawn");
    assert!(bits(gpu, &frame) == from_nothing(gpu, &plan, &contents));
    assert_eq!(left_out(&plan, &frame.renderer().passes_after(&[heights])), TABLES);

    // Narrower lobes have larger tables: the renderer keeps its plan.
    scene.surface.specular =
        Some(Specular::Constant(PhongSpecular { exponent: 1000.0, scale: 0.5 }));
    let narrow = planned(gpu, &scene);
    gpu.replace_plan(&mut frame, narrow).expect_err("larger tables");
    assert_eq!(left_out(&plan, &frame.renderer().passes_after(&[heights])), TABLES);
    gpu.end(frame);
}

/// With bounces, tables reflect direct light, and harmonics light that bounces. Another environment changes both and needs no sweep.
#[test]
fn bounced_specular_follows_the_environment() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let scene = scene(5.0);
    let plan = planned_with(gpu, &scene, 1);
    let mut contents = contents(&scene, 1);
    let mut frame = gpu.frame(plan.clone(), &contents).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    relit(gpu, &mut frame, &plan, (&scene, &mut contents));
    gpu.end(frame);
}

/// A sun that moves needs no tables. A plan with specular has no passes for edits: an edited rectangle needs the passes that read
/// heights.
#[test]
fn moved_suns_and_edited_heights_need_no_tables() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = scene(5.0);
    let plan = planned(gpu, &scene);
    let heights = plan.find("heights").expect("an input");
    let mut contents = contents(&scene, 1);
    let mut frame = gpu.frame(plan, &contents).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let first = bits(gpu, &frame);

    let sun = &mut scene.lights.suns[0];
    (sun.azimuth_rad, sun.irradiance) = (2.05, [0.3, 0.9, 1.5]);
    let plan = planned(gpu, &scene);
    let due = gpu.replace_plan(&mut frame, plan.clone()).expect("the same passes");
    assert_eq!(frame.renderer().passes_after(&[]), due);
    let kept = left_out(&plan, &due);
    assert!(TABLES.iter().all(|table| kept.iter().any(|label| label == table)), "{kept:?}");
    gpu.draw_passes(&mut frame, &due).expect("drawn");
    let moved = bits(gpu, &frame);
    assert!(moved != first && moved == from_nothing(gpu, &plan, &contents));

    let edited = Rectangle { col: 6, row: 4, cols: 5, rows: 3 };
    (4..7).for_each(|row| contents[0][row * SIDE + 6..][..5].iter_mut().for_each(|h| *h += 20.0));
    gpu.refill(&frame, 0, &contents[0]).expect("raised");
    let error = gpu.draw_edit(&mut frame, edited).expect_err("no passes for edits").to_string();
    assert!(error.contains("specular"), "{error}");
    let passes = frame.renderer().passes_after(&[heights]);
    assert_eq!(left_out(&plan, &passes), TABLES);
    gpu.draw_passes(&mut frame, &passes).expect("drawn");
    let raised = bits(gpu, &frame);
    assert!(raised != moved && raised == from_nothing(gpu, &plan, &contents));
    gpu.end(frame);
}

/// Another eye needs neither a sweep nor tables, both by slices of the lobe and by harmonics. The pictures equal those of new
/// renderers bit for bit.
#[test]
fn another_eye_needs_no_tables() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let (scene, limits) = (scene(5.0), crate::limits_of(gpu));
    let contents = contents(&scene, 1);
    for basis in [Basis::Auto, Basis::Sh] {
        let planned = |eye_m| {
            let quality =
                Quality { azimuths: 12, table_elevations: 32, basis, ..Quality::default() };
            let (keeps_horizons, light_layers) = (true, true);
            let wanted = Picture { keeps_horizons, light_layers, eye_m, ..Picture::default() };
            plan::picture(&scene, &quality, &limits, wanted).expect("a plan")
        };
        let mut frame = gpu.frame(planned(None), &contents).expect("a frame");
        gpu.draw(&mut frame).expect("drawn");
        let mut last = bits(gpu, &frame);
        for eye_m in [[-5.0, 8.0, 60.0], [30.0, 8.0, 60.0]].map(Some) {
            let plan = planned(eye_m);
            let due = gpu.replace_plan(&mut frame, plan.clone()).expect("the same passes");
            let kept = left_out(&plan, &due);
            let is_there = |label: &str| plan.passes.iter().any(|pass| pass.label() == label);
            let mut tables = TABLES.iter().filter(|table| is_there(table));
            assert!(tables.all(|table| kept.iter().any(|k| k == table)), "{basis:?}: {kept:?}");
            assert!(kept.iter().any(|label| label.starts_with("horizon_sweep")), "{kept:?}");
            gpu.draw_passes(&mut frame, &due).expect("drawn");
            let found = bits(gpu, &frame);
            assert!(found != last, "{basis:?}: the view of the eye before");
            assert!(found == from_nothing(gpu, &plan, &contents), "{basis:?} {eye_m:?}");
            last = found;
        }
        gpu.end(frame);
    }
}

/// The tables of a specular map's levels, which share one image of whole slices, follow the environment. A map with other exponents
/// needs none of them: it has the bits of a plan that was made for it, as both have the same largest exponent. Exponents above it are
/// clamped to it.
#[test]
fn tables_of_a_map_follow_the_environment_alone() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let of = |exponent| PhongSpecular { exponent, scale: 0.5 };
    let mut scene = scene(5.0);
    scene.surface.specular = Some(Specular::Map(vec![of(30.0); SIDE * SIDE]));
    // Suns are reflected by each texel's own exponent.
    scene.lights.suns.clear();
    let plan = planned(gpu, &scene);
    let mut contents = contents(&scene, 1);
    let mut frame = gpu.frame(plan.clone(), &contents).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let kept = relit(gpu, &mut frame, &plan, (&scene, &mut contents));
    let is_table = |label: &&String| label.contains("_tables") || label.contains("mirror_map");
    assert_eq!(kept.iter().filter(is_table).count(), 0, "{kept:?}");

    let phong = plan.find("phong").expect("an input");
    let input = plan.inputs().position(|(id, _)| id == phong).expect("an input");
    let planned_bits = bits(gpu, &frame);
    let above = (0..SIDE * SIDE).map(|i| of((30 + i) as f32));
    scene.surface.specular = Some(Specular::Map(above.collect()));
    let too_large = plan::picture_inputs(&scene).swap_remove(input);
    gpu.refill(&frame, input, &too_large).expect("refilled");
    let passes = frame.renderer().passes_after(&[phong]);
    gpu.draw_passes(&mut frame, &passes).expect("drawn");
    assert!(bits(gpu, &frame) == planned_bits);

    let texels = (0..SIDE * SIDE).map(|i| of((i % 31) as f32));
    scene.surface.specular = Some(Specular::Map(texels.collect()));
    let own = planned(gpu, &scene);
    contents[input] = plan::picture_inputs(&scene).swap_remove(input);
    gpu.refill(&frame, input, &contents[input]).expect("refilled");
    let passes = frame.renderer().passes_after(&[phong]);
    let kept = left_out(&plan, &passes);
    let tables = plan.passes.iter().map(|pass| pass.label()).filter(|label| is_table(&label));
    assert!(tables.clone().count() > 30 && tables.clone().all(|label| kept.contains(&label)));
    gpu.draw_passes(&mut frame, &passes).expect("drawn");
    assert!(bits(gpu, &frame) == from_nothing(gpu, &own, &contents));
    gpu.end(frame);
}

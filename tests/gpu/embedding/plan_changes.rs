//! After a change only the necessary passes run: the same bits as all of them.

use ash::vk;
use ridgelight::gpu::{Headless, ImageArg, ImageState, Work};
use ridgelight::plan::{self, Limits, Picture, Plan, Rectangle};
use ridgelight::scene::fractal;
use ridgelight::scene::{Basis, Environment, Lights, Method, Quality, Scene, Sun, Surface};

use crate::{Device, bits, random};

fn environment(seed: u64) -> Environment {
    let mut next = random(seed);
    let texels = (0..32 * 16).map(|_| [next() as f32, next() as f32, 4.0 * next() as f32]);
    Environment::new(32, 16, texels.collect(), 0.0).expect("an environment")
}

fn scene() -> Scene {
    let sun = |azimuth_rad, diameter_rad| Sun {
        azimuth_rad,
        elevation_rad: 0.3,
        diameter_rad,
        irradiance: [2.0, 1.5, 1.0],
    };
    Scene {
        field: fractal(96, 1).expect("a field"),
        surface: Surface::default(),
        lights: Lights {
            sky: Some([1.0, 0.9, 0.8]),
            environment: Some(environment(5)),
            suns: vec![sun(1.0, 0.02), sun(4.0, 0.0)],
            ..Lights::default()
        },
    }
}

fn contents(scene: &Scene) -> [Vec<f32>; 2] {
    let environment = scene.lights.environment.as_ref().expect("one");
    let texels = environment.texels().iter().flat_map(|t| [t[0], t[1], t[2], 1.0]).collect();
    [scene.field.heights_m().to_vec(), texels]
}

/// Tables, and harmonics at every second texel.
fn qualities() -> [Quality; 2] {
    let tables = Quality { azimuths: 12, table_elevations: 32, ..Quality::default() };
    [tables, Quality { basis: Basis::Sh, subsample: 2, ..tables }]
}

fn planned(gpu: &Headless, scene: &Scene, (quality, keeps_horizons): Form) -> Plan {
    let wanted = Picture { keeps_horizons, light_layers: true, ..Picture::default() };
    plan::picture(scene, quality, &crate::limits_of(gpu), wanted).expect("a plan")
}

/// A quality, and whether horizons are kept.
type Form<'a> = (&'a Quality, bool);

/// The output of all passes of the scene's plan for these contents.
fn from_nothing(
    gpu: &mut Headless,
    scene: &Scene,
    [heights, environment]: [Vec<f32>; 2],
    form: Form,
) -> Vec<u32> {
    let plan = planned(gpu, scene, form);
    let mut frame = gpu.frame(plan, &[&heights, &environment]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let all = bits(gpu, &frame);
    gpu.end(frame);
    all
}

#[test]
fn passes_after_a_change_match_all_passes() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let all = qualities();
    for form in all.iter().flat_map(|quality| [(quality, true), (quality, false)]) {
        let mut scene = scene();
        let plan = planned(gpu, &scene, form);
        let [heights, texels] = contents(&scene);
        let mut frame = gpu.frame(plan, &[&heights, &texels]).expect("a frame");
        gpu.draw(&mut frame).expect("drawn");
        let mut last = bits(gpu, &frame);
        // A sphere light of another colour; a new environment, by the plan of the old one, whose azimuths are
        // importance-sampled for that; a new field.
        let mut texels = texels;
        for change in 0..3 {
            let passes = match change {
                0 => {
                    scene.lights.suns[1].irradiance = [0.1, 0.2, 7.0];
                    let plan = planned(gpu, &scene, form);
                    gpu.replace_plan(&mut frame, plan).expect("the same passes")
                }
                1 => {
                    let mut other = scene.clone();
                    other.lights.environment = Some(environment(6));
                    [_, texels] = contents(&other);
                    gpu.refill(&frame, 1, &texels).expect("refilled");
                    let input = frame.plan().find("environment").expect("an input");
                    let passes = frame.plan().passes_after(frame.plan(), &[input]);
                    // The second sun's sum reuses the memory of the first's, which is computed again.
                    let label = |i: &usize| frame.plan().passes[*i].label();
                    let is_of_light = |label: &str| {
                        let visible =
                            label.starts_with("sh_visibility") || label.starts_with("sky_shade");
                        !visible && !label.contains(" sky ")
                    };
                    let light_alone = passes.iter().all(|i| is_of_light(&label(i)));
                    // Suns have lattices of their own: the circle's one lattice stays as it is, too.
                    assert!(light_alone == (form.0.basis == Basis::Sh), "{form:?}");
                    passes
                }
                _ => {
                    scene.field = fractal(96, 2).expect("a field");
                    gpu.refill(&frame, 0, scene.field.heights_m()).expect("refilled");
                    let input = frame.plan().find("heights").expect("an input");
                    frame.plan().passes_after(frame.plan(), &[input])
                }
            };
            let all = frame.plan().passes.len();
            assert!(passes.len() < all, "change {change}: {} of {all} passes", passes.len());
            gpu.draw_passes(&mut frame, &passes).expect("drawn");
            let found = bits(gpu, &frame);
            assert!(found != last, "change {change} shows");
            let heights = scene.field.heights_m().to_vec();
            assert!(
                found == from_nothing(gpu, &scene, [heights, texels.clone()], (form.0, !form.1)),
                "change {change}: {form:?}"
            );
            last = found;
        }
        gpu.end(frame);
    }
}

#[test]
fn a_plan_of_other_images_is_refused_and_the_old_one_stays() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = scene();
    let plan = planned(gpu, &scene, (&qualities()[0], true));
    let [heights, texels] = contents(&scene);
    let mut frame = gpu.frame(plan, &[&heights, &texels]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let before = bits(gpu, &frame);
    scene.lights.suns.clear();
    let other = planned(gpu, &scene, (&qualities()[0], true));
    let error = gpu.replace_plan(&mut frame, other).expect_err("no sun").to_string();
    assert!(error.starts_with("plan: found no "), "{error}");
    assert!(error.ends_with("as in the renderer's plan; make a renderer for the new plan"));
    gpu.draw(&mut frame).expect("drawn");
    assert!(bits(gpu, &frame) == before);
    gpu.end(frame);
}

/// All but the last pass, and then another plan: its pieces begin at its own first pass and give the output of the
/// whole plan.
#[test]
fn pieces_of_two_plans_do_not_mix() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = scene();
    let plan = planned(gpu, &scene, (&qualities()[0], true));
    let count = plan.passes.len();
    let [heights, texels] = contents(&scene);
    let mut frame = gpu.frame(plan, &[&heights, &texels]).expect("a frame");
    let first: Vec<usize> = (0..count - 1).collect();
    gpu.draw_passes(&mut frame, &first).expect("the first piece");
    let environment = scene.lights.environment.take().expect("one");
    let texels = environment.texels().to_vec();
    scene.lights.environment = Environment::new(32, 16, texels, 3.0).ok();
    let plan = planned(gpu, &scene, (&qualities()[0], true));
    let due = gpu.replace_plan(&mut frame, plan).expect("the same passes");
    assert!(due[0] < count - 1, "{due:?}");
    assert!(gpu.draw_passes(&mut frame, &[count - 1]).is_err(), "light of two plans");
    let rest: Vec<usize> = (due[0]..count).collect();
    gpu.draw_passes(&mut frame, &rest).expect("the next piece");
    let pieces = bits(gpu, &frame);
    gpu.draw(&mut frame).expect("drawn");
    assert!(bits(gpu, &frame) == pieces);
    gpu.end(frame);
}

/// After a whole recording, changed passes are recorded one at a time, in order. Recording an early pass again makes its
/// dependents pending. Once all are recorded, an edit is allowed.
#[test]
fn changed_passes_are_recorded_in_order_part_by_part() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = scene();
    scene.lights.suns.truncate(1);
    scene.lights.environment = None;
    let quality = Quality { method: Method::Sweep, ..Quality::default() };
    let plan = planned(gpu, &scene, (&quality, true));
    let heights = scene.field.heights_m().to_vec();
    let mut frame = gpu.frame(plan, &[&heights]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    scene.lights.suns[0].azimuth_rad += 0.01;
    let plan = planned(gpu, &scene, (&quality, true));
    let pending = gpu.replace_plan(&mut frame, plan.clone()).expect("the same passes");
    assert!(pending.len() > 2, "{pending:?}");
    for later in &pending[1..] {
        let error =
            gpu.draw_passes(&mut frame, &[*later]).expect_err("an earlier changed pass is pending");
        let expected = format!("passes: found {later} without {}, expected", pending[0]);
        assert!(error.to_string().starts_with(&expected), "{error}");
    }
    let whole = Rectangle { col: 0, row: 0, cols: 4, rows: 4 };
    gpu.draw_edit(&mut frame, whole).expect_err("not recorded yet");
    for pass in &pending {
        gpu.draw_passes(&mut frame, &[*pass]).expect("drawn");
    }
    let mut other = gpu.frame(plan.clone(), &[&heights]).expect("a frame");
    let last = plan.passes.len() - 1;
    gpu.draw_passes(&mut other, &(0..last).collect::<Vec<_>>()).expect("drawn");
    gpu.draw_passes(&mut other, &[0]).expect("drawn again");
    gpu.draw_passes(&mut other, &[last]).expect_err("passes that read pass 0 are pending");
    gpu.draw_passes(&mut other, &(1..=last).collect::<Vec<_>>()).expect("drawn");
    assert!(bits(gpu, &frame) == bits(gpu, &other));
    let none: [usize; 0] = [];
    assert_eq!(gpu.replace_plan(&mut frame, plan).expect("the same"), none);
    // The edit of either is the whole frame of the new heights.
    let mut raised = heights;
    (40..44).for_each(|row| (30..36).for_each(|col| raised[row * 96 + col] += 20.0));
    let edited = Rectangle { col: 30, row: 40, cols: 6, rows: 4 };
    let before = bits(gpu, &frame);
    for part in [&mut frame, &mut other] {
        gpu.refill(part, 0, &raised).expect("refilled");
        gpu.draw_edit(part, edited).expect("edited");
    }
    let [edited, of_parts] = [&frame, &other].map(|part| bits(gpu, part));
    gpu.draw(&mut other).expect("drawn");
    let fresh = bits(gpu, &other);
    assert!(fresh != before && edited == fresh && of_parts == fresh);
    gpu.end(other);
    gpu.end(frame);
}

/// A frame under a sky and an environment. Its batches of azimuths add to one sum and share a lattice, except on a GPU, where each may have its own. A part that is recorded
/// again is refused if it would add twice, or read what a later part has overwritten.
#[test]
fn a_part_is_recorded_again_only_with_what_it_needs() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = scene();
    scene.lights.suns.clear();
    let quality = Quality { azimuths: 16, method: Method::Sweep, ..Quality::default() };
    let mut limits = crate::limits_of(gpu);
    limits.sweep.azimuths = 4;
    let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
    let labels: Vec<String> = plan.passes.iter().map(|pass| pass.label()).collect();
    let is_shade = |i: &usize| labels[*i].starts_with("sky_shade");
    let shades: Vec<usize> = (0..labels.len()).filter(is_shade).collect();
    assert!(shades.len() > 2, "{labels:?}");
    let [heights, texels] = contents(&scene);
    let mut frame = gpu.frame(plan.clone(), &[&heights, &texels]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let fresh = bits(gpu, &frame);
    gpu.end(frame);

    let mut frame = gpu.frame(plan.clone(), &[&heights, &texels]).expect("a frame");
    let end = plan.passes.len();
    let done = shades[shades.len() - 1];
    gpu.draw_passes(&mut frame, &(0..=done).collect::<Vec<_>>()).expect("drawn");
    let rest: Vec<usize> = (done + 1..end).collect();
    for shade in &shades {
        let (error, passes) = match gpu.draw_passes(&mut frame, &[*shade]) {
            Err(error) => (error, vec![*shade]),
            // The first one starts the sum again. If its lattice is its own, as on a GPU, it may run alone; the sum then lacks the others.
            Ok(_) => {
                assert_eq!(*shade, shades[0], "twice in a sum");
                let error = gpu.draw_passes(&mut frame, &rest).expect_err("a sum of one batch");
                gpu.draw_passes(&mut frame, &(*shade..=done).collect::<Vec<_>>()).expect("drawn");
                (error, rest.clone())
            }
        };
        let error = error.to_string();
        let is_expected = |pass| error.starts_with(&format!("passes: found {pass} without "));
        assert!(passes.into_iter().any(is_expected), "{error}");
    }
    gpu.draw_passes(&mut frame, &rest).expect("drawn");
    assert!(bits(gpu, &frame) == fresh);
    // Alone when nothing is pending, to time it: the plan then names all that must run.
    gpu.draw_passes(&mut frame, &shades[1..2]).expect("timed");
    let pending = gpu.replace_plan(&mut frame, plan.clone()).expect("the same");
    assert!(pending.contains(&shades[0]) && pending.contains(&(end - 1)), "{pending:?}");
    gpu.draw_passes(&mut frame, &pending).expect("drawn");
    assert!(bits(gpu, &frame) == fresh);
    gpu.end(frame);

    // The environment's tables again: all batches that read them are pending, with the sweeps that they share a lattice with.
    let mut frame = gpu.frame(plan.clone(), &[&heights, &texels]).expect("a frame");
    gpu.draw_passes(&mut frame, &(0..=done).collect::<Vec<_>>()).expect("drawn");
    let is_table = |i: &usize| labels[*i].starts_with("env_");
    let tables: Vec<usize> = (0..end).filter(is_table).collect();
    let other: Vec<f32> = texels.iter().rev().copied().collect();
    gpu.refill(&frame, 1, &other).expect("refilled");
    gpu.draw_passes(&mut frame, &tables).expect("drawn again");
    gpu.refill(&frame, 1, &texels).expect("refilled");
    gpu.draw_passes(&mut frame, &tables).expect("drawn again");
    let pending = gpu.replace_plan(&mut frame, plan).expect("the same");
    gpu.draw_passes(&mut frame, &pending).expect("drawn");
    assert!(bits(gpu, &frame) == fresh);
    gpu.end(frame);
}

/// A result built up over several frames, as docs/embedding/questions.md says: with a lower `Limits::image_layers` each batch of
/// azimuths, and so each of its passes, covers fewer. One pass per submission, in order, gives the bits of a whole frame of the
/// same plan: with a new renderer, and then with one whose images hold the light of other heights.
#[test]
fn few_layers_split_a_sky_into_passes_for_several_frames() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = scene();
    scene.lights.suns.clear();
    scene.lights.environment = None;
    let quality = Quality { azimuths: 32, method: Method::Sweep, ..Quality::default() };
    let limits = crate::limits_of(gpu);
    // An azimuth of 96 lanes has 3 to 6 layers of 32 lines. Plans of a GPU widen the layers, down to one for an azimuth.
    let few = Limits { image_layers: 6, ..limits };
    let [usual, cut] = [limits, few].map(|limits| {
        plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan")
    });
    let counts = |plan: &Plan, name: &str| -> Vec<usize> {
        let named = plan.passes.iter().filter(|pass| pass.name() == name);
        named.map(|pass| pass.azimuths.len()).collect()
    };
    for name in ["horizon_sweep", "sky_shade"] {
        let [usual, cut] = [&usual, &cut].map(|plan| counts(plan, name));
        let (least, most) = (usual.iter().min(), cut.iter().max());
        assert!(cut.len() > usual.len() && most < least, "{name}: {cut:?}, {usual:?}");
    }
    assert_eq!(counts(&cut, "sky_shade").iter().sum::<usize>(), 32);

    let passes = cut.passes.len();
    let fields = [1, 2].map(|seed| fractal(96, seed).expect("a field"));
    let whole = fields.each_ref().map(|field| {
        let mut frame = gpu.frame(cut.clone(), &[field.heights_m()]).expect("a frame");
        gpu.draw(&mut frame).expect("drawn");
        let bits = bits(gpu, &frame);
        gpu.end(frame);
        bits
    });
    assert!(whole[0] != whole[1]);
    let mut frame = gpu.frame(cut, &[fields[0].heights_m()]).expect("a frame");
    for (field, whole) in fields.iter().zip(&whole) {
        gpu.refill(&frame, 0, field.heights_m()).expect("refilled");
        for pass in 0..passes {
            gpu.draw_passes(&mut frame, &[pass]).expect("drawn");
        }
        assert!(bits(gpu, &frame) == *whole, "other light than of a whole frame");
    }
    gpu.end(frame);
}

#[test]
fn two_changes_before_a_recording_are_both_drawn() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = scene();
    let plan = planned(gpu, &scene, (&qualities()[0], true));
    let [heights, texels] = contents(&scene);
    let mut frame = gpu.frame(plan.clone(), &[&heights, &texels]).expect("a frame");
    let all: Vec<usize> = (0..plan.passes.len()).collect();
    assert_eq!(gpu.replace_plan(&mut frame, plan).expect("the same"), all, "nothing is drawn yet");
    gpu.draw(&mut frame).expect("drawn");
    // Half an environment's turn, which its wedges depend on; then a colour, which they do not.
    let environment = scene.lights.environment.take().expect("one");
    let texels = environment.texels().to_vec();
    scene.lights.environment = Environment::new(32, 16, texels, 3.0).ok();
    let plan = planned(gpu, &scene, (&qualities()[0], true));
    let turned = gpu.replace_plan(&mut frame, plan).expect("the same passes");
    scene.lights.suns[0].irradiance = [0.1, 0.2, 7.0];
    let plan = planned(gpu, &scene, (&qualities()[0], true));
    let coloured = plan.passes_after(frame.plan(), &[]);
    let both = gpu.replace_plan(&mut frame, plan.clone()).expect("the same passes");
    assert!(turned.iter().any(|p| !coloured.contains(p)), "two changes");
    assert!(turned.iter().chain(&coloured).all(|p| both.contains(p)) && both.len() < all.len());
    gpu.draw_passes(&mut frame, &both).expect("drawn");
    let nothing = from_nothing(gpu, &scene, contents(&scene), (&qualities()[0], true));
    assert!(bits(gpu, &frame) == nothing);
    let none: [usize; 0] = [];
    assert_eq!(gpu.replace_plan(&mut frame, plan).expect("the same"), none);
    gpu.end(frame);
}

/// A pass that adds to an output needs the contents that earlier passes wrote. A whole frame needs none, and neither does a list
/// that includes the first pass of the sum.
#[test]
fn outputs_that_passes_go_on_with_must_have_contents() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let scene = scene();
    let plan = planned(gpu, &scene, (&qualities()[0], true));
    let [heights, texels] = contents(&scene);
    let mut frame = gpu.frame(plan.clone(), &[&heights, &texels]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let all: Vec<usize> = (0..plan.passes.len()).collect();
    let resolves = |part: &str| {
        all.iter()
            .copied()
            .filter(|i| plan.passes[*i].label().starts_with(part))
            .collect::<Vec<_>>()
    };
    let (inputs, outputs) = (frame.inputs(), frame.outputs());
    let empty: Vec<ImageArg> = outputs
        .iter()
        .map(|image| {
            let before = ImageState { layout: vk::ImageLayout::UNDEFINED, ..image.before };
            ImageArg { before, ..*image }
        })
        .collect();
    let mut check = |outputs: &[ImageArg], passes: &[usize]| {
        frame.renderer().check_recording(0, &inputs, outputs, Work::Passes(passes))
    };
    let last = resolves("light_resolve sun2");
    check(&outputs, &last).expect("contents");
    let error = check(&empty, &last).expect_err("no contents").to_string();
    let expected = format!(
        "radiance: layout before: found UNDEFINED, expected a layout with the contents of pass {}, which pass {} reads or adds to",
        resolves("light_resolve sky")[0],
        last[0]
    );
    assert_eq!(error, expected);
    check(&empty, &resolves("light_resolve")).expect("what begins the sums");
    check(&empty, &all).expect("a whole frame");
    gpu.end(frame);
}

/// The sky's horizons and the environment's wedges have azimuths of their own in the same buffer.
#[test]
fn a_sun_that_moves_a_little_is_swept_alone() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = scene();
    let plan = planned(gpu, &scene, (&qualities()[0], true));
    let [heights, texels] = contents(&scene);
    let mut frame = gpu.frame(plan, &[&heights, &texels]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let before = bits(gpu, &frame);
    scene.lights.suns[0].azimuth_rad += 0.01;
    let plan = planned(gpu, &scene, (&qualities()[0], true));
    let passes = gpu.replace_plan(&mut frame, plan).expect("the same passes");
    let labels: Vec<String> = passes.iter().map(|p| frame.plan().passes[*p].label()).collect();
    assert!(labels.iter().any(|l| l.starts_with("shadow_sweep sun1")), "{labels:?}");
    for not in ["horizon_sweep sky", "shadow_sweep sun2", "env_", "sky_shade"] {
        assert!(!labels.iter().any(|l| l.starts_with(not)), "{not} in {labels:?}");
    }
    gpu.draw_passes(&mut frame, &passes).expect("drawn");
    let moved = bits(gpu, &frame);
    assert!(moved != before, "the sun has moved");
    let nothing = from_nothing(gpu, &scene, contents(&scene), (&qualities()[0], true));
    assert!(moved == nothing);
    gpu.end(frame);
}

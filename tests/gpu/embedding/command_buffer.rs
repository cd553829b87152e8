//! The embedding contract inside one command buffer: states of images, renderers side by side, and
//! errors that record nothing.

use ash::vk;
use ridgelight::Error;
use ridgelight::gpu::{Frame, Headless, ImageArg, ImageState, Renderer};
use ridgelight::plan::{self, Picture, Plan};
use ridgelight::scene::{Albedo, Border, Environment, Quality, Scene, Sun};

use super::host_faults::with_families;
use crate::{Device, field, under_sky};

/// A scene with an image of every kind that the table of docs/embedding.md lists.
fn scene() -> Scene {
    let heights = field(12, 14, [1.0, 2.0], |r, c| ((r * 31 + c * 17) % 7) as f64);
    let mut scene = under_sky(heights, Border::Plane);
    let environment = Environment::new(16, 8, vec![[0.5, 0.4, 0.3]; 128], 0.3);
    scene.lights.environment = Some(environment.expect("an environment"));
    scene.lights.suns = vec![Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.5,
        diameter_rad: 0.02,
        irradiance: [1.0, 0.9, 0.8],
    }];
    scene.surface.albedo = Albedo::Map(vec![[0.9, 0.5, 0.1]; 12 * 14]);
    scene
}

/// Texels of the inputs of [`scene`], in the plan's order.
fn contents(scene: &Scene) -> [Vec<f32>; 3] {
    [
        scene.field.heights_m().to_vec(),
        [0.5, 0.4, 0.3, 1.0].repeat(128),
        [0.9, 0.5, 0.1, 1.0].repeat(12 * 14),
    ]
}

fn quality() -> Quality {
    Quality { azimuths: 4, sun_azimuths: 2, table_elevations: 16, ..Quality::default() }
}

fn picture(device: &Device, scene: &Scene) -> Plan {
    let wanted = Picture { light_layers: true, sky_view: true, ..Picture::default() };
    plan::picture(scene, &quality(), &device.limits(), wanted).expect("a plan")
}

fn frame(gpu: &mut Headless, plan: &Plan, contents: &[Vec<f32>]) -> Frame {
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    gpu.frame(plan.clone(), &contents).expect("a frame")
}

/// Bits of all outputs.
fn outputs(gpu: &mut Headless, frame: &Frame) -> Vec<Vec<u32>> {
    let ids: Vec<_> = frame.plan().outputs().map(|(id, _)| id).collect();
    ids.into_iter().map(|id| gpu.read(frame, id).expect("read back")).collect()
}

const fn state(
    stage: vk::PipelineStageFlags2,
    access: vk::AccessFlags2,
    layout: vk::ImageLayout,
) -> ImageState {
    ImageState { stage, access, layout }
}

const NO_CONTENTS: ImageState =
    state(vk::PipelineStageFlags2::NONE, vk::AccessFlags2::NONE, vk::ImageLayout::UNDEFINED);
const SAMPLED: ImageState = state(
    vk::PipelineStageFlags2::COMPUTE_SHADER,
    vk::AccessFlags2::SHADER_SAMPLED_READ,
    vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
);
const STORED: ImageState = state(
    vk::PipelineStageFlags2::COMPUTE_SHADER,
    vk::AccessFlags2::SHADER_STORAGE_WRITE,
    vk::ImageLayout::GENERAL,
);
const COPIED_FROM: ImageState = state(
    vk::PipelineStageFlags2::COPY,
    vk::AccessFlags2::TRANSFER_READ,
    vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
);
const COPIED_TO: ImageState = state(
    vk::PipelineStageFlags2::COPY,
    vk::AccessFlags2::TRANSFER_WRITE,
    vk::ImageLayout::TRANSFER_DST_OPTIMAL,
);

/// States of inputs, of outputs before, and of outputs after.
const STATES: [[ImageState; 3]; 6] = [
    [SAMPLED, NO_CONTENTS, SAMPLED],
    [COPIED_TO, NO_CONTENTS, COPIED_FROM],
    [COPIED_FROM, SAMPLED, STORED],
    [STORED, COPIED_FROM, COPIED_TO],
    [SAMPLED, STORED, ImageState::ANY_USE],
    [ImageState::ANY_USE, ImageState::ANY_USE, SAMPLED],
];

/// The same images from one state to another.
fn with(images: &[ImageArg], before: ImageState, after: ImageState) -> Vec<ImageArg> {
    images.iter().map(|image| ImageArg { before, after, ..*image }).collect()
}

/// Records a frame with its images in the given states, and takes them there and back: `left` is the expected state of
/// the outputs.
fn record_in(
    gpu: &Headless,
    frame: &mut Frame,
    [input, before, after]: [ImageState; 3],
    left: ImageState,
) {
    let (inputs, outputs) = (frame.inputs(), frame.outputs());
    let done = gpu.run(|commands| {
        let go = |images: &[ImageArg], from, to| {
            with(images, from, to).iter().for_each(|image| gpu.transition(commands, image));
        };
        go(&inputs, ImageState::ANY_USE, input);
        if before != NO_CONTENTS {
            go(&outputs, ImageState::ANY_USE, before);
        }
        // The `after` of an input does not count.
        let read = with(&inputs, input, NO_CONTENTS);
        frame.renderer().record(commands, 0, &read, &with(&outputs, before, after))?;
        go(&inputs, input, ImageState::ANY_USE);
        go(&outputs, left, ImageState::ANY_USE);
        Ok(())
    });
    done.expect("recorded and run");
}

/// Validation tracks layouts and hazards: a barrier from a wrong state is an error.
#[test]
fn images_are_left_as_the_table_says() {
    let mut device = Device::new();
    let scene = scene();
    let plan = picture(&device, &scene);
    let page = include_str!("../../../docs/embedding.md");
    let row = |begin: &str| page.lines().find(|l| l.starts_with(begin)).expect("a row");
    for (_, input) in plan.inputs() {
        assert!(row("| inputs:").contains(&format!("`{}`", input.name)), "{}", input.name);
    }
    assert!(row("| inputs:").ends_with("| as it came |"));
    assert!(row("| outputs:").contains("`radiance`, light layers"));
    assert!(row("| outputs:").ends_with("| the state that you ask for |"));

    let contents = contents(&scene);
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = frame(gpu, &plan, &contents);
    gpu.draw(&mut frame).expect("drawn");
    let drawn = outputs(gpu, &frame);
    let inputs: Vec<_> = plan.inputs().map(|(id, _)| id).collect();
    for states in STATES {
        record_in(gpu, &mut frame, states, states[2]);
        assert_eq!(outputs(gpu, &frame), drawn, "{states:?}");
        for (id, texels) in inputs.iter().zip(&contents) {
            let bits: Vec<u32> = texels.iter().map(|t| t.to_bits()).collect();
            assert_eq!(gpu.read(&frame, *id).expect("read back"), bits, "{states:?} {id:?}");
        }
    }
    assert_eq!(gpu.take_messages(), [""; 0], "validation is silent so far");
    if device.validates {
        // The comparison can fail: validation reports outputs in another state than the requested one.
        let gpu = device.gpu.as_mut().expect("alive");
        record_in(gpu, &mut frame, [SAMPLED, NO_CONTENTS, COPIED_FROM], SAMPLED);
        assert!(!gpu.take_messages().is_empty(), "validation reports nothing");
    }
    device.gpu.as_mut().expect("alive").end(frame);
}

#[test]
fn two_renderers_in_one_buffer_are_each_what_they_are_alone() {
    let mut device = Device::new();
    let scene = scene();
    let picture = picture(&device, &scene);
    let (field, border) = (&scene.field, scene.surface.border);
    let horizons =
        plan::horizons(field, border, &quality(), &device.limits(), (0, 4), false).expect("a plan");
    let contents = contents(&scene);
    let gpu = device.gpu.as_mut().expect("alive");
    let mut lit = frame(gpu, &picture, &contents);
    let mut visible = frame(gpu, &horizons, &contents[..1]);
    gpu.draw(&mut lit).expect("drawn");
    gpu.draw(&mut visible).expect("drawn");
    let alone = [outputs(gpu, &lit), outputs(gpu, &visible)];

    // Other heights in between, so that stale contents cannot pass.
    let flat = vec![1.0; contents[0].len()];
    gpu.refill(&lit, 0, &flat).expect("other heights");
    gpu.refill(&visible, 0, &flat).expect("other heights");
    gpu.draw(&mut lit).expect("drawn");
    gpu.draw(&mut visible).expect("drawn");
    assert!(outputs(gpu, &lit) != alone[0] && outputs(gpu, &visible) != alone[1]);
    gpu.refill(&lit, 0, &contents[0]).expect("the heights again");

    // Both read one image: the first leaves it as the second expects it.
    let (inputs, lit_outputs) = (lit.inputs(), lit.outputs());
    let view_outputs = visible.outputs();
    let both = gpu.run(|commands| {
        lit.renderer().record(commands, 0, &inputs, &lit_outputs)?;
        visible.renderer().record(commands, 0, &inputs[..1], &view_outputs)
    });
    both.expect("recorded and run");
    assert_eq!([outputs(gpu, &lit), outputs(gpu, &visible)], alone);
    gpu.end(lit);
    gpu.end(visible);
}

/// Everything that `record` refuses, with a word of its error.
fn refused(
    renderer: &mut Renderer,
    commands: vk::CommandBuffer,
    inputs: &[ImageArg],
    outputs: &[ImageArg],
) {
    let passes = renderer.plan().passes.len();
    let mut refuse =
        |named: &str, slot, inputs: &[ImageArg], outputs: &[ImageArg], passes: Option<&[usize]>| {
            let error: Error = match passes {
                None => renderer.record(commands, slot, inputs, outputs),
                Some(passes) => renderer.record_passes(commands, slot, inputs, outputs, passes),
            }
            .expect_err(named);
            assert!(error.to_string().contains(named), "{named}: {error}");
        };
    refuse("slot", 1, inputs, outputs, None);
    refuse("pass", 0, inputs, outputs, Some(&[0, passes]));
    refuse("order", 0, inputs, outputs, Some(&[1, 1]));
    refuse("order", 0, inputs, outputs, Some(&[2, 1]));
    // More passes than there are queries; as many as there are, but not all.
    refuse("order", 0, inputs, outputs, Some(&vec![0; 2 * passes]));
    refuse("order", 0, inputs, outputs, Some(&vec![0; passes]));
    refuse("inputs", 0, &inputs[1..], outputs, None);
    refuse("outputs", 0, inputs, &outputs[1..], None);
    type Spoil = fn(&mut ImageArg);
    let spoils: [(&str, Spoil); 4] = [
        ("image or view", |arg| arg.image = vk::Image::null()),
        ("image or view", |arg| arg.view = vk::ImageView::null()),
        ("format", |arg| arg.format = vk::Format::R8_UNORM),
        ("extent", |arg| arg.extent[1] += 1),
    ];
    // The last image of each list: all others have passed the checks by then.
    for (named, spoil) in spoils {
        let (mut bad_inputs, mut bad_outputs) = (inputs.to_vec(), outputs.to_vec());
        spoil(bad_inputs.last_mut().expect("inputs"));
        refuse(named, 0, &bad_inputs, outputs, None);
        spoil(bad_outputs.last_mut().expect("outputs"));
        refuse(named, 0, inputs, &bad_outputs, None);
    }
    refuse("layout", 0, &with(inputs, NO_CONTENTS, NO_CONTENTS), outputs, None);
    refuse("layout after", 0, inputs, &with(outputs, NO_CONTENTS, NO_CONTENTS), None);
    let of_depth =
        ImageState { layout: vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL, ..ImageState::ANY_USE };
    refuse("heights: layout before", 0, &with(inputs, of_depth, NO_CONTENTS), outputs, None);
    refuse("radiance: layout before", 0, inputs, &with(outputs, of_depth, SAMPLED), None);
    refuse("radiance: layout after", 0, inputs, &with(outputs, SAMPLED, of_depth), None);
    let nowhere = ImageState { stage: vk::PipelineStageFlags2::NONE, ..SAMPLED };
    refuse("heights: stage before", 0, &with(inputs, nowhere, NO_CONTENTS), outputs, None);
    refuse("radiance: stage after", 0, inputs, &with(outputs, SAMPLED, nowhere), None);
    // The last output as the first again.
    let mut twice = outputs.to_vec();
    let last = twice.len() - 1;
    twice[last].image = twice[0].image;
    refuse("the image of radiance", 0, inputs, &twice, None);
}

#[test]
fn an_error_leaves_the_command_buffer_untouched() {
    let mut device = Device::new();
    let scene = scene();
    let plan = picture(&device, &scene);
    let contents = contents(&scene);
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = frame(gpu, &plan, &contents);
    let (inputs, written) = (frame.inputs(), frame.outputs());
    gpu.draw(&mut frame).expect("drawn");
    let right = outputs(gpu, &frame);
    gpu.refill(&frame, 0, &vec![1.0; contents[0].len()]).expect("other heights");
    gpu.draw(&mut frame).expect("drawn");
    let flat = outputs(gpu, &frame);
    let times = frame.renderer().timings(0);
    assert!(flat != right);
    gpu.refill(&frame, 0, &contents[0]).expect("the heights again");

    // Drivers and layers dereference the command buffer: a command in a null one would crash.
    refused(frame.renderer(), vk::CommandBuffer::null(), &inputs, &written);
    // A command buffer with nothing but refused recordings does nothing: no texel changes, no timestamp is reset.
    gpu.run(|commands| {
        refused(frame.renderer(), commands, &inputs, &written);
        Ok(())
    })
    .expect("run");
    assert_eq!(outputs(gpu, &frame), flat);
    assert_eq!(frame.renderer().timings(0), times);
    // After errors, the same buffer takes a valid recording.
    gpu.run(|commands| {
        refused(frame.renderer(), commands, &inputs, &written);
        frame.renderer().record(commands, 0, &inputs, &written)
    })
    .expect("recorded and run");
    assert_eq!(outputs(gpu, &frame), right);
    gpu.end(frame);
}

/// The plan's own images have no contents and no layout before all passes have run: a plan is recorded piece by piece
/// from the first pass on, or refused.
#[test]
fn some_passes_are_refused_until_all_have_been_recorded() {
    let mut device = Device::new();
    let scene = scene();
    let plan = picture(&device, &scene);
    let all: Vec<usize> = (0..plan.passes.len()).collect();
    let contents = contents(&scene);
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = frame(gpu, &plan, &contents);
    let refused = |gpu: &mut Headless, frame: &mut Frame, few: &[usize]| {
        let error = gpu.draw_passes(frame, few).expect_err("nothing to go on from");
        assert!(error.to_string().contains("a recording of all passes"), "{error}");
    };
    for few in [&[][..], &[0, 2], &all[1..]] {
        refused(gpu, &mut frame, few);
    }
    gpu.draw_passes(&mut frame, &[0]).expect("the first");
    for few in [&[][..], &all[2..]] {
        refused(gpu, &mut frame, few);
    }
    gpu.draw_passes(&mut frame, &all).expect("all, by name");
    let drawn = outputs(gpu, &frame);
    gpu.draw_passes(&mut frame, &all[1..]).expect("some");
    assert_eq!(outputs(gpu, &frame), drawn);
    gpu.end(frame);
}

/// One family with compute and no timestamps.
unsafe extern "system" fn untimed_family(
    _: vk::PhysicalDevice,
    count: *mut u32,
    families: *mut vk::QueueFamilyProperties,
) {
    // SAFETY: as Vulkan's function, which the caller asks for the number of families first.
    unsafe {
        *count = 1;
        if let Some(family) = families.as_mut() {
            let queue_flags = vk::QueueFlags::COMPUTE;
            *family = vk::QueueFamilyProperties { queue_flags, ..Default::default() };
        }
    }
}

#[test]
fn timings_are_those_of_the_last_recording_or_none() {
    let mut device = Device::new();
    let scene = scene();
    let plan = picture(&device, &scene);
    let contents = contents(&scene);
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = frame(gpu, &plan, &contents);
    let (inputs, written) = (frame.inputs(), frame.outputs());
    gpu.draw(&mut frame).expect("drawn");
    assert_eq!(frame.renderer().timings(0).map(|t| t.len()), Some(plan.passes.len()));
    gpu.run(|commands| {
        frame.renderer().record_passes(commands, 0, &inputs, &written, &[2])?;
        assert_eq!(frame.renderer().timings(0), None, "recorded, but not run");
        Ok(())
    })
    .expect("recorded and run");
    let times = frame.renderer().timings(0).expect("run");
    assert_eq!(times.iter().map(|t| &t.label).collect::<Vec<_>>(), [&plan.passes[2].label()]);
    let drawn = outputs(gpu, &frame);

    // One time of all passes, also of none, and the same picture; then each again.
    let all: Vec<usize> = (0..plan.passes.len()).collect();
    frame.renderer().time_passes(false);
    for some in [&all[..], &all[2..3], &[]] {
        let times = gpu.draw_passes(&mut frame, some).expect("drawn");
        let labels: Vec<_> = times.iter().map(|t| t.label.as_str()).collect();
        assert_eq!(labels, if some.is_empty() { vec![] } else { vec!["all passes"] });
        assert!(times.iter().all(|t| t.ns > 0.0));
    }
    assert_eq!(outputs(gpu, &frame), drawn);
    frame.renderer().time_passes(true);
    assert_eq!(gpu.draw(&mut frame).expect("drawn").len(), all.len());

    let host = with_families(gpu.host(), 0, untimed_family);
    let mut untimed = Renderer::new(&host, plan, 1).expect("a renderer");
    gpu.run(|commands| untimed.record(commands, 0, &inputs, &written)).expect("recorded and run");
    assert_eq!(untimed.timings(0), None);
    assert_eq!(outputs(gpu, &frame), drawn);
    untimed.destroy();
    gpu.end(frame);
}

/// A recorded command buffer still runs after its renderer is dropped: its memory is not freed and its objects stay,
/// as documented.
#[test]
fn a_renderer_that_is_dropped_takes_no_memory_from_what_was_recorded() {
    let mut device = Device::new();
    let scene = scene();
    let plan = picture(&device, &scene);
    let contents = contents(&scene);
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = frame(gpu, &plan, &contents);
    let (inputs, written) = (frame.inputs(), frame.outputs());
    gpu.draw(&mut frame).expect("drawn");
    let right = outputs(gpu, &frame);
    gpu.refill(&frame, 0, &vec![1.0; contents[0].len()]).expect("other heights");
    gpu.draw(&mut frame).expect("drawn");
    gpu.refill(&frame, 0, &contents[0]).expect("the heights again");
    let mut dropped = Renderer::new(gpu.host(), plan, 1).expect("a renderer");
    gpu.run(|commands| {
        let recorded = dropped.record(commands, 0, &inputs, &written);
        drop(dropped);
        recorded
    })
    .expect("recorded and run");
    assert_eq!(outputs(gpu, &frame), right);
    gpu.end(frame);
}

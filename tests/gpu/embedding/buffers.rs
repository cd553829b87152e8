//! Inputs in the caller's buffers: the bytes of the same inputs in images.

use ash::vk;
use ridgelight::gpu::{
    BufferArg, Frame, Headless, InputArg, Renderer, ViewInputs, ViewOutputs, ViewRenderer,
};
use ridgelight::plan::{self, Format, Kind, Owner, Picture, Plan, Rectangle, View, ViewOptions};
use ridgelight::scene::fractal;
use ridgelight::scene::{Border, Camera, Lens, Quality};

use super::borrowed::{framed, packed, planned, scene};
use crate::target::{FORMAT, SIZE, Staging, Target};
use crate::{Device, under_sky};

/// Formats that each input may have in a buffer.
fn texels(name: &str) -> &'static [Format] {
    match name {
        "heights" => &[Format::R32Float, Format::R16Float, Format::R16Unorm],
        _ => &[Format::Rgba32Float, Format::Rgba16Float, Format::Rgba8Unorm, Format::Rgba8Srgb],
    }
}

fn taking(plan: &Plan, input: &str, texels: Format) -> Plan {
    let mut plan = plan.clone();
    plan.take_buffer(input, texels).expect("an input");
    plan
}

/// Output 0, after a draw of level ground, so that stale contents cannot pass.
fn drawn_over(
    gpu: &mut Headless,
    frame: &mut Frame,
    renderer: &mut Renderer,
    inputs: &[InputArg],
) -> Vec<f32> {
    let count = frame.plan().resources[0].bytes() / 4;
    let before = gpu.read(frame, frame.plan().find("heights").expect("heights")).expect("read");
    gpu.refill(frame, 0, &vec![0.0; count as usize]).expect("level ground");
    gpu.draw(frame).expect("drawn");
    let heights: Vec<f32> = before.into_iter().map(f32::from_bits).collect();
    gpu.refill(frame, 0, &heights).expect("the heights again");
    let outputs = frame.outputs();
    gpu.run(|commands| renderer.record(commands, 0, inputs, &outputs)).expect("recorded and run");
    gpu.pixels(frame, 0).expect("pixels").values
}

/// Each input in each format, the others in images; then all at once, in one buffer, rows apart.
#[test]
fn buffers_are_lit_as_images_are() {
    let mut device = Device::new();
    let scene = scene();
    let contents = plan::picture_inputs(&scene);
    let gpu = device.gpu.as_mut().expect("alive");
    let plan = planned(gpu, &scene);
    let mut frame = framed(gpu, &scene);
    gpu.draw(&mut frame).expect("drawn");
    let right = gpu.pixels(&frame, 0).expect("pixels").values;
    let names: Vec<String> = plan.inputs().map(|(_, r)| r.name.clone()).collect();
    assert_eq!(names, ["heights", "environment", "albedo"]);
    let images: Vec<InputArg> = frame.inputs().into_iter().map(InputArg::Image).collect();
    let mut drawn = Vec::new();
    for (which, name) in names.iter().enumerate() {
        for &format in texels(name) {
            let plan = taking(&plan, name, format);
            let own = plan.find(name).map(|id| plan.resources[id.0].bytes()).expect("an input");
            let made = Renderer::new(gpu.host(), plan.clone(), 1);
            let mut renderer = match made {
                Ok(renderer) => renderer,
                // Vulkan requires every format but this.
                Err(error) if format == Format::R16Unorm => {
                    assert!(error.to_string().contains("heights: texels"), "{error}");
                    continue;
                }
                Err(error) => panic!("{name} {format:?}: {error}"),
            };
            let bytes = packed(&contents[which], format.vk());
            assert_eq!(bytes.len() as u64, own, "{name} {format:?}");
            let lent = Staging::new(gpu.host(), &bytes);
            let mut given = images.clone();
            given[which] = lent.arg().into();
            let lit = drawn_over(gpu, &mut frame, &mut renderer, &given);
            assert!(lit == right, "{name} {format:?}");
            drawn.push(format);
            renderer.destroy();
            lent.end(gpu.host());
        }
    }
    println!("{drawn:?}");
    assert!(drawn.len() >= 2 + 4 + 4, "{drawn:?}");

    // One buffer: each input after the last, from an offset of whole texels, three texels between rows.
    let mut all = plan.clone();
    let mut bytes = vec![0xff_u8; 16];
    let mut places = Vec::new();
    for ((_, resource), values) in plan.inputs().zip(&contents) {
        let Kind::Image { format, width, .. } = resource.kind else { panic!("{}", resource.name) };
        all.take_buffer(&resource.name, format).expect("an input");
        let row = format.bytes() as usize * width as usize;
        let apart = 3 * format.bytes() as usize;
        places.push((bytes.len() as u64, (row + apart) as u64));
        for line in packed(values, format.vk()).chunks(row) {
            bytes.extend(line);
            bytes.resize(bytes.len() + apart, 0xff);
        }
        bytes.resize(bytes.len().next_multiple_of(16), 0xff);
    }
    assert_eq!(all.internal_bytes(), plan.internal_bytes() + input_bytes(&plan));
    let lent = Staging::new(gpu.host(), &bytes);
    let whole = lent.arg();
    let given: Vec<BufferArg> = places
        .into_iter()
        .map(|(offset, row_bytes)| BufferArg { offset, row_bytes, ..whole })
        .collect();
    let mut renderer = Renderer::new(gpu.host(), all, 2).expect("a renderer");
    let of_buffers: Vec<InputArg> = given.iter().map(|arg| (*arg).into()).collect();
    assert!(drawn_over(gpu, &mut frame, &mut renderer, &of_buffers) == right, "one buffer");
    // And again into the same images, two recordings in one command buffer.
    let outputs = frame.outputs();
    gpu.run(|commands| {
        renderer.record(commands, 0, &given, &outputs)?;
        renderer.record_passes(commands, 1, &given, &outputs, &[0])
    })
    .expect("recorded and run");
    assert!(gpu.pixels(&frame, 0).expect("pixels").values == right, "again");
    renderer.destroy();
    lent.end(gpu.host());
    gpu.end(frame);
}

fn input_bytes(plan: &Plan) -> u64 {
    plan.inputs().map(|(_, r)| r.bytes()).sum()
}

/// Each buffer that `record` refuses, by field, with nothing recorded: a command in a null command buffer would crash.
#[test]
fn wrong_buffers_are_refused_by_name() {
    let mut device = Device::new();
    let scene = scene();
    let gpu = device.gpu.as_mut().expect("alive");
    let plan = planned(gpu, &scene);
    let frame = framed(gpu, &scene);
    let [cols, rows] = [plan.size[0], plan.size[1]].map(u64::from);
    let count = (cols * rows * 4) as usize;
    let lent = Staging::new(gpu.host(), &vec![0; count]);
    let right = lent.arg();
    let mut plan_of_buffer = taking(&plan, "heights", Format::R32Float);
    let mut renderer = Renderer::new(gpu.host(), plan_of_buffer.clone(), 1).expect("a renderer");
    let images: Vec<InputArg> = frame.inputs().into_iter().map(InputArg::Image).collect();
    let outputs = frame.outputs();
    let mut refuse = |input: InputArg, says: &str| {
        let mut given = images.clone();
        given[0] = input;
        let refused = renderer.record(vk::CommandBuffer::null(), 0, &given, &outputs);
        let error = refused.expect_err(says).to_string();
        assert!(error.contains(says), "{error} does not say {says}");
    };
    type Spoil = fn(&mut BufferArg);
    let none = vk::PipelineStageFlags2::NONE;
    let spoils: [(&str, Spoil); 9] = [
        ("heights: buffer: found null", |arg| arg.buffer = vk::Buffer::null()),
        ("heights: offset: found 2 bytes", |arg| arg.offset = 2),
        ("heights: bytes: found", |arg| arg.offset = 4),
        ("heights: bytes: found", |arg| arg.bytes -= 1),
        ("heights: bytes: found", |arg| arg.offset = !3),
        ("heights: row_bytes: found 76 bytes", |arg| arg.row_bytes = 76),
        ("heights: row_bytes: found 82 bytes", |arg| arg.row_bytes = 82),
        ("heights: row_bytes: found 2147483648 bytes", |arg| arg.row_bytes = 1 << 31),
        ("heights: bytes: found 960, expected 1004", |arg| arg.row_bytes = 84),
    ];
    assert_eq!((cols, rows), (20, 12), "the numbers above");
    for (says, spoil) in spoils {
        let mut wrong = right;
        spoil(&mut wrong);
        refuse(wrong.into(), says);
    }
    refuse(BufferArg { stage: none, ..right }.into(), "heights: stage: found NONE, with access");
    refuse(images[0], "heights: found an image, expected a buffer");
    renderer.destroy();
    let mut of_images = Renderer::new(gpu.host(), plan.clone(), 1).expect("a renderer");
    let mut given = images.clone();
    given[0] = right.into();
    let refused = of_images.record(vk::CommandBuffer::null(), 0, &given, &outputs);
    let error = refused.expect_err("a buffer").to_string();
    assert!(error.contains("heights: found a buffer, expected an image"), "{error}");
    of_images.destroy();

    // Inputs that a plan cannot take in a buffer, and a frame with images of its own.
    for (input, texels, says) in [
        ("depths", Format::R32Float, "input: found depths, expected heights or environment"),
        ("radiance", Format::R32Float, "input: found radiance"),
        ("heights", Format::Rgba8Unorm, "heights: texels: found Rgba8Unorm, expected R32Float or"),
        ("albedo", Format::R16Float, "albedo: texels: found R16Float"),
    ] {
        let error = plan_of_buffer.take_buffer(input, texels).expect_err(says).to_string();
        assert!(error.contains(says), "{error} does not say {says}");
    }
    let contents = plan::picture_inputs(&scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let error = gpu.frame(plan_of_buffer, &contents).err().expect("no frame").to_string();
    assert!(error.contains("heights: found an input in a buffer"), "{error}");
    lent.end(gpu.host());
    gpu.end(frame);
}

/// An edit copies the edited rectangle, and a camera draws the copied heights.
#[test]
fn edits_and_cameras_go_on_from_what_was_copied() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut scene = under_sky(fractal(40, 3).expect("a field"), Border::Plane);
    let quality = Quality { azimuths: 8, ..Quality::default() };
    let limits = crate::limits_of(gpu);
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    scene.lights.sky = Some([1.0, 0.5, 0.25]);
    let plan = plan::picture(&scene, &quality, &limits, wanted).expect("a plan");
    assert!(!plan.edit_passes.is_empty());
    let heights = scene.field.heights_m().to_vec();
    let mut frame = gpu.frame(plan.clone(), &[&heights]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let before = gpu.pixels(&frame, 0).expect("pixels").values;
    let edited = Rectangle { col: 9, row: 21, cols: 5, rows: 3 };
    let mut raised = heights.clone();
    for row in 21..24 {
        raised[row * 40 + 9..][..5].iter_mut().for_each(|h| *h += 2.0);
    }
    gpu.refill(&frame, 0, &raised).expect("raised");
    gpu.draw(&mut frame).expect("drawn");
    let after = gpu.pixels(&frame, 0).expect("pixels").values;
    assert!(before != after);

    let bytes = |values: &[f32]| packed_floats(values);
    let lent = Staging::new(gpu.host(), &bytes(&heights));
    let taken = taking(&plan, "heights", Format::R32Float);
    assert!(taken.resources.iter().any(|r| r.owner == Owner::InputBuffer));
    let mut renderer = Renderer::new(gpu.host(), taken, 2).expect("a renderer");
    let (given, outputs) = ([lent.arg()], frame.outputs());
    gpu.run(|commands| renderer.record(commands, 0, &given, &outputs)).expect("run");
    assert!(gpu.pixels(&frame, 0).expect("pixels").values == before);
    // The rest of the buffer has lost its heights: nothing reads it.
    let mut alone = vec![f32::NAN; heights.len()];
    for row in 21..24 {
        let at = row * 40 + 9;
        alone[at..at + 5].copy_from_slice(&raised[at..at + 5]);
    }
    lent.fill(gpu.host(), &bytes(&alone));
    gpu.run(|commands| renderer.record_edit(commands, 0, &given, &outputs, edited)).expect("run");
    assert!(gpu.pixels(&frame, 0).expect("pixels").values == after, "the edit");

    let options = ViewOptions { size: SIZE, samples: 1, ..ViewOptions::default() };
    let lens = Lens::Perspective { fov_rad: 0.7 };
    let camera = Camera::around(&scene.field, None, [1.0, 0.6], lens, options.aspect());
    let view = View::new(&scene, &plan, &camera, &options, &limits).expect("a view");
    let by_image = gpu.look(&frame, &view, None).expect("a picture").radiance;
    let copied = renderer.taken("heights").expect("an image");
    let radiance = frame.outputs()[0];
    let inputs = ViewInputs { heights: copied, radiance, environment: None, voids: None };
    let host = gpu.host().clone();
    let target = Target::new(&host);
    let mut looking = ViewRenderer::new(&host, &view, FORMAT, 1).expect("a renderer");
    // Copied, viewed, and copied again: each waits for the other.
    lent.fill(gpu.host(), &bytes(&raised));
    gpu.run(|commands| {
        renderer.record(commands, 0, &given, &outputs)?;
        let drawn = ViewOutputs { picture: target.arg(), depth: None };
        looking.record(commands, 0, (&view, 1.0), &inputs, &drawn)?;
        target.copy(&host, commands);
        renderer.record(commands, 1, &given, &outputs)
    })
    .expect("run");
    assert!(target.texels(&host) == by_image);
    looking.destroy();
    target.end(&host);
    assert!(renderer.taken("albedo").is_none());
    renderer.destroy();
    lent.end(gpu.host());
    gpu.end(frame);
}

fn packed_floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_ne_bytes()).collect()
}

//! Views into an engine's own images: two frames in flight, lit and drawn in the same command buffers.

use ash::vk;
use ridgelight::gpu::{Host, ImageArg, ImageState, ViewInputs, ViewOutputs, ViewRenderer};
use ridgelight::plan::{self, Picture, View, ViewOptions};
use ridgelight::scene::{Border, Camera, Lens, Quality};

use crate::{Device, field, under_sky};

const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const SIZE: [u32; 2] = [20, 12];
const BYTES: usize = 20 * 12 * 16;

/// An image that an engine has drawn into, and a buffer to look at it.
struct Target {
    image: vk::Image,
    view: vk::ImageView,
    buffer: vk::Buffer,
    memory: [vk::DeviceMemory; 2],
}

fn memory(
    host: &Host,
    needs: vk::MemoryRequirements,
    flags: vk::MemoryPropertyFlags,
) -> vk::DeviceMemory {
    // SAFETY: the physical device is the instance's.
    let all = unsafe { host.instance.get_physical_device_memory_properties(host.physical_device) };
    let is_fit = |i: &u32| {
        let has = all.memory_types[*i as usize].property_flags.contains(flags);
        needs.memory_type_bits & (1 << i) != 0 && has
    };
    let index = (0..all.memory_type_count).find(is_fit).expect("memory");
    let info =
        vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(index);
    // SAFETY: the device is alive.
    unsafe { host.device.allocate_memory(&info, None) }.expect("memory")
}

impl Target {
    fn new(host: &Host) -> Self {
        let [width, height] = SIZE;
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(FORMAT)
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC);
        let bytes = vk::BufferCreateInfo::default()
            .size(BYTES as u64)
            .usage(vk::BufferUsageFlags::TRANSFER_DST);
        let device = &host.device;
        // SAFETY: what is made here is of the device, bound once and destroyed by `end`.
        unsafe {
            let image = device.create_image(&info, None).expect("an image");
            let needs = device.get_image_memory_requirements(image);
            let of_image = memory(host, needs, vk::MemoryPropertyFlags::empty());
            device.bind_image_memory(image, of_image, 0).expect("bound");
            let view = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(FORMAT)
                .subresource_range(range());
            let view = device.create_image_view(&view, None).expect("a view");
            let buffer = device.create_buffer(&bytes, None).expect("a buffer");
            let needs = device.get_buffer_memory_requirements(buffer);
            let seen =
                vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
            let of_buffer = memory(host, needs, seen);
            device.bind_buffer_memory(buffer, of_buffer, 0).expect("bound");
            Self { image, view, buffer, memory: [of_image, of_buffer] }
        }
    }

    fn arg(&self) -> ImageArg {
        let before = ImageState {
            stage: vk::PipelineStageFlags2::NONE,
            access: vk::AccessFlags2::NONE,
            layout: vk::ImageLayout::UNDEFINED,
        };
        let after = ImageState {
            stage: vk::PipelineStageFlags2::COPY,
            access: vk::AccessFlags2::TRANSFER_READ,
            layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
        };
        let (image, view, extent) = (self.image, self.view, [SIZE[0], SIZE[1], 1]);
        ImageArg { image, view, format: FORMAT, extent, before, after }
    }

    fn copy(&self, host: &Host, commands: vk::CommandBuffer) {
        let layers = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            layer_count: 1,
            ..Default::default()
        };
        let [width, height] = SIZE;
        let region = [vk::BufferImageCopy::default()
            .image_subresource(layers)
            .image_extent(vk::Extent3D { width, height, depth: 1 })];
        let written = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::COPY)
            .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::HOST)
            .dst_access_mask(vk::AccessFlags2::HOST_READ)];
        let written = vk::DependencyInfo::default().memory_barriers(&written);
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        // SAFETY: `commands` is being recorded, the image left for copies; the buffer holds its texels.
        unsafe {
            host.device.cmd_copy_image_to_buffer(
                commands,
                self.image,
                layout,
                self.buffer,
                &region,
            );
            host.device.cmd_pipeline_barrier2(commands, &written);
        }
    }

    fn texels(&self, host: &Host) -> Vec<[f32; 3]> {
        let (memory, flags) = (self.memory[1], vk::MemoryMapFlags::empty());
        // SAFETY: the queue is idle; the memory is mapped here alone, and as long as the buffer.
        let bytes = unsafe {
            let at = host.device.map_memory(memory, 0, vk::WHOLE_SIZE, flags).expect("mapped");
            let bytes = std::slice::from_raw_parts(at.cast::<u8>(), BYTES).to_vec();
            host.device.unmap_memory(memory);
            bytes
        };
        let values: Vec<f32> = bytemuck::pod_collect_to_vec(&bytes);
        values.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect()
    }

    fn end(self, host: &Host) {
        let device = &host.device;
        // SAFETY: made here, no longer used.
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.image, None);
            device.destroy_buffer(self.buffer, None);
            self.memory.into_iter().for_each(|memory| device.free_memory(memory, None));
        }
    }
}

fn range() -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        level_count: 1,
        layer_count: 1,
        ..Default::default()
    }
}

/// Two slots, each lit and drawn from another place into an image of its own, submitted as one: each is what the same
/// view draws alone. Synchronisation validation looks from one command buffer to the next.
#[test]
fn two_views_in_flight_are_what_each_is_alone() {
    let mut device = Device::new();
    let heights = field(18, 16, [1.0, 1.0], |r, c| ((r * 31 + c * 17) % 7) as f64 * 0.3);
    let scene = under_sky(heights, Border::Plane);
    let quality = Quality { azimuths: 4, ..Quality::default() };
    let limits = device.limits();
    let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
    let options = ViewOptions { size: SIZE, samples: 4, ..ViewOptions::default() };
    let views = [0.3, 2.0].map(|azimuth| {
        let lens = Lens::Perspective { fov_rad: 0.8 };
        let camera = Camera::around(&scene.field, None, [azimuth, 0.6], lens, options.aspect());
        View::new(&scene, &plan, &camera, &options, &limits).expect("a view")
    });
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = gpu.frame(plan, &[scene.field.heights_m()]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let alone = views.each_ref().map(|v| gpu.look(&frame, v, None).expect("a picture").radiance);
    assert!(alone[0] != alone[1]);
    let host = gpu.host().clone();
    let targets = [Target::new(&host), Target::new(&host)];
    let mut renderer = ViewRenderer::new(&host, &views[0], FORMAT, 2).expect("a renderer");
    let (heights, radiance) = (frame.inputs()[0], frame.outputs()[0]);
    let inputs = ViewInputs { heights, radiance, environment: None, voids: None };
    let (lit_inputs, lit_outputs) = (frame.inputs(), frame.outputs());
    type Record<'a> = Box<dyn FnOnce(vk::CommandBuffer) -> ridgelight::Result<()> + 'a>;
    let shared = std::cell::RefCell::new((&mut renderer, frame.renderer()));
    let records = (0..2).map(|slot| -> Record<'_> {
        let (shared, views, targets, host) = (&shared, &views, &targets, &host);
        let (inputs, lit_inputs, lit_outputs) = (&inputs, &lit_inputs, &lit_outputs);
        Box::new(move |commands| {
            let (renderer, lit) = &mut *shared.borrow_mut();
            // The frame's renderer has one slot: it is recorded once.
            if slot == 0 {
                lit.record(commands, 0, lit_inputs, lit_outputs)?;
            }
            let outputs = ViewOutputs { picture: targets[slot].arg(), depth: None };
            renderer.record(commands, slot, (&views[slot], 1.0), inputs, &outputs)?;
            targets[slot].copy(host, commands);
            Ok(())
        })
    });
    gpu.run_all(records.collect::<Vec<_>>()).expect("both");
    for (target, alone) in targets.iter().zip(&alone) {
        assert!(target.texels(&host) == *alone, "another picture in flight");
    }
    if device.report().timestamp_period_ns > 0.0 {
        for slot in 0..2 {
            let labels = renderer.timings(slot).expect("times").into_iter().map(|t| t.label);
            assert_eq!(labels.collect::<Vec<_>>(), ["terrain_draw", "sky_draw"]);
        }
    }
    renderer.destroy();
    targets.into_iter().for_each(|target| target.end(&host));
    device.gpu.as_mut().expect("alive").end(frame);
}

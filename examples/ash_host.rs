//! Ridgelight in a Vulkan program of its own, by `ash`. docs/embedding.md shows the first half, which is what an
//! engine writes; the second stands for the engine. `ash_host OUT [FRAMES]` writes the light of every texel in the last
//! frame, row by row, as floats. A test runs it under validation.

use ash::vk;
use ridgelight::gpu::{self, Host, ImageArg, ImageState, Renderer};
use ridgelight::plan::{self, Picture};
use ridgelight::scene::{Quality, Scene};

/// Once per scene: plans, and creates the plan's resources on the engine's device, for two frames in flight.
pub fn prepare(host: &Host, scene: &Scene) -> ridgelight::Result<Renderer> {
    let limits = gpu::limits(&host.instance, host.physical_device);
    let plan = plan::picture(scene, &Quality::for_scene(scene, None), &limits, Picture::default())?;
    Renderer::new(host, plan, 2)
}

/// Each frame, in the engine's command buffer: reads heights from an image that a copy has filled, and writes light
/// to another that a copy will read. Both are R32F because all colours are grey; otherwise the light is RGBA32F.
pub fn record(
    renderer: &mut Renderer,
    commands: vk::CommandBuffer,
    frame_in_flight: usize,
    heights: (vk::Image, vk::ImageView),
    light: (vk::Image, vk::ImageView),
) -> ridgelight::Result<()> {
    let [cols, rows] = renderer.plan().size;
    let arg = |(image, view), before, after| {
        let (format, extent) = (vk::Format::R32_SFLOAT, [cols, rows, 1]);
        ImageArg { image, view, format, extent, before, after }
    };
    let inputs = [arg(heights, FILLED, FILLED)];
    let outputs = [arg(light, REUSED, COPIED)];
    renderer.record(commands, frame_in_flight, &inputs, &outputs)
}

/// The states of the images before the recording, and of the light after it. An earlier frame's copy may still read the
/// light: its state before names that copy, and drops the contents.
const FILLED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::COPY,
    access: vk::AccessFlags2::TRANSFER_WRITE,
    layout: vk::ImageLayout::TRANSFER_DST_OPTIMAL,
};
const REUSED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::COPY,
    access: vk::AccessFlags2::NONE,
    layout: vk::ImageLayout::UNDEFINED,
};
const COPIED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::COPY,
    access: vk::AccessFlags2::TRANSFER_READ,
    layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
};

// What follows an engine has already.

use ridgelight::gpu::{Allocation, Allocator, Blocks, MemoryRequest, MemoryUse};

#[path = "host/scene.rs"]
mod host_scene;
pub use host_scene::{COLS, ROWS, frames, scene};

type Any<T> = Result<T, Box<dyn std::error::Error>>;

const EXTENT: vk::Extent3D = vk::Extent3D { width: COLS as u32, height: ROWS as u32, depth: 1 };

/// An instance and a device with what Ridgelight needs, and its queue.
fn host(entry: &ash::Entry) -> Any<(Host, vk::Queue)> {
    let needs = gpu::requirements();
    let app = vk::ApplicationInfo::default().api_version(needs.api_version);
    let instance_info = vk::InstanceCreateInfo::default().application_info(&app);
    // SAFETY: the loader stays loaded; all structs live across their calls.
    unsafe {
        let instance = entry.create_instance(&instance_info, None)?;
        let physical_device = instance.enumerate_physical_devices()?[0];
        let families = instance.get_physical_device_queue_family_properties(physical_device);
        let family = families.iter().position(|f| f.queue_flags.contains(needs.queue_flags));
        let queue_family = family.ok_or("no queue for compute")? as u32;
        let queue = vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family);
        let queues = [queue.queue_priorities(&[1.0])];
        let device_info = vk::DeviceCreateInfo::default().queue_create_infos(&queues);
        let device = instance.create_device(physical_device, &device_info, None)?;
        let queue = device.get_device_queue(queue_family, 0);
        let pipeline_cache = vk::PipelineCache::null();
        let debug_utils = None;
        Ok((
            Host { instance, physical_device, device, queue_family, pipeline_cache, debug_utils },
            queue,
        ))
    }
}

struct Image {
    image: vk::Image,
    view: vk::ImageView,
    memory: Allocation,
}

fn image(host: &Host, blocks: &mut Blocks, usage: vk::ImageUsageFlags) -> Any<Image> {
    let info = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(vk::Format::R32_SFLOAT)
        .extent(EXTENT)
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(usage);
    // SAFETY: the device is alive; the memory is the image's own.
    unsafe {
        let image = host.device.create_image(&info, None)?;
        let requirements = host.device.get_image_memory_requirements(image);
        let (used_by, is_linear) = (MemoryUse::Device, false);
        let request = MemoryRequest { name: "image", requirements, used_by, is_linear };
        let memory = blocks.allocate(&request)?;
        host.device.bind_image_memory(image, memory.memory, memory.offset)?;
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(vk::Format::R32_SFLOAT)
            .subresource_range(WHOLE);
        let view = host.device.create_image_view(&info, None)?;
        Ok(Image { image, view, memory })
    }
}

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};
const LAYER: vk::ImageSubresourceLayers = vk::ImageSubresourceLayers {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    mip_level: 0,
    base_array_layer: 0,
    layer_count: 1,
};

/// Draws `frames` frames. Each copies heights to an image, records Ridgelight, and copies the light back to the host.
fn draw(
    host: &Host,
    queue: vk::Queue,
    blocks: &mut Blocks,
    scene: &Scene,
    frames: u32,
) -> Any<Vec<f32>> {
    let device = &host.device;
    let (from, to) = (vk::ImageUsageFlags::TRANSFER_SRC, vk::ImageUsageFlags::TRANSFER_DST);
    let heights = image(host, blocks, vk::ImageUsageFlags::SAMPLED | to)?;
    let light =
        image(host, blocks, vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED | from)?;
    let mut renderer = prepare(host, scene)?;
    let size = 4 * (ROWS * COLS) as u64;
    let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    let buffer_info = vk::BufferCreateInfo::default().size(2 * size).usage(usage);
    let pool_info = vk::CommandPoolCreateInfo::default().queue_family_index(host.queue_family);
    let texel_copy = vk::BufferImageCopy::default().image_subresource(LAYER).image_extent(EXTENT);
    let (filled_from, read_to) = ([texel_copy], [texel_copy.buffer_offset(size)]);
    let filling = [vk::ImageMemoryBarrier::default()
        .image(heights.image)
        .subresource_range(WHOLE)
        .dst_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .new_layout(FILLED.layout)];
    let reading = [vk::MemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .dst_access_mask(vk::AccessFlags::HOST_READ)];
    let [top, transfer, to_host] = [
        vk::PipelineStageFlags::TOP_OF_PIPE,
        vk::PipelineStageFlags::TRANSFER,
        vk::PipelineStageFlags::HOST,
    ];
    let none = vk::DependencyFlags::empty();
    // SAFETY: all handles are alive, and are destroyed when the queue has done all its work.
    unsafe {
        let buffer = device.create_buffer(&buffer_info, None)?;
        let requirements = device.get_buffer_memory_requirements(buffer);
        let (used_by, is_linear) = (MemoryUse::Upload, true);
        let request = MemoryRequest { name: "texels", requirements, used_by, is_linear };
        let memory = blocks.allocate(&request)?;
        device.bind_buffer_memory(buffer, memory.memory, memory.offset)?;
        let texels = memory.mapped.ok_or("not mapped")?.cast::<f32>().as_ptr();
        texels.copy_from(scene.field.heights_m().as_ptr(), ROWS * COLS);

        let pool = device.create_command_pool(&pool_info, None)?;
        let commands_info = vk::CommandBufferAllocateInfo::default().command_pool(pool);
        let commands = device.allocate_command_buffers(&commands_info.command_buffer_count(1))?[0];
        for _ in 0..frames {
            texels.add(ROWS * COLS).write_bytes(0, ROWS * COLS);
            device.reset_command_pool(pool, vk::CommandPoolResetFlags::empty())?;
            device.begin_command_buffer(commands, &vk::CommandBufferBeginInfo::default())?;
            device.cmd_pipeline_barrier(commands, top, transfer, none, &[], &[], &filling);
            let (to, from) = (FILLED.layout, COPIED.layout);
            device.cmd_copy_buffer_to_image(commands, buffer, heights.image, to, &filled_from);
            let (read, written) = ((heights.image, heights.view), (light.image, light.view));
            record(&mut renderer, commands, 0, read, written)?;
            device.cmd_copy_image_to_buffer(commands, light.image, from, buffer, &read_to);
            device.cmd_pipeline_barrier(commands, transfer, to_host, none, &reading, &[], &[]);
            device.end_command_buffer(commands)?;
            let submitted = [commands];
            let submit = [vk::SubmitInfo::default().command_buffers(&submitted)];
            device.queue_submit(queue, &submit, vk::Fence::null())?;
            device.queue_wait_idle(queue)?;
        }
        let lit = std::slice::from_raw_parts(texels.add(ROWS * COLS), ROWS * COLS).to_vec();

        renderer.destroy();
        device.destroy_command_pool(pool, None);
        device.destroy_buffer(buffer, None);
        blocks.free(memory);
        for image in [heights, light] {
            device.destroy_image_view(image.view, None);
            device.destroy_image(image.image, None);
            blocks.free(image.memory);
        }
        Ok(lit)
    }
}

/// Draws `frames` frames. Returns the light of every texel in the last one, row by row.
pub fn lit(frames: u32) -> Any<Vec<f32>> {
    // SAFETY: the system's Vulkan loader, whose initialisers are meant to run.
    let entry = unsafe { ash::Entry::load() }?;
    let (host, queue) = host(&entry)?;
    let mut blocks = Blocks::new(&host)?;
    let lit = draw(&host, queue, &mut blocks, &scene()?, frames);
    drop(blocks);
    // SAFETY: nothing is left that was made on them.
    unsafe {
        host.device.destroy_device(None);
        host.instance.destroy_instance(None);
    }
    lit
}

fn main() -> Any<()> {
    let mut args = std::env::args_os().skip(1);
    let out = args.next().ok_or("usage: ash_host OUT [FRAMES]")?;
    let lit = lit(frames(args.next())?)?;
    let bytes: Vec<u8> = lit.iter().flat_map(|value| value.to_ne_bytes()).collect();
    Ok(std::fs::write(out, bytes)?)
}

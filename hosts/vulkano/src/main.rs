//! Ridgelight in a vulkano program: on vulkano's device, with its images, buffers and command buffer.
//! `ridgelight-vulkano-host OUT.exr [FRAMES]` writes the light of the last frame. `hosts/vulkano/check` runs it.

use std::sync::Arc;

use ash::vk;
use ridgelight::gpu::{self, Host};
use ridgelight_io as files;
use ridgelight_io::{Channels, Layer};
use vulkano::buffer::{Buffer, BufferCreateInfo, BufferUsage, Subbuffer};
use vulkano::command_buffer::allocator::StandardCommandBufferAllocator;
use vulkano::command_buffer::{CommandBufferBeginInfo, CommandBufferLevel, RecordingCommandBuffer};
use vulkano::device::{Device, DeviceCreateInfo, Queue, QueueCreateInfo, QueueFlags};
use vulkano::format::Format;
use vulkano::image::view::ImageView;
use vulkano::image::{Image, ImageCreateInfo, ImageUsage as Usage};
use vulkano::instance::{Instance, InstanceCreateInfo};
use vulkano::memory::allocator::{AllocationCreateInfo, MemoryTypeFilter, StandardMemoryAllocator};
use vulkano::{Version, VulkanLibrary, VulkanObject};

#[expect(dead_code, reason = "of the host by ash only what an engine writes, and its scene")]
#[path = "../../../examples/ash_host.rs"]
mod ash_host;
use ash_host::{COLS, ROWS};

type Any<T> = Result<T, Box<dyn std::error::Error>>;

/// vulkano's device as Ridgelight borrows it.
fn host(device: &Device, queue: &Queue) -> Any<Host> {
    let (instance, physical_device) = (device.instance(), device.physical_device().handle());
    // SAFETY: the loader is vulkano's own, and the handles live as long as vulkano's objects, which outlive the host.
    unsafe {
        let entry = ash::Entry::load()?;
        let instance = ash::Instance::load(entry.static_fn(), instance.handle());
        let lacks = gpu::missing(&instance, physical_device);
        if !lacks.is_empty() {
            return Err(format!("the device lacks {}", lacks.join(", ")).into());
        }
        let device = ash::Device::load(instance.fp_v1_0(), device.handle());
        let queue_family = queue.queue_family_index();
        let pipeline_cache = vk::PipelineCache::null();
        let debug_utils = None;
        Ok(Host { instance, physical_device, device, queue_family, pipeline_cache, debug_utils })
    }
}

fn image(memory: &Arc<StandardMemoryAllocator>, usage: Usage) -> Any<Arc<ImageView>> {
    let extent = [COLS as u32, ROWS as u32, 1];
    let info = ImageCreateInfo { format: Format::R32_SFLOAT, extent, usage, ..Default::default() };
    let image = Image::new(memory.clone(), info, AllocationCreateInfo::default())?;
    Ok(ImageView::new_default(image)?)
}

fn texels(memory: &Arc<StandardMemoryAllocator>, values: &[f32]) -> Any<Subbuffer<[f32]>> {
    let usage = BufferUsage::TRANSFER_SRC | BufferUsage::TRANSFER_DST;
    let info = BufferCreateInfo { usage, ..Default::default() };
    let memory_type_filter = MemoryTypeFilter::PREFER_HOST | MemoryTypeFilter::HOST_RANDOM_ACCESS;
    let of_memory = AllocationCreateInfo { memory_type_filter, ..Default::default() };
    Ok(Buffer::from_iter(memory.clone(), info, of_memory, values.iter().copied())?)
}

fn main() -> Any<()> {
    let mut args = std::env::args_os().skip(1);
    let out = args.next().ok_or("usage: ridgelight-vulkano-host OUT.exr [FRAMES]")?;
    let frames = ash_host::frames(args.next())?;
    let info = InstanceCreateInfo { max_api_version: Some(Version::V1_1), ..Default::default() };
    let instance = Instance::new(VulkanLibrary::new()?, info)?;
    let physical_device = instance.enumerate_physical_devices()?.next().ok_or("no device")?;
    let families = physical_device.queue_family_properties();
    let family = families.iter().position(|f| f.queue_flags.contains(QueueFlags::COMPUTE));
    let queue_family_index = family.ok_or("no queue for compute")? as u32;
    let queue_info = QueueCreateInfo { queue_family_index, ..Default::default() };
    let info = DeviceCreateInfo { queue_create_infos: vec![queue_info], ..Default::default() };
    let (device, mut queues) = Device::new(physical_device, info)?;
    let queue = queues.next().ok_or("no queue")?;
    let memory = Arc::new(StandardMemoryAllocator::new_default(device.clone()));

    let scene = ash_host::scene()?;
    let host = host(&device, &queue)?;
    let mut renderer = ash_host::prepare(&host, &scene)?;
    let heights = image(&memory, Usage::SAMPLED | Usage::TRANSFER_DST)?;
    let light = image(&memory, Usage::STORAGE | Usage::SAMPLED | Usage::TRANSFER_SRC)?;
    let [filled_from, read_to] =
        [texels(&memory, scene.field.heights_m())?, texels(&memory, &[0.0; ROWS * COLS])?];

    let pool = Arc::new(StandardCommandBufferAllocator::new(device.clone(), Default::default()));
    let handles = |view: &Arc<ImageView>| (view.image().handle(), view.handle());
    let layers = vk::ImageSubresourceLayers {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        layer_count: 1,
        ..Default::default()
    };
    let image_extent = vk::Extent3D { width: COLS as u32, height: ROWS as u32, depth: 1 };
    let region = |texels: &Subbuffer<[f32]>| {
        let buffer_offset = texels.offset();
        let image_subresource = layers;
        [vk::BufferImageCopy {
            buffer_offset,
            image_subresource,
            image_extent,
            ..Default::default()
        }]
    };
    let whole = vk::ImageSubresourceRange {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        level_count: 1,
        layer_count: 1,
        ..Default::default()
    };
    let (to, from) = (vk::ImageLayout::TRANSFER_DST_OPTIMAL, vk::ImageLayout::TRANSFER_SRC_OPTIMAL);
    let filling = [vk::ImageMemoryBarrier::default()
        .image(handles(&heights).0)
        .subresource_range(whole)
        .dst_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .new_layout(to)];
    let reading = [vk::MemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .dst_access_mask(vk::AccessFlags::HOST_READ)];
    let [top, copy, to_host] = [
        vk::PipelineStageFlags::TOP_OF_PIPE,
        vk::PipelineStageFlags::TRANSFER,
        vk::PipelineStageFlags::HOST,
    ];
    let (ash, none) = (&host.device, vk::DependencyFlags::empty());
    let [read, written] = [&filled_from, &read_to].map(|texels| texels.buffer().handle());
    for _ in 0..frames {
        read_to.write()?.fill(0.0);
        let (begin, level) = (CommandBufferBeginInfo::default(), CommandBufferLevel::Primary);
        let recording =
            RecordingCommandBuffer::new(pool.clone(), queue_family_index, level, begin)?;
        let commands = recording.handle();
        // SAFETY: all handles are alive until the queue is idle; images are in the layouts that the barriers state.
        unsafe {
            ash.cmd_pipeline_barrier(commands, top, copy, none, &[], &[], &filling);
            ash.cmd_copy_buffer_to_image(
                commands,
                read,
                handles(&heights).0,
                to,
                &region(&filled_from),
            );
            ash_host::record(&mut renderer, commands, 0, handles(&heights), handles(&light))?;
            ash.cmd_copy_image_to_buffer(
                commands,
                handles(&light).0,
                from,
                written,
                &region(&read_to),
            );
            ash.cmd_pipeline_barrier(commands, copy, to_host, none, &reading, &[], &[]);
            let recorded = recording.end()?;
            let all = [recorded.handle()];
            let submit = [vk::SubmitInfo::default().command_buffers(&all)];
            queue.with(|mut locked| -> Any<()> {
                ash.queue_submit(queue.handle(), &submit, vk::Fence::null())?;
                Ok(locked.wait_idle()?)
            })?;
        }
    }
    let grey: Vec<[f32; 3]> = read_to.read()?.iter().map(|value| [*value; 3]).collect();
    let layer = Layer { name: String::new(), channels: Channels::Rgb(&grey) };
    files::write_exr(out.as_ref(), ROWS, COLS, &[layer], &[])?;
    renderer.destroy();
    Ok(())
}

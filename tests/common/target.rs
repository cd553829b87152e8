//! Images and buffers that an engine owns: for the tests of the core and of the C ABI.

use ash::vk;
use ridgelight::gpu::{BufferArg, Headless, Host, ImageArg, ImageState};

pub(crate) const FORMAT: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
pub(crate) const SIZE: [u32; 2] = [20, 12];
const BYTES: usize = 20 * 12 * 16;

/// An image that an engine draws into, and a buffer to read it back.
pub(crate) struct Target {
    image: vk::Image,
    view: vk::ImageView,
    buffer: vk::Buffer,
    memory: [vk::DeviceMemory; 2],
}

const MAPPED: vk::MemoryPropertyFlags = vk::MemoryPropertyFlags::from_raw(
    vk::MemoryPropertyFlags::HOST_VISIBLE.as_raw()
        | vk::MemoryPropertyFlags::HOST_COHERENT.as_raw(),
);

/// Best practices warn of a smaller block that one image fills.
pub const LEAST_BLOCK: u64 = 1 << 20;

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
    let info = vk::MemoryAllocateInfo::default()
        .allocation_size(needs.size.max(LEAST_BLOCK))
        .memory_type_index(index);
    // SAFETY: the device is alive.
    unsafe { host.device.allocate_memory(&info, None) }.expect("memory")
}

impl Target {
    pub(crate) fn new(host: &Host) -> Self {
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
            let of_buffer = memory(host, needs, MAPPED);
            device.bind_buffer_memory(buffer, of_buffer, 0).expect("bound");
            Self { image, view, buffer, memory: [of_image, of_buffer] }
        }
    }

    pub(crate) fn arg(&self) -> ImageArg {
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

    pub(crate) fn copy(&self, host: &Host, commands: vk::CommandBuffer) {
        let layers = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            layer_count: 1,
            ..Default::default()
        };
        let [width, height] = SIZE;
        let region = [vk::BufferImageCopy::default()
            .image_subresource(layers)
            .image_extent(vk::Extent3D { width, height, depth: 1 })];
        let written = [vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ)];
        let [copy, to_host] = [vk::PipelineStageFlags::TRANSFER, vk::PipelineStageFlags::HOST];
        let layout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;
        // SAFETY: `commands` is being recorded, the image is in the layout for copies; the buffer holds its texels.
        unsafe {
            host.device.cmd_copy_image_to_buffer(
                commands,
                self.image,
                layout,
                self.buffer,
                &region,
            );
            let none = vk::DependencyFlags::empty();
            host.device.cmd_pipeline_barrier(commands, copy, to_host, none, &written, &[], &[]);
        }
    }

    pub(crate) fn texels(&self, host: &Host) -> Vec<[f32; 3]> {
        let (memory, flags) = (self.memory[1], vk::MemoryMapFlags::empty());
        // SAFETY: the queue is idle; only this function maps the memory, and the buffer is as long.
        let bytes = unsafe {
            let at = host.device.map_memory(memory, 0, vk::WHOLE_SIZE, flags).expect("mapped");
            let bytes = std::slice::from_raw_parts(at.cast::<u8>(), BYTES).to_vec();
            host.device.unmap_memory(memory);
            bytes
        };
        let values: Vec<f32> =
            bytes.as_chunks::<4>().0.iter().map(|word| f32::from_ne_bytes(*word)).collect();
        values.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect()
    }

    pub(crate) fn end(self, host: &Host) {
        let device = &host.device;
        // SAFETY: made by `new`, no longer used.
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

/// An image of the engine that a renderer reads, in GENERAL.
pub(crate) struct Input {
    image: vk::Image,
    memory: vk::DeviceMemory,
    arg: ImageArg,
}

impl Input {
    /// Holds `texels`, row by row, packed as in Vulkan. `None` where the device cannot sample the format.
    pub(crate) fn new(
        gpu: &Headless,
        format: vk::Format,
        [width, height]: [u32; 2],
        texels: &[u8],
    ) -> Option<Self> {
        let host = gpu.host();
        let (device, physical) = (&host.device, host.physical_device);
        // SAFETY: the physical device is the instance's.
        let known =
            unsafe { host.instance.get_physical_device_format_properties(physical, format) };
        if !known.optimal_tiling_features.contains(vk::FormatFeatureFlags::SAMPLED_IMAGE) {
            return None;
        }
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST);
        // SAFETY: what is made here is of the device, bound once and destroyed by `end`.
        let (image, memory, view) = unsafe {
            let image = device.create_image(&info, None).expect("an image");
            let needs = device.get_image_memory_requirements(image);
            let memory = memory(host, needs, vk::MemoryPropertyFlags::empty());
            device.bind_image_memory(image, memory, 0).expect("bound");
            let view = vk::ImageViewCreateInfo::default()
                .image(image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(format)
                .subresource_range(range());
            (image, memory, device.create_image_view(&view, None).expect("a view"))
        };
        let (before, extent) = (ImageState::ANY_USE, [width, height, 1]);
        let arg = ImageArg { image, view, format, extent, before, after: before };
        let staging = Staging::new(host, texels);
        let layers = vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            layer_count: 1,
            ..Default::default()
        };
        let region = [vk::BufferImageCopy::default()
            .image_subresource(layers)
            .image_extent(vk::Extent3D { width, height, depth: 1 })];
        gpu.run(|commands| {
            let unknown = ImageState { layout: vk::ImageLayout::UNDEFINED, ..before };
            gpu.transition(commands, &ImageArg { before: unknown, ..arg });
            let (from, to) = (staging.buffer, vk::ImageLayout::GENERAL);
            // SAFETY: the image is in GENERAL, the buffer holds its texels.
            unsafe { device.cmd_copy_buffer_to_image(commands, from, image, to, &region) };
            gpu.transition(commands, &arg);
            Ok(())
        })
        .expect("filled");
        staging.end(host);
        Some(Self { image, memory, arg })
    }

    pub(crate) fn arg(&self) -> ImageArg {
        self.arg
    }

    pub(crate) fn end(self, host: &Host) {
        // SAFETY: made by `new`, no longer used.
        unsafe {
            host.device.destroy_image_view(self.arg.view, None);
            host.device.destroy_image(self.image, None);
            host.device.free_memory(self.memory, None);
        }
    }
}

/// A mapped buffer of the engine that a renderer copies from.
pub(crate) struct Staging {
    buffer: vk::Buffer,
    memory: vk::DeviceMemory,
    bytes: u64,
}

impl Staging {
    pub(crate) fn new(host: &Host, contents: &[u8]) -> Self {
        let (device, bytes) = (&host.device, contents.len() as u64);
        let info =
            vk::BufferCreateInfo::default().size(bytes).usage(vk::BufferUsageFlags::TRANSFER_SRC);
        // SAFETY: what is made here is of the device, bound once and destroyed by `end`.
        let (buffer, memory) = unsafe {
            let buffer = device.create_buffer(&info, None).expect("a buffer");
            let memory = memory(host, device.get_buffer_memory_requirements(buffer), MAPPED);
            device.bind_buffer_memory(buffer, memory, 0).expect("bound");
            (buffer, memory)
        };
        let made = Self { buffer, memory, bytes };
        made.fill(host, contents);
        made
    }

    /// Overwrites it; the device must not be using it.
    pub(crate) fn fill(&self, host: &Host, contents: &[u8]) {
        assert_eq!(contents.len() as u64, self.bytes);
        let flags = vk::MemoryMapFlags::empty();
        // SAFETY: the queue is idle; only this function maps the memory, which is as long.
        unsafe {
            let at = host.device.map_memory(self.memory, 0, vk::WHOLE_SIZE, flags).expect("mapped");
            let at = std::slice::from_raw_parts_mut(at.cast::<u8>(), contents.len());
            at.copy_from_slice(contents);
            host.device.unmap_memory(self.memory);
        }
    }

    pub(crate) fn arg(&self) -> BufferArg {
        let ImageState { stage, access, .. } = ImageState::ANY_USE;
        let (buffer, bytes) = (self.buffer, self.bytes);
        BufferArg { buffer, bytes, offset: 0, row_bytes: 0, stage, access }
    }

    pub(crate) fn end(self, host: &Host) {
        // SAFETY: made by `new`, no longer used.
        unsafe {
            host.device.destroy_buffer(self.buffer, None);
            host.device.free_memory(self.memory, None);
        }
    }
}

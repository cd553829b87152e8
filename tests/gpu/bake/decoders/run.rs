//! A decoder on the device: its texture, and its output.

use ash::vk;
use ridgelight::gpu::{Allocation, Allocator, Blocks, Headless, Host, MemoryRequest, MemoryUse};

use super::Decoder;

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: vk::REMAINING_ARRAY_LAYERS,
};

/// A buffer of texels or of values, which the host can reach.
struct Buffer {
    buffer: vk::Buffer,
    memory: Allocation,
}

impl Buffer {
    fn new(host: &Host, blocks: &mut Blocks, bytes: usize, is_read: bool) -> Self {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::STORAGE_BUFFER;
        let info = vk::BufferCreateInfo::default().size(bytes as u64).usage(usage);
        // SAFETY: the device is alive; the memory is the buffer's own.
        unsafe {
            let buffer = host.device.create_buffer(&info, None).expect("a buffer");
            let requirements = host.device.get_buffer_memory_requirements(buffer);
            let used_by = if is_read { MemoryUse::Readback } else { MemoryUse::Upload };
            let request = MemoryRequest { name: "texels", requirements, used_by, is_linear: true };
            let memory = blocks.allocate(&request).expect("memory");
            host.device.bind_buffer_memory(buffer, memory.memory, memory.offset).expect("bound");
            Self { buffer, memory }
        }
    }

    fn mapped(&self) -> *mut u8 {
        self.memory.mapped.expect("mapped").cast().as_ptr()
    }
}

/// The texture as an image of its own format, in any layout for sampling once it is filled.
fn image(
    host: &Host,
    blocks: &mut Blocks,
    header: &ktx2::Header,
    is_array: bool,
) -> (vk::Image, vk::ImageView, Allocation) {
    let format = vk::Format::from_raw(header.format.expect("a format").value() as i32);
    let info = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(format)
        .extent(vk::Extent3D { width: header.pixel_width, height: header.pixel_height, depth: 1 })
        .mip_levels(1)
        .array_layers(header.layer_count.max(1))
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST);
    assert_eq!(header.layer_count > 0, is_array);
    // SAFETY: the device is alive; the memory is the image's own.
    unsafe {
        let (instance, physical) = (&host.instance, host.physical_device);
        let about = instance.get_physical_device_format_properties(physical, format);
        let needed = vk::FormatFeatureFlags::SAMPLED_IMAGE;
        assert!(about.optimal_tiling_features.contains(needed), "{format:?} is not sampled here");
        let image = host.device.create_image(&info, None).expect("an image");
        let requirements = host.device.get_image_memory_requirements(image);
        let used_by = MemoryUse::Device;
        let request = MemoryRequest { name: "map", requirements, used_by, is_linear: false };
        let memory = blocks.allocate(&request).expect("memory");
        host.device.bind_image_memory(image, memory.memory, memory.offset).expect("bound");
        let kind =
            if is_array { vk::ImageViewType::TYPE_2D_ARRAY } else { vk::ImageViewType::TYPE_2D };
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(kind)
            .format(format)
            .subresource_range(WHOLE);
        let view = host.device.create_image_view(&info, None).expect("a view");
        (image, view, memory)
    }
}

/// Runs a decoder over a texture, at azimuths that many steps on, and returns its output.
pub(super) fn decode(
    gpu: &Headless,
    decoder: &Decoder,
    bits: &[u32],
    texture: &[u8],
    offset: f32,
) -> Vec<f32> {
    let host = gpu.host();
    let device = &host.device;
    let mut blocks = Blocks::new(host).expect("blocks");
    let reader = ktx2::Reader::new(texture).expect("a texture");
    let (header, texels) = (reader.header(), reader.levels().next().expect("a level").data);
    let (width, height) = (header.pixel_width, header.pixel_height);
    let grid_points = (width * height) as usize;
    let upload = Buffer::new(host, &mut blocks, texels.len(), false);
    let values = Buffer::new(host, &mut blocks, 4 * grid_points * decoder.planes, true);
    let (map, view, map_memory) = image(host, &mut blocks, &header, decoder.is_array);
    let entries: Vec<vk::SpecializationMapEntry> = (0..bits.len() as u32)
        .map(|i| vk::SpecializationMapEntry { constant_id: i, offset: 4 * i, size: 4 })
        .collect();
    let data: Vec<u8> = bits.iter().flat_map(|b| b.to_ne_bytes()).collect();
    let constants = vk::SpecializationInfo::default().map_entries(&entries).data(&data);
    let words: Vec<u32> =
        decoder.spirv.as_chunks::<4>().0.iter().map(|b| u32::from_ne_bytes(*b)).collect();
    let kinds = [vk::DescriptorType::COMBINED_IMAGE_SAMPLER, vk::DescriptorType::STORAGE_BUFFER];
    let bindings = [0, 1].map(|i| {
        vk::DescriptorSetLayoutBinding::default()
            .binding(i as u32)
            .descriptor_type(kinds[i])
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
    });
    let sizes = kinds.map(|ty| vk::DescriptorPoolSize::default().ty(ty).descriptor_count(1));
    let push_range =
        [vk::PushConstantRange { stage_flags: vk::ShaderStageFlags::COMPUTE, offset: 0, size: 12 }];
    let push: Vec<u8> =
        [width, height, offset.to_bits()].iter().flat_map(|word| word.to_ne_bytes()).collect();
    // Only the array's own layers and planes count: a decoder of an array runs once a plane.
    let depth = if decoder.is_array { decoder.planes as u32 } else { 1 };
    // SAFETY: all handles are alive, and are destroyed when the queue has done all its work (`run` waits).
    unsafe {
        upload.mapped().copy_from(texels.as_ptr(), texels.len());
        let sampler = vk::SamplerCreateInfo::default()
            .address_mode_u(vk::SamplerAddressMode::CLAMP_TO_EDGE)
            .address_mode_v(vk::SamplerAddressMode::CLAMP_TO_EDGE);
        let sampler = device.create_sampler(&sampler, None).expect("a sampler");
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        let set_layouts = [device.create_descriptor_set_layout(&info, None).expect("a layout")];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&set_layouts)
            .push_constant_ranges(&push_range);
        let layout = device.create_pipeline_layout(&info, None).expect("a layout");
        let info = vk::ShaderModuleCreateInfo::default().code(&words);
        let module = device.create_shader_module(&info, None).expect("a module");
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(c"main")
            .specialization_info(&constants);
        let info = [vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout)];
        let pipeline = device
            .create_compute_pipelines(vk::PipelineCache::null(), &info, None)
            .expect("a pipeline")[0];
        let info = vk::DescriptorPoolCreateInfo::default().max_sets(1).pool_sizes(&sizes);
        let pool = device.create_descriptor_pool(&info, None).expect("a pool");
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(pool)
            .set_layouts(&set_layouts);
        let set = device.allocate_descriptor_sets(&info).expect("a set")[0];
        let read = [vk::DescriptorImageInfo {
            sampler,
            image_view: view,
            image_layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
        }];
        let written =
            [vk::DescriptorBufferInfo { buffer: values.buffer, offset: 0, range: vk::WHOLE_SIZE }];
        let write = |i: usize| {
            vk::WriteDescriptorSet::default()
                .dst_set(set)
                .dst_binding(i as u32)
                .descriptor_type(kinds[i])
                .descriptor_count(1)
        };
        let writes = [write(0).image_info(&read), write(1).buffer_info(&written)];
        device.update_descriptor_sets(&writes, &[]);
        gpu.run(|commands| {
            let barrier = |old, new| {
                vk::ImageMemoryBarrier::default()
                    .image(map)
                    .subresource_range(WHOLE)
                    .old_layout(old)
                    .new_layout(new)
                    .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            };
            let [start, copy, compute, to_host] = [
                vk::PipelineStageFlags::TOP_OF_PIPE,
                vk::PipelineStageFlags::TRANSFER,
                vk::PipelineStageFlags::COMPUTE_SHADER,
                vk::PipelineStageFlags::HOST,
            ];
            let none = vk::DependencyFlags::empty();
            let filled = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
            let before = [barrier(vk::ImageLayout::UNDEFINED, filled)
                .dst_access_mask(vk::AccessFlags::TRANSFER_WRITE)];
            let sampled = vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL;
            let after = [barrier(filled, sampled)
                .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
                .dst_access_mask(vk::AccessFlags::SHADER_READ)];
            let host_reads = [vk::MemoryBarrier::default()
                .src_access_mask(vk::AccessFlags::SHADER_WRITE)
                .dst_access_mask(vk::AccessFlags::HOST_READ)];
            let region = [vk::BufferImageCopy::default()
                .image_subresource(vk::ImageSubresourceLayers {
                    aspect_mask: vk::ImageAspectFlags::COLOR,
                    mip_level: 0,
                    base_array_layer: 0,
                    layer_count: header.layer_count.max(1),
                })
                .image_extent(vk::Extent3D { width, height, depth: 1 })];
            device.cmd_pipeline_barrier(commands, start, copy, none, &[], &[], &before);
            device.cmd_copy_buffer_to_image(commands, upload.buffer, map, filled, &region);
            device.cmd_pipeline_barrier(commands, copy, compute, none, &[], &[], &after);
            let point = vk::PipelineBindPoint::COMPUTE;
            device.cmd_bind_pipeline(commands, point, pipeline);
            device.cmd_bind_descriptor_sets(commands, point, layout, 0, &[set], &[]);
            device.cmd_push_constants(commands, layout, vk::ShaderStageFlags::COMPUTE, 0, &push);
            device.cmd_dispatch(commands, grid_points.div_ceil(64) as u32, 1, depth);
            device.cmd_pipeline_barrier(commands, compute, to_host, none, &host_reads, &[], &[]);
            Ok(())
        })
        .expect("run");
        let found =
            std::slice::from_raw_parts(values.mapped().cast::<f32>(), grid_points * decoder.planes);
        let found = found.to_vec();
        device.destroy_descriptor_pool(pool, None);
        device.destroy_pipeline(pipeline, None);
        device.destroy_shader_module(module, None);
        device.destroy_pipeline_layout(layout, None);
        device.destroy_descriptor_set_layout(set_layouts[0], None);
        device.destroy_sampler(sampler, None);
        device.destroy_image_view(view, None);
        device.destroy_image(map, None);
        blocks.free(map_memory);
        for buffer in [upload, values] {
            device.destroy_buffer(buffer.buffer, None);
            blocks.free(buffer.memory);
        }
        found
    }
}

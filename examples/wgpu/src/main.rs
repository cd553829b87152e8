//! Ridgelight in a wgpu program: on a device of wgpu's, heights and light in wgpu's textures, light sampled in a wgpu
//! pass. `ridgelight-wgpu-host OUT.exr` writes what the pass has read. `examples/wgpu/check` runs it.

use ash::vk;
use ridgelight_io as files;
use ridgelight_io::{Channels, Layer};
use ridgelight::gpu::{self, Host, ImageArg, ImageState};
use wgpu::hal::api::Vulkan;

#[expect(dead_code, reason = "of the host by ash only its scene and how it plans")]
#[path = "../../ash_host.rs"]
mod ash_host;
use ash_host::{COLS, ROWS};

type Any<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: wgpu::Extent3d =
    wgpu::Extent3d { width: COLS as u32, height: ROWS as u32, depth_or_array_layers: 1 };

/// A device as wgpu makes it: Ridgelight needs nothing besides.
fn device(adapter: &wgpu::Adapter) -> Any<(wgpu::Device, wgpu::Queue)> {
    // SAFETY: instance and physical device are alive.
    let lacks = unsafe {
        let hal = adapter.as_hal::<Vulkan>().ok_or("no Vulkan")?;
        gpu::missing(hal.shared_instance().raw_instance(), hal.raw_physical_device())
    };
    if !lacks.is_empty() {
        return Err(format!("the device lacks {}", lacks.join(", ")).into());
    }
    let descriptor = wgpu::DeviceDescriptor::default();
    Ok(pollster::block_on(adapter.request_device(&descriptor))?)
}

fn texture(device: &wgpu::Device, label: &str, usage: wgpu::TextureUsages) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: SIZE,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::R32Float,
        usage: usage | wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

fn write(queue: &wgpu::Queue, texture: &wgpu::Texture, values: &[f32]) {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_ne_bytes()).collect();
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * SIZE.width),
        rows_per_image: None,
    };
    queue.write_texture(texture.as_image_copy(), &bytes, layout, SIZE);
}

/// A wgpu texture as Ridgelight takes it, in the layout that wgpu holds it in and is given it back in.
fn image(device: &ash::Device, texture: &wgpu::Texture, layout: vk::ImageLayout) -> Any<ImageArg> {
    let state = ImageState { layout, ..ImageState::ANY_USE };
    // SAFETY: the texture is alive as long as this is used; the view is destroyed at the end.
    unsafe {
        let image = texture.as_hal::<Vulkan>().ok_or("no Vulkan")?.raw_handle();
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(vk::Format::R32_SFLOAT)
            .subresource_range(vk::ImageSubresourceRange {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                base_mip_level: 0,
                level_count: 1,
                base_array_layer: 0,
                layer_count: 1,
            });
        let view = device.create_image_view(&info, None)?;
        let extent = [SIZE.width, SIZE.height, 1];
        let format = vk::Format::R32_SFLOAT;
        Ok(ImageArg { image, view, format, extent, before: state, after: state })
    }
}

/// What wgpu does with the light: each texel is fetched by a compute shader and put in a buffer.
struct Reader {
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
    texels: wgpu::Buffer,
    mapped: wgpu::Buffer,
}

const READ: &str = "
@group(0) @binding(0) var light: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> texels: array<f32>;
@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) at: vec3u) {
    let size = textureDimensions(light);
    if (all(at.xy < size)) {
        texels[at.y * size.x + at.x] = textureLoad(light, at.xy, 0).r;
    }
}";

impl Reader {
    fn new(device: &wgpu::Device, light: &wgpu::Texture) -> Self {
        let buffer = |usage| {
            let size = 4 * (ROWS * COLS) as u64;
            let (label, mapped_at_creation) = (Some("texels"), false);
            device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation })
        };
        let texels = buffer(wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
        let mapped = buffer(wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
        let source = wgpu::ShaderSource::Wgsl(READ.into());
        let shader = wgpu::ShaderModuleDescriptor { label: None, source };
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: None,
            module: &device.create_shader_module(shader),
            entry_point: None,
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let view = light.create_view(&wgpu::TextureViewDescriptor::default());
        let resources = [wgpu::BindingResource::TextureView(&view), texels.as_entire_binding()];
        let entries: Vec<_> = (0..)
            .zip(resources)
            .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
            .collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        Self { pipeline, group, texels, mapped }
    }

    fn record(&self, device: &wgpu::Device) -> wgpu::CommandBuffer {
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, &self.group, &[]);
        pass.dispatch_workgroups(SIZE.width.div_ceil(8), SIZE.height.div_ceil(8), 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&self.texels, 0, &self.mapped, 0, self.texels.size());
        encoder.finish()
    }

    fn values(&self, device: &wgpu::Device) -> Any<Vec<f32>> {
        self.mapped.map_async(wgpu::MapMode::Read, .., |mapped| mapped.expect("mapped"));
        device.poll(wgpu::PollType::wait_indefinitely())?;
        let bytes = self.mapped.get_mapped_range(..);
        Ok(bytes.as_chunks::<4>().0.iter().map(|b| f32::from_ne_bytes(*b)).collect())
    }
}

fn main() -> Any<()> {
    let out = std::env::args_os().nth(1).ok_or("usage: ridgelight-wgpu-host OUT.exr")?;
    let instance = wgpu::Instance::new(&wgpu::InstanceDescriptor {
        backends: wgpu::Backends::VULKAN,
        // The layer, where one listens, is the environment's to choose.
        flags: wgpu::InstanceFlags::empty(),
        ..wgpu::InstanceDescriptor::default()
    });
    let options = wgpu::RequestAdapterOptions::default();
    let adapter = pollster::block_on(instance.request_adapter(&options))?;
    let (device, queue) = device(&adapter)?;
    let scene = ash_host::scene()?;
    let heights = texture(&device, "heights", wgpu::TextureUsages::empty());
    let light = texture(&device, "light", wgpu::TextureUsages::STORAGE_BINDING);
    write(&queue, &heights, scene.field.heights_m());
    // wgpu clears a texture without a recorded write, before it reads it.
    write(&queue, &light, &[0.0; ROWS * COLS]);
    let reader = Reader::new(&device, &light);

    // SAFETY: wgpu's own device, alive until the end.
    let host = unsafe {
        let hal = device.as_hal::<Vulkan>().ok_or("no Vulkan")?;
        Host {
            instance: hal.shared_instance().raw_instance().clone(),
            physical_device: hal.raw_physical_device(),
            device: hal.raw_device().clone(),
            queue_family: hal.queue_family_index(),
            pipeline_cache: vk::PipelineCache::null(),
            debug_utils: None,
        }
    };
    let mut renderer = ash_host::prepare(&host, &scene)?;
    let read = image(&host.device, &heights, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)?;
    let written = image(&host.device, &light, vk::ImageLayout::GENERAL)?;

    // wgpu brings its textures to those layouts, and believes them to be there afterwards.
    let mut before = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let uses =
        [(&heights, wgpu::TextureUses::RESOURCE), (&light, wgpu::TextureUses::STORAGE_WRITE_ONLY)];
    let transitions =
        uses.map(|(texture, state)| wgpu::TextureTransition { texture, selector: None, state });
    before.transition_resources(std::iter::empty(), transitions.into_iter());
    let mut lit = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    // SAFETY: the command buffer is being recorded; it is submitted between the others.
    unsafe {
        lit.as_hal_mut::<Vulkan, _, _>(|encoder| -> Any<()> {
            let commands = encoder.ok_or("no Vulkan")?.raw_handle();
            Ok(renderer.record(commands, 0, &[read], &[written])?)
        })?;
    }
    queue.submit([before.finish(), lit.finish(), reader.record(&device)]);
    let grey: Vec<[f32; 3]> = reader.values(&device)?.into_iter().map(|v| [v; 3]).collect();
    let layer = Layer { name: String::new(), channels: Channels::Rgb(&grey) };
    files::write_exr(out.as_ref(), ROWS, COLS, &[layer], &[])?;

    renderer.destroy();
    // SAFETY: the queue has done all its work.
    unsafe {
        for view in [read.view, written.view] {
            host.device.destroy_image_view(view, None);
        }
    }
    Ok(())
}

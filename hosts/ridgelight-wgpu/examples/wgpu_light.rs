//! Light of a height field in a wgpu texture, read by a wgpu pass. `wgpu_light OUT.exr [FRAMES]` writes what the pass has read in
//! the last frame. `hosts/ridgelight-wgpu/check` runs it.

use ridgelight::plan::{self, Picture, Plan, Rectangle};
use ridgelight::scene::{Environment, Quality, Scene};
use ridgelight_io as files;
use ridgelight_io::{Channels, Layer};
use ridgelight_wgpu::{Renderer, limits, texture};

#[path = "../../../examples/host/scene.rs"]
mod host_scene;
use host_scene::{COLS, ROWS};

type Any<T> = Result<T, Box<dyn std::error::Error>>;

const SIZE: wgpu::Extent3d =
    wgpu::Extent3d { width: COLS as u32, height: ROWS as u32, depth_or_array_layers: 1 };

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

/// Raises a rectangle of the heights: the edit sweeps again, and has the bits of a whole submission.
fn edit(device: &wgpu::Device, queue: &wgpu::Queue, scene: &Scene) -> Any<()> {
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let plan = plan::picture(scene, &Quality::default(), &limits(device)?, wanted)?;
    let sampled = wgpu::TextureUsages::TEXTURE_BINDING;
    let heights = texture(device, queue, plan.inputs().next().ok_or("no input")?.1, sampled)?;
    let light = texture(device, queue, plan.outputs().next().ok_or("no output")?.1, sampled)?;
    let mut renderer = Renderer::new(device, queue, plan)?;
    let reader = Reader::new(device, &light);
    // Level ground with zeros, before and after.
    renderer.submit(&[&heights], &[&light])?;
    queue.submit([reader.record(device)]);
    let level = reader.values(device)?;
    reader.mapped.unmap();
    let raised = Rectangle { col: 20, row: 12, cols: 8, rows: 6 };
    let bytes: Vec<u8> = [5.0_f32; 8 * 6].iter().flat_map(|v| v.to_ne_bytes()).collect();
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * 8), rows_per_image: None };
    let origin = wgpu::Origin3d { x: raised.col, y: raised.row, z: 0 };
    let to = wgpu::TexelCopyTextureInfo { origin, ..heights.as_image_copy() };
    let size = wgpu::Extent3d { width: raised.cols, height: raised.rows, depth_or_array_layers: 1 };
    queue.write_texture(to, &bytes, layout, size);
    renderer.submit_edit(&[&heights], &[&light], raised)?;
    queue.submit([reader.record(device)]);
    let edited = reader.values(device)?;
    reader.mapped.unmap();
    let labels = renderer.timings().ok_or("no times of an edit")?;
    if !labels.iter().any(|timing| timing.label.starts_with("horizon_resweep")) {
        return Err(format!("an edit that sweeps nothing again: {labels:?}").into());
    }
    renderer.submit(&[&heights], &[&light])?;
    queue.submit([reader.record(device)]);
    let whole = reader.values(device)?;
    reader.mapped.unmap();
    if edited == level || edited != whole {
        return Err("an edit has other light than a whole submission".into());
    }
    Ok(())
}

/// Writes all texels of a texture.
fn write(queue: &wgpu::Queue, texture: &wgpu::Texture, values: &[f32]) {
    let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_ne_bytes()).collect();
    let row = bytes.len() as u32 / texture.height();
    let layout =
        wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
    queue.write_texture(texture.as_image_copy(), &bytes, layout, texture.size());
}

/// An environment whose light depends on `seed`.
fn environment(seed: usize) -> ridgelight::Result<Environment> {
    let texels = (0..32 * 16).map(|i| [((i * 7 + seed) % 5) as f32, 1.0, ((i + seed) % 3) as f32]);
    Environment::new(32, 16, texels.collect(), 0.0)
}

/// Frames of new heights compute no tables of an environment. Every frame has the light of a new renderer, also where the sun moves
/// or the environment changes in the same frame, and after a refused submission.
fn new_heights(device: &wgpu::Device, queue: &wgpu::Queue) -> Any<()> {
    let mut scene = host_scene::scene()?;
    scene.lights.environment = Some(environment(0)?);
    let planned = |scene: &Scene| -> Any<Plan> {
        let quality = Quality { azimuths: 16, ..Quality::default() };
        Ok(plan::picture(scene, &quality, &limits(device)?, Picture::default())?)
    };
    let plan = planned(&scene)?;
    let sampled = wgpu::TextureUsages::TEXTURE_BINDING;
    let made = |resource| texture(device, queue, resource, sampled);
    let inputs: Vec<_> =
        plan.inputs().map(|(_, input)| made(input)).collect::<ridgelight::Result<_>>()?;
    let [heights, sky] = &inputs[..] else { return Err("two inputs were expected".into()) };
    let output = plan.outputs().next().ok_or("no output")?.1;
    let [light, fresh] = [made(output)?, made(output)?];
    let readers = [&light, &fresh].map(|light| Reader::new(device, light));
    let read = |reader: &Reader| -> Any<Vec<f32>> {
        queue.submit([reader.record(device)]);
        let values = reader.values(device)?;
        reader.mapped.unmap();
        Ok(values)
    };
    let write_sky = |environment: &Environment| {
        let texels = environment.texels().iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0]);
        write(queue, sky, &texels.collect::<Vec<f32>>());
    };
    write_sky(&environment(0)?);
    let still = scene.field.heights_m().to_vec();
    let mut renderer = Renderer::new(device, queue, plan)?;
    let (mut counts, mut last) = (Vec::new(), Vec::new());
    for n in 0..7 {
        let mut changed = vec!["heights"];
        if n == 2 {
            let sun = &mut scene.lights.suns[0];
            (sun.azimuth_rad, sun.irradiance) = (0.05, [1.0, 2.0, 3.0]);
            renderer.set_plan(planned(&scene)?)?;
        }
        if n == 4 {
            let other = environment(1)?;
            write_sky(&other);
            scene.lights.environment = Some(other);
            renderer.set_plan(planned(&scene)?)?;
            changed.push("environment");
        }
        if n == 6 && renderer.submit(&[&light, sky], &[heights]).is_ok() {
            return Err("swapped textures were accepted".into());
        }
        let moved = |(i, height): (usize, &f32)| height + (i * n % 5) as f32;
        let moved: Vec<f32> = still.iter().enumerate().map(moved).collect();
        write(queue, heights, &moved);
        let changed: Vec<_> =
            changed.iter().filter_map(|name| renderer.plan().find(name)).collect();
        let passes = renderer.passes_after(&changed);
        renderer.submit_passes(&[heights, sky], &[&light], &passes)?;
        let found = read(&readers[0])?;
        let mut new = Renderer::new(device, queue, planned(&scene)?)?;
        new.submit(&[heights, sky], &[&fresh])?;
        if found != read(&readers[1])? || found == last {
            return Err(format!("frame {n} of new heights differs from a new renderer's").into());
        }
        counts.push(passes.len());
        last = found;
    }
    let all = renderer.plan().passes.len();
    if counts[0] != all || [1, 3, 5, 6].iter().any(|n| counts[*n] >= all) {
        return Err(format!("{counts:?} of {all} passes ran in frames of new heights").into());
    }
    Ok(())
}

/// A texture of another device is refused, and the next submission runs.
fn refuse(
    adapter: &wgpu::Adapter,
    renderer: &mut Renderer,
    [heights, light]: [&wgpu::Texture; 2],
) -> Any<()> {
    let other = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
    let of = renderer.plan().inputs().next().ok_or("no input")?.1.clone();
    let foreign = texture(&other.0, &other.1, &of, wgpu::TextureUsages::empty())?;
    match renderer.submit(&[&foreign], &[light]) {
        Err(error) if error.to_string().contains("wgpu queue") => {}
        other => return Err(format!("a texture of another device: {other:?}").into()),
    }
    renderer.submit(&[heights], &[light])?;
    Ok(())
}

fn main() -> Any<()> {
    let mut args = std::env::args_os().skip(1);
    let out = args.next().ok_or("usage: wgpu_light OUT.exr [FRAMES]")?;
    let frames = host_scene::frames(args.next())?;
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::VULKAN;
    // wgpu enables no layer; VK_INSTANCE_LAYERS can.
    descriptor.flags = wgpu::InstanceFlags::empty();
    let instance = wgpu::Instance::new(descriptor);
    let adapter =
        pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()))?;
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;

    let scene = host_scene::scene()?;
    let plan = plan::picture(&scene, &Quality::default(), &limits(&device)?, Picture::default())?;
    let none = wgpu::TextureUsages::empty();
    let heights = texture(&device, &queue, plan.inputs().next().ok_or("no input")?.1, none)?;
    let sampled = wgpu::TextureUsages::TEXTURE_BINDING;
    let light = texture(&device, &queue, plan.outputs().next().ok_or("no output")?.1, sampled)?;
    let bytes: Vec<u8> = scene.field.heights_m().iter().flat_map(|v| v.to_ne_bytes()).collect();
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(4 * SIZE.width),
        rows_per_image: None,
    };
    queue.write_texture(heights.as_image_copy(), &bytes, layout, SIZE);

    let mut renderer = Renderer::new(&device, &queue, plan)?;
    // More often than there are frames in flight.
    for _ in 0..3 {
        renderer.submit(&[&heights], &[&light])?;
    }
    refuse(&adapter, &mut renderer, [&heights, &light])?;
    let wrong = renderer.submit(&[&light], &[&heights]);
    let refused = wrong.err().ok_or("swapped textures were accepted")?.to_string();
    if !refused.contains("usage: found") {
        return Err(refused.into());
    }

    edit(&device, &queue, &scene)?;
    new_heights(&device, &queue)?;

    let reader = Reader::new(&device, &light);
    let mut values = Vec::new();
    for _ in 0..frames {
        queue.write_texture(heights.as_image_copy(), &bytes, layout, SIZE);
        let passes = renderer.passes_after(renderer.plan().find("heights").as_slice());
        renderer.submit_passes(&[&heights], &[&light], &passes)?;
        queue.submit([reader.record(&device)]);
        values = reader.values(&device)?;
        reader.mapped.unmap();
    }
    let grey: Vec<[f32; 3]> = values.into_iter().map(|v| [v; 3]).collect();
    let layer = Layer { name: String::new(), channels: Channels::Rgb(&grey) };
    files::write_exr(out.as_ref(), ROWS, COLS, &[layer], &[])?;
    for timing in renderer.timings().ok_or("no times of a submission that has run")? {
        println!("{} {:.3} ms", timing.label, timing.ns / 1e6);
    }
    Ok(())
}

#![doc = include_str!("../../../docs/embedding/wgpu.md")]

use std::future::Future;
use std::task::{Context, Poll, Waker};

use ash::vk;
use ridgelight::gpu::{self, Host, ImageArg, ImageState, Timing};
use ridgelight::plan::{Format, Kind, Limits, Owner, Plan, Rectangle, Resource, ResourceId};
use ridgelight::{Error, Result};
use wgpu::hal::api::Vulkan;

/// Submissions in flight. The next one waits for the oldest.
const SLOTS: usize = 2;

/// An error for a device of another API.
fn no_vulkan() -> Error {
    Error::Device {
        doing: "using a wgpu device".into(),
        reason: "its backend is not Vulkan: create the instance with Backends::VULKAN".into(),
    }
}

/// The device as renderers borrow it.
fn host(device: &wgpu::Device) -> Result<Host> {
    // SAFETY: the handles are used while `device` is alive, of which a renderer keeps a clone.
    let hal = unsafe { device.as_hal::<Vulkan>() }.ok_or_else(no_vulkan)?;
    let host = Host {
        instance: hal.shared_instance().raw_instance().clone(),
        physical_device: hal.raw_physical_device(),
        device: hal.raw_device().clone(),
        queue_family: hal.queue_family_index(),
        pipeline_cache: vk::PipelineCache::null(),
        debug_utils: None,
    };
    let lacks = gpu::missing(&host.instance, host.physical_device);
    if lacks.is_empty() {
        return Ok(host);
    }
    let reason = format!("the device lacks {}", lacks.join(", "));
    Err(Error::Device { doing: "using a wgpu device".into(), reason })
}

/// Limits for a plan on this device.
///
/// # Errors
/// A device that is not of Vulkan, or lacks something (named).
pub fn limits(device: &wgpu::Device) -> Result<Limits> {
    let host = host(device)?;
    let mut limits = gpu::limits(&host.instance, host.physical_device);
    // Inputs and outputs are textures of wgpu's, whose limits may be lower.
    limits.image_side = limits.image_side.min(device.limits().max_texture_dimension_2d);
    // `image_layers` stays that of Vulkan. It also bounds Ridgelight's own images, which wgpu does not make: 256 layers, wgpu's
    // default, would cut a sweep into more batches. `texture` refuses outputs of too many layers.
    // `Renderer::set_plan` may hold the resources of two plans for a moment.
    limits.memory_budget /= 2;
    Ok(limits)
}

/// wgpu's name of a format, where it has one.
fn of_wgpu(format: Format) -> Option<wgpu::TextureFormat> {
    Some(match format {
        Format::R32Float => wgpu::TextureFormat::R32Float,
        Format::Rgba16Float => wgpu::TextureFormat::Rgba16Float,
        Format::Rgba32Float => wgpu::TextureFormat::Rgba32Float,
        Format::R16Float => wgpu::TextureFormat::R16Float,
        Format::Rgba8Unorm => wgpu::TextureFormat::Rgba8Unorm,
        Format::Rgba8Srgb => wgpu::TextureFormat::Rgba8UnormSrgb,
        _ => return None,
    })
}

/// Vulkan's name of a format, where a plan may have it.
fn of_vulkan(format: wgpu::TextureFormat) -> Option<vk::Format> {
    Some(match format {
        wgpu::TextureFormat::R32Float => vk::Format::R32_SFLOAT,
        wgpu::TextureFormat::R16Float => vk::Format::R16_SFLOAT,
        wgpu::TextureFormat::R16Unorm => vk::Format::R16_UNORM,
        wgpu::TextureFormat::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
        wgpu::TextureFormat::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
        wgpu::TextureFormat::Rgba8Unorm => vk::Format::R8G8B8A8_UNORM,
        wgpu::TextureFormat::Rgba8UnormSrgb => vk::Format::R8G8B8A8_SRGB,
        _ => return None,
    })
}

/// A texture for an input or output of a plan, with the usages that a renderer needs and those of `usages`; its texels are
/// 0.
///
/// For textures of your own: an input needs TEXTURE_BINDING, an output STORAGE_BINDING and TEXTURE_BINDING. wgpu does not see Ridgelight's
/// writes. It clears a texture at its first read if none of its own commands wrote to it, and the light is lost. So write
/// to each output once.
///
/// # Errors
/// A buffer, a format that wgpu lacks, or a size beyond the device's limits.
pub fn texture(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    resource: &Resource,
    usages: wgpu::TextureUsages,
) -> Result<wgpu::Texture> {
    let Kind::Image { format, width, height, layers, .. } = resource.kind else {
        return Err(Error::setting(&resource.name, "a buffer", "an image"));
    };
    let Some(named) = of_wgpu(format) else {
        return Err(Error::setting(
            &resource.name,
            format!("{format:?}"),
            "a format that wgpu has",
        ));
    };
    let bound = if resource.owner == Owner::Output {
        wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING
    } else {
        wgpu::TextureUsages::TEXTURE_BINDING
    };
    let most = device.limits();
    if width.max(height) > most.max_texture_dimension_2d || layers > most.max_texture_array_layers {
        let (side, count) = (most.max_texture_dimension_2d, most.max_texture_array_layers);
        let expected = format!("at most {side} x {side}, {count} layers, the wgpu device's limits");
        let found = format!("{width} x {height}, {layers} layers");
        return Err(Error::setting(&resource.name, found, expected));
    }
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: layers };
    let made = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(&resource.name),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: named,
        usage: usages | bound | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let row = format.bytes() * u64::from(width);
    let zeros = vec![0; (row * u64::from(height) * u64::from(layers)) as usize];
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(row as u32),
        rows_per_image: Some(height),
    };
    queue.write_texture(made.as_image_copy(), &zeros, layout, size);
    Ok(made)
}

/// What a submission needs until it has run.
#[derive(Default)]
struct Slot {
    submission: Option<wgpu::SubmissionIndex>,
    /// With the raw view of each.
    textures: Vec<(wgpu::Texture, vk::ImageView)>,
}

/// Passes to record.
#[derive(Clone, Copy)]
enum Work<'a> {
    Passes(&'a [usize]),
    Edit(Rectangle),
}

/// Submits a plan to a wgpu queue. Dropping it waits for its last submission.
pub struct Renderer {
    device: wgpu::Device,
    queue: wgpu::Queue,
    host: Host,
    /// None only while it is made and dropped.
    recorder: Option<gpu::Renderer>,
    slots: [Slot; SLOTS],
    /// The slot of the last submission.
    last: usize,
}

impl Renderer {
    /// Makes everything that `plan` needs on a device.
    ///
    /// # Errors
    /// As [`limits`], or a device out of memory.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue, plan: Plan) -> Result<Self> {
        let mut host = host(device)?;
        let info = vk::PipelineCacheCreateInfo::default();
        // SAFETY: the device is alive; `drop` destroys the cache.
        let cache = unsafe { host.device.create_pipeline_cache(&info, None) };
        // Without one, pipelines are compiled each time.
        host.pipeline_cache = cache.unwrap_or_default();
        let (device, queue) = (device.clone(), queue.clone());
        let slots = Default::default();
        let mut renderer = Self { device, queue, host, recorder: None, slots, last: 0 };
        renderer.recorder = Some(gpu::Renderer::new(&renderer.host, plan, SLOTS)?);
        Ok(renderer)
    }

    fn recorder(&mut self) -> &mut gpu::Renderer {
        self.recorder.as_mut().expect("alive until dropped")
    }

    /// The plan that is submitted.
    pub fn plan(&self) -> &Plan {
        self.recorder.as_ref().expect("alive until dropped").plan()
    }

    /// Sets another plan. Returns the passes that must run next if the inputs are unchanged.
    ///
    /// Where colours, directions and sizes of lights differ this waits for nothing ([`gpu::Renderer::replace_plan`]).
    /// Where images or passes differ (a sun that crosses a diagonal of the grid, another number of lights, another size) it waits for
    /// earlier submissions and makes new resources; pipelines come from a cache.
    ///
    /// # Errors
    /// A device out of memory; the old plan stays.
    pub fn set_plan(&mut self, plan: Plan) -> Result<Vec<usize>> {
        if let Ok(passes) = self.recorder().replace_plan(plan.clone()) {
            return Ok(passes);
        }
        for slot in 0..SLOTS {
            self.finish(slot)?;
        }
        let all = (0..plan.passes.len()).collect();
        let made = gpu::Renderer::new(&self.host, plan, SLOTS)?;
        if let Some(old) = self.recorder.replace(made) {
            old.destroy();
        }
        Ok(all)
    }

    /// The passes to submit next with [`submit_passes`](Self::submit_passes) if only the inputs `changed` have new texels since the last
    /// submission, and all textures are the same: see [`gpu::Renderer::passes_after`]. After a failed submission, these are all passes.
    pub fn passes_after(&self, changed: &[ResourceId]) -> Vec<usize> {
        self.recorder.as_ref().expect("alive until dropped").passes_after(changed)
    }

    /// Submits the whole plan. `inputs` and `outputs` are the plan's, in its order.
    ///
    /// # Errors
    /// A texture that does not match the plan, by name; a texture of another device.
    pub fn submit(
        &mut self,
        inputs: &[&wgpu::Texture],
        outputs: &[&wgpu::Texture],
    ) -> Result<wgpu::SubmissionIndex> {
        let all: Vec<usize> = (0..self.plan().passes.len()).collect();
        self.submit_passes(inputs, outputs, &all)
    }

    /// Submits only some passes: those that [`set_plan`](Self::set_plan) or [`passes_after`](Self::passes_after) returned, say.
    ///
    /// # Errors
    /// As [`submit`](Self::submit), and those of [`gpu::Renderer::record_passes`].
    pub fn submit_passes(
        &mut self,
        inputs: &[&wgpu::Texture],
        outputs: &[&wgpu::Texture],
        passes: &[usize],
    ) -> Result<wgpu::SubmissionIndex> {
        self.work(inputs, outputs, Work::Passes(passes))
    }

    /// Submits the edit of a rectangle of heights; elsewhere they are as in the last submission.
    ///
    /// # Errors
    /// As [`submit`](Self::submit), and those of [`gpu::Renderer::record_edit`].
    pub fn submit_edit(
        &mut self,
        inputs: &[&wgpu::Texture],
        outputs: &[&wgpu::Texture],
        rectangle: Rectangle,
    ) -> Result<wgpu::SubmissionIndex> {
        self.work(inputs, outputs, Work::Edit(rectangle))
    }

    /// GPU times by pass of the last submission, once it has run and where the device has timestamps.
    pub fn timings(&self) -> Option<Vec<Timing>> {
        self.recorder.as_ref()?.timings(self.last)
    }

    fn work(
        &mut self,
        inputs: &[&wgpu::Texture],
        outputs: &[&wgpu::Texture],
        work: Work<'_>,
    ) -> Result<wgpu::SubmissionIndex> {
        let slot = (self.last + 1) % SLOTS;
        self.finish(slot)?;
        // First, so that wgpu refuses a texture of another device before its handle is used.
        let refused = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let used = [
            (inputs, wgpu::TextureUses::RESOURCE),
            (outputs, wgpu::TextureUses::STORAGE_WRITE_ONLY),
        ];
        let uses = used.iter().flat_map(|(all, state)| all.iter().map(|t| (*t, *state)));
        let transitions =
            uses.map(|(texture, state)| wgpu::TextureTransition { texture, selector: None, state });
        let descriptor = wgpu::CommandEncoderDescriptor::default();
        let mut before = self.device.create_command_encoder(&descriptor);
        before.transition_resources(std::iter::empty(), transitions);
        let before = before.finish();
        accepted(refused)?;
        let mut read = Vec::new();
        let mut written = Vec::new();
        let resources = |outputs: bool| -> Vec<Resource> {
            let plan = self.plan();
            let of = |(_, resource): (_, &Resource)| resource.clone();
            if outputs { plan.outputs().map(of).collect() } else { plan.inputs().map(of).collect() }
        };
        let (of_inputs, of_outputs) = (resources(false), resources(true));
        // A further texture is refused by the recorder, which knows the names.
        for (all, of, args, layout) in [
            (inputs, &of_inputs, &mut read, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL),
            (outputs, &of_outputs, &mut written, vk::ImageLayout::GENERAL),
        ] {
            for (i, texture) in all.iter().enumerate() {
                let arg = image(&self.host, texture, of.get(i), layout)?;
                self.slots[slot].textures.push(((*texture).clone(), arg.view));
                args.push(arg);
            }
        }
        let mut lit = self.device.create_command_encoder(&descriptor);
        let recorder = self.recorder();
        // SAFETY: the command buffer is being recorded, for the queue of the host's family, and is submitted after the
        // transitions. The slot's last submission has run; what is used lives until this one has.
        unsafe {
            lit.as_hal_mut::<Vulkan, _, _>(|encoder| {
                let commands = encoder.ok_or_else(no_vulkan)?.raw_handle();
                match work {
                    Work::Passes(passes) => {
                        recorder.record_passes(commands, slot, &read, &written, passes)
                    }
                    Work::Edit(edit) => recorder.record_edit(commands, slot, &read, &written, edit),
                }
            })?;
        }
        let refused = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let submission = self.queue.submit([before, lit.finish()]);
        self.slots[slot].submission = Some(submission.clone());
        self.last = slot;
        if let Err(error) = accepted(refused) {
            self.recorder().forget();
            return Err(error);
        }
        Ok(submission)
    }

    /// Waits for a slot's submission, and frees what it needed.
    fn finish(&mut self, slot: usize) -> Result<()> {
        let Slot { submission, textures } = std::mem::take(&mut self.slots[slot]);
        let waited = match submission {
            Some(index) => {
                let poll = wgpu::PollType::Wait { submission_index: Some(index), timeout: None };
                self.device.poll(poll).map(|_| ())
            }
            None => Ok(()),
        };
        for (_, view) in &textures {
            // SAFETY: made by this device; the submission has run, or the device is lost.
            unsafe { self.host.device.destroy_image_view(*view, None) };
        }
        waited.map_err(|error| Error::Device {
            doing: "waiting for a submission".into(),
            reason: error.to_string(),
        })
    }
}

impl Drop for Renderer {
    fn drop(&mut self) {
        for slot in 0..SLOTS {
            // A lost device runs nothing any more.
            let _ = self.finish(slot);
        }
        if let Some(recorder) = self.recorder.take() {
            recorder.destroy();
        }
        // SAFETY: made in `new`, or null; nothing uses it any more.
        unsafe { self.host.device.destroy_pipeline_cache(self.host.pipeline_cache, None) };
    }
}

/// The error that wgpu found since the scope began, if any.
fn accepted(scope: wgpu::ErrorScopeGuard) -> Result<()> {
    // Outside of browsers the error is there at once.
    let mut popped = std::pin::pin!(scope.pop());
    let mut context = Context::from_waker(Waker::noop());
    match popped.as_mut().poll(&mut context) {
        Poll::Ready(Some(error)) => Err(Error::Device {
            doing: "submitting to a wgpu queue".into(),
            reason: error.to_string(),
        }),
        Poll::Ready(None) | Poll::Pending => Ok(()),
    }
}

/// A texture as a recorder takes it, in the layout in which wgpu keeps it.
fn image(
    host: &Host,
    texture: &wgpu::Texture,
    resource: Option<&Resource>,
    layout: vk::ImageLayout,
) -> Result<ImageArg> {
    let name = resource.map_or("a texture", |resource| resource.name.as_str());
    let Some(format) = of_vulkan(texture.format()) else {
        let found = format!("{:?}", texture.format());
        let expected = resource.and_then(Resource::format);
        let expected = expected.map_or("a format of a plan".to_owned(), |f| format!("{f:?}"));
        return Err(Error::setting(format!("{name}: format"), found, expected));
    };
    let needed = if layout == vk::ImageLayout::GENERAL {
        wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING
    } else {
        wgpu::TextureUsages::TEXTURE_BINDING
    };
    if !texture.usage().contains(needed) {
        let found = format!("{:?}", texture.usage());
        return Err(Error::setting(format!("{name}: usage"), found, format!("{needed:?}")));
    }
    if texture.dimension() != wgpu::TextureDimension::D2 || texture.sample_count() != 1 {
        let found = format!("{:?}, {} samples", texture.dimension(), texture.sample_count());
        return Err(Error::setting(name, found, "a 2D texture without MSAA"));
    }
    let layers = texture.depth_or_array_layers();
    let is_layered = resource.is_some_and(|r| matches!(r.kind, Kind::Image { layered: true, .. }));
    let view_type =
        if is_layered { vk::ImageViewType::TYPE_2D_ARRAY } else { vk::ImageViewType::TYPE_2D };
    // SAFETY: the texture is alive, and so is its image as long as the caller keeps a clone.
    let image = unsafe { texture.as_hal::<Vulkan>().map(|texture| texture.raw_handle()) };
    let Some(image) = image else {
        return Err(Error::setting(name, "a destroyed texture", "one that is alive"));
    };
    let info = vk::ImageViewCreateInfo::default()
        .image(image)
        .view_type(view_type)
        .format(format)
        .subresource_range(vk::ImageSubresourceRange {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            base_mip_level: 0,
            level_count: 1,
            base_array_layer: 0,
            layer_count: if is_layered { layers } else { 1 },
        });
    // SAFETY: as above; the caller destroys the view.
    let view = unsafe { host.device.create_image_view(&info, None) }.map_err(|result| {
        Error::Device { doing: format!("viewing {name}"), reason: result.to_string() }
    })?;
    let state = ImageState { layout, ..ImageState::ANY_USE };
    let extent = [texture.width(), texture.height(), layers];
    Ok(ImageArg { image, view, format, extent, before: state, after: state })
}

mod read;

use std::ffi::{CStr, c_void};
use std::sync::{Arc, Mutex};

use ash::{ext, vk};
use gpu_allocator::MemoryLocation;

use super::memory::{Backed, Memory};
use super::requirements::report;
use super::{DeviceReport, Host, ImageArg, ImageState, Renderer, Timing, failed};
use crate::plan::{Format, Kind, Plan, Resource};
use crate::{Error, Result};

/// How a device of our own is made.
#[derive(Clone, Debug, Default)]
pub struct HeadlessOptions {
    /// Part of the device's name, or its number in [`devices`]; else the first that will do,
    /// graphics processors before software.
    pub device: Option<String>,
    /// Requires VK_LAYER_KHRONOS_validation with synchronisation validation, and keeps its messages.
    pub validation: bool,
}

/// Contents of an image: rows of texels of one or four f32.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    /// The image's name in the plan.
    pub name: String,
    /// f32 a texel: 1 or 4.
    pub channels: usize,
    /// Layer after layer, row after row.
    pub values: Vec<f32>,
}

/// A device of our own, for rendering offscreen: for programs that have none to lend.
pub struct Headless {
    _entry: ash::Entry,
    debug: Option<(ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Arc<Mutex<Vec<String>>>,
    host: Host,
    queue: vk::Queue,
    pool: vk::CommandPool,
    report: DeviceReport,
    memory: Memory,
}

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";
/// Staging goes through buffers of at most this size.
const STAGING_BYTES: u64 = 64 << 20;

fn load() -> Result<ash::Entry> {
    // SAFETY: loading the system's Vulkan loader runs its initialisers, which is its purpose.
    unsafe { ash::Entry::load() }.map_err(|e| Error::Device {
        doing: "loading Vulkan".into(),
        reason: format!(
            "{e}; install a Vulkan loader and a driver (Debian: libvulkan1 mesa-vulkan-drivers)"
        ),
    })
}

fn no_driver() -> Error {
    Error::Device {
        doing: "choosing a device".into(),
        reason: "no Vulkan driver answers (Debian: install mesa-vulkan-drivers)".into(),
    }
}

/// Turns one of the validation layer's settings on.
fn layer_setting(key: &'static CStr) -> vk::LayerSettingEXT<'static> {
    const ON: [u8; 4] = vk::TRUE.to_ne_bytes();
    let mut setting = vk::LayerSettingEXT::default()
        .layer_name(VALIDATION)
        .setting_name(key)
        .ty(vk::LayerSettingTypeEXT::BOOL32)
        .values(&ON);
    // One VkBool32; ash 0.38 counts bytes.
    setting.value_count = 1;
    setting
}

fn instance(
    entry: &ash::Entry,
    messenger: Option<&mut vk::DebugUtilsMessengerCreateInfoEXT<'_>>,
) -> Result<ash::Instance> {
    let app = vk::ApplicationInfo::default()
        .application_name(c"ridgelight")
        .api_version(vk::API_VERSION_1_3);
    // Without the second, hazards of dispatches on one buffer go unheard.
    let settings =
        [layer_setting(c"validate_sync"), layer_setting(c"syncval_shader_accesses_heuristic")];
    let mut layer_settings = vk::LayerSettingsCreateInfoEXT::default().settings(&settings);
    let layers = [VALIDATION.as_ptr()];
    let extensions = [ext::debug_utils::NAME.as_ptr()];
    let mut info = vk::InstanceCreateInfo::default().application_info(&app);
    if let Some(messenger) = messenger {
        info = info
            .enabled_layer_names(&layers)
            .enabled_extension_names(&extensions)
            .push_next(&mut layer_settings)
            .push_next(messenger);
    }
    // SAFETY: names are nul-terminated and live across the call; so do the chained structs.
    unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
        vk::Result::ERROR_INCOMPATIBLE_DRIVER => no_driver(),
        other => failed("making a Vulkan instance")(other),
    })
}

/// All devices of the system.
///
/// # Errors
/// No loader, or no driver that answers.
pub fn devices() -> Result<Vec<DeviceReport>> {
    let entry = load()?;
    let instance = instance(&entry, None)?;
    // SAFETY: the instance is alive; it is destroyed after its last use.
    unsafe {
        let found = instance.enumerate_physical_devices().map_err(failed("listing devices"));
        let reports = found.map(|all| all.into_iter().map(|d| report(&instance, d)).collect());
        instance.destroy_instance(None);
        reports
    }
}

unsafe extern "system" fn keep_message(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: Vulkan passes valid callback data; `user` is the Mutex that Headless keeps alive until
    // the messenger is destroyed.
    unsafe {
        let kept = &*user.cast::<Mutex<Vec<String>>>();
        let text = (*data)
            .message_as_c_str()
            .map_or_else(String::new, |m| m.to_string_lossy().into_owned());
        if let Ok(mut kept) = kept.lock() {
            kept.push(text);
        }
    }
    vk::FALSE
}

impl Headless {
    /// Makes an instance and a device.
    ///
    /// # Errors
    /// No loader, no driver, no device of that name, a device that lacks something, or no validation
    /// layer where it is required.
    pub fn new(options: &HeadlessOptions) -> Result<Self> {
        let entry = load()?;
        if options.validation {
            // SAFETY: a query without preconditions.
            let known = unsafe { entry.enumerate_instance_layer_properties() }
                .map_err(failed("listing layers"))?;
            if !known.iter().any(|l| l.layer_name_as_c_str() == Ok(VALIDATION)) {
                return Err(Error::Device {
                    doing: "turning validation on".into(),
                    reason: "no VK_LAYER_KHRONOS_validation is installed".into(),
                });
            }
        }
        let messages = Arc::new(Mutex::new(Vec::new()));
        let listen = || {
            vk::DebugUtilsMessengerCreateInfoEXT::default()
                .message_severity(
                    vk::DebugUtilsMessageSeverityFlagsEXT::WARNING
                        | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR,
                )
                .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
                .pfn_user_callback(Some(keep_message))
                .user_data(Arc::as_ptr(&messages).cast_mut().cast())
        };
        let mut during = listen();
        let instance = instance(&entry, options.validation.then_some(&mut during))?;
        let debug = if options.validation {
            let loader = ext::debug_utils::Instance::new(&entry, &instance);
            // SAFETY: the callback and its data outlive the messenger (see Drop).
            let messenger = unsafe { loader.create_debug_utils_messenger(&listen(), None) };
            Some((loader, messenger.map_err(failed("listening to validation"))?))
        } else {
            None
        };
        // SAFETY: the instance is alive; whatever fails below leaves it to the end of the process,
        // which is where a failed start goes.
        let all =
            unsafe { instance.enumerate_physical_devices() }.map_err(failed("listing devices"))?;
        let reports: Vec<_> = all.iter().map(|d| report(&instance, *d)).collect();
        let chosen = choose(&reports, options.device.as_deref())?;
        let (physical_device, report) = (all[chosen], reports[chosen].clone());
        // SAFETY: the physical device is the instance's.
        let families =
            unsafe { instance.get_physical_device_queue_family_properties(physical_device) };
        let family = families.iter().position(|f| f.queue_flags.contains(vk::QueueFlags::COMPUTE));
        let queue_family = family.expect("the report found one") as u32;
        let queues = [vk::DeviceQueueCreateInfo::default()
            .queue_family_index(queue_family)
            .queue_priorities(&[1.0])];
        let core = vk::PhysicalDeviceFeatures::default()
            .shader_storage_image_write_without_format(true)
            .shader_storage_image_extended_formats(true);
        let mut features13 = vk::PhysicalDeviceVulkan13Features::default().synchronization2(true);
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&core)
            .push_next(&mut features13);
        // SAFETY: the features were reported as present, the family as existing.
        let device = unsafe { instance.create_device(physical_device, &info, None) }
            .map_err(failed(format!("making a device on {}", report.name)))?;
        let pool_info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        // SAFETY: the device was made above with one queue of this family.
        let (queue, pool) = unsafe {
            let queue = device.get_device_queue(queue_family, 0);
            (
                queue,
                device
                    .create_command_pool(&pool_info, None)
                    .map_err(failed("making a command pool"))?,
            )
        };
        let debug_utils = debug.as_ref().map(|_| ext::debug_utils::Device::new(&instance, &device));
        let host = Host { instance, physical_device, device, queue_family, debug_utils };
        let memory = Memory::new(&host)?;
        Ok(Self { _entry: entry, debug, messages, host, queue, pool, report, memory })
    }

    /// What a renderer borrows.
    pub fn host(&self) -> &Host {
        &self.host
    }

    /// The device and its limits.
    pub fn report(&self) -> &DeviceReport {
        &self.report
    }

    /// What validation has said so far, oldest first; emptied by the call.
    pub fn take_messages(&self) -> Vec<String> {
        self.messages.lock().map(|mut m| std::mem::take(&mut *m)).unwrap_or_default()
    }

    /// Runs `record` in a command buffer of its own and waits for it.
    ///
    /// # Errors
    /// `record`'s own, or the device's.
    pub fn run(&self, record: impl FnOnce(vk::CommandBuffer) -> Result<()>) -> Result<()> {
        let device = &self.host.device;
        let allocate = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.pool)
            .command_buffer_count(1);
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: pool, queue and device are ours; the buffer is freed after the queue is idle.
        unsafe {
            let buffers = device
                .allocate_command_buffers(&allocate)
                .map_err(failed("taking a command buffer"))?;
            let done = device
                .begin_command_buffer(buffers[0], &begin)
                .map_err(failed("recording"))
                .and_then(|()| record(buffers[0]))
                .and_then(|()| device.end_command_buffer(buffers[0]).map_err(failed("recording")))
                .and_then(|()| {
                    let commands =
                        [vk::CommandBufferSubmitInfo::default().command_buffer(buffers[0])];
                    let submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
                    device
                        .queue_submit2(self.queue, &submit, vk::Fence::null())
                        .and_then(|()| device.queue_wait_idle(self.queue))
                        .map_err(failed("running commands"))
                });
            device.free_command_buffers(self.pool, &buffers);
            done
        }
    }

    /// Makes an image for an input or output of a plan, in GENERAL layout after [`frame`](Self::frame).
    fn image_for(&mut self, resource: &Resource) -> Result<Owned> {
        let Kind::Image { format, width, height, layers, layered } = resource.kind else {
            return Err(Error::setting(&resource.name, "a buffer", "an image"));
        };
        let extent = [width, height, layers];
        let backed = self.memory.image(&resource.name, format, extent, layered)?;
        Ok(Owned { backed, format, extent, name: resource.name.clone() })
    }

    /// Makes a renderer for `plan` with images for all its inputs and outputs, and fills the inputs:
    /// `contents` are their texels in the plan's order, 1 or 4 f32 each.
    ///
    /// # Errors
    /// Contents that do not fit, or a device out of memory.
    pub fn frame(&mut self, plan: Plan, contents: &[&[f32]]) -> Result<Frame> {
        let inputs: Vec<Resource> = plan.inputs().map(|(_, r)| r.clone()).collect();
        let outputs: Vec<Resource> = plan.outputs().map(|(_, r)| r.clone()).collect();
        let mut frame = Frame {
            renderer: Some(Renderer::new(&self.host, plan, 1)?),
            inputs: Vec::new(),
            outputs: Vec::new(),
        };
        let filled = self.fill(&mut frame, &inputs, &outputs, contents);
        match filled {
            Ok(()) => Ok(frame),
            Err(error) => {
                self.end(frame);
                Err(error)
            }
        }
    }

    fn fill(
        &mut self,
        frame: &mut Frame,
        inputs: &[Resource],
        outputs: &[Resource],
        contents: &[&[f32]],
    ) -> Result<()> {
        if inputs.len() != contents.len() {
            return Err(Error::setting(
                "inputs",
                contents.len().to_string(),
                inputs.len().to_string(),
            ));
        }
        for resource in inputs {
            let image = self.image_for(resource)?;
            frame.inputs.push(image);
        }
        for resource in outputs {
            let image = self.image_for(resource)?;
            frame.outputs.push(image);
        }
        for (image, values) in frame.inputs.iter().zip(contents) {
            self.upload(image, values)?;
        }
        self.run(|commands| {
            for image in &frame.outputs {
                self.to_general(commands, image);
            }
            Ok(())
        })
    }

    /// Writes new texels into input number `input` of a frame.
    ///
    /// # Errors
    /// Contents that do not fit.
    pub fn refill(&mut self, frame: &Frame, input: usize, values: &[f32]) -> Result<()> {
        let image = frame.inputs.get(input).ok_or_else(|| {
            Error::setting("input", input.to_string(), format!("less than {}", frame.inputs.len()))
        })?;
        self.upload(image, values)
    }

    fn to_general(&self, commands: vk::CommandBuffer, image: &Owned) {
        let barrier = [vk::ImageMemoryBarrier2::default()
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .dst_access_mask(vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE)
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .new_layout(vk::ImageLayout::GENERAL)
            .image(image.backed.image)
            .subresource_range(super::memory::whole(image.extent[2]))];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        // SAFETY: `commands` is being recorded; the image is ours and its contents are not needed.
        unsafe { self.host.device.cmd_pipeline_barrier2(commands, &info) };
    }

    /// Copies between an image in GENERAL and host memory, in stretches of whole rows.
    fn copy(
        &mut self,
        image: &Owned,
        to_image: bool,
        mut each: impl FnMut(&mut [u8], usize) -> Result<()>,
    ) -> Result<()> {
        let [width, height, layers] = image.extent;
        let row_bytes = image.format.bytes() * u64::from(width);
        let rows = (STAGING_BYTES / row_bytes).clamp(1, u64::from(height)) as u32;
        let usage = if to_image {
            vk::BufferUsageFlags::TRANSFER_SRC
        } else {
            vk::BufferUsageFlags::TRANSFER_DST
        };
        let location = if to_image { MemoryLocation::CpuToGpu } else { MemoryLocation::GpuToCpu };
        let mut staging =
            self.memory.buffer("staging", row_bytes * u64::from(rows), usage, location)?;
        let mut done = 0;
        let mut copied = Ok(());
        'all: for layer in 0..layers {
            for top in (0..height).step_by(rows as usize) {
                let count = rows.min(height - top);
                let bytes = (row_bytes * u64::from(count)) as usize;
                copied = self.copy_rows(
                    image,
                    &mut staging,
                    to_image,
                    [layer, top, count],
                    &mut |all| each(&mut all[..bytes], done),
                );
                if copied.is_err() {
                    break 'all;
                }
                done += bytes;
            }
        }
        self.memory.free(&mut staging);
        copied
    }

    fn copy_rows(
        &self,
        image: &Owned,
        staging: &mut Backed,
        to_image: bool,
        [layer, top, count]: [u32; 3],
        each: &mut dyn FnMut(&mut [u8]) -> Result<()>,
    ) -> Result<()> {
        let mut touch = |staging: &mut Backed| {
            let mapped = staging.allocation.as_mut().and_then(|a| a.mapped_slice_mut());
            each(mapped.expect("host-visible memory is mapped"))
        };
        if to_image {
            touch(staging)?;
        }
        let region = [vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                mip_level: 0,
                base_array_layer: layer,
                layer_count: 1,
            })
            .image_offset(vk::Offset3D { x: 0, y: top as i32, z: 0 })
            .image_extent(vk::Extent3D { width: image.extent[0], height: count, depth: 1 })];
        let (image, buffer) = (image.backed.image, staging.buffer);
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS | vk::PipelineStageFlags2::HOST)
            .dst_access_mask(
                vk::AccessFlags2::MEMORY_READ
                    | vk::AccessFlags2::MEMORY_WRITE
                    | vk::AccessFlags2::HOST_READ,
            )];
        let all = vk::DependencyInfo::default().memory_barriers(&barrier);
        self.run(|commands| {
            // SAFETY: the image is in GENERAL, the buffer as large as the region, both ours.
            unsafe {
                let device = &self.host.device;
                device.cmd_pipeline_barrier2(commands, &all);
                if to_image {
                    device.cmd_copy_buffer_to_image(
                        commands,
                        buffer,
                        image,
                        vk::ImageLayout::GENERAL,
                        &region,
                    );
                } else {
                    device.cmd_copy_image_to_buffer(
                        commands,
                        image,
                        vk::ImageLayout::GENERAL,
                        buffer,
                        &region,
                    );
                }
                device.cmd_pipeline_barrier2(commands, &all);
            }
            Ok(())
        })?;
        if to_image { Ok(()) } else { touch(staging) }
    }

    fn upload(&mut self, image: &Owned, values: &[f32]) -> Result<()> {
        let wanted =
            image.format.bytes() / 4 * image.extent.iter().map(|e| u64::from(*e)).product::<u64>();
        if values.len() as u64 != wanted {
            return Err(Error::setting(
                &image.name,
                format!("{} values", values.len()),
                format!("{wanted} values"),
            ));
        }
        self.run(|commands| {
            self.to_general(commands, image);
            Ok(())
        })?;
        let bytes: &[u8] = bytemuck::cast_slice(values);
        self.copy(image, true, |staging, from| {
            staging.copy_from_slice(&bytes[from..from + staging.len()]);
            Ok(())
        })
    }

    /// Runs a frame once and waits; its times by pass, where the device has timestamps.
    ///
    /// # Errors
    /// The device's.
    pub fn draw(&self, frame: &mut Frame) -> Result<Vec<Timing>> {
        let all: Vec<usize> = (0..frame.plan().passes.len()).collect();
        self.draw_passes(frame, &all)
    }

    /// Runs some passes of a frame that has been drawn, and waits.
    ///
    /// # Errors
    /// The device's.
    pub fn draw_passes(&self, frame: &mut Frame, passes: &[usize]) -> Result<Vec<Timing>> {
        let (inputs, outputs) = (frame.inputs(), frame.outputs());
        let renderer = frame.renderer.as_mut().expect("alive until ended");
        self.run(|commands| renderer.record_passes(commands, 0, &inputs, &outputs, passes))?;
        Ok(renderer.timings(0).unwrap_or_default())
    }

    /// Texels of output number `output` of a frame.
    ///
    /// # Errors
    /// An output that does not exist, or the device's.
    pub fn pixels(&mut self, frame: &Frame, output: usize) -> Result<Pixels> {
        let image = frame.outputs.get(output).ok_or_else(|| {
            Error::setting(
                "output",
                output.to_string(),
                format!("less than {}", frame.outputs.len()),
            )
        })?;
        let channels = (image.format.bytes() / 4) as usize;
        let count = image.extent.iter().map(|e| *e as usize).product::<usize>() * channels;
        let mut values = vec![0.0_f32; count];
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut values);
        self.copy(image, false, |staging, from| {
            bytes[from..from + staging.len()].copy_from_slice(staging);
            Ok(())
        })?;
        Ok(Pixels { name: image.name.clone(), channels, values })
    }

    /// Frees a frame.
    pub fn end(&mut self, mut frame: Frame) {
        if let Some(renderer) = frame.renderer.take() {
            renderer.destroy();
        }
        for mut image in frame.inputs.drain(..).chain(frame.outputs.drain(..)) {
            self.memory.free(&mut image.backed);
        }
    }
}

/// A renderer with images for its inputs and outputs; given back with [`Headless::end`].
pub struct Frame {
    renderer: Option<Renderer>,
    inputs: Vec<Owned>,
    outputs: Vec<Owned>,
}

impl Frame {
    /// What it draws.
    pub fn plan(&self) -> &Plan {
        self.renderer.as_ref().expect("alive until ended").plan()
    }
}

struct Owned {
    backed: Backed,
    format: Format,
    extent: [u32; 3],
    name: String,
}

impl Owned {
    fn arg(&self) -> ImageArg {
        ImageArg {
            image: self.backed.image,
            view: self.backed.view,
            format: self.format.vk(),
            extent: self.extent,
            before: ImageState::ANY_USE,
            after: ImageState::ANY_USE,
        }
    }
}

/// Which of the `reports` of [`devices`] would be used: the one `wanted`, by number or by a part of
/// its name, else the first GPU that will do, else any that will.
///
/// # Errors
/// No such device, none at all, or one that lacks what is needed (named).
pub fn choose(reports: &[DeviceReport], wanted: Option<&str>) -> Result<usize> {
    let listed = || reports.iter().map(|r| r.name.as_str()).collect::<Vec<_>>().join(", ");
    let no = |reason: String| Error::Device { doing: "choosing a device".into(), reason };
    let index = match wanted {
        Some(wanted) => {
            let number = wanted.parse::<usize>().ok().filter(|i| *i < reports.len());
            let lower = wanted.to_lowercase();
            let named = || reports.iter().position(|r| r.name.to_lowercase().contains(&lower));
            number.or_else(named).ok_or_else(|| {
                no(format!("no device is called {wanted}; there are: {}", listed()))
            })?
        }
        None => {
            let fit = |r: &DeviceReport| r.missing.is_empty();
            let gpu = reports.iter().position(|r| fit(r) && !r.limits.is_cpu);
            let any = || reports.iter().position(fit);
            gpu.or_else(any).or((!reports.is_empty()).then_some(0)).ok_or_else(no_driver)?
        }
    };
    let report = &reports[index];
    if !report.missing.is_empty() {
        return Err(no(format!("{} lacks {}", report.name, report.missing.join(", "))));
    }
    Ok(index)
}

impl Drop for Headless {
    fn drop(&mut self) {
        self.memory.end();
        // SAFETY: every frame has been ended or leaks by its own word; the queue is idle (`run` waits).
        unsafe {
            self.host.device.destroy_command_pool(self.pool, None);
            self.host.device.destroy_device(None);
            if let Some((loader, messenger)) = self.debug.take() {
                loader.destroy_debug_utils_messenger(messenger, None);
            }
            self.host.instance.destroy_instance(None);
        }
    }
}

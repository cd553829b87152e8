pub(super) mod copy;
pub(super) mod frame;
pub(super) mod look;
pub(super) mod read;
pub(super) mod scattering;

use ash::{ext, khr, vk};

use super::allocator::Blocks;
use super::instance::{chosen, instance, load};
use super::memory::Memory;
use super::pipelines::Pipelines;
use super::surface::{Surface, SurfaceSource, WINDOW_VERSION, queue_family};
use super::validation::{self, Listener, Messages};
use super::{DeviceReport, Host, failed, requirements};
use crate::Result;

/// How to make a device of our own.
#[derive(Clone, Debug, Default)]
pub struct HeadlessOptions {
    /// Part of the device's name, or its number in [`devices`](super::devices). None: the first suitable one,
    /// GPUs before software.
    pub device: Option<String>,
    /// Requires VK_LAYER_KHRONOS_validation with synchronisation validation, and keeps its messages.
    pub validation: bool,
}

/// An instance and its validation messenger; ends both.
struct Started {
    entry: ash::Entry,
    instance: ash::Instance,
    listener: Option<Listener>,
    /// Surface functions, where pictures are shown in a window.
    surface: Option<Surface>,
    /// Outlives the instance, which may report while it is destroyed.
    messages: Messages,
}

impl Started {
    fn new(validation: bool, window: Option<SurfaceSource>) -> Result<Self> {
        let entry = load()?;
        let extensions = match &window {
            Some(window) => window.extensions(&entry)?,
            None => &[],
        };
        if validation {
            validation::require(&entry)?;
        }
        let messages = Messages::default();
        let mut during = validation::messenger(&messages);
        let version = if window.is_some() { WINDOW_VERSION } else { requirements().api_version };
        let instance = instance(&entry, version, validation.then_some(&mut during), extensions)?;
        let mut started =
            Self { entry, instance, listener: None, surface: None, messages: messages.clone() };
        if validation {
            let listener = Listener::new(&started.entry, &started.instance, messages)?;
            started.listener = Some(listener);
        }
        if let Some(window) = window {
            started.surface = Some(Surface::new(&started.entry, &started.instance, window)?);
        }
        Ok(started)
    }
}

impl Drop for Started {
    fn drop(&mut self) {
        if let Some(surface) = &mut self.surface {
            surface.end();
        }
        if let Some(listener) = &self.listener {
            listener.end();
        }
        // SAFETY: the devices made from it have been destroyed: `Headless` destroys its own before its fields
        // drop.
        unsafe { self.instance.destroy_instance(None) };
    }
}

/// A device of our own for offscreen rendering, for programs that have none.
pub struct Headless {
    started: Started,
    /// Tests replace functions of its device.
    #[doc(hidden)]
    pub host: Host,
    /// The queue of its own submissions.
    #[doc(hidden)]
    pub queue: vk::Queue,
    pool: vk::CommandPool,
    report: DeviceReport,
    #[doc(hidden)]
    pub memory: Memory,
    /// Kept between frames, since making pipelines takes most of a small frame's time.
    #[doc(hidden)]
    pub pipelines: Pipelines,
    /// Passes of [`draw_counted`](Self::draw_counted): name, runs, nanoseconds.
    pub(super) counted: Vec<(String, u32, f64)>,
}

/// A device, and the family of its one queue.
fn make_device(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    name: &str,
    surface: Option<&Surface>,
) -> Result<(ash::Device, u32)> {
    let family = queue_family(instance, physical_device, surface);
    let queue_family = family.expect("the report found one");
    let extensions = [khr::swapchain::NAME.as_ptr()];
    let extensions = if surface.is_some() { &extensions[..] } else { &[] };
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(queue_family)
        .queue_priorities(&[1.0])];
    // The window's panel needs both.
    let mut of_window = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .synchronization2(true);
    let mut info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(extensions);
    if surface.is_some() {
        info = info.push_next(&mut of_window);
    }
    // SAFETY: the family was reported as existing; a device for a window has Vulkan 1.3, whose devices have the features.
    let device = unsafe { instance.create_device(physical_device, &info, None) }
        .map_err(failed(format!("making a device on {name}")))?;
    Ok((device, queue_family))
}

impl Headless {
    /// Makes an instance and a device.
    ///
    /// # Errors
    /// No loader, no driver, no device of that name, a device that lacks something, or no validation layer
    /// where it is required.
    pub fn new(options: &HeadlessOptions) -> Result<Self> {
        Self::showing(options, None)
    }

    /// The same, for pictures in a window.
    #[doc(hidden)]
    pub fn showing(options: &HeadlessOptions, window: Option<SurfaceSource>) -> Result<Self> {
        let started = Started::new(options.validation, window)?;
        let (instance, surface) = (started.instance.clone(), started.surface.as_ref());
        let (physical_device, report) = chosen(&instance, options.device.as_deref(), surface)?;
        let (device, queue_family) =
            make_device(&instance, physical_device, &report.name, surface)?;
        let names = || ext::debug_utils::Device::new(&instance, &device);
        let debug_utils = started.listener.is_some().then(names);
        let pipeline_cache = vk::PipelineCache::null();
        let host =
            Host { instance, physical_device, device, queue_family, pipeline_cache, debug_utils };
        let pool_info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        let made = Blocks::new(&host).and_then(|blocks| {
            let memory = Memory::new(&host, Box::new(blocks));
            // SAFETY: the device was made above with one queue of this family.
            let pool = unsafe { host.device.create_command_pool(&pool_info, None) };
            Ok((memory, pool.map_err(failed("making a command pool"))?))
        });
        match made {
            Ok((memory, pool)) => {
                // SAFETY: as above.
                let queue = unsafe { host.device.get_device_queue(queue_family, 0) };
                let (pipelines, counted) = (Pipelines::default(), Vec::new());
                Ok(Self { started, host, queue, pool, report, memory, pipelines, counted })
            }
            Err(error) => {
                // SAFETY: everything made on it has been destroyed.
                unsafe { host.device.destroy_device(None) };
                Err(error)
            }
        }
    }

    /// The surface of its window, and the functions for another one.
    #[doc(hidden)]
    pub fn surface(&mut self) -> Option<(&ash::Entry, &ash::Instance, &mut Surface)> {
        let Started { entry, instance, surface, .. } = &mut self.started;
        Some((entry, instance, surface.as_mut()?))
    }

    /// The device as renderers borrow it.
    pub fn host(&self) -> &Host {
        &self.host
    }

    /// The device and its limits.
    pub fn report(&self) -> &DeviceReport {
        &self.report
    }

    /// Validation messages so far, oldest first; the call empties the list.
    pub fn take_messages(&self) -> Vec<String> {
        self.started.listener.as_ref().map(Listener::take).unwrap_or_default()
    }

    /// Destroys the device, and returns the validation messages since the last [`take_messages`](Self::take_messages): also
    /// those of the destruction, which name every object that is still alive.
    #[doc(hidden)]
    pub fn destroy(self) -> Vec<String> {
        let messages = self.started.messages.clone();
        drop(self);
        messages.lock().map(|mut kept| std::mem::take(&mut *kept)).unwrap_or_default()
    }

    /// Runs `record` in a command buffer of its own and waits for it.
    ///
    /// # Errors
    /// `record`'s own, or the device's.
    pub fn run(&self, record: impl FnOnce(vk::CommandBuffer) -> Result<()>) -> Result<()> {
        self.run_all([record])
    }

    /// Runs each of `records` in a command buffer of its own. All are submitted together, in order, as frames
    /// in flight; waits once.
    ///
    /// # Errors
    /// A record's own, before anything has run, or the device's.
    pub fn run_all<R: FnOnce(vk::CommandBuffer) -> Result<()>>(
        &self,
        records: impl IntoIterator<Item = R, IntoIter: ExactSizeIterator>,
    ) -> Result<()> {
        let device = &self.host.device;
        let records = records.into_iter();
        let allocate = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.pool)
            .command_buffer_count(records.len() as u32);
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: pool, queue and device are ours; the buffers are freed after the queue is idle.
        unsafe {
            let buffers = device
                .allocate_command_buffers(&allocate)
                .map_err(failed("taking a command buffer"))?;
            let recorded = records.zip(&buffers).try_for_each(|(record, &commands)| {
                device.begin_command_buffer(commands, &begin).map_err(failed("recording"))?;
                record(commands)?;
                device.end_command_buffer(commands).map_err(failed("recording"))
            });
            let done = recorded.and_then(|()| {
                let submit = [vk::SubmitInfo::default().command_buffers(&buffers)];
                device
                    .queue_submit(self.queue, &submit, vk::Fence::null())
                    .and_then(|()| device.queue_wait_idle(self.queue))
                    .map_err(failed("running commands"))
            });
            device.free_command_buffers(self.pool, &buffers);
            done
        }
    }
}

impl Drop for Headless {
    fn drop(&mut self) {
        self.memory.end();
        std::mem::take(&mut self.pipelines).end(&self.host);
        // SAFETY: every frame has been ended, or leaks with a warning; the queue is idle (`run` waits).
        unsafe {
            self.host.device.destroy_command_pool(self.pool, None);
            self.host.device.destroy_device(None);
        }
    }
}

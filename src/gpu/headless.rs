use ash::{ext, vk};

use super::instance::{chosen, instance, load};
use super::memory::Memory;
use super::validation::{self, Listener, Messages};
use super::{DeviceReport, Host, failed};
use crate::Result;

/// How a device of our own is made.
#[derive(Clone, Debug, Default)]
pub struct HeadlessOptions {
    /// Part of the device's name, or its number in [`devices`](super::devices); else the first that will do,
    /// graphics processors before software.
    pub device: Option<String>,
    /// Requires VK_LAYER_KHRONOS_validation with synchronisation validation, and keeps its messages.
    pub validation: bool,
}

/// A device of our own, for rendering offscreen: for programs that have none to lend.
pub struct Headless {
    _entry: ash::Entry,
    listener: Option<Listener>,
    host: Host,
    queue: vk::Queue,
    pool: vk::CommandPool,
    report: DeviceReport,
    pub(super) memory: Memory,
}

/// A device with what [`missing`](super::missing) asks for, and the family of its one queue.
fn make_device(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
    name: &str,
) -> Result<(ash::Device, u32)> {
    // SAFETY: the physical device is the instance's.
    let families = unsafe { instance.get_physical_device_queue_family_properties(physical_device) };
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
        .map_err(failed(format!("making a device on {name}")))?;
    Ok((device, queue_family))
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
            validation::require(&entry)?;
        }
        let messages = Messages::default();
        let mut during = validation::messenger(&messages);
        let instance = instance(&entry, options.validation.then_some(&mut during))?;
        let listener = match options.validation {
            true => Some(Listener::new(&entry, &instance, messages)?),
            false => None,
        };
        // Whatever fails below leaves the instance to the end of the process, which is where a
        // failed start goes.
        let (physical_device, report) = chosen(&instance, options.device.as_deref())?;
        let (device, queue_family) = make_device(&instance, physical_device, &report.name)?;
        let pool_info = vk::CommandPoolCreateInfo::default()
            .queue_family_index(queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        // SAFETY: the device was made above with one queue of this family.
        let (queue, pool) = unsafe {
            let pool = device.create_command_pool(&pool_info, None);
            (
                device.get_device_queue(queue_family, 0),
                pool.map_err(failed("making a command pool"))?,
            )
        };
        let names = || ext::debug_utils::Device::new(&instance, &device);
        let debug_utils = listener.is_some().then(names);
        let host = Host { instance, physical_device, device, queue_family, debug_utils };
        let memory = Memory::new(&host)?;
        Ok(Self { _entry: entry, listener, host, queue, pool, report, memory })
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
        self.listener.as_ref().map(Listener::take).unwrap_or_default()
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
}

impl Drop for Headless {
    fn drop(&mut self) {
        self.memory.end();
        // SAFETY: every frame has been ended or leaks by its own word; the queue is idle (`run` waits).
        unsafe {
            self.host.device.destroy_command_pool(self.pool, None);
            self.host.device.destroy_device(None);
            // Its messages stay until after the instance, which may speak while it ends.
            if let Some(listener) = &self.listener {
                listener.end();
            }
            self.host.instance.destroy_instance(None);
        }
    }
}

//! What one frame in flight holds.

use ash::vk;

use super::super::allocator::MemoryUse;
use super::super::memory::Backed;
use super::super::{Headless, failed};
use crate::Result;

/// One frame in flight.
pub(super) struct Slot {
    pub pool: vk::CommandPool,
    pub commands: vk::CommandBuffer,
    /// Signalled when its commands have run.
    pub done: vk::Fence,
    /// Signalled when its picture may be drawn into.
    pub acquired: vk::Semaphore,
    /// Heights of each part, text, and what is read back: made when first needed.
    pub heights: Vec<Option<Backed>>,
    pub text: Option<Backed>,
    pub readback: Option<Backed>,
    /// Whether the last shot lit each of its parts.
    pub was_lit: Vec<bool>,
}

impl Slot {
    pub fn new(gpu: &Headless) -> Result<Self> {
        let host = gpu.host();
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(host.queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        let done = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        let acquired = vk::SemaphoreCreateInfo::default();
        let mut slot = Self {
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            done: vk::Fence::null(),
            acquired: vk::Semaphore::null(),
            heights: Vec::new(),
            text: None,
            readback: None,
            was_lit: Vec::new(),
        };
        // SAFETY: the device is alive; what was made before a failure is destroyed below.
        let made = unsafe {
            (|| {
                slot.pool = host.device.create_command_pool(&pool, None)?;
                slot.done = host.device.create_fence(&done, None)?;
                slot.acquired = host.device.create_semaphore(&acquired, None)?;
                let commands = vk::CommandBufferAllocateInfo::default()
                    .command_pool(slot.pool)
                    .command_buffer_count(1);
                slot.commands = host.device.allocate_command_buffers(&commands)?[0];
                Ok(())
            })()
        };
        match made {
            Ok(()) => Ok(slot),
            Err(result) => {
                slot.end(gpu);
                Err(failed("making a frame in flight")(result))
            }
        }
    }

    /// Its objects; its buffers go with [`free`](Self::free).
    pub fn end(&self, gpu: &Headless) {
        let device = &gpu.host().device;
        // SAFETY: made by this device, or null; the caller says that the device is done with them.
        unsafe {
            device.destroy_command_pool(self.pool, None);
            device.destroy_fence(self.done, None);
            device.destroy_semaphore(self.acquired, None);
        }
    }

    pub fn free(&mut self, gpu: &mut Headless) {
        let others = [&mut self.text, &mut self.readback];
        let all = self.heights.iter_mut().chain(others);
        for mut backed in all.filter_map(Option::take) {
            gpu.memory.free(&mut backed);
        }
    }
}

/// A buffer of at least so many bytes in the place of one that is none or smaller.
pub(super) fn fitting<'b>(
    gpu: &mut Headless,
    place: &'b mut Option<Backed>,
    (name, bytes): (&str, u64),
    used_by: MemoryUse,
) -> Result<&'b mut Backed> {
    if place.as_mut().and_then(Backed::mapped).is_none_or(|m| (m.len() as u64) < bytes) {
        if let Some(mut old) = place.take() {
            gpu.memory.free(&mut old);
        }
        let usage = match used_by {
            MemoryUse::Readback => vk::BufferUsageFlags::TRANSFER_DST,
            _ => vk::BufferUsageFlags::TRANSFER_SRC,
        };
        *place = Some(gpu.memory.buffer(name, bytes, usage, used_by)?);
    }
    Ok(place.as_mut().expect("made above"))
}

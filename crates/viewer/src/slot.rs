//! The objects of one frame in flight.

use ash::vk;

use ridgelight::Result;
use ridgelight::gpu::{Backed, Headless, MemoryUse, failed};

/// One frame in flight.
pub(super) struct Slot {
    pub pool: vk::CommandPool,
    pub commands: vk::CommandBuffer,
    /// Signalled when its commands have run.
    pub done: vk::Fence,
    /// Whether submitted commands will signal `done`, and may not have yet.
    pub is_in_flight: bool,
    /// Signalled when its picture may be drawn into; null until [`acquired`](Self::acquired) makes it.
    pub acquired: vk::Semaphore,
    /// Heights of each pane, and the picture that is read back: made when first needed.
    pub heights: Vec<Option<Backed>>,
    pub readback: Option<Backed>,
    /// Whether the last picture lit each of its panes.
    pub was_lit: Vec<bool>,
}

impl Slot {
    pub fn new(gpu: &Headless) -> Result<Self> {
        let host = gpu.host();
        let pool = vk::CommandPoolCreateInfo::default()
            .queue_family_index(host.queue_family)
            .flags(vk::CommandPoolCreateFlags::TRANSIENT);
        let done = vk::FenceCreateInfo::default();
        let mut slot = Self {
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            done: vk::Fence::null(),
            is_in_flight: false,
            acquired: vk::Semaphore::null(),
            heights: Vec::new(),
            readback: None,
            was_lit: Vec::new(),
        };
        // SAFETY: the device is alive; what was made before a failure is destroyed below.
        let made = unsafe {
            (|| {
                slot.pool = host.device.create_command_pool(&pool, None)?;
                slot.done = host.device.create_fence(&done, None)?;
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

    /// Waits for its commands: then it is free.
    pub fn settle(&mut self, gpu: &Headless) -> Result<()> {
        if self.is_in_flight {
            // SAFETY: the fence is this slot's, and what signals it was submitted.
            unsafe { gpu.host().device.wait_for_fences(&[self.done], true, u64::MAX) }
                .map_err(failed("waiting for a frame"))?;
            self.is_in_flight = false;
        }
        Ok(())
    }

    /// Semaphore of the next acquisition; made where there is none.
    pub fn acquired(&mut self, gpu: &Headless) -> Result<vk::Semaphore> {
        if self.acquired == vk::Semaphore::null() {
            let info = vk::SemaphoreCreateInfo::default();
            // SAFETY: the device is alive.
            self.acquired = unsafe { gpu.host().device.create_semaphore(&info, None) }
                .map_err(failed("making a frame in flight"))?;
        }
        Ok(self.acquired)
    }

    /// Drops a semaphore that nothing will wait for, once the device has finished and its swapchain is gone.
    pub fn give_up(&mut self, gpu: &Headless) {
        self.was_lit.clear();
        // SAFETY: made by this device, or null; nothing uses it any more, as the caller guarantees.
        unsafe { gpu.host().device.destroy_semaphore(std::mem::take(&mut self.acquired), None) };
    }

    /// Its objects; its buffers go with [`free`](Self::free).
    pub fn end(&self, gpu: &Headless) {
        let device = &gpu.host().device;
        // SAFETY: made by this device, or null; the caller guarantees that the device has finished with them.
        unsafe {
            device.destroy_command_pool(self.pool, None);
            device.destroy_fence(self.done, None);
            device.destroy_semaphore(self.acquired, None);
        }
    }

    pub fn free(&mut self, gpu: &mut Headless) {
        let all = self.heights.iter_mut().chain([&mut self.readback]);
        for mut backed in all.filter_map(Option::take) {
            gpu.memory.free(&mut backed);
        }
    }
}

/// A buffer of at least `bytes`, which replaces none or a smaller one.
pub(super) fn fitting<'b>(
    gpu: &mut Headless,
    place: &'b mut Option<Backed>,
    (name, bytes): (&str, u64),
    used_by: MemoryUse,
) -> Result<&'b mut Backed> {
    if place.as_mut().is_none_or(|old| (old.mapped().len() as u64) < bytes) {
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

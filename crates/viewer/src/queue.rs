//! Acquires, submits and presents pictures.

use ash::vk;

use super::{Pane, PresentOptions, Screen};
use ridgelight::Result;
use ridgelight::gpu::failed;

/// Timeout of acquiring a picture: compositors may hold pictures of hidden windows.
const PATIENCE_NS: u64 = 500_000_000;

impl Screen {
    /// The index of the picture to draw into; the slot is free.
    pub(super) fn acquire(&mut self, slot: usize) -> Result<Option<usize>> {
        let acquired = self.slots[slot].acquired(&self.gpu)?;
        let Some(chain) = &mut self.chain else { return Ok(None) };
        let none = vk::Fence::null();
        // SAFETY: the semaphore is this slot's, whose commands, which waited for it, have run.
        let got = unsafe {
            self.swapchains.acquire_next_image(chain.swapchain, PATIENCE_NS, acquired, none)
        };
        match got {
            Ok((image, is_suboptimal)) => {
                chain.is_stale |= is_suboptimal;
                Ok(Some(image as usize))
            }
            Err(vk::Result::TIMEOUT | vk::Result::NOT_READY) => Ok(None),
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                chain.is_stale = true;
                Ok(None)
            }
            Err(vk::Result::ERROR_SURFACE_LOST_KHR) => self.renew().map(|()| None),
            Err(other) => Err(failed("taking a picture of the window's")(other)),
        }
    }

    /// Records an acquired picture, runs it and presents it; returns whether the window presented it.
    pub(super) fn hand_over(
        &mut self,
        slot: usize,
        image: usize,
        panes: &mut [Pane<'_>],
        options: &PresentOptions<'_>,
    ) -> Result<bool> {
        self.record(slot, image, panes, options)?;
        self.submit(slot, Some(image))?;
        self.present(slot, image)
    }

    /// Drops the swapchain after an acquired picture could not be submitted; with it the semaphore of the
    /// acquisition, which nothing will wait for.
    pub(super) fn give_up(&mut self, slot: usize) {
        // A lost device has finished with everything.
        let _ = self.wait();
        self.end_chain();
        self.slots[slot].give_up(&self.gpu);
    }

    /// Destroys the swapchain. The device must no longer use it.
    pub(super) fn end_chain(&mut self) {
        if let Some(chain) = self.chain.take() {
            chain.end(&self.gpu, &self.swapchains);
        }
    }

    /// Runs a slot's commands, which draw into an acquired picture or only light a frame.
    pub(super) fn submit(&mut self, slot: usize, image: Option<usize>) -> Result<()> {
        let (device, slot) = (&self.gpu.host().device, &mut self.slots[slot]);
        let stage = vk::PipelineStageFlags2::ALL_TRANSFER;
        let wait = [vk::SemaphoreSubmitInfo::default().semaphore(slot.acquired).stage_mask(stage)];
        let finished = self.chain.as_ref().zip(image).map(|(chain, image)| chain.finished[image]);
        let signal = [vk::SemaphoreSubmitInfo::default()
            .semaphore(finished.unwrap_or_default())
            .stage_mask(vk::PipelineStageFlags2::ALL_COMMANDS)];
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(slot.commands)];
        let mut submit = [vk::SubmitInfo2::default().command_buffer_infos(&commands)];
        if finished.is_some() {
            submit = submit.map(|s| s.wait_semaphore_infos(&wait).signal_semaphore_infos(&signal));
        }
        // SAFETY: everything is this device's; the slot is free.
        unsafe {
            device
                .reset_fences(&[slot.done])
                .and_then(|()| device.queue_submit2(self.gpu.queue, &submit, slot.done))
        }
        .map_err(failed("running a frame"))?;
        slot.is_in_flight = true;
        Ok(())
    }

    /// Whether the window presents it.
    fn present(&mut self, slot: usize, image: usize) -> Result<bool> {
        let chain = self.chain.as_mut().expect("acquired from");
        let (finished, swapchains) = ([chain.finished[image]], [chain.swapchain]);
        let images = [image as u32];
        let info = vk::PresentInfoKHR::default()
            .wait_semaphores(&finished)
            .swapchains(&swapchains)
            .image_indices(&images);
        // SAFETY: the picture was acquired, and this slot's commands leave it for presentation.
        let shown = unsafe { self.swapchains.queue_present(self.gpu.queue, &info) };
        match shown {
            Ok(is_suboptimal) => {
                chain.is_stale |= is_suboptimal;
                Ok(true)
            }
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                chain.is_stale = true;
                Ok(false)
            }
            Err(vk::Result::ERROR_SURFACE_LOST_KHR) => self.renew().map(|()| false),
            Err(other) => Err(failed(format!("showing frame {slot}"))(other)),
        }
    }
}

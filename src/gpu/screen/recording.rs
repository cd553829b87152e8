//! One frame's commands.

use ash::vk;

use super::super::allocator::MemoryUse;
use super::super::memory::whole;
use super::super::{Frame, failed};
use super::drawer::{COPIED, Drawer};
use super::{Panel, Screen, Shot, Sight, Slot, fitting};
use crate::{Error, Result};

/// Where the window's picture is, between the copies into it.
const FILLED: (vk::ImageLayout, vk::AccessFlags2) =
    (vk::ImageLayout::TRANSFER_DST_OPTIMAL, vk::AccessFlags2::TRANSFER_WRITE);
const READ: (vk::ImageLayout, vk::AccessFlags2) =
    (vk::ImageLayout::TRANSFER_SRC_OPTIMAL, vk::AccessFlags2::TRANSFER_READ);
const NEW: (vk::ImageLayout, vk::AccessFlags2) =
    (vk::ImageLayout::UNDEFINED, vk::AccessFlags2::NONE);
const SHOWN: (vk::ImageLayout, vk::AccessFlags2) =
    (vk::ImageLayout::PRESENT_SRC_KHR, vk::AccessFlags2::NONE);

impl Screen {
    /// What the shot hands to the device; the slot is free.
    pub(super) fn prepare(&mut self, slot: usize, frame: &Frame, shot: &Shot<'_>) -> Result<()> {
        let [cols, rows] = frame.plan().size;
        let samples = cols as usize * rows as usize;
        if shot.heights.is_some_and(|h| h.len() != samples) {
            let found = format!("{} heights", shot.heights.map_or(0, <[f32]>::len));
            return Err(Error::setting("heights", found, format!("{samples}, one a sample")));
        }
        let chain = self.chain.as_ref().expect("acquired from");
        let (size, swaps) = match shot.sight {
            Sight::Map(map) => (map.size, map.swaps),
            Sight::Camera(view) => (view.size, chain.swaps()),
        };
        if size != chain.size || swaps != chain.swaps() {
            return Err(Error::setting("sight: size", "another", "the window's pictures'"));
        }
        let pixels = u64::from(chain.size[0]) * u64::from(chain.size[1]);
        let gpu = &mut self.gpu;
        let is_readable = chain.is_readable;
        let of_slot = &mut self.slots[slot];
        if let Some(heights) = shot.heights {
            let bytes: &[u8] = bytemuck::cast_slice(heights);
            let named = ("heights of a frame", bytes.len() as u64);
            put(fitting(gpu, &mut of_slot.heights, named, MemoryUse::Upload)?, bytes)?;
        }
        if let Some(panel) = &shot.panel {
            let texels: Vec<[u8; 4]> = panel.pixels.iter().map(|p| ordered(*p, swaps)).collect();
            let bytes = texels.as_flattened();
            let named = ("text of a frame", bytes.len() as u64);
            put(fitting(gpu, &mut of_slot.panel, named, MemoryUse::Upload)?, bytes)?;
        }
        if shot.keeps {
            if !is_readable {
                let reason = "the window's pictures cannot be copied".into();
                return Err(Error::Device { doing: "reading a picture back".into(), reason });
            }
            let named = ("picture of a frame", 4 * pixels);
            fitting(gpu, &mut of_slot.readback, named, MemoryUse::Readback)?;
        }
        if self.drawer.as_ref().is_none_or(|d| !d.fits(shot)) {
            self.wait()?;
            if let Some(old) = self.drawer.take() {
                old.end(&mut self.gpu);
            }
            self.drawer = Some(Drawer::new(&mut self.gpu, shot, swaps)?);
        }
        let drawer = self.drawer.as_mut().expect("made above");
        drawer.set_tone(&mut self.gpu, shot.tone)
    }

    pub(super) fn record(
        &mut self,
        slot: usize,
        image: usize,
        frame: &mut Frame,
        shot: &Shot<'_>,
    ) -> Result<()> {
        let device = self.gpu.host().device.clone();
        let Slot { pool, commands, .. } = self.slots[slot];
        let begin = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the slot's commands have run.
        unsafe {
            device
                .reset_command_pool(pool, vk::CommandPoolResetFlags::empty())
                .and_then(|()| device.begin_command_buffer(commands, &begin))
        }
        .map_err(failed("recording a frame"))?;
        if shot.heights.is_some() {
            self.copy_heights(slot, frame);
        }
        if !shot.passes.is_empty() {
            let (inputs, outputs) = (frame.inputs(), frame.outputs());
            frame.renderer().record_passes(commands, slot, &inputs, &outputs, shot.passes)?;
        }
        let drawer = self.drawer.as_mut().expect("prepared");
        drawer.record(&self.gpu, commands, slot, (shot, frame))?;
        self.fill(slot, image, shot);
        // SAFETY: recording was begun above.
        unsafe { device.end_command_buffer(commands) }.map_err(failed("recording a frame"))
    }

    /// From the slot's buffer into the frame's first input, which is in GENERAL: what used it before and will
    /// next is the renderer's to wait for, which hands it over for any use.
    fn copy_heights(&self, slot: usize, frame: &Frame) {
        let (Some(from), commands) = (&self.slots[slot].heights, self.slots[slot].commands) else {
            return;
        };
        let [width, height] = frame.plan().size;
        let region = [copied([width, height])];
        let general = vk::ImageLayout::GENERAL;
        let to = frame.inputs()[0].image;
        let all = vk::PipelineStageFlags2::ALL_COMMANDS;
        let any = vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE;
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(any)
            .dst_stage_mask(all)
            .dst_access_mask(any)];
        let wait = vk::DependencyInfo::default().memory_barriers(&barrier);
        let device = &self.gpu.host().device;
        // SAFETY: `commands` is being recorded; the buffer holds a height a texel.
        unsafe {
            device.cmd_pipeline_barrier2(commands, &wait);
            device.cmd_copy_buffer_to_image(commands, from.buffer, to, general, &region);
        }
    }

    /// Copies picture and text into the window's image, and back to the host where they are kept.
    fn fill(&self, slot: usize, image: usize, shot: &Shot<'_>) {
        let (device, slot) = (&self.gpu.host().device, &self.slots[slot]);
        let chain = self.chain.as_ref().expect("acquired from");
        let (to, commands) = (chain.images[image], slot.commands);
        let change = |from: (vk::ImageLayout, vk::AccessFlags2), to_state| {
            self.change(commands, to, from, to_state);
        };
        let whole_image = copied(chain.size);
        let (size, part) = (whole_image.image_extent, whole_image.image_subresource);
        let copy =
            [vk::ImageCopy::default().src_subresource(part).dst_subresource(part).extent(size)];
        let picture = self.drawer.as_ref().expect("prepared").picture();
        change(NEW, FILLED);
        // SAFETY: `commands` is being recorded; texels of both images are four bytes; both are of the size.
        unsafe {
            device.cmd_copy_image(commands, picture, COPIED.layout, to, FILLED.0, &copy);
        }
        if let (Some(panel), Some(from)) = (&shot.panel, &slot.panel) {
            change(FILLED, FILLED);
            let region = [text(panel, chain.size)];
            // SAFETY: the buffer holds the panel's pixels, the region is cut to the image.
            unsafe {
                device.cmd_copy_buffer_to_image(commands, from.buffer, to, FILLED.0, &region);
            }
        }
        let mut last = FILLED;
        if let (true, Some(back)) = (shot.keeps, &slot.readback) {
            change(FILLED, READ);
            let written = [vk::MemoryBarrier2::default()
                .src_stage_mask(vk::PipelineStageFlags2::COPY)
                .src_access_mask(vk::AccessFlags2::TRANSFER_WRITE)
                .dst_stage_mask(vk::PipelineStageFlags2::HOST)
                .dst_access_mask(vk::AccessFlags2::HOST_READ)];
            let info = vk::DependencyInfo::default().memory_barriers(&written);
            // SAFETY: the buffer holds a picture.
            unsafe {
                let region = [whole_image];
                device.cmd_copy_image_to_buffer(commands, to, READ.0, back.buffer, &region);
                device.cmd_pipeline_barrier2(commands, &info);
            }
            last = READ;
        }
        change(last, SHOWN);
    }

    /// A barrier between copies; the first comes after what the semaphore of the picture waits for.
    fn change(
        &self,
        commands: vk::CommandBuffer,
        image: vk::Image,
        from: (vk::ImageLayout, vk::AccessFlags2),
        to: (vk::ImageLayout, vk::AccessFlags2),
    ) {
        let barrier = [vk::ImageMemoryBarrier2::default()
            .src_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .src_access_mask(from.1)
            .dst_stage_mask(vk::PipelineStageFlags2::ALL_TRANSFER)
            .dst_access_mask(to.1)
            .old_layout(from.0)
            .new_layout(to.0)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image)
            .subresource_range(whole(1))];
        let info = vk::DependencyInfo::default().image_memory_barriers(&barrier);
        // SAFETY: `commands` is being recorded; the image is the window's, acquired.
        unsafe { self.gpu.host().device.cmd_pipeline_barrier2(commands, &info) };
    }

    /// What the slot read back, once it has run.
    pub(super) fn read_back(&mut self, slot: usize) -> Result<Vec<[u8; 4]>> {
        let chain = self.chain.as_ref();
        let (swaps, size) = chain.map_or((false, [0; 2]), |c| (c.swaps(), c.size));
        let slot = &mut self.slots[slot];
        // SAFETY: the fence is the slot's, its commands have been submitted.
        unsafe { self.gpu.host().device.wait_for_fences(&[slot.done], true, u64::MAX) }
            .map_err(failed("waiting for a frame"))?;
        let mapped = slot.readback.as_mut().and_then(|b| b.mapped());
        let mapped =
            mapped.ok_or_else(|| failed("reading back")(vk::Result::ERROR_MEMORY_MAP_FAILED))?;
        let pixels = mapped.as_chunks::<4>().0.iter().take(size[0] as usize * size[1] as usize);
        Ok(pixels.map(|p| ordered(*p, swaps)).collect())
    }
}

fn ordered([r, g, b, a]: [u8; 4], swaps: bool) -> [u8; 4] {
    if swaps { [b, g, r, a] } else { [r, g, b, a] }
}

fn put(backed: &mut super::Backed, bytes: &[u8]) -> Result<()> {
    let mapped = backed.mapped();
    let mapped = mapped.ok_or_else(|| failed("uploading")(vk::Result::ERROR_MEMORY_MAP_FAILED))?;
    mapped[..bytes.len()].copy_from_slice(bytes);
    Ok(())
}

/// All of an image of one layer, rows packed.
fn copied([width, height]: [u32; 2]) -> vk::BufferImageCopy {
    vk::BufferImageCopy::default()
        .image_subresource(vk::ImageSubresourceLayers {
            aspect_mask: vk::ImageAspectFlags::COLOR,
            mip_level: 0,
            base_array_layer: 0,
            layer_count: 1,
        })
        .image_extent(vk::Extent3D { width, height, depth: 1 })
}

/// A panel's part of a picture.
fn text(panel: &Panel<'_>, size: [u32; 2]) -> vk::BufferImageCopy {
    let [width, height] = panel.size;
    let region = copied([width.min(size[0]), height.min(size[1])]);
    region.buffer_row_length(width).buffer_image_height(height)
}

use ash::vk;

use crate::gpu::allocator::MemoryUse;
use crate::gpu::barriers::Barriers;
use crate::gpu::headless::frame::Owned;
use crate::gpu::memory::{Backed, region};
use crate::gpu::{Headless, ImageArg, ImageState};
use crate::{Error, Result};

/// Largest staging buffer, in bytes.
const STAGING_BYTES: u64 = 64 << 20;

impl Headless {
    pub(in crate::gpu) fn to_general(&self, commands: vk::CommandBuffer, image: &Owned) {
        // Its contents are not needed.
        let before = ImageState { layout: vk::ImageLayout::UNDEFINED, ..ImageState::ANY_USE };
        self.transition(commands, &ImageArg { before, ..image.arg() });
    }

    /// A barrier within `commands`, which is being recorded, from all before to all after it and to the host.
    pub(in crate::gpu) fn wait_for_all(&self, commands: vk::CommandBuffer) {
        let (all, read) = (vk::PipelineStageFlags2::ALL_COMMANDS, vk::AccessFlags2::MEMORY_READ);
        let barrier = [vk::MemoryBarrier2::default()
            .src_stage_mask(all)
            .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
            .dst_stage_mask(all | vk::PipelineStageFlags2::HOST)
            .dst_access_mask(read | vk::AccessFlags2::MEMORY_WRITE | vk::AccessFlags2::HOST_READ)];
        // SAFETY: the caller guarantees that `commands` is being recorded.
        unsafe {
            Barriers::default().memory(&barrier).record(&self.host().device, commands);
        }
    }

    /// Copies between an image in GENERAL and host memory, several whole rows at a time.
    pub(in crate::gpu) fn copy(
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
        let used_by = if to_image { MemoryUse::Upload } else { MemoryUse::Readback };
        let mut staging =
            self.memory.buffer("staging", row_bytes * u64::from(rows), usage, used_by)?;
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
        let mut touch = |staging: &mut Backed| each(staging.mapped());
        if to_image {
            touch(staging)?;
        }
        let mut region = [region([image.extent[0], count, 1])];
        region[0].image_subresource.base_array_layer = layer;
        region[0].image_offset.y = top as i32;
        let (image, buffer) = (image.backed.image, staging.buffer);
        let (device, general) = (&self.host().device, vk::ImageLayout::GENERAL);
        self.run(|commands| {
            self.wait_for_all(commands);
            // SAFETY: the image is in GENERAL, the buffer as large as the region, both ours.
            unsafe {
                if to_image {
                    device.cmd_copy_buffer_to_image(commands, buffer, image, general, &region);
                } else {
                    device.cmd_copy_image_to_buffer(commands, image, general, buffer, &region);
                }
            }
            self.wait_for_all(commands);
            Ok(())
        })?;
        if to_image { Ok(()) } else { touch(staging) }
    }

    /// Fills an image; `values` are its texels, 1 or 4 f32 each.
    #[doc(hidden)]
    pub fn upload(&mut self, image: &Owned, values: &[f32]) -> Result<()> {
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
}

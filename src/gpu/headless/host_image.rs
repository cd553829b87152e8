//! Images in an engine's own formats: for tests, and for programs with 8 or 16 bits per channel.

use ash::vk;

use crate::gpu::allocator::MemoryUse;
use crate::gpu::memory::Backed;
use crate::gpu::{BufferArg, Headless, ImageArg, ImageState};
use crate::{Error, Result};

/// An image outside a frame, in GENERAL; freed by [`Headless::take_back`].
pub struct HostImage {
    backed: Backed,
    format: vk::Format,
    extent: [u32; 3],
}

impl HostImage {
    /// As an argument that replaces a frame's own input.
    pub fn arg(&self) -> ImageArg {
        ImageArg {
            image: self.backed.image,
            view: self.backed.view,
            format: self.format,
            extent: self.extent,
            before: ImageState::ANY_USE,
            after: ImageState::ANY_USE,
        }
    }
}

/// A buffer of texels, freed by [`Headless::take_back_buffer`].
pub struct HostBuffer {
    backed: Backed,
    bytes: u64,
}

impl HostBuffer {
    /// As an argument for a plan that takes a buffer: from its first byte, rows consecutive.
    pub fn arg(&self) -> BufferArg {
        BufferArg {
            buffer: self.backed.buffer,
            bytes: self.bytes,
            offset: 0,
            row_bytes: 0,
            stage: ImageState::ANY_USE.stage,
            access: ImageState::ANY_USE.access,
        }
    }

    /// Its bytes; the device must not be using them.
    pub fn contents(&mut self) -> &mut [u8] {
        self.backed.mapped().expect("uploads are mapped")
    }
}

impl Headless {
    /// Makes and fills a buffer that the host writes and a renderer copies from.
    ///
    /// # Errors
    /// No bytes, or the device's.
    pub fn lend_buffer(&mut self, name: &str, contents: &[u8]) -> Result<HostBuffer> {
        if contents.is_empty() {
            return Err(Error::setting(name, "no bytes", "at least one texel"));
        }
        let (usage, bytes) = (vk::BufferUsageFlags::TRANSFER_SRC, contents.len() as u64);
        let backed = self.memory.buffer(name, bytes, usage, MemoryUse::Upload)?;
        let mut lent = HostBuffer { backed, bytes };
        lent.contents().copy_from_slice(contents);
        Ok(lent)
    }

    /// Frees such a buffer.
    pub fn take_back_buffer(&mut self, mut lent: HostBuffer) {
        self.memory.free(&mut lent.backed);
    }

    /// Makes and fills an image of a colour format that the device can sample; texels row by row, packed as in
    /// Vulkan.
    ///
    /// # Errors
    /// The bytes are not whole texels for `cols` × `rows`, or the device's.
    pub fn lend(
        &mut self,
        name: &str,
        format: vk::Format,
        [cols, rows]: [u32; 2],
        texels: &[u8],
    ) -> Result<HostImage> {
        let count = cols as usize * rows as usize;
        if count == 0 || texels.is_empty() || !texels.len().is_multiple_of(count) {
            return Err(Error::setting(
                name,
                format!("{} bytes for {cols} × {rows} texels", texels.len()),
                "as many for each of at least one texel",
            ));
        }
        let host = self.host();
        // SAFETY: the physical device is the instance's.
        let properties = unsafe {
            host.instance.get_physical_device_format_properties(host.physical_device, format)
        };
        if !properties.optimal_tiling_features.contains(vk::FormatFeatureFlags::SAMPLED_IMAGE) {
            let found = format!("{format:?}");
            return Err(Error::setting(name, found, "a format that the device samples"));
        }
        let extent = [cols, rows, 1];
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let backed = self.memory.image_for(name, (format, usage), extent, false)?;
        let mut lent = HostImage { backed, format, extent };
        match self.fill_lent(&lent, texels) {
            Ok(()) => Ok(lent),
            Err(error) => {
                self.memory.free(&mut lent.backed);
                Err(error)
            }
        }
    }

    fn fill_lent(&mut self, lent: &HostImage, texels: &[u8]) -> Result<()> {
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let bytes = texels.len() as u64;
        let mut staging = self.memory.buffer("staging", bytes, usage, MemoryUse::Upload)?;
        staging.mapped().expect("uploads are mapped").copy_from_slice(texels);
        let [width, height, _] = lent.extent;
        let region = [vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                mip_level: 0,
                base_array_layer: 0,
                layer_count: 1,
            })
            .image_extent(vk::Extent3D { width, height, depth: 1 })];
        let filled = self.run(|commands| {
            let unknown = ImageState { layout: vk::ImageLayout::UNDEFINED, ..ImageState::ANY_USE };
            self.transition(commands, &ImageArg { before: unknown, ..lent.arg() });
            let (from, to) = (staging.buffer, lent.backed.image);
            let device = &self.host().device;
            // SAFETY: the image is in GENERAL, the buffer holds its texels, both are ours.
            unsafe {
                let layout = vk::ImageLayout::GENERAL;
                device.cmd_copy_buffer_to_image(commands, from, to, layout, &region);
            }
            self.transition(commands, &lent.arg());
            Ok(())
        });
        self.memory.free(&mut staging);
        filled
    }

    /// Frees such an image.
    pub fn take_back(&mut self, mut lent: HostImage) {
        self.memory.free(&mut lent.backed);
    }
}

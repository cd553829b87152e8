use ash::vk;
use gpu_allocator::MemoryLocation;

use super::super::failed;
use super::{Backed, Memory};
use crate::Result;

/// Depth, farthest 0.
pub(crate) const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// All of an image that is drawn into.
pub(crate) fn whole_attachment(format: vk::Format) -> vk::ImageSubresourceRange {
    let aspect =
        if format == DEPTH { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR };
    vk::ImageSubresourceRange { aspect_mask: aspect, ..super::whole(1) }
}

impl Memory {
    /// An image to draw into, of `samples` a pixel; also to copy from where that is one, and, of colour, to sample.
    pub fn attachment(
        &mut self,
        name: &str,
        format: vk::Format,
        [width, height]: [u32; 2],
        samples: vk::SampleCountFlags,
    ) -> Result<Backed> {
        let mut usage = if format == DEPTH {
            vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
        } else {
            vk::ImageUsageFlags::COLOR_ATTACHMENT
        };
        if samples == vk::SampleCountFlags::TYPE_1 {
            usage |= vk::ImageUsageFlags::TRANSFER_SRC;
            if format != DEPTH {
                usage |= vk::ImageUsageFlags::SAMPLED;
            }
        }
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width, height, depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(samples)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(usage);
        let device = self.host.device.clone();
        // SAFETY: the device is alive; size and samples are within its limits (`ViewRenderer::new`).
        let image = unsafe { device.create_image(&info, None) }
            .map_err(failed(format!("making image {name}")))?;
        let mut backed = Backed {
            image,
            view: vk::ImageView::null(),
            buffer: vk::Buffer::null(),
            texels: vk::BufferView::null(),
            allocation: None,
            layers: 1,
        };
        // SAFETY: `image` was made above on this device.
        let requirements = unsafe { device.get_image_memory_requirements(image) };
        let made =
            self.take(name, requirements, MemoryLocation::GpuOnly, false).and_then(|allocation| {
                let view = vk::ImageViewCreateInfo::default()
                    .image(image)
                    .view_type(vk::ImageViewType::TYPE_2D)
                    .format(format)
                    .subresource_range(whole_attachment(format));
                // SAFETY: the allocation is as large as the image requires and bound once; the view is of the
                // image's own format.
                let view = unsafe {
                    device
                        .bind_image_memory(image, allocation.memory(), allocation.offset())
                        .and_then(|()| device.create_image_view(&view, None))
                };
                backed.allocation = Some(allocation);
                backed.view = view.map_err(failed(format!("making image {name}")))?;
                Ok(())
            });
        match made {
            Ok(()) => {
                self.label(image, name);
                Ok(backed)
            }
            Err(error) => {
                self.free(&mut backed);
                Err(error)
            }
        }
    }
}

use ash::vk;

use super::{Backed, Memory};
use crate::Result;

/// Depth format; 0 is farthest.
pub(crate) const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// The whole of an attachment.
pub(crate) fn whole_attachment(format: vk::Format) -> vk::ImageSubresourceRange {
    let aspect =
        if format == DEPTH { vk::ImageAspectFlags::DEPTH } else { vk::ImageAspectFlags::COLOR };
    vk::ImageSubresourceRange { aspect_mask: aspect, ..super::whole(1) }
}

impl Memory {
    /// An attachment with `samples` MSAA samples. A single-sample one can be copied from. Shaders can read single-sample
    /// colour and multisample depth.
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
        let is_single = samples == vk::SampleCountFlags::TYPE_1;
        if is_single {
            usage |= vk::ImageUsageFlags::TRANSFER_SRC;
        }
        if is_single != (format == DEPTH) {
            usage |= vk::ImageUsageFlags::SAMPLED;
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
        let range = whole_attachment(format);
        self.image_of(name, &info, (vk::ImageViewType::TYPE_2D, range))
    }
}

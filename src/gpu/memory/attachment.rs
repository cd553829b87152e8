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
        self.image_for(name, (format, usage, samples), [width, height, 1], false)
    }
}

//! Image arguments, and the barriers between uses of an image.

use ash::vk;

use super::super::memory::whole;

/// The use of an image at a point of a command buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageState {
    /// Stages of its last or next use.
    pub stage: vk::PipelineStageFlags2,
    /// Accesses of its last or next use.
    pub access: vk::AccessFlags2,
    /// Its layout. UNDEFINED is allowed for outputs before a recording: their contents are not kept.
    pub layout: vk::ImageLayout,
}

impl ImageState {
    /// How the renderer uses inputs.
    pub(super) const READ: Self = Self {
        stage: vk::PipelineStageFlags2::COMPUTE_SHADER,
        access: vk::AccessFlags2::SHADER_SAMPLED_READ,
        layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    };
    /// How the renderer uses outputs and its own images.
    pub(super) const WRITTEN: Self = Self {
        stage: vk::PipelineStageFlags2::COMPUTE_SHADER,
        access: vk::AccessFlags2::from_raw(
            vk::AccessFlags2::SHADER_STORAGE_READ.as_raw()
                | vk::AccessFlags2::SHADER_STORAGE_WRITE.as_raw()
                | vk::AccessFlags2::SHADER_SAMPLED_READ.as_raw(),
        ),
        layout: vk::ImageLayout::GENERAL,
    };
}

/// An image of the caller, for one recording.
#[derive(Clone, Copy, Debug)]
pub struct ImageArg {
    /// The image; only mip level 0 and array layers from 0 are used and change state. Inputs need usage
    /// SAMPLED, outputs STORAGE and SAMPLED.
    pub image: vk::Image,
    /// A view of its colour aspect: 2D, or 2D array where the plan's resource is layered.
    pub view: vk::ImageView,
    /// Its format: the plan's. An input of heights, an environment, an albedo or light colours may have another
    /// of [`Format::vk_read`](crate::graph::Format::vk_read) that the device can sample, except in a
    /// [`plan::reference`](crate::plan::reference()).
    pub format: vk::Format,
    /// Columns, rows and layers; must match the plan.
    pub extent: [u32; 3],
    /// State before the recording.
    pub before: ImageState,
    /// State after the recording. Ignored for inputs, which are left as before.
    pub after: ImageState,
}

/// A barrier over a whole image.
pub fn transition<'a>(
    image: vk::Image,
    layers: u32,
    from: ImageState,
    to: ImageState,
) -> vk::ImageMemoryBarrier2<'a> {
    vk::ImageMemoryBarrier2::default()
        .src_stage_mask(from.stage)
        .src_access_mask(from.access)
        .dst_stage_mask(to.stage)
        .dst_access_mask(to.access)
        .old_layout(from.layout)
        .new_layout(to.layout)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .image(image)
        .subresource_range(whole(layers))
}

//! What a caller says of images, and barriers between what they are used for.

use ash::vk;

use super::super::memory::whole;

/// What an image is being used for at a point of a command buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageState {
    /// Stages that used it last, or will next.
    pub stage: vk::PipelineStageFlags2,
    /// How they did, or will.
    pub access: vk::AccessFlags2,
    /// Its layout. UNDEFINED is allowed for outputs on entry: their contents are not kept.
    pub layout: vk::ImageLayout,
}

impl ImageState {
    /// What the renderer uses inputs as.
    pub(super) const READ: Self = Self {
        stage: vk::PipelineStageFlags2::COMPUTE_SHADER,
        access: vk::AccessFlags2::SHADER_SAMPLED_READ,
        layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    };
    /// What the renderer uses outputs and its own images as.
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

/// An image of the caller's, handed in for one recording.
#[derive(Clone, Copy, Debug)]
pub struct ImageArg {
    /// The image, of mip level 0 and array layers from 0: no others are looked at, nor change state. Inputs
    /// are made with usage SAMPLED, outputs with STORAGE.
    pub image: vk::Image,
    /// A view of its colour: 2D, or 2D array where the plan's resource is layered.
    pub view: vk::ImageView,
    /// Its format: the plan's; of inputs that only hold heights, an environment, an albedo or colours of lights also another
    /// of [`Format::vk_read`](crate::graph::Format::vk_read) that the device can sample.
    pub format: vk::Format,
    /// Columns, rows and layers; must be the plan's.
    pub extent: [u32; 3],
    /// How it comes.
    pub before: ImageState,
    /// How it is left. Inputs are left as they came, whatever stands here.
    pub after: ImageState,
}

/// A barrier over a whole image.
pub(in crate::gpu) fn transition<'a>(
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

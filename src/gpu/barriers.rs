//! Barriers in the terms of Vulkan 1.3, recorded by the command of Vulkan 1.0: no device has to enable
//! `synchronization2`. `src/graph/place_barriers.rs` decides where barriers between passes are.

use ash::vk;

/// Bits that both kinds of flags share: Vulkan 1.3 adds only higher ones.
const SHARED: u64 = u32::MAX as u64;

/// Flags of Vulkan 1.0 for those of Vulkan 1.3. Shared flags stay; others become the flags that contain them. `any` replaces
/// an unknown flag, such as a stage of an extension.
fn converted(all: u64, containing: &[(u64, u32)], any: u32) -> u32 {
    let (mut old, mut rest) = ((all & SHARED) as u32, all & !SHARED);
    for (new, flags) in containing {
        if rest & new != 0 {
            old |= flags;
            rest &= !new;
        }
    }
    if rest == 0 { old } else { old | any }
}

fn stages(all: vk::PipelineStageFlags2) -> vk::PipelineStageFlags {
    use vk::{PipelineStageFlags as Old, PipelineStageFlags2 as New};
    let containing = [
        (New::COPY | New::RESOLVE | New::BLIT | New::CLEAR, Old::TRANSFER),
        (New::INDEX_INPUT | New::VERTEX_ATTRIBUTE_INPUT, Old::VERTEX_INPUT),
        (New::PRE_RASTERIZATION_SHADERS, Old::ALL_GRAPHICS),
    ]
    .map(|(new, old)| (new.as_raw(), old.as_raw()));
    Old::from_raw(converted(all.as_raw(), &containing, Old::ALL_COMMANDS.as_raw()))
}

fn accesses(all: vk::AccessFlags2) -> vk::AccessFlags {
    use vk::{AccessFlags as Old, AccessFlags2 as New};
    let containing = [
        (New::SHADER_SAMPLED_READ | New::SHADER_STORAGE_READ, Old::SHADER_READ),
        (New::SHADER_STORAGE_WRITE, Old::SHADER_WRITE),
    ]
    .map(|(new, old)| (new.as_raw(), old.as_raw()));
    let any = Old::MEMORY_READ | Old::MEMORY_WRITE;
    Old::from_raw(converted(all.as_raw(), &containing, any.as_raw()))
}

/// The stage masks of a barrier, from its unions of stages. A mask of Vulkan 1.0 is never empty: no stage to wait for is the top
/// of the pipe, and no stage that waits is its bottom.
fn masks(
    from: vk::PipelineStageFlags2,
    to: vk::PipelineStageFlags2,
) -> [vk::PipelineStageFlags; 2] {
    let or = |stages: vk::PipelineStageFlags, none| if stages.is_empty() { none } else { stages };
    [
        or(stages(from), vk::PipelineStageFlags::TOP_OF_PIPE),
        or(stages(to), vk::PipelineStageFlags::BOTTOM_OF_PIPE),
    ]
}

/// The barriers of one vkCmdPipelineBarrier. Its stage masks are the unions of their stage masks.
#[derive(Default)]
pub(in crate::gpu) struct Barriers {
    from: vk::PipelineStageFlags2,
    to: vk::PipelineStageFlags2,
    memory: Vec<vk::MemoryBarrier<'static>>,
    buffers: Vec<vk::BufferMemoryBarrier<'static>>,
    images: Vec<vk::ImageMemoryBarrier<'static>>,
}

impl Barriers {
    /// Adds barriers of memory.
    pub(in crate::gpu) fn memory(mut self, all: &[vk::MemoryBarrier2<'_>]) -> Self {
        for new in all {
            self.from |= new.src_stage_mask;
            self.to |= new.dst_stage_mask;
            self.memory.push(
                vk::MemoryBarrier::default()
                    .src_access_mask(accesses(new.src_access_mask))
                    .dst_access_mask(accesses(new.dst_access_mask)),
            );
        }
        self
    }

    /// Adds barriers of buffers.
    pub(in crate::gpu) fn buffers(mut self, all: &[vk::BufferMemoryBarrier2<'_>]) -> Self {
        for new in all {
            self.from |= new.src_stage_mask;
            self.to |= new.dst_stage_mask;
            self.buffers.push(
                vk::BufferMemoryBarrier::default()
                    .src_access_mask(accesses(new.src_access_mask))
                    .dst_access_mask(accesses(new.dst_access_mask))
                    .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .buffer(new.buffer)
                    .offset(new.offset)
                    .size(new.size),
            );
        }
        self
    }

    /// Adds barriers of images.
    pub(in crate::gpu) fn images(mut self, all: &[vk::ImageMemoryBarrier2<'_>]) -> Self {
        for new in all {
            self.from |= new.src_stage_mask;
            self.to |= new.dst_stage_mask;
            self.images.push(
                vk::ImageMemoryBarrier::default()
                    .src_access_mask(accesses(new.src_access_mask))
                    .dst_access_mask(accesses(new.dst_access_mask))
                    .old_layout(new.old_layout)
                    .new_layout(new.new_layout)
                    .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                    .image(new.image)
                    .subresource_range(new.subresource_range),
            );
        }
        self
    }

    /// Records them; nothing where there are none.
    ///
    /// # Safety
    /// `commands` is being recorded outside a render pass for a family that supports the stages; images and buffers are
    /// alive and in the stated layouts.
    pub(in crate::gpu) unsafe fn record(&self, device: &ash::Device, commands: vk::CommandBuffer) {
        if self.memory.is_empty() && self.buffers.is_empty() && self.images.is_empty() {
            return;
        }
        let [from, to] = masks(self.from, self.to);
        let Self { memory, buffers, images, .. } = self;
        let flags = vk::DependencyFlags::empty();
        // SAFETY: as the caller guarantees.
        unsafe {
            device.cmd_pipeline_barrier(commands, from, to, flags, memory, buffers, images);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each new flag becomes one that contains it; unknown ones become all.
    #[test]
    fn new_stages_and_accesses_become_old_ones() {
        use vk::{AccessFlags as OldAccess, AccessFlags2 as Access};
        use vk::{PipelineStageFlags as OldStage, PipelineStageFlags2 as Stage};
        for (new, old) in [
            (Stage::NONE, OldStage::empty()),
            (Stage::COMPUTE_SHADER, OldStage::COMPUTE_SHADER),
            (Stage::ALL_COMMANDS | Stage::HOST, OldStage::ALL_COMMANDS | OldStage::HOST),
            (Stage::COPY | Stage::CLEAR, OldStage::TRANSFER),
            (Stage::BLIT | Stage::DRAW_INDIRECT, OldStage::TRANSFER | OldStage::DRAW_INDIRECT),
            (Stage::INDEX_INPUT, OldStage::VERTEX_INPUT),
            (Stage::PRE_RASTERIZATION_SHADERS, OldStage::ALL_GRAPHICS),
            (Stage::from_raw(1 << 60), OldStage::ALL_COMMANDS),
        ] {
            assert_eq!(stages(new), old, "{new:?}");
        }
        let any = OldAccess::MEMORY_READ | OldAccess::MEMORY_WRITE;
        for (new, old) in [
            (Access::NONE, OldAccess::empty()),
            (Access::SHADER_SAMPLED_READ, OldAccess::SHADER_READ),
            (
                Access::SHADER_STORAGE_READ | Access::SHADER_STORAGE_WRITE,
                OldAccess::SHADER_READ | OldAccess::SHADER_WRITE,
            ),
            (Access::MEMORY_READ | Access::MEMORY_WRITE, any),
            (Access::TRANSFER_READ, OldAccess::TRANSFER_READ),
            (Access::from_raw(1 << 60), any),
        ] {
            assert_eq!(accesses(new), old, "{new:?}");
        }
    }

    /// Vulkan 1.0 refuses an empty mask. A side without stages becomes an end of the pipe, the source its top and the destination
    /// its bottom; a side with stages gets nothing more.
    #[test]
    fn a_side_without_stages_is_an_end_of_the_pipe() {
        use vk::{PipelineStageFlags as Old, PipelineStageFlags2 as New};
        for (from, to, expected) in [
            (New::NONE, New::NONE, [Old::TOP_OF_PIPE, Old::BOTTOM_OF_PIPE]),
            (New::NONE, New::COPY, [Old::TOP_OF_PIPE, Old::TRANSFER]),
            (New::COMPUTE_SHADER, New::NONE, [Old::COMPUTE_SHADER, Old::BOTTOM_OF_PIPE]),
            (
                New::COMPUTE_SHADER | New::CLEAR,
                New::HOST,
                [Old::COMPUTE_SHADER | Old::TRANSFER, Old::HOST],
            ),
        ] {
            assert_eq!(masks(from, to), expected, "{from:?} to {to:?}");
        }
    }
}

//! Pipeline stages that a queue family supports.

use ash::vk;
use ash::vk::PipelineStageFlags2 as Stage;

use crate::{Error, Result};

/// Stages that a barrier may name only on a queue family with graphics: the table "Supported Pipeline Stage Flags" of
/// the Vulkan specification. BLIT and RESOLVE are left out, because later extensions allow them elsewhere.
const GRAPHICS: [Stage; 18] = [
    Stage::VERTEX_INPUT,
    Stage::INDEX_INPUT,
    Stage::VERTEX_ATTRIBUTE_INPUT,
    Stage::VERTEX_SHADER,
    Stage::TESSELLATION_CONTROL_SHADER,
    Stage::TESSELLATION_EVALUATION_SHADER,
    Stage::GEOMETRY_SHADER,
    Stage::PRE_RASTERIZATION_SHADERS,
    Stage::FRAGMENT_SHADER,
    Stage::EARLY_FRAGMENT_TESTS,
    Stage::LATE_FRAGMENT_TESTS,
    Stage::COLOR_ATTACHMENT_OUTPUT,
    Stage::ALL_GRAPHICS,
    Stage::TRANSFORM_FEEDBACK_EXT,
    Stage::TASK_SHADER_EXT,
    Stage::MESH_SHADER_EXT,
    Stage::FRAGMENT_SHADING_RATE_ATTACHMENT_KHR,
    Stage::FRAGMENT_DENSITY_PROCESS_EXT,
];

/// Those of `stages` that no barrier on a family of compute may name.
pub(super) fn unsupported(stages: Stage, family: vk::QueueFlags) -> Stage {
    if family.contains(vk::QueueFlags::GRAPHICS) {
        return Stage::NONE;
    }
    GRAPHICS.into_iter().fold(Stage::NONE, |all, stage| all | stages & stage)
}

/// Refuses stages of a caller's image or buffer that the host's queue family does not support.
pub(super) fn check_supported(
    name: &str,
    when: &str,
    stages: Stage,
    family: vk::QueueFlags,
) -> Result<()> {
    let wrong = unsupported(stages, family);
    if wrong == Stage::NONE {
        return Ok(());
    }
    Err(Error::setting(
        format!("{name}: {when}"),
        format!("{wrong:?}"),
        format!("stages that a queue family with {family:?} supports, or ALL_COMMANDS"),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All stages of a renderer's own barriers and timestamps, and the general ones, are supported by compute alone.
    #[test]
    fn a_family_without_graphics_supports_no_stage_of_graphics() {
        let compute = vk::QueueFlags::COMPUTE | vk::QueueFlags::TRANSFER;
        let own = Stage::COMPUTE_SHADER | Stage::DRAW_INDIRECT | Stage::COPY;
        let general = Stage::ALL_COMMANDS | Stage::ALL_TRANSFER | Stage::HOST | Stage::CLEAR;
        assert_eq!(unsupported(own | general, compute), Stage::NONE);
        for stage in GRAPHICS {
            assert_eq!(unsupported(stage | own, compute), stage, "{stage:?}");
            assert_eq!(unsupported(stage | own, compute | vk::QueueFlags::GRAPHICS), Stage::NONE);
        }
        let both = Stage::FRAGMENT_SHADER | Stage::VERTEX_SHADER;
        assert_eq!(unsupported(both | Stage::HOST, compute), both);
    }
}

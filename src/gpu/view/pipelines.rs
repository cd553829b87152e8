//! Graphics pipelines of a view.

use ash::vk;

use super::super::Host;
use super::super::pipelines::Pipeline;
use super::super::shaders::Specialised;
use crate::Result;

/// Inputs of a pipeline.
pub(super) struct Recipe {
    /// Vertex, fragment.
    pub shaders: [Specialised; 2],
    pub render_pass: vk::RenderPass,
    pub has_colour: bool,
    pub samples: vk::SampleCountFlags,
    /// The depth comparison, and whether depths are written.
    pub depth: Option<(vk::CompareOp, bool)>,
}

impl Recipe {
    pub(super) fn make(&self, host: &Host) -> Result<Pipeline> {
        let [vertex, fragment] = &self.shaders;
        let shaders = [
            (vk::ShaderStageFlags::VERTEX, vertex.shader, &vertex.constants[..]),
            (vk::ShaderStageFlags::FRAGMENT, fragment.shader, &fragment.constants[..]),
        ];
        let vertices = vk::PipelineVertexInputStateCreateInfo::default();
        let triangles = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport =
            vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        // Both sides of the ground are visible.
        let raster = vk::PipelineRasterizationStateCreateInfo::default()
            .polygon_mode(vk::PolygonMode::FILL)
            .cull_mode(vk::CullModeFlags::NONE)
            .line_width(1.0);
        let samples =
            vk::PipelineMultisampleStateCreateInfo::default().rasterization_samples(self.samples);
        let (compare, keeps) = self.depth.unwrap_or((vk::CompareOp::ALWAYS, false));
        let depth = vk::PipelineDepthStencilStateCreateInfo::default()
            .depth_test_enable(self.depth.is_some())
            .depth_write_enable(keeps)
            .depth_compare_op(compare);
        let all = [vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA)];
        let all = &all[..usize::from(self.has_colour)];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(all);
        let dynamic = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&dynamic);
        Pipeline::new(host, &shaders, |layout, stages| {
            let info = [vk::GraphicsPipelineCreateInfo::default()
                .stages(stages)
                .vertex_input_state(&vertices)
                .input_assembly_state(&triangles)
                .viewport_state(&viewport)
                .rasterization_state(&raster)
                .multisample_state(&samples)
                .depth_stencil_state(&depth)
                .color_blend_state(&blend)
                .dynamic_state(&dynamic)
                .layout(layout)
                .render_pass(self.render_pass)];
            // SAFETY: device, layout and modules are alive; the data that the info points to lives across the call.
            unsafe { host.device.create_graphics_pipelines(host.pipeline_cache, &info, None) }
        })
    }
}

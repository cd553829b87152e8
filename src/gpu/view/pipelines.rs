//! Graphics pipelines of a view.

use ash::vk;

use super::super::shaders::{BindingKind, Specialised};
use super::super::specialise::specialised;
use super::super::{Host, failed};
use crate::Result;

/// A pipeline and its layouts; null until made.
#[derive(Clone, Copy, Default)]
pub(super) struct Drawing {
    pub pipeline: vk::Pipeline,
    pub layout: vk::PipelineLayout,
    pub set_layout: vk::DescriptorSetLayout,
    pub push_bytes: u32,
}

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

/// Stages that read the bindings and push constants.
pub(super) const STAGES: vk::ShaderStageFlags = vk::ShaderStageFlags::from_raw(
    vk::ShaderStageFlags::VERTEX.as_raw() | vk::ShaderStageFlags::FRAGMENT.as_raw(),
);

impl Drawing {
    /// Makes layouts and pipeline; after an error [`free`](Self::free) frees what was made.
    pub(crate) fn make(&mut self, host: &Host, recipe: &Recipe) -> Result<()> {
        let device = &host.device;
        let doing = || format!("making the pipeline of {}", recipe.shaders[1].shader.name);
        let mut all: Vec<_> = recipe.shaders.iter().flat_map(|s| s.shader.bindings).collect();
        all.sort_by_key(|binding| binding.binding);
        // Both stages may read one.
        all.dedup_by_key(|binding| binding.binding);
        let bindings: Vec<_> = all
            .iter()
            .map(|binding| {
                assert!(matches!(binding.kind, BindingKind::SampledImage { .. }));
                vk::DescriptorSetLayoutBinding::default()
                    .binding(binding.binding)
                    .descriptor_type(vk::DescriptorType::SAMPLED_IMAGE)
                    .descriptor_count(1)
                    .stage_flags(STAGES)
            })
            .collect();
        let set_info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: the device is alive; the bindings are those that reflection found.
        self.set_layout = unsafe { device.create_descriptor_set_layout(&set_info, None) }
            .map_err(failed(doing()))?;
        self.push_bytes = recipe.shaders.iter().map(|s| s.shader.push_bytes).max().unwrap_or(0);
        let push =
            [vk::PushConstantRange { stage_flags: STAGES, offset: 0, size: self.push_bytes }];
        let layouts = [self.set_layout];
        let ranges = if self.push_bytes > 0 { &push[..] } else { &[] };
        let layout_info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&layouts)
            .push_constant_ranges(ranges);
        // SAFETY: as above.
        self.layout = unsafe { device.create_pipeline_layout(&layout_info, None) }
            .map_err(failed(doing()))?;
        let mut modules = [vk::ShaderModule::null(); 2];
        // SAFETY: the SPIR-V is glslang's output for this layout, with constants of its own types; modules are
        // destroyed once, also after an error.
        let made = unsafe {
            let made = recipe.modules(device, &mut modules);
            let made = made.and_then(|()| recipe.pipeline(host, self.layout, modules));
            modules.into_iter().for_each(|module| device.destroy_shader_module(module, None));
            made
        };
        self.pipeline = made.map_err(failed(doing()))?;
        host.name(self.pipeline, recipe.shaders[1].shader.name);
        host.name(self.layout, recipe.shaders[1].shader.name);
        host.name(self.set_layout, recipe.shaders[1].shader.name);
        Ok(())
    }

    /// Destroys what has been made.
    pub(crate) fn free(&mut self, host: &Host) {
        // SAFETY: made by this device or null; the caller guarantees that nothing in flight uses them.
        unsafe {
            host.device.destroy_pipeline(self.pipeline, None);
            host.device.destroy_pipeline_layout(self.layout, None);
            host.device.destroy_descriptor_set_layout(self.set_layout, None);
        }
        *self = Self::default();
    }
}

impl Recipe {
    /// # Safety
    /// The device is alive; the caller destroys the modules, also after an error.
    unsafe fn modules(
        &self,
        device: &ash::Device,
        modules: &mut [vk::ShaderModule; 2],
    ) -> std::result::Result<(), vk::Result> {
        for (module, Specialised { shader, constants }) in modules.iter_mut().zip(&self.shaders) {
            let words = specialised(shader, constants);
            let info = vk::ShaderModuleCreateInfo::default().code(&words);
            // SAFETY: as the caller guarantees.
            *module = unsafe { device.create_shader_module(&info, None) }?;
        }
        Ok(())
    }

    /// # Safety
    /// Device, layout and modules are alive.
    unsafe fn pipeline(
        &self,
        host: &Host,
        layout: vk::PipelineLayout,
        modules: [vk::ShaderModule; 2],
    ) -> std::result::Result<vk::Pipeline, vk::Result> {
        let kinds = [vk::ShaderStageFlags::VERTEX, vk::ShaderStageFlags::FRAGMENT];
        let stages = [0, 1].map(|i| {
            vk::PipelineShaderStageCreateInfo::default()
                .stage(kinds[i])
                .module(modules[i])
                .name(c"main")
        });
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
        let info = vk::GraphicsPipelineCreateInfo::default()
            .stages(&stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&triangles)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(layout)
            .render_pass(self.render_pass);
        // SAFETY: as the caller guarantees; the data that the info points to lives across the call.
        let made =
            unsafe { host.device.create_graphics_pipelines(host.pipeline_cache, &[info], None) };
        made.map(|all| all[0]).map_err(|(_, result)| result)
    }
}

use std::collections::HashMap;

use ash::vk;

use super::shaders::{BindingKind, Shader};
use super::{Host, failed};
use crate::Result;
use crate::plan::Pass;

/// One shader with its constants, ready to bind.
#[derive(Clone, Copy)]
pub(crate) struct Pipeline {
    pub pipeline: vk::Pipeline,
    pub layout: vk::PipelineLayout,
    pub set_layout: vk::DescriptorSetLayout,
}

/// Pipelines of a plan: one a shader and set of constants, shared by the passes that agree in both.
pub(crate) struct Pipelines {
    made: Vec<Pipeline>,
    of_pass: Vec<usize>,
}

pub(crate) fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::TexelBuffer => vk::DescriptorType::UNIFORM_TEXEL_BUFFER,
        BindingKind::SampledImage { .. } => vk::DescriptorType::SAMPLED_IMAGE,
        BindingKind::StorageImage { .. } => vk::DescriptorType::STORAGE_IMAGE,
    }
}

impl Pipelines {
    pub fn new<'a>(host: &Host, passes: impl Iterator<Item = &'a Pass>) -> Result<Self> {
        let mut all = Self { made: Vec::new(), of_pass: Vec::new() };
        let mut known = HashMap::<_, usize>::new();
        for pass in passes {
            let key = (pass.name(), pass.constants.as_slice());
            let index = match known.get(&key) {
                Some(&index) => index,
                None => match make(host, pass.shader, &pass.constants) {
                    Ok(pipeline) => {
                        all.made.push(pipeline);
                        known.insert(key, all.made.len() - 1);
                        all.made.len() - 1
                    }
                    Err(error) => {
                        all.destroy(host);
                        return Err(error);
                    }
                },
            };
            all.of_pass.push(index);
        }
        Ok(all)
    }

    pub fn of(&self, pass: usize) -> Pipeline {
        self.made[self.of_pass[pass]]
    }

    /// Destroys all. The device must be done with them.
    pub fn destroy(&mut self, host: &Host) {
        for pipeline in self.made.drain(..) {
            // SAFETY: made by this host's device, and the caller says that nothing in flight uses them.
            unsafe {
                host.device.destroy_pipeline(pipeline.pipeline, None);
                host.device.destroy_pipeline_layout(pipeline.layout, None);
                host.device.destroy_descriptor_set_layout(pipeline.set_layout, None);
            }
        }
    }
}

fn make(host: &Host, shader: &Shader, constants: &[(u32, u32)]) -> Result<Pipeline> {
    let device = &host.device;
    let doing = || format!("making the pipeline of {}", shader.name);
    let bindings: Vec<_> = shader
        .bindings
        .iter()
        .map(|b| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(b.binding)
                .descriptor_type(descriptor_type(b.kind))
                .descriptor_count(1)
                .stage_flags(vk::ShaderStageFlags::COMPUTE)
        })
        .collect();
    let set_info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
    // SAFETY: the device is alive; the bindings are those that reflection found.
    let set_layout =
        unsafe { device.create_descriptor_set_layout(&set_info, None) }.map_err(failed(doing()))?;
    let push = [vk::PushConstantRange {
        stage_flags: vk::ShaderStageFlags::COMPUTE,
        offset: 0,
        size: shader.push_bytes,
    }];
    let layouts = [set_layout];
    let layout_info =
        vk::PipelineLayoutCreateInfo::default().set_layouts(&layouts).push_constant_ranges(&push);
    let mut made =
        Pipeline { pipeline: vk::Pipeline::null(), layout: vk::PipelineLayout::null(), set_layout };
    let module_info = vk::ShaderModuleCreateInfo::default().code(shader.words);
    let data: Vec<u32> = constants.iter().map(|c| c.1).collect();
    let entries: Vec<_> = constants
        .iter()
        .enumerate()
        .map(|(i, c)| vk::SpecializationMapEntry {
            constant_id: c.0,
            offset: 4 * i as u32,
            size: 4,
        })
        .collect();
    let specialisation =
        vk::SpecializationInfo::default().map_entries(&entries).data(bytemuck::cast_slice(&data));
    // SAFETY: the SPIR-V is glslang's output for this very layout; every constant is one word;
    // handles made on the way are destroyed here when a later step fails.
    let result = unsafe {
        device.create_pipeline_layout(&layout_info, None).and_then(|layout| {
            made.layout = layout;
            let module = device.create_shader_module(&module_info, None)?;
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(module)
                .name(c"main")
                .specialization_info(&specialisation);
            let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
            let pipelines =
                device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None);
            device.destroy_shader_module(module, None);
            pipelines.map_err(|(_, result)| result)
        })
    };
    match result {
        Ok(pipelines) => {
            made.pipeline = pipelines[0];
            Ok(made)
        }
        Err(result) => {
            // SAFETY: made above, used by nothing.
            unsafe {
                device.destroy_pipeline_layout(made.layout, None);
                device.destroy_descriptor_set_layout(set_layout, None);
            }
            Err(failed(doing())(result))
        }
    }
}

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

use super::shaders::{BindingKind, Shader};
use super::specialise::specialised;
use super::{Host, failed};
use crate::Result;
use crate::graph::Pass;

/// One shader with its constants, ready to bind.
#[derive(Clone, Copy)]
pub(crate) struct Pipeline {
    pub pipeline: vk::Pipeline,
    pub layout: vk::PipelineLayout,
    pub set_layout: vk::DescriptorSetLayout,
}

/// A shader's name and its constants.
type Key = (&'static str, Vec<u32>);

/// Pipelines, one per shader and set of constants: of a renderer, or shared by all that hold a clone of this.
#[derive(Clone, Default)]
pub struct Pipelines(Arc<Mutex<HashMap<Key, Pipeline>>>);

pub(crate) fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::StorageBuffer => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::TexelBuffer => vk::DescriptorType::UNIFORM_TEXEL_BUFFER,
        BindingKind::SampledImage { .. } => vk::DescriptorType::SAMPLED_IMAGE,
        BindingKind::StorageImage { .. } => vk::DescriptorType::STORAGE_IMAGE,
    }
}

impl Pipelines {
    /// The pipeline of each pass; makes missing ones.
    pub(crate) fn of<'a>(
        &self,
        host: &Host,
        passes: impl Iterator<Item = &'a Pass>,
    ) -> Result<Vec<Pipeline>> {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let mut all = Vec::new();
        for pass in passes {
            let key = (pass.name(), pass.constants.clone());
            let pipeline = match known.get(&key) {
                Some(pipeline) => *pipeline,
                None => {
                    let made = make(host, pass.shader, &pass.constants)?;
                    known.insert(key, made);
                    made
                }
            };
            all.push(pipeline);
        }
        Ok(all)
    }

    /// Drops this clone; the last one destroys the pipelines. The device must have finished with those that
    /// this clone used.
    pub(crate) fn end(self, host: &Host) {
        let Some(known) = Arc::into_inner(self.0) else { return };
        for pipeline in known.into_inner().unwrap_or_else(PoisonError::into_inner).into_values() {
            // SAFETY: made by this host's device; every user has dropped its clone, and thereby guarantees that
            // nothing in flight uses them.
            unsafe {
                host.device.destroy_pipeline(pipeline.pipeline, None);
                host.device.destroy_pipeline_layout(pipeline.layout, None);
                host.device.destroy_descriptor_set_layout(pipeline.set_layout, None);
            }
        }
    }
}

fn make(host: &Host, shader: &Shader, constants: &[u32]) -> Result<Pipeline> {
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
    let words = specialised(shader, constants);
    let module_info = vk::ShaderModuleCreateInfo::default().code(&words);
    // SAFETY: the SPIR-V is glslang's output for this layout, with constants of its own types; the cache is
    // null or the host's; handles made before a failing step are destroyed here.
    let result = unsafe {
        device.create_pipeline_layout(&layout_info, None).and_then(|layout| {
            made.layout = layout;
            let module = device.create_shader_module(&module_info, None)?;
            let stage = vk::PipelineShaderStageCreateInfo::default()
                .stage(vk::ShaderStageFlags::COMPUTE)
                .module(module)
                .name(c"main");
            let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout);
            let pipelines = device.create_compute_pipelines(host.pipeline_cache, &[info], None);
            device.destroy_shader_module(module, None);
            pipelines.map_err(|(_, result)| result)
        })
    };
    match result {
        Ok(pipelines) => {
            made.pipeline = pipelines[0];
            host.name(made.pipeline, shader.name);
            host.name(made.layout, shader.name);
            host.name(made.set_layout, shader.name);
            Ok(made)
        }
        Err(result) => {
            // SAFETY: made above and unused.
            unsafe {
                device.destroy_pipeline_layout(made.layout, None);
                device.destroy_descriptor_set_layout(set_layout, None);
            }
            Err(failed(doing())(result))
        }
    }
}

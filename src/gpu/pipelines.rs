use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use ash::vk;

use super::shaders::{BindingKind, Shader};
use super::specialise::specialised;
use super::{Host, failed};
use crate::Result;
use crate::graph::Pass;

/// Shaders with their constants, ready to bind.
#[derive(Clone, Copy, Default)]
pub(crate) struct Pipeline {
    pub pipeline: vk::Pipeline,
    pub layout: vk::PipelineLayout,
    pub set_layout: vk::DescriptorSetLayout,
    /// Of all stages.
    pub push: vk::PushConstantRange,
}

/// What Vulkan's calls that make pipelines return.
type Created = std::result::Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>;

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
                    let stage = (vk::ShaderStageFlags::COMPUTE, pass.shader, &pass.constants[..]);
                    let made = Pipeline::new(host, &[stage], |layout, stages| {
                        let info = vk::ComputePipelineCreateInfo::default();
                        let info = [info.stage(stages[0]).layout(layout)];
                        // SAFETY: device, layout and module are alive; the cache is null or the host's.
                        unsafe {
                            host.device.create_compute_pipelines(host.pipeline_cache, &info, None)
                        }
                    })?;
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
        let known = known.into_inner().unwrap_or_else(PoisonError::into_inner);
        // Every user has dropped its clone, and thereby guarantees that nothing in flight uses them.
        known.into_values().for_each(|pipeline| pipeline.free(host));
    }
}

impl Pipeline {
    /// The pipeline that `create` makes for a layout and stages: shaders with their constants. Every stage reads all
    /// bindings and push constants. The last shader names it.
    pub(crate) fn new(
        host: &Host,
        shaders: &[(vk::ShaderStageFlags, &Shader, &[u32])],
        create: impl FnOnce(vk::PipelineLayout, &[vk::PipelineShaderStageCreateInfo<'_>]) -> Created,
    ) -> Result<Self> {
        let mut made = Self::default();
        let mut modules = Vec::new();
        let result = made.make(host, shaders, &mut modules, create);
        for module in modules {
            // SAFETY: made by this device; pipelines do not need their modules once they are made.
            unsafe { host.device.destroy_shader_module(module, None) };
        }
        let name = shaders.last().map_or("", |(_, shader, _)| shader.name);
        if let Err(result) = result {
            made.free(host);
            return Err(failed(format!("making the pipeline of {name}"))(result));
        }
        host.name(made.pipeline, name);
        host.name(made.layout, name);
        host.name(made.set_layout, name);
        Ok(made)
    }

    fn make(
        &mut self,
        host: &Host,
        shaders: &[(vk::ShaderStageFlags, &Shader, &[u32])],
        modules: &mut Vec<vk::ShaderModule>,
        create: impl FnOnce(vk::PipelineLayout, &[vk::PipelineShaderStageCreateInfo<'_>]) -> Created,
    ) -> std::result::Result<(), vk::Result> {
        let device = &host.device;
        for (stage, shader, _) in shaders {
            self.push.stage_flags |= *stage;
            self.push.size = self.push.size.max(shader.push_bytes);
        }
        let mut all: Vec<_> = shaders.iter().flat_map(|(_, shader, _)| shader.bindings).collect();
        all.sort_by_key(|binding| binding.binding);
        // Several stages may read one.
        all.dedup_by_key(|binding| binding.binding);
        let bindings: Vec<_> = all
            .iter()
            .map(|b| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(b.binding)
                    .descriptor_type(descriptor_type(b.kind))
                    .descriptor_count(1)
                    .stage_flags(self.push.stage_flags)
            })
            .collect();
        let set_info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: the device is alive; the bindings are those that reflection found.
        self.set_layout = unsafe { device.create_descriptor_set_layout(&set_info, None) }?;
        let (layouts, push) = ([self.set_layout], [self.push]);
        let layout_info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&layouts)
            .push_constant_ranges(if self.push.size > 0 { &push[..] } else { &[] });
        // SAFETY: as above.
        self.layout = unsafe { device.create_pipeline_layout(&layout_info, None) }?;
        for (_, shader, constants) in shaders {
            let words = specialised(shader, constants);
            let info = vk::ShaderModuleCreateInfo::default().code(&words);
            // SAFETY: the SPIR-V is glslang's output for this layout, with constants of its own types.
            modules.push(unsafe { device.create_shader_module(&info, None) }?);
        }
        let stage = |((stage, ..), module): (&(vk::ShaderStageFlags, _, _), &vk::ShaderModule)| {
            let info = vk::PipelineShaderStageCreateInfo::default();
            info.stage(*stage).module(*module).name(c"main")
        };
        let stages: Vec<_> = shaders.iter().zip(&*modules).map(stage).collect();
        self.pipeline = create(self.layout, &stages).map_err(|(_, result)| result)?[0];
        Ok(())
    }

    /// Destroys what has been made; nothing in flight may use it.
    pub(crate) fn free(self, host: &Host) {
        // SAFETY: made by this host's device, or null; the caller guarantees that nothing in flight uses them.
        unsafe {
            host.device.destroy_pipeline(self.pipeline, None);
            host.device.destroy_pipeline_layout(self.layout, None);
            host.device.destroy_descriptor_set_layout(self.set_layout, None);
        }
    }
}

/// Sets of these layouts, and the pool that holds them, which is made at `pool`.
pub(crate) fn descriptors(
    host: &Host,
    (pool, name): (&mut vk::DescriptorPool, &str),
    sizes: &[vk::DescriptorPoolSize],
    layouts: &[vk::DescriptorSetLayout],
) -> Result<Vec<vk::DescriptorSet>> {
    let info = vk::DescriptorPoolCreateInfo::default();
    let info = info.max_sets(layouts.len() as u32).pool_sizes(sizes);
    // SAFETY: the device is alive; there is at least one set, and one binding.
    *pool = unsafe { host.device.create_descriptor_pool(&info, None) }
        .map_err(failed("making the descriptor pool"))?;
    host.name(*pool, name);
    let info = vk::DescriptorSetAllocateInfo::default().descriptor_pool(*pool).set_layouts(layouts);
    // SAFETY: the pool was sized for exactly these sets; the layouts are alive.
    unsafe { host.device.allocate_descriptor_sets(&info) }.map_err(failed("making the descriptors"))
}

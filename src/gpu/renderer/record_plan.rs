//! Records every pass of a plan into a command buffer, in one loop.

use ash::vk;

use super::super::barriers::Barriers;
use super::super::memory::Backed;
use super::super::pipelines::descriptor_type;
use super::super::shaders::BindingKind;
use super::buffers::Taken;
use super::images::transition;
use super::{BufferArg, ImageArg, ImageState, InputArg, Progress, Renderer};
use crate::graph::{Owner, Rectangle, ResourceId};

impl Renderer {
    /// Records passes; all arguments have been checked.
    pub(super) fn append(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        inputs: &[InputArg],
        outputs: &[ImageArg],
        passes: &[usize],
        edited: Option<Rectangle>,
    ) {
        let whole_plan = edited.is_none() && passes.len() == self.plan.passes.len();
        let holds_nothing = whole_plan || self.progress.iter().all(|p| *p == Progress::Pending);
        let (bound, buffers) = self.bind(inputs, outputs);
        let taken = self.takes(&buffers, edited);
        self.write_tables(slot);
        self.write_sets(slot, &bound);
        let device = self.host.device.clone();
        let times_passes = self.times_passes;
        let entry = self.entry(&bound, holds_nothing);
        let exit = self.exit(&bound);
        // Passes of an edit may read their workgroup counts from a buffer.
        let compute = vk::PipelineStageFlags::COMPUTE_SHADER;
        let stages =
            vk::PipelineStageFlags2::COMPUTE_SHADER | vk::PipelineStageFlags2::DRAW_INDIRECT;
        let memory = [vk::MemoryBarrier2::default()
            .src_stage_mask(stages)
            .src_access_mask(vk::AccessFlags2::SHADER_STORAGE_WRITE)
            .dst_stage_mask(stages)
            .dst_access_mask(ImageState::WRITTEN.access | vk::AccessFlags2::INDIRECT_COMMAND_READ)];
        let between = Barriers::default().memory(&memory);
        let filled: Vec<_> = taken.iter().map(Taken::filled).collect();
        let [lent, given_back] =
            [Taken::entry, Taken::exit].map(|to| taken.iter().map(to).collect::<Vec<_>>());
        let first = Barriers::default().images(&entry).buffers(&lent).memory(&memory);
        let last = Barriers::default().images(&exit).buffers(&given_back);
        let count = if times_passes { passes.len() } else { 1 } + 1;
        // SAFETY: the caller guarantees that `commands` is being recorded for the host's family; every handle
        // is alive, images are in the stated layouts, sets and timestamps of this slot are not in use. There is one
        // timestamp more than the plan has passes.
        unsafe {
            if let Some(timestamps) = &mut self.slots[slot].timestamps {
                timestamps.begin(&device, commands, count);
            }
            let timestamps = self.slots[slot].timestamps.as_ref();
            let write_timestamp = |index: usize| {
                if let Some(timestamps) = timestamps {
                    timestamps.write(&device, commands, compute, index);
                }
            };
            first.record(&device, commands);
            if !taken.is_empty() {
                taken.iter().for_each(|taken| taken.copy(&device, commands));
                Barriers::default().images(&filled).record(&device, commands);
            }
            write_timestamp(0);
            if timestamps.is_some() {
                // lavapipe writes a timestamp when it next waits, which a lone pass would precede.
                between.record(&device, commands);
            }
            for (query, &index) in passes.iter().enumerate() {
                if query > 0 && self.must_wait(passes[query - 1], index) {
                    between.record(&device, commands);
                }
                self.dispatch(commands, slot, index, edited);
                if times_passes {
                    write_timestamp(query + 1);
                }
            }
            if !times_passes {
                write_timestamp(1);
            }
            last.record(&device, commands);
            if let Some(timestamps) = timestamps {
                timestamps.end(&device, commands, count);
            }
        }
        self.slots[slot].recorded = passes.to_vec();
        self.slots[slot].times_passes = times_passes;
    }

    /// Barriers from the images' states to their use by passes. The plan's own images hold nothing from frame
    /// to frame, unless only some passes are recorded after others.
    fn entry(
        &self,
        bound: &[Option<&ImageArg>],
        holds_nothing: bool,
    ) -> Vec<vk::ImageMemoryBarrier2<'static>> {
        let own_to = |backed: &Backed, layout, to| {
            let from = ImageState { layout, ..ImageState::WRITTEN };
            transition(backed.image, backed.layers, from, to)
        };
        let own = |backed: &Backed, layout| own_to(backed, layout, ImageState::WRITTEN);
        let mut entry = Vec::new();
        for (i, backed) in self.resources.iter().enumerate() {
            if let Some(backed) = backed.as_ref().filter(|b| b.image != vk::Image::null()) {
                let layout = if holds_nothing {
                    vk::ImageLayout::UNDEFINED
                } else {
                    vk::ImageLayout::GENERAL
                };
                entry.push(match self.plan.resources[i].owner {
                    Owner::InputBuffer => own_to(backed, layout, Taken::COPIED),
                    _ => own(backed, layout),
                });
            }
            if let Some(arg) = bound[i] {
                let to = self.state_of(ResourceId(i));
                entry.push(transition(arg.image, arg.extent[2], arg.before, to));
            }
        }
        for (_, _, backed) in self.unused.iter().filter(|u| u.2.image != vk::Image::null()) {
            entry.push(own(backed, vk::ImageLayout::UNDEFINED));
        }
        entry
    }

    /// Barriers from the passes' use of the caller's images to their states after.
    fn exit(&self, bound: &[Option<&ImageArg>]) -> Vec<vk::ImageMemoryBarrier2<'static>> {
        let left = |(i, arg): (usize, &Option<&ImageArg>)| {
            let arg = (*arg)?;
            let after = match self.plan.resources[i].owner {
                Owner::Input => arg.before,
                _ => arg.after,
            };
            Some(transition(arg.image, arg.extent[2], self.state_of(ResourceId(i)), after))
        };
        bound.iter().enumerate().filter_map(left).collect()
    }

    /// One pass, labelled.
    ///
    /// # Safety
    /// `commands` is being recorded for the host's family; every handle is alive, and the slot's sets are not
    /// in use.
    unsafe fn dispatch(
        &self,
        commands: vk::CommandBuffer,
        slot: usize,
        index: usize,
        edited: Option<Rectangle>,
    ) {
        let device = &self.host.device;
        let pass = self.pass(index);
        let pipeline = self.pipeline_of_pass[index];
        let point = vk::PipelineBindPoint::COMPUTE;
        let sets = [self.slots[slot].sets[index]];
        let of_edit = edited.map(|rectangle| pass.for_edit(rectangle));
        let (groups, push) = of_edit.as_ref().map_or((pass.groups, &pass.push), |(g, p)| (*g, p));
        let record = || {
            // SAFETY: as the caller guarantees; sets and push constants match the pipeline's layout.
            unsafe {
                device.cmd_bind_pipeline(commands, point, pipeline.pipeline);
                device.cmd_bind_descriptor_sets(commands, point, pipeline.layout, 0, &sets, &[]);
                let stages = pipeline.push.stage_flags;
                device.cmd_push_constants(commands, pipeline.layout, stages, 0, push);
                match pass.indirect.and_then(|(id, at)| Some((self.internal(id)?.buffer, at))) {
                    Some((buffer, at)) => device.cmd_dispatch_indirect(commands, buffer, at),
                    None => device.cmd_dispatch(commands, groups[0], groups[1], groups[2]),
                }
            }
        };
        self.host.labelled(commands, || pass.label(), record);
    }

    /// Whether a barrier is between two passes recorded one after the other.
    fn must_wait(&self, last: usize, next: usize) -> bool {
        (last + 1..=next).any(|p| self.pass(p).barrier_before)
    }

    fn state_of(&self, id: ResourceId) -> ImageState {
        match self.plan.resources[id.0].owner {
            Owner::Input => ImageState::READ,
            _ => ImageState::WRITTEN,
        }
    }

    /// The caller's image, or buffer, of each resource of the plan.
    fn bind<'a>(
        &self,
        inputs: &'a [InputArg],
        outputs: &'a [ImageArg],
    ) -> (Vec<Option<&'a ImageArg>>, Vec<Option<BufferArg>>) {
        let (mut inputs, mut outputs) = (inputs.iter(), outputs.iter());
        let owners = self.plan.resources.iter().map(|r| r.owner);
        owners
            .map(|owner| match owner {
                Owner::Internal => (None, None),
                Owner::Input | Owner::InputBuffer => match inputs.next() {
                    Some(InputArg::Image(image)) => (Some(image), None),
                    Some(InputArg::Buffer(buffer)) => (None, Some(*buffer)),
                    None => (None, None),
                },
                Owner::Output => (outputs.next(), None),
            })
            .unzip()
    }

    fn write_sets(&self, slot: usize, bound: &[Option<&ImageArg>]) {
        for (index, (pass, set)) in self.plan.every_pass().zip(&self.slots[slot].sets).enumerate() {
            let mut images = Vec::new();
            let mut buffers = Vec::new();
            let mut texels = Vec::new();
            for (binding, id) in pass.shader.bindings.iter().zip(&pass.bindings) {
                let backed = match id {
                    Some(id) => self.internal_of(slot, *id),
                    None => {
                        let writer = binding.written.then_some(index);
                        let fitting =
                            self.unused.iter().find(|u| u.0 == binding.kind && u.1 == writer);
                        fitting.map(|u| &u.2)
                    }
                };
                let arg = id.and_then(|id| bound[id.0]);
                let is_input = id.is_some_and(|id| self.plan.resources[id.0].owner == Owner::Input);
                images.push([vk::DescriptorImageInfo {
                    sampler: vk::Sampler::null(),
                    image_view: arg.map_or_else(
                        || backed.map_or_else(Default::default, |b| b.view),
                        |a| a.view,
                    ),
                    image_layout: if is_input {
                        ImageState::READ.layout
                    } else {
                        vk::ImageLayout::GENERAL
                    },
                }]);
                texels.push([backed.map_or_else(Default::default, |b| b.texels)]);
                buffers.push([vk::DescriptorBufferInfo {
                    buffer: backed.map_or_else(Default::default, |b| b.buffer),
                    offset: 0,
                    range: vk::WHOLE_SIZE,
                }]);
            }
            let writes: Vec<_> = pass
                .shader
                .bindings
                .iter()
                .enumerate()
                .map(|(i, binding)| {
                    let write = vk::WriteDescriptorSet::default()
                        .dst_set(*set)
                        .dst_binding(binding.binding)
                        .descriptor_type(descriptor_type(binding.kind));
                    match binding.kind {
                        BindingKind::StorageBuffer => write.buffer_info(&buffers[i]),
                        BindingKind::TexelBuffer => write.texel_buffer_view(&texels[i]),
                        _ => write.image_info(&images[i]),
                    }
                })
                .collect();
            // SAFETY: the sets are this slot's, whose last command buffer has run; views and buffers are alive
            // and of the reflected kinds.
            unsafe { self.host.device.update_descriptor_sets(&writes, &[]) };
        }
    }
}

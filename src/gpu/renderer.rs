use ash::vk;
use gpu_allocator::MemoryLocation;

use super::memory::{Backed, Memory, whole};
use super::pipelines::{Pipeline, Pipelines, descriptor_type};
use super::shaders::BindingKind;
use super::{Host, failed};
use crate::plan::{Format, Kind, Owner, Pass, Plan, Rectangle, Resource, ResourceId};
use crate::{Error, Result};

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
    const READ: Self = Self {
        stage: vk::PipelineStageFlags2::COMPUTE_SHADER,
        access: vk::AccessFlags2::SHADER_SAMPLED_READ,
        layout: vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    };
    /// What the renderer uses outputs and its own images as.
    const WRITTEN: Self = Self {
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
    /// The image.
    pub image: vk::Image,
    /// A view of its colour: 2D, or 2D array where the plan's resource is layered.
    pub view: vk::ImageView,
    /// Its format; must be the plan's.
    pub format: vk::Format,
    /// Columns, rows and layers; must be the plan's.
    pub extent: [u32; 3],
    /// How it comes.
    pub before: ImageState,
    /// How it is left. Inputs are left as they came, whatever stands here.
    pub after: ImageState,
}

/// GPU time of one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// The pass's label: name and part.
    pub label: String,
    /// Nanoseconds.
    pub ns: f64,
}

/// Records a plan into command buffers of a device that it borrows. Makes every resource when it is
/// made; recording takes nothing from the device, submits nothing and waits for nothing. (It takes
/// a little memory of the host, for barriers and descriptor writes, and gives it back.)
///
/// The plan's internal images serve all slots: command buffers of different slots must run one after
/// the other on one queue (which a queue does by itself: the recording begins with the barrier).
pub struct Renderer {
    host: Host,
    plan: Plan,
    memory: Memory,
    resources: Vec<Option<Backed>>,
    /// For bindings that a pass leaves unused: (kind, pass that alone may write it, resource).
    unused: Vec<(BindingKind, Option<usize>, Backed)>,
    pipelines: Pipelines,
    pipeline_of_pass: Vec<Pipeline>,
    descriptor_pool: vk::DescriptorPool,
    slots: Vec<Slot>,
    /// Whether all passes have been recorded: what an edit goes on from.
    is_drawn: bool,
    /// By pass of a whole recording: whether it must run, as it has been told something new since it
    /// was recorded last, or follows one that has.
    pending: Vec<bool>,
    /// Nanoseconds of a tick and a mask of the bits that count, where the host's queue has timestamps.
    timestamps: Option<(f64, u64)>,
    destroyed: bool,
}

struct Slot {
    sets: Vec<vk::DescriptorSet>,
    /// Null where there are no timestamps.
    queries: vk::QueryPool,
    recorded: Vec<usize>,
}

const fn is_send<T: Send>() {}
const _: () = is_send::<Renderer>();

impl Renderer {
    /// Makes all that `plan` needs on the host's device, for `slots` frames in flight (1 or more).
    ///
    /// # Errors
    /// A device that lacks something (named), or is out of memory.
    pub fn new(host: &Host, plan: Plan, slots: usize) -> Result<Self> {
        Self::sharing(host, plan, slots, Pipelines::default())
    }

    /// [`new`](Self::new) with pipelines that other renderers of the same device share.
    pub(super) fn sharing(
        host: &Host,
        plan: Plan,
        slots: usize,
        pipelines: Pipelines,
    ) -> Result<Self> {
        let report = super::requirements::report(&host.instance, host.physical_device);
        if !report.missing.is_empty() {
            return Err(Error::Device {
                doing: format!("making a renderer on {}", report.name),
                reason: format!("the device lacks {}", report.missing.join(", ")),
            });
        }
        let timestamps = super::requirements::timestamps(host);
        let mut renderer = Self {
            host: host.clone(),
            memory: Memory::new(host)?,
            resources: Vec::new(),
            unused: Vec::new(),
            pipelines,
            pipeline_of_pass: Vec::new(),
            descriptor_pool: vk::DescriptorPool::null(),
            slots: Vec::new(),
            is_drawn: false,
            pending: vec![true; plan.passes.len()],
            timestamps: timestamps.map(|(ns, bits)| (ns, u64::MAX >> (64 - bits.min(64)))),
            plan,
            destroyed: false,
        };
        match renderer.make(slots.max(1)) {
            Ok(()) => Ok(renderer),
            Err(error) => {
                renderer.destroy();
                Err(error)
            }
        }
    }

    fn make(&mut self, slots: usize) -> Result<()> {
        self.pipeline_of_pass = self.pipelines.of(&self.host, self.plan.every_pass())?;
        let azimuths = self.plan.find("azimuths");
        for (i, resource) in self.plan.resources.iter().enumerate() {
            // The one that the host writes.
            let location = if azimuths == Some(ResourceId(i)) {
                MemoryLocation::CpuToGpu
            } else {
                MemoryLocation::GpuOnly
            };
            let backed = match resource.owner {
                Owner::Internal => {
                    Some(self.memory.make(&resource.name, resource.kind, location)?)
                }
                Owner::Input | Owner::Output => None,
            };
            self.resources.push(backed);
        }
        self.write_azimuths()?;
        // What a shader might write is its pass's alone: two passes that "write" one unused image
        // would need a barrier for nothing.
        for (index, pass) in self.plan.every_pass().enumerate() {
            for (binding, id) in pass.shader.bindings.iter().zip(&pass.bindings) {
                let writer = binding.written.then_some(index);
                let known =
                    |u: &(BindingKind, Option<usize>, Backed)| u.0 == binding.kind && u.1 == writer;
                if id.is_none() && !self.unused.iter().any(known) {
                    let kind = smallest(binding.kind);
                    let backed = self.memory.make("unused", kind, MemoryLocation::GpuOnly)?;
                    self.unused.push((binding.kind, writer, backed));
                }
            }
        }
        self.make_slots(slots)
    }

    fn write_azimuths(&mut self) -> Result<()> {
        if let Some(id) = self.plan.find("azimuths") {
            let backed = self.resources[id.0].as_mut();
            let mapped = backed.and_then(|b| b.allocation.as_mut()?.mapped_slice_mut());
            let bytes: &[u8] = bytemuck::cast_slice(&self.plan.azimuths);
            let mapped = mapped.ok_or_else(|| Error::Device {
                doing: "writing the azimuths".into(),
                reason: "the device has no memory that the host can write".into(),
            })?;
            mapped[..bytes.len()].copy_from_slice(bytes);
        }
        Ok(())
    }

    fn make_slots(&mut self, slots: usize) -> Result<()> {
        let device = &self.host.device;
        let mut sizes: Vec<vk::DescriptorPoolSize> = Vec::new();
        for binding in self.plan.every_pass().flat_map(|p| p.shader.bindings) {
            let ty = descriptor_type(binding.kind);
            match sizes.iter_mut().find(|s| s.ty == ty) {
                Some(size) => size.descriptor_count += slots as u32,
                None => sizes.push(vk::DescriptorPoolSize { ty, descriptor_count: slots as u32 }),
            }
        }
        let passes = self.plan.every_pass().count();
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets((slots * passes) as u32)
            .pool_sizes(&sizes);
        // SAFETY: the device is alive; a plan has at least one pass, a pass at least one binding.
        self.descriptor_pool = unsafe { device.create_descriptor_pool(&info, None) }
            .map_err(failed("making the descriptor pool"))?;
        for _ in 0..slots {
            let layouts: Vec<_> = self.pipeline_of_pass.iter().map(|p| p.set_layout).collect();
            let sets_info = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(self.descriptor_pool)
                .set_layouts(&layouts);
            let queries_info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::TIMESTAMP)
                .query_count(passes as u32 + 1);
            // SAFETY: the pool was sized for exactly these sets; the layouts are alive.
            let slot = unsafe {
                device.allocate_descriptor_sets(&sets_info).and_then(|sets| {
                    let queries = match self.timestamps {
                        Some(_) => device.create_query_pool(&queries_info, None)?,
                        None => vk::QueryPool::null(),
                    };
                    Ok(Slot { sets, queries, recorded: Vec::new() })
                })
            };
            self.slots.push(slot.map_err(failed("making a frame's descriptors"))?);
        }
        Ok(())
    }

    /// The plan that is recorded.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Goes over to a plan that differs in what its passes are told, not in which there are nor in
    /// images and buffers: another colour of a light, a sun that has moved a little. Returns the
    /// passes that must run next for inputs that are as they were ([`Plan::passes_after`]), with those
    /// that earlier calls returned and that have not been recorded since. The device must be done with
    /// all that was recorded.
    ///
    /// # Errors
    /// A plan that needs a renderer of its own; the old one stays.
    pub fn replace_plan(&mut self, plan: Plan) -> Result<Vec<usize>> {
        if plan.resources != self.plan.resources || !plan.has_passes_of(&self.plan) {
            return Err(Error::setting(
                "plan",
                "other passes, images or buffers",
                "those of the plan that the renderer was made for",
            ));
        }
        for pass in plan.passes_after(&self.plan, &[]) {
            self.pending[pass] = true;
        }
        self.plan = plan;
        self.write_azimuths()?;
        Ok((0..self.pending.len()).filter(|p| self.pending[*p]).collect())
    }

    /// Bytes of memory that the renderer has taken from the device: [`Plan::internal_bytes`], and what
    /// drivers round up to and blocks of 4 MiB leave over.
    pub fn device_bytes(&self) -> u64 {
        self.memory.bytes()
    }

    /// An image or buffer of the renderer's own.
    pub(crate) fn internal(&self, id: ResourceId) -> Option<&Backed> {
        self.resources.get(id.0)?.as_ref()
    }

    /// Appends the plan to `commands`.
    ///
    /// `slot` is the frame in flight (0..slots); its last command buffer must have run. `inputs` and
    /// `outputs` are the plan's, in its order. Checks everything first: after an error nothing has
    /// been recorded. `commands` is being recorded, outside a render pass, for the host's family.
    ///
    /// # Errors
    /// An argument that is not what the plan says, by name.
    pub fn record(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        inputs: &[ImageArg],
        outputs: &[ImageArg],
    ) -> Result<()> {
        let all: Vec<usize> = (0..self.plan.passes.len()).collect();
        self.record_passes(commands, slot, inputs, outputs, &all)
    }

    /// Appends only some passes, by position in the plan, in its order: for timing them alone, or
    /// because no others are needed ([`Plan::passes_after`]). What they read must have been left by an
    /// earlier recording of this renderer; of outputs that they do not write the contents are kept
    /// where the caller's state before keeps them.
    ///
    /// # Errors
    /// As [`record`](Self::record); a pass that does not exist, twice the same, or one before another
    /// that precedes it in the plan; fewer than all by a renderer that has not yet recorded all.
    pub fn record_passes(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        inputs: &[ImageArg],
        outputs: &[ImageArg],
        passes: &[usize],
    ) -> Result<()> {
        self.check(slot, inputs, outputs)?;
        self.check_passes(passes)?;
        self.append(commands, slot, inputs, outputs, passes, None);
        self.is_drawn = true;
        passes.iter().for_each(|pass| self.pending[*pass] = false);
        self.plan.add_followers(&mut self.pending);
        Ok(())
    }

    /// In the plan's order, each once; so that as many as there are, are all. Fewer only after all: the
    /// plan's own images would hold nothing.
    fn check_passes(&self, passes: &[usize]) -> Result<()> {
        let count = self.plan.passes.len();
        if let Some(pass) = passes.iter().find(|p| **p >= count) {
            return Err(Error::setting("pass", pass.to_string(), format!("less than {count}")));
        }
        if let Some(pair) = passes.windows(2).find(|pair| pair[0] >= pair[1]) {
            return Err(Error::setting(
                "passes",
                format!("{} after {}", pair[1], pair[0]),
                "each once, in the plan's order",
            ));
        }
        if passes.len() < count && !self.is_drawn {
            return Err(Error::setting(
                "passes",
                format!("{} of {count}, nothing recorded", passes.len()),
                "a recording of all passes before",
            ));
        }
        Ok(())
    }

    /// Appends what must run where only the heights in `rectangle` are others than in the last
    /// recording: the lines that can reach it, from where they meet it to where it no longer stands on
    /// their hulls, and the light of the samples that see it ([`Plan::edit_passes`]). Leaves the same
    /// bits in every output as [`record`](Self::record) would.
    ///
    /// The outputs must hold, in the state that they come in, what the last recording left in them;
    /// every earlier change must have been recorded.
    ///
    /// # Errors
    /// As [`record`](Self::record); a plan without passes for edits; a rectangle beyond the field; a
    /// renderer that has not yet recorded all, or not all since its plan was replaced; an output whose
    /// contents are not kept.
    pub fn record_edit(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        inputs: &[ImageArg],
        outputs: &[ImageArg],
        rectangle: Rectangle,
    ) -> Result<()> {
        self.plan.check_edit(rectangle)?;
        self.check(slot, inputs, outputs)?;
        if !self.is_drawn {
            return Err(Error::setting("an edit", "nothing recorded", "a recording of all passes"));
        }
        let pending = self.pending.iter().filter(|p| **p).count();
        if pending > 0 {
            return Err(Error::setting(
                "an edit",
                format!("{pending} passes of the new plan not recorded"),
                "a recording of what replace_plan returned",
            ));
        }
        let names = self.plan.outputs().map(|(_, r)| &r.name);
        for (name, arg) in names.zip(outputs) {
            if is_without_contents(arg.before.layout) {
                return Err(Error::setting(
                    format!("{name}: layout before an edit"),
                    format!("{:?}", arg.before.layout),
                    "a layout with the contents of the last recording",
                ));
            }
        }
        let first = self.plan.passes.len();
        let passes: Vec<usize> = (first..first + self.plan.edit_passes.len()).collect();
        self.append(commands, slot, inputs, outputs, &passes, Some(rectangle));
        Ok(())
    }

    /// A pass by position: those of a whole recording, then those of an edit.
    fn pass(&self, index: usize) -> &Pass {
        let all = self.plan.passes.len();
        if index < all { &self.plan.passes[index] } else { &self.plan.edit_passes[index - all] }
    }

    /// Records passes, all arguments checked.
    fn append(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        inputs: &[ImageArg],
        outputs: &[ImageArg],
        passes: &[usize],
        edited: Option<Rectangle>,
    ) {
        let whole_plan = edited.is_none() && passes.len() == self.plan.passes.len();
        let bound = self.bind(inputs, outputs);
        self.write_sets(slot, &bound);
        let device = self.host.device.clone();
        let queries = self.slots[slot].queries;
        // The plan's own images hold nothing from frame to frame, unless single passes are repeated.
        let mut entry: Vec<_> = Vec::new();
        for (i, backed) in self.resources.iter().enumerate() {
            if let Some(backed) = backed.as_ref().filter(|b| b.image != vk::Image::null()) {
                let layout =
                    if whole_plan { vk::ImageLayout::UNDEFINED } else { vk::ImageLayout::GENERAL };
                let from = ImageState { layout, ..ImageState::WRITTEN };
                entry.push(transition(backed.image, backed.layers, from, ImageState::WRITTEN));
            }
            if let Some(arg) = bound[i] {
                let to = self.state_of(ResourceId(i));
                entry.push(transition(arg.image, arg.extent[2], arg.before, to));
            }
        }
        for (_, _, backed) in self.unused.iter().filter(|u| u.2.image != vk::Image::null()) {
            let from = ImageState { layout: vk::ImageLayout::UNDEFINED, ..ImageState::WRITTEN };
            entry.push(transition(backed.image, backed.layers, from, ImageState::WRITTEN));
        }
        let compute = vk::PipelineStageFlags2::COMPUTE_SHADER;
        // Passes of an edit may find their workgroups in a buffer.
        let stages = compute | vk::PipelineStageFlags2::DRAW_INDIRECT;
        let memory = [vk::MemoryBarrier2::default()
            .src_stage_mask(stages)
            .src_access_mask(vk::AccessFlags2::SHADER_STORAGE_WRITE)
            .dst_stage_mask(stages)
            .dst_access_mask(ImageState::WRITTEN.access | vk::AccessFlags2::INDIRECT_COMMAND_READ)];
        let between = vk::DependencyInfo::default().memory_barriers(&memory);
        let first =
            vk::DependencyInfo::default().image_memory_barriers(&entry).memory_barriers(&memory);
        let timestamp = |query: usize| {
            if queries != vk::QueryPool::null() {
                // SAFETY: `commands` is being recorded for a family with timestamps; the pool has a
                // query more than the plan has passes, reset where the recording begins.
                unsafe { device.cmd_write_timestamp2(commands, compute, queries, query as u32) };
            }
        };
        // SAFETY: the caller says that `commands` is being recorded for the host's family; every
        // handle is alive, images are in the layouts that their arguments state, sets and queries of
        // this slot are not in use.
        unsafe {
            if queries != vk::QueryPool::null() {
                let count = passes.len() as u32 + 1;
                // At once, so that no earlier times are taken for these; and where it runs, in case it
                // runs again.
                device.reset_query_pool(queries, 0, count);
                device.cmd_reset_query_pool(commands, queries, 0, count);
            }
            device.cmd_pipeline_barrier2(commands, &first);
            timestamp(0);
            for (query, &index) in passes.iter().enumerate() {
                let pass = self.pass(index);
                if query > 0 && self.must_wait(passes[query - 1], index) {
                    device.cmd_pipeline_barrier2(commands, &between);
                }
                self.label(commands, Some(pass));
                let pipeline = self.pipeline_of_pass[index];
                let point = vk::PipelineBindPoint::COMPUTE;
                device.cmd_bind_pipeline(commands, point, pipeline.pipeline);
                let sets = [self.slots[slot].sets[index]];
                device.cmd_bind_descriptor_sets(commands, point, pipeline.layout, 0, &sets, &[]);
                let stages = vk::ShaderStageFlags::COMPUTE;
                let of_edit = edited.map(|rectangle| pass.for_edit(rectangle));
                let (groups, push) =
                    of_edit.as_ref().map_or((pass.groups, &pass.push), |(g, p)| (*g, p));
                device.cmd_push_constants(commands, pipeline.layout, stages, 0, push);
                match pass.indirect.and_then(|(id, at)| Some((self.internal(id)?.buffer, at))) {
                    Some((buffer, at)) => device.cmd_dispatch_indirect(commands, buffer, at),
                    None => device.cmd_dispatch(commands, groups[0], groups[1], groups[2]),
                }
                self.label(commands, None);
                timestamp(query + 1);
            }
            let exit: Vec<_> = bound
                .iter()
                .enumerate()
                .filter_map(|(i, arg)| {
                    let arg = (*arg)?;
                    let after = match self.plan.resources[i].owner {
                        Owner::Input => arg.before,
                        _ => arg.after,
                    };
                    Some(transition(arg.image, arg.extent[2], self.state_of(ResourceId(i)), after))
                })
                .collect();
            let last = vk::DependencyInfo::default().image_memory_barriers(&exit);
            device.cmd_pipeline_barrier2(commands, &last);
        }
        self.slots[slot].recorded = passes.to_vec();
    }

    /// Whether a barrier stands between two passes recorded one after the other.
    fn must_wait(&self, last: usize, next: usize) -> bool {
        (last + 1..=next).any(|p| self.pass(p).barrier_before)
    }

    fn label(&self, commands: vk::CommandBuffer, pass: Option<&Pass>) {
        let Some(debug) = &self.host.debug_utils else { return };
        match pass {
            Some(pass) => {
                let name = std::ffi::CString::new(pass.label()).unwrap_or_default();
                let info = vk::DebugUtilsLabelEXT::default().label_name(&name);
                // SAFETY: `commands` is being recorded; the name lives across the call.
                unsafe { debug.cmd_begin_debug_utils_label(commands, &info) };
            }
            // SAFETY: `commands` is being recorded and a label is open.
            None => unsafe { debug.cmd_end_debug_utils_label(commands) },
        }
    }

    fn state_of(&self, id: ResourceId) -> ImageState {
        match self.plan.resources[id.0].owner {
            Owner::Input => ImageState::READ,
            _ => ImageState::WRITTEN,
        }
    }

    fn check(&self, slot: usize, inputs: &[ImageArg], outputs: &[ImageArg]) -> Result<()> {
        if slot >= self.slots.len() {
            return Err(Error::setting(
                "slot",
                slot.to_string(),
                format!("less than {}", self.slots.len()),
            ));
        }
        let check_all = |what: &str, args: &[ImageArg], wanted: Vec<(ResourceId, &Resource)>| {
            if args.len() != wanted.len() {
                let names: Vec<_> = wanted.iter().map(|w| w.1.name.as_str()).collect();
                return Err(Error::setting(
                    what,
                    format!("{} images", args.len()),
                    format!("{}: {}", names.len(), names.join(", ")),
                ));
            }
            args.iter().zip(wanted).try_for_each(|(arg, (_, resource))| check_image(arg, resource))
        };
        check_all("inputs", inputs, self.plan.inputs().collect())?;
        check_all("outputs", outputs, self.plan.outputs().collect())
    }

    fn bind<'a>(
        &self,
        inputs: &'a [ImageArg],
        outputs: &'a [ImageArg],
    ) -> Vec<Option<&'a ImageArg>> {
        let (mut inputs, mut outputs) = (inputs.iter(), outputs.iter());
        let owners = self.plan.resources.iter().map(|r| r.owner);
        owners
            .map(|owner| match owner {
                Owner::Internal => None,
                Owner::Input => inputs.next(),
                Owner::Output => outputs.next(),
            })
            .collect()
    }

    fn write_sets(&self, slot: usize, bound: &[Option<&ImageArg>]) {
        for (index, (pass, set)) in self.plan.every_pass().zip(&self.slots[slot].sets).enumerate() {
            let mut images = Vec::new();
            let mut buffers = Vec::new();
            let mut texels = Vec::new();
            for (binding, id) in pass.shader.bindings.iter().zip(&pass.bindings) {
                let backed = match id {
                    Some(id) => self.resources[id.0].as_ref(),
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
            // SAFETY: the sets are this slot's, whose last command buffer has run; views and buffers
            // are alive and of the kinds that reflection found.
            unsafe { self.host.device.update_descriptor_sets(&writes, &[]) };
        }
    }

    /// GPU times of the passes that `slot` recorded last, in order; none while they are not all in, and
    /// where the host's queue family has no timestamps. Never waits.
    pub fn timings(&self, slot: usize) -> Option<Vec<Timing>> {
        let slot = self.slots.get(slot)?;
        let (tick_ns, mask) = self.timestamps?;
        if slot.recorded.is_empty() {
            return None;
        }
        // Each a value and whether it is there.
        let mut ticks = vec![[0_u64; 2]; slot.recorded.len() + 1];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
        // SAFETY: the pool holds at least this many queries; two words a query are asked for and given.
        let got =
            unsafe { self.host.device.get_query_pool_results(slot.queries, 0, &mut ticks, flags) };
        if got.is_err() || ticks.iter().any(|t| t[1] == 0) {
            return None;
        }
        let passes = slot.recorded.iter().zip(ticks.windows(2));
        let timings = passes.map(|(&index, pair)| {
            let elapsed = pair[1][0].wrapping_sub(pair[0][0]) & mask;
            Timing { label: self.pass(index).label(), ns: elapsed as f64 * tick_ns }
        });
        Some(timings.collect())
    }

    /// Frees everything. The device must be done with all that was recorded.
    pub fn destroy(mut self) {
        self.free();
    }

    fn free(&mut self) {
        for mut backed in self.resources.drain(..).flatten() {
            self.memory.free(&mut backed);
        }
        for (_, _, mut backed) in self.unused.drain(..) {
            self.memory.free(&mut backed);
        }
        for slot in self.slots.drain(..) {
            // SAFETY: made by this device; the caller of `destroy` says that nothing in flight uses it.
            // Null is allowed.
            unsafe { self.host.device.destroy_query_pool(slot.queries, None) };
        }
        // SAFETY: as above; null is allowed.
        unsafe { self.host.device.destroy_descriptor_pool(self.descriptor_pool, None) };
        std::mem::take(&mut self.pipelines).end(&self.host);
        self.memory.end();
        self.destroyed = true;
    }
}

impl Drop for Renderer {
    fn drop(&mut self) {
        if !self.destroyed {
            eprintln!(
                "ridgelight: a renderer was dropped without destroy(): its Vulkan objects stay"
            );
            self.memory.leak();
        }
    }
}

/// An image or buffer for a binding that a pass leaves unused.
fn smallest(kind: BindingKind) -> Kind {
    let image = |format, layered| Kind::Image { format, width: 1, height: 1, layers: 1, layered };
    match kind {
        BindingKind::StorageBuffer => Kind::Buffer { bytes: 16, texels: false },
        BindingKind::TexelBuffer => Kind::Buffer { bytes: 16, texels: true },
        BindingKind::SampledImage { uint: true, layered } => image(Format::R32Uint, layered),
        BindingKind::SampledImage { uint: false, layered } => image(Format::R32Float, layered),
        BindingKind::StorageImage { format, uint, layered } => {
            let all = [
                Format::R32Float,
                Format::Rgba32Float,
                Format::R32Uint,
                Format::Rg32Uint,
                Format::Rgba32Uint,
            ];
            let fitting = all.into_iter().find(|f| f.spirv() == format);
            image(fitting.unwrap_or(if uint { Format::R32Uint } else { Format::R32Float }), layered)
        }
    }
}

fn is_without_contents(layout: vk::ImageLayout) -> bool {
    matches!(layout, vk::ImageLayout::UNDEFINED | vk::ImageLayout::PREINITIALIZED)
}

fn check_image(arg: &ImageArg, resource: &Resource) -> Result<()> {
    let Kind::Image { format, width, height, layers, .. } = resource.kind else { return Ok(()) };
    let name = &resource.name;
    if arg.image == vk::Image::null() || arg.view == vk::ImageView::null() {
        return Err(Error::setting(name, "a null image or view", "an image"));
    }
    if arg.format != format.vk() {
        return Err(Error::setting(
            format!("{name}: format"),
            format!("{:?}", arg.format),
            format!("{:?}", format.vk()),
        ));
    }
    if arg.extent != [width, height, layers] {
        return Err(Error::setting(
            format!("{name}: extent"),
            format!("{:?}", arg.extent),
            format!("{:?} (columns, rows, layers)", [width, height, layers]),
        ));
    }
    if resource.owner == Owner::Input && is_without_contents(arg.before.layout) {
        return Err(Error::setting(
            format!("{name}: layout"),
            format!("{:?}", arg.before.layout),
            "a layout with contents",
        ));
    }
    if resource.owner == Owner::Output && is_without_contents(arg.after.layout) {
        return Err(Error::setting(
            format!("{name}: layout after"),
            format!("{:?}", arg.after.layout),
            "a layout to be left in",
        ));
    }
    Ok(())
}

fn transition<'a>(
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

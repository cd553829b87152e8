//! A plan on a device: its resources, its recording, its GPU times.

mod buffers;
mod checks;
mod images;
mod record_plan;
mod resources;
mod stages;

use ash::vk;

use super::allocator::{Allocator, Blocks};
use super::memory::{Backed, Memory};
use super::pipelines::{Pipeline, Pipelines};
use super::shaders::BindingKind;
use super::timestamps::Timestamps;
use super::{Host, requirements};
use crate::graph::{Pass, Rectangle, ResourceId};
use crate::plan::Plan;
use crate::{Error, Result};

pub use buffers::{BufferArg, InputArg};
pub(super) use checks::{
    check_apart, check_contents, check_image, check_left, check_stage, check_state,
};
pub use images::{ImageArg, ImageState, transition};

/// GPU time of one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// The pass's label: name and part.
    pub label: String,
    /// Nanoseconds.
    pub ns: f64,
}

/// How a frame is lit before it is shown.
#[derive(Clone, Copy, Debug)]
pub enum Work<'a> {
    /// Passes by position in its plan, as for [`Renderer::record_passes`]; none: the light is unchanged.
    Passes(&'a [usize]),
    /// The edit of a rectangle of heights: [`Renderer::record_edit`].
    Edit(Rectangle),
}

impl Work<'_> {
    /// Whether there is nothing to do.
    #[doc(hidden)]
    pub fn is_none(&self) -> bool {
        matches!(self, Self::Passes([]))
    }
}

/// Records a plan into command buffers of a borrowed device. It makes every resource when it is made. Recording
/// allocates nothing on the device, submits nothing and waits for nothing. (It allocates a little host memory
/// for barriers and descriptor writes.)
///
/// The plan's internal images serve all slots: command buffers of different slots must run one after the other
/// on one queue (which a queue does by itself: the recording begins with the barrier).
pub struct Renderer {
    host: Host,
    /// Capabilities of the host's queue family.
    family: vk::QueueFlags,
    plan: Plan,
    memory: Memory,
    resources: Vec<Option<Backed>>,
    /// For bindings that a pass leaves unused: (kind, the only pass that may write it, resource).
    unused: Vec<(BindingKind, Option<usize>, Backed)>,
    pipelines: Pipelines,
    pipeline_of_pass: Vec<Pipeline>,
    descriptor_pool: vk::DescriptorPool,
    slots: Vec<Slot>,
    /// By pass of a whole recording.
    progress: Vec<Progress>,
    /// Whether there is a timestamp after every pass, or only after the last.
    times_passes: bool,
    /// Formats that inputs may have on this device, besides the plan's.
    readable: Vec<vk::Format>,
}

struct Slot {
    sets: Vec<vk::DescriptorSet>,
    /// Buffers that the host writes; one set per frame in flight.
    tables: Vec<(ResourceId, Backed)>,
    /// Whether they hold the current plan's values.
    is_current: bool,
    /// None where the host's queue family has no timestamps.
    timestamps: Option<Timestamps>,
    recorded: Vec<usize>,
    /// Whether that has a timestamp after every pass.
    times_passes: bool,
}

/// How far a pass is from what a whole recording would leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Progress {
    /// Recorded with this plan.
    Current,
    /// A pass that it depends on, or that adds to the same sum, was recorded alone since. Edits are refused, and
    /// `replace_plan` makes it pending.
    Stale,
    /// Not recorded, or its inputs from the plan have changed since, or it depends on such a pass. Pending passes are recorded in
    /// the plan's order.
    Pending,
}

const fn is_send<T: Send>() {}
const _: () = is_send::<Renderer>();

impl Renderer {
    /// Makes everything that `plan` needs on the host's device, for `slots` frames in flight (1 or more). The plan must be for this
    /// device's [`limits`](crate::gpu::limits): only the sizes of its images are checked again.
    ///
    /// # Errors
    /// A device that lacks a requirement (named), or is out of memory; a queue family that the device does not
    /// have, or that has no compute; images that are larger than the device allows.
    pub fn new(host: &Host, plan: Plan, slots: usize) -> Result<Self> {
        Self::with_memory(host, plan, slots, Box::new(Blocks::new(host)?))
    }

    /// [`new`](Self::new) with memory from an engine's own allocator, which is dropped after everything has
    /// been freed.
    ///
    /// # Errors
    /// As there, and the allocator's own.
    pub fn with_memory(
        host: &Host,
        plan: Plan,
        slots: usize,
        allocator: Box<dyn Allocator>,
    ) -> Result<Self> {
        Self::sharing(host, plan, slots, Pipelines::default(), allocator)
    }

    /// The same, with pipelines shared with other renderers of the device.
    #[doc(hidden)]
    pub fn sharing(
        host: &Host,
        plan: Plan,
        slots: usize,
        pipelines: Pipelines,
        allocator: Box<dyn Allocator>,
    ) -> Result<Self> {
        let report = requirements::report(&host.instance, host.physical_device);
        if !report.missing.is_empty() {
            return Err(Error::Device {
                doing: format!("making a renderer on {}", report.name),
                reason: format!("the device lacks {}", report.missing.join(", ")),
            });
        }
        let family = requirements::family_flags(host, vk::QueueFlags::COMPUTE)?;
        let mut renderer = Self {
            host: host.clone(),
            family,
            memory: Memory::new(host, allocator),
            readable: requirements::readable(host),
            resources: Vec::new(),
            unused: Vec::new(),
            pipelines,
            pipeline_of_pass: Vec::new(),
            descriptor_pool: vk::DescriptorPool::null(),
            slots: Vec::new(),
            progress: vec![Progress::Pending; plan.passes.len()],
            times_passes: true,
            plan,
        };
        match renderer.make(slots.max(1)) {
            Ok(()) => Ok(renderer),
            Err(error) => {
                renderer.destroy();
                Err(error)
            }
        }
    }

    /// The plan that is recorded.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Replaces the plan by one with the same passes, images and buffers but other values: another colour of a
    /// light, a sun that moved a little. Returns the passes that must run next if the inputs are unchanged
    /// ([`Plan::passes_after`]), with those that earlier calls returned and that have not been recorded since.
    ///
    /// It does not wait, and the caller need not wait: frames in flight finish with the plan of their
    /// recording. So lights may change each frame.
    ///
    /// # Errors
    /// A plan that needs a renderer of its own, by the size, settings, images or passes that differ; the old one
    /// stays.
    pub fn replace_plan(&mut self, plan: Plan) -> Result<Vec<usize>> {
        if let Some([found, expected]) = plan.difference(&self.plan) {
            let expected =
                format!("{expected}, as in the renderer's plan; make a renderer for the new plan");
            return Err(Error::setting("plan", found, expected));
        }
        let changed = plan.passes_after(&self.plan, &[]);
        if !changed.is_empty() || self.progress.contains(&Progress::Stale) {
            let mut runs: Vec<bool> =
                self.progress.iter().map(|p| *p != Progress::Current).collect();
            changed.iter().for_each(|pass| runs[*pass] = true);
            // All passes that add to a partly recorded sum run again.
            plan.add_followers(&mut runs);
            let pending = self.progress.iter_mut().zip(runs).filter(|(_, runs)| *runs);
            pending.for_each(|(progress, _)| *progress = Progress::Pending);
        }
        self.plan = plan;
        self.slots.iter_mut().for_each(|slot| slot.is_current = false);
        let is_pending = |pass: &usize| self.progress[*pass] == Progress::Pending;
        Ok((0..self.progress.len()).filter(is_pending).collect())
    }

    /// The passes to record next with [`record_passes`](Self::record_passes), if only the inputs `changed` have new texels
    /// since the last recording. They are the passes that depend on `changed` ([`Plan::passes_after`]), and those that have
    /// not been recorded since the renderer was created or [`replace_plan`](Self::replace_plan) changed them.
    ///
    /// In a series of frames with new heights, only the first frame then computes the tables of an environment. The
    /// renderer's images keep their contents between recordings, and all slots share them. What is recorded
    /// counts as run: after a command buffer that was not submitted, call [`record`](Self::record).
    pub fn passes_after(&self, changed: &[ResourceId]) -> Vec<usize> {
        let mut runs: Vec<bool> = self.progress.iter().map(|p| *p != Progress::Current).collect();
        self.plan.passes_after(&self.plan, changed).iter().for_each(|pass| runs[*pass] = true);
        self.plan.add_followers(&mut runs);
        (0..runs.len()).filter(|pass| runs[*pass]).collect()
    }

    /// Bytes of device memory in use: [`Plan::internal_bytes`], the few that the host writes for each further
    /// slot, and what drivers and blocks of 4 MiB round up to.
    pub fn device_bytes(&self) -> u64 {
        self.memory.bytes()
    }

    /// An image or buffer of the renderer; the first slot's where each slot has one.
    pub(crate) fn internal(&self, id: ResourceId) -> Option<&Backed> {
        self.internal_of(0, id)
    }

    /// The same, for a slot.
    fn internal_of(&self, slot: usize, id: ResourceId) -> Option<&Backed> {
        let tables = self.slots.get(slot).map_or(&[][..], |slot| &slot.tables);
        let table = tables.iter().find(|table| table.0 == id).map(|table| &table.1);
        table.or(self.resources.get(id.0)?.as_ref())
    }

    /// Appends all passes to `commands`, because any input may have new texels. [`passes_after`](Self::passes_after) returns the
    /// passes that a change of some inputs needs.
    ///
    /// `slot` is the frame in flight (0..slots); its last command buffer must have run. `inputs` and `outputs`
    /// are the plan's, in its order. Inputs are [images](ImageArg), or [buffers](BufferArg) where
    /// [`Plan::take_buffer`] allowed it ([`InputArg`] where both occur). `commands` is being recorded, outside
    /// a render pass, for the host's family. All arguments are checked first: after an error nothing has been
    /// recorded.
    ///
    /// # Errors
    /// An argument that does not match the plan, by name.
    pub fn record<I: Copy + Into<InputArg>>(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        inputs: &[I],
        outputs: &[ImageArg],
    ) -> Result<()> {
        let all: Vec<usize> = (0..self.plan.passes.len()).collect();
        self.record_passes(commands, slot, inputs, outputs, &all)
    }

    /// Appends only some passes, by position in the plan and in its order: to time them alone, or because no
    /// others are needed ([`passes_after`](Self::passes_after)). An earlier recording of this renderer must have left what
    /// they read. Outputs that they do not write keep their contents where the caller's state before keeps
    /// them.
    ///
    /// All passes of a new renderer, or those that [`replace_plan`](Self::replace_plan) returned, may be recorded in parts,
    /// over several frames. Start with the first of them and skip none; until they are recorded, a list without passes is
    /// refused. Passes recorded alone at other times leave sums and images of the plan that are not those of a whole frame:
    /// the next edit is refused, and the next `replace_plan` and `passes_after` return what must run.
    ///
    /// # Errors
    /// As [`record`](Self::record). A pass that does not exist, is repeated or out of order, or follows a pass that must be
    /// recorded first. An output without contents that these passes read or add to.
    pub fn record_passes<I: Copy + Into<InputArg>>(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        inputs: &[I],
        outputs: &[ImageArg],
        passes: &[usize],
    ) -> Result<()> {
        let inputs: Vec<InputArg> = inputs.iter().map(|input| (*input).into()).collect();
        self.check(slot, &inputs, outputs)?;
        self.check_passes(passes)?;
        self.check_kept(outputs, passes)?;
        let affected = self.affected(passes);
        self.append(commands, slot, &inputs, outputs, passes, None);
        let has_pending = self.progress.contains(&Progress::Pending);
        let becomes = if has_pending { Progress::Pending } else { Progress::Stale };
        for progress in self.progress.iter_mut().zip(affected).filter_map(|(p, a)| a.then_some(p)) {
            *progress = becomes.max(*progress);
        }
        passes.iter().for_each(|pass| self.progress[*pass] = Progress::Current);
        Ok(())
    }

    /// Whether [`record_passes`](Self::record_passes) would refuse these passes, or
    /// [`record_edit`](Self::record_edit) a rectangle; records nothing.
    #[doc(hidden)]
    pub fn check_recording(
        &self,
        slot: usize,
        inputs: &[ImageArg],
        outputs: &[ImageArg],
        work: Work<'_>,
    ) -> Result<()> {
        let inputs: Vec<InputArg> = inputs.iter().map(|input| (*input).into()).collect();
        self.check(slot, &inputs, outputs)?;
        match work {
            Work::Passes([]) => Ok(()),
            Work::Passes(passes) => {
                self.check_passes(passes).and_then(|()| self.check_kept(outputs, passes))
            }
            Work::Edit(edit) => self.plan.check_edit(edit).and_then(|()| self.check_drawn(outputs)),
        }
    }

    /// The last recording did not run: nothing counts as recorded.
    #[doc(hidden)]
    pub fn forget(&mut self) {
        self.progress.fill(Progress::Pending);
        self.slots.iter_mut().for_each(|slot| slot.recorded.clear());
    }

    /// Appends the edit of a rectangle of heights; only there may the input differ from the last recording. It
    /// sweeps the lines that can reach the rectangle, from where they enter it to where it has left their
    /// hulls, and lights the texels whose horizon changes ([`Plan::edit_passes`]). Every output gets the same
    /// bits as from [`record`](Self::record).
    ///
    /// The outputs must hold, in their state before, what the last recording left in them. Every earlier change
    /// must have been recorded.
    ///
    /// # Errors
    /// As [`record`](Self::record). A plan without passes for edits; a rectangle beyond the field; a renderer
    /// that has not recorded all passes, or not since its plan was replaced; an output whose contents are not
    /// kept.
    pub fn record_edit<I: Copy + Into<InputArg>>(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        inputs: &[I],
        outputs: &[ImageArg],
        rectangle: Rectangle,
    ) -> Result<()> {
        self.plan.check_edit(rectangle)?;
        let inputs: Vec<InputArg> = inputs.iter().map(|input| (*input).into()).collect();
        self.check(slot, &inputs, outputs)?;
        self.check_drawn(outputs)?;
        let first = self.plan.passes.len();
        let passes: Vec<usize> = (first..first + self.plan.edit_passes.len()).collect();
        self.append(commands, slot, &inputs, outputs, &passes, Some(rectangle));
        Ok(())
    }

    /// A pass by position: those of a whole recording, then those of an edit.
    fn pass(&self, index: usize) -> &Pass {
        let all = self.plan.passes.len();
        if index < all { &self.plan.passes[index] } else { &self.plan.edit_passes[index - all] }
    }

    /// Sets whether later recordings write a timestamp after every pass (the default) or only after the last. On an NVIDIA
    /// H200 a timestamp waits for all earlier passes and delays later ones, so that passes do not overlap.
    pub fn time_passes(&mut self, each: bool) {
        self.times_passes = each;
    }

    /// GPU times of the passes that `slot` recorded last, in order; after
    /// [`time_passes(false)`](Self::time_passes) a single entry labelled "all passes". None while some are not available, and
    /// where the host's queue family has no timestamps. Never waits.
    pub fn timings(&self, slot: usize) -> Option<Vec<Timing>> {
        let slot = self.slots.get(slot)?;
        if slot.recorded.is_empty() {
            return None;
        }
        let timestamps = slot.timestamps.as_ref()?;
        if !slot.times_passes {
            let ns = timestamps.ns(2)?[0];
            return Some(vec![Timing { label: "all passes".into(), ns }]);
        }
        let times = timestamps.ns(slot.recorded.len() + 1)?;
        let passes = slot.recorded.iter().zip(times);
        let timings = passes.map(|(&index, ns)| Timing { label: self.pass(index).label(), ns });
        Some(timings.collect())
    }

    /// Frees everything. All recorded commands must have finished.
    pub fn destroy(mut self) {
        self.free();
    }
}

impl Drop for Renderer {
    fn drop(&mut self) {
        self.memory.leak("a renderer");
    }
}

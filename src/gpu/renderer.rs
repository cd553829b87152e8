//! A plan on a device: what it makes, what it records, how long that took.

mod buffers;
mod checks;
mod images;
mod recording;
mod resources;

use ash::vk;

use super::allocator::{Allocator, Blocks};
use super::memory::{Backed, Memory};
use super::pipelines::{Pipeline, Pipelines};
use super::shaders::BindingKind;
use super::{Host, requirements};
use crate::graph::{Pass, Rectangle, ResourceId};
use crate::plan::Plan;
use crate::{Error, Result};

pub use buffers::{BufferArg, InputArg};
pub(super) use checks::{check_stage, check_state};
pub(super) use images::transition;
pub use images::{ImageArg, ImageState};

/// GPU time of one pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// The pass's label: name and part.
    pub label: String,
    /// Nanoseconds.
    pub ns: f64,
}

/// What lights a frame before it is shown.
#[derive(Clone, Copy, Debug)]
pub enum Work<'a> {
    /// Passes by position in its plan, as [`Renderer::record_passes`] takes them; none: it
    /// stays as it was.
    Passes(&'a [usize]),
    /// What an edit of a rectangle of its heights needs: [`Renderer::record_edit`].
    Edit(Rectangle),
}

impl Work<'_> {
    /// Whether nothing is done.
    #[doc(hidden)]
    pub fn is_none(&self) -> bool {
        matches!(self, Self::Passes([]))
    }
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
    /// How many of the plan's first passes have been recorded; after all, it stays all: what an edit goes on from.
    begun: usize,
    /// By pass of a whole recording: whether it must run, as it has been told something new since it
    /// was recorded last, or follows one that has.
    pending: Vec<bool>,
    /// Nanoseconds of a tick and a mask of the bits that count, where the host's queue has timestamps.
    timestamps: Option<(f64, u64)>,
    /// Formats that inputs may have on this device, beside those of their plan.
    readable: Vec<vk::Format>,
    destroyed: bool,
}

struct Slot {
    sets: Vec<vk::DescriptorSet>,
    /// What the host tells passes beside push constants: of frames in flight each has its own.
    tables: Vec<(ResourceId, Backed)>,
    /// Whether they hold what the plan says.
    is_told: bool,
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
        Self::with_memory(host, plan, slots, Box::new(Blocks::new(host)?))
    }

    /// [`new`](Self::new) with memory from an engine's own allocator, dropped after all has been freed.
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

    /// The same with pipelines that other renderers of the same device share.
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
        let timestamps = requirements::timestamps(host);
        let mut renderer = Self {
            host: host.clone(),
            memory: Memory::new(host, allocator),
            readable: requirements::readable(host),
            resources: Vec::new(),
            unused: Vec::new(),
            pipelines,
            pipeline_of_pass: Vec::new(),
            descriptor_pool: vk::DescriptorPool::null(),
            slots: Vec::new(),
            begun: 0,
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

    /// The plan that is recorded.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Goes over to a plan that differs in what its passes are told, not in which there are nor in
    /// images and buffers: another colour of a light, a sun that has moved a little. Returns the
    /// passes that must run next for inputs that are as they were ([`Plan::passes_after`]), with those
    /// that earlier calls returned and that have not been recorded since.
    ///
    /// Waits for nothing, and need not be waited for: what is in flight goes on with the plan that it was
    /// recorded with. So lights may change each frame.
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
        // Pieces go on from the first pass that is not of this plan.
        let first = self.pending.iter().position(|p| *p);
        if let Some(first) = first.filter(|_| self.begun < self.pending.len()) {
            self.begun = self.begun.min(first);
        }
        self.plan = plan;
        self.slots.iter_mut().for_each(|slot| slot.is_told = false);
        Ok((0..self.pending.len()).filter(|p| self.pending[*p]).collect())
    }

    /// Bytes of memory that the renderer has taken from the device: [`Plan::internal_bytes`], the few that
    /// the host writes once more for each further slot, and what drivers round up to and blocks of 4 MiB
    /// leave over.
    pub fn device_bytes(&self) -> u64 {
        self.memory.bytes()
    }

    /// An image or buffer of the renderer's own; of those that each slot has, the first's.
    pub(crate) fn internal(&self, id: ResourceId) -> Option<&Backed> {
        self.internal_of(0, id)
    }

    /// The same, a slot's.
    fn internal_of(&self, slot: usize, id: ResourceId) -> Option<&Backed> {
        let tables = self.slots.get(slot).map_or(&[][..], |slot| &slot.tables);
        let table = tables.iter().find(|table| table.0 == id).map(|table| &table.1);
        table.or(self.resources.get(id.0)?.as_ref())
    }

    /// Appends the plan to `commands`.
    ///
    /// `slot` is the frame in flight (0..slots); its last command buffer must have run. `inputs` and
    /// `outputs` are the plan's, in its order: inputs are [images](ImageArg), or [buffers](BufferArg) where
    /// [`Plan::take_buffer`] said so ([`InputArg`] where there are both). Checks everything first: after an
    /// error nothing has been recorded. `commands` is being recorded, outside a render pass, for the host's
    /// family.
    ///
    /// # Errors
    /// An argument that is not what the plan says, by name.
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

    /// Appends only some passes, by position in the plan, in its order: for timing them alone, or
    /// because no others are needed ([`Plan::passes_after`]). What they read must have been left by an
    /// earlier recording of this renderer; of outputs that they do not write the contents are kept
    /// where the caller's state before keeps them.
    ///
    /// A renderer that has not yet recorded all may do so in pieces: the plan's first passes, and then those that
    /// follow, or the first again.
    ///
    /// # Errors
    /// As [`record`](Self::record); a pass that does not exist, twice the same, or one before another
    /// that precedes it in the plan; others than those of the next piece by a renderer that has not yet recorded all.
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
        self.append(commands, slot, &inputs, outputs, passes, None);
        self.begun = self.begun.max(passes.last().map_or(0, |last| last + 1));
        passes.iter().for_each(|pass| self.pending[*pass] = false);
        self.plan.add_followers(&mut self.pending);
        Ok(())
    }

    /// What [`record_passes`](Self::record_passes) refuses, or of a rectangle [`record_edit`](Self::record_edit), with
    /// nothing recorded.
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
            Work::Passes(passes) => self.check_passes(passes),
            Work::Edit(edit) => self.plan.check_edit(edit).and_then(|()| self.check_drawn(outputs)),
        }
    }

    /// Of what was recorded last nothing ran: nothing counts as recorded.
    #[doc(hidden)]
    pub fn forget(&mut self) {
        self.begun = 0;
        self.pending.fill(true);
        self.slots.iter_mut().for_each(|slot| slot.recorded.clear());
    }

    /// Appends what an edit needs, a rectangle of heights in which alone the input differs from the last
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

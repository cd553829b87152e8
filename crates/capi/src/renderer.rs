use std::collections::HashMap;
use std::ffi::c_char;

use ash::vk;
use ridgelight::gpu::{ImageArg, InputArg, Renderer, Timing};
use ridgelight::plan::{Rectangle, Resource};

use crate::allocator::{Callbacks, RidgelightAllocator};
use crate::errors::{Done, Failure, RidgelightResult, done};
use crate::plan::{RidgelightPlan, text};
use crate::read::{SizeFirst, hand_out, handle, handle_mut, indices, read, read_all, room, write};
use crate::types::{RidgelightHost, RidgelightImage, host};

/// A plan on a device. Any thread may use it, one at a time.
pub struct RidgelightRenderer(pub(crate) Renderer);

/// Makes everything that a plan needs on a host's device, for `slots` frames in flight (0: 1); recording
/// allocates nothing on it. `allocator` may be null: memory then comes in blocks of 4 MiB.
///
/// Internal images serve all slots: command buffers of different slots must run one after the other on one
/// queue.
///
/// Returns OK, ARGUMENT, SETTING or DEVICE.
///
/// # Safety
/// Pointers are null, or to structs whose struct_size is set, and whose handles are alive until the renderer is
/// destroyed, as is the data that `allocator` uses through `user`; `renderer` may be written to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_renderer_create(
    host: *const RidgelightHost,
    plan: *const RidgelightPlan,
    slots: u32,
    allocator: *const RidgelightAllocator,
    renderer: *mut *mut RidgelightRenderer,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        hand_out(renderer, || {
            let host = self::host(host)?;
            let plan = handle(plan, "plan")?.0.clone();
            let slots = slots.max(1) as usize;
            let made = match callbacks(allocator)? {
                Some(callbacks) => Renderer::with_memory(&host, plan, slots, Box::new(callbacks)),
                None => Renderer::new(&host, plan, slots),
            };
            Ok(RidgelightRenderer(made?))
        })
    })
}

pub(crate) unsafe fn callbacks(from: *const RidgelightAllocator) -> Done<Option<Callbacks>> {
    if from.is_null() {
        return Ok(None);
    }
    // SAFETY: as the caller's caller guarantees.
    let given = unsafe { read(from, "allocator") }?;
    let null = |name: &str| Failure::argument(&format!("allocator: {name}"), "null", "a function");
    Ok(Some(Callbacks {
        user: given.user,
        allocate: given.allocate.ok_or_else(|| null("allocate"))?,
        free: given.free.ok_or_else(|| null("free"))?,
        held: HashMap::new(),
    }))
}

/// Frees everything. All recorded commands must have finished. Null is allowed.
///
/// # Safety
/// It came from ridgelight_renderer_create and is not used again.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_renderer_destroy(renderer: *mut RidgelightRenderer) {
    if !renderer.is_null() {
        // SAFETY: as the caller says.
        unsafe { Box::from_raw(renderer) }.0.destroy();
    }
}

/// A rectangle of texels.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightRectangle {
    /// The first column.
    pub col: u32,
    /// The first row.
    pub row: u32,
    /// Number of columns, 1 or more.
    pub cols: u32,
    /// Number of rows, 1 or more.
    pub rows: u32,
}

/// Appends a plan to `commands`: no submit, no wait, no allocation on the device. All arguments are checked
/// first: after an error nothing has been recorded.
///
/// `commands` is being recorded outside a render pass, for the host's family. `slot` is the frame in flight;
/// its last command buffer must have run. `inputs` and `outputs` are the plan's, in its order.
///
/// Returns OK, ARGUMENT or SETTING.
///
/// # Safety
/// `renderer` is alive or null, and used only by this thread meanwhile; arrays have the given lengths, and each
/// struct's struct_size is set; images and views are alive until the command buffer has run.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_record(
    renderer: *mut RidgelightRenderer,
    commands: vk::CommandBuffer,
    slot: u32,
    inputs: *const RidgelightImage,
    input_count: u32,
    outputs: *const RidgelightImage,
    output_count: u32,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let renderer = recorder(renderer, commands)?;
        let (inputs, outputs) = images(renderer, (inputs, input_count), (outputs, output_count))?;
        Ok(renderer.record(commands, slot as usize, &inputs, &outputs)?)
    })
}

/// Appends only some passes of a plan: `passes` are their indices, 0 to RidgelightPlanInfo.passes - 1, ascending,
/// each once. The images that they read must hold what an earlier recording of this renderer left in them.
/// Outputs that they do not write keep their contents, unless their layout before is UNDEFINED.
///
/// You can record all passes of a new renderer, or those that ridgelight_replace_plan returned, in parts over several
/// frames. Start with the first of them and skip none. Each part needs a slot of its own, or one whose last command
/// buffer has run.
///
/// Returns OK, ARGUMENT or SETTING, as ridgelight_record; SETTING also for passes that do not exist, are repeated
/// or out of order, or come after one that must be recorded first.
///
/// # Safety
/// As ridgelight_record; `passes` is null or points at `pass_count` numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_record_passes(
    renderer: *mut RidgelightRenderer,
    commands: vk::CommandBuffer,
    slot: u32,
    inputs: *const RidgelightImage,
    input_count: u32,
    outputs: *const RidgelightImage,
    output_count: u32,
    passes: *const u32,
    pass_count: u32,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let renderer = recorder(renderer, commands)?;
        let passes = indices(passes, pass_count, "passes")?;
        let (inputs, outputs) = images(renderer, (inputs, input_count), (outputs, output_count))?;
        Ok(renderer.record_passes(commands, slot as usize, &inputs, &outputs, &passes)?)
    })
}

/// Appends the edit of a rectangle of heights, for a plan with RIDGELIGHT_PICTURE_KEEPS_HORIZONS. Every output
/// gets the same bits as from ridgelight_record. Outputs must hold what the last recording left in them.
///
/// Returns OK, ARGUMENT or SETTING.
///
/// # Safety
/// As ridgelight_record; `rectangle` is null or points at one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_record_edit(
    renderer: *mut RidgelightRenderer,
    commands: vk::CommandBuffer,
    slot: u32,
    inputs: *const RidgelightImage,
    input_count: u32,
    outputs: *const RidgelightImage,
    output_count: u32,
    rectangle: *const RidgelightRectangle,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let renderer = recorder(renderer, commands)?;
        let RidgelightRectangle { col, row, cols, rows } = *handle(rectangle, "rectangle")?;
        let (inputs, outputs) = images(renderer, (inputs, input_count), (outputs, output_count))?;
        let edited = Rectangle { col, row, cols, rows };
        Ok(renderer.record_edit(commands, slot as usize, &inputs, &outputs, edited)?)
    })
}

unsafe fn recorder<'a>(
    renderer: *mut RidgelightRenderer,
    commands: vk::CommandBuffer,
) -> Done<&'a mut Renderer> {
    if commands == vk::CommandBuffer::null() {
        return Err(Failure::argument("commands", "null", "a command buffer"));
    }
    // SAFETY: as the caller's caller guarantees.
    Ok(&mut unsafe { handle_mut(renderer, "renderer") }?.0)
}

type Images = (*const RidgelightImage, u32);

unsafe fn images(
    renderer: &Renderer,
    inputs: Images,
    outputs: Images,
) -> Done<(Vec<InputArg>, Vec<ImageArg>)> {
    let plan = renderer.plan();
    let (read, written) = (plan.inputs().map(|(_, r)| r), plan.outputs().map(|(_, r)| r));
    // SAFETY: as the caller's caller guarantees.
    unsafe {
        Ok((
            args(inputs, read, "input", RidgelightImage::input)?,
            args(outputs, written, "output", RidgelightImage::arg)?,
        ))
    }
}

unsafe fn args<'a, T>(
    (images, count): Images,
    mut wanted: impl Iterator<Item = &'a Resource>,
    name: &str,
    arg: fn(RidgelightImage, Option<&Resource>) -> T,
) -> Done<Vec<T>> {
    // SAFETY: as the caller's caller guarantees.
    let images = unsafe { read_all(images, count, name) }?;
    // `record` refuses a wrong number of them.
    Ok(images.into_iter().map(|image| arg(image, wanted.next())).collect())
}

/// Replaces the plan by one with the same passes, images and buffers but other values: another colour of a
/// light, a sun that moved a little. Frames in flight finish with the plan of their recording; do not wait for
/// them.
///
/// `passes` receives the indices of the passes that must run next if the inputs are unchanged; pass them to
/// ridgelight_record_passes. They include passes that earlier calls returned and that have not been recorded since.
/// `count` holds the capacity of `passes` before the call and the number of these passes after it. If `count` is null,
/// nothing is written. A capacity of RidgelightPlanInfo.passes is always enough; indices beyond the capacity are not
/// written.
///
/// Returns OK; ARGUMENT if a handle is null, or if `passes` is null and the capacity is not 0; SETTING if the plan needs
/// a renderer of its own. After an error the old plan stays.
///
/// # Safety
/// The renderer and the plan are alive or null; only this thread uses the renderer meanwhile. `count` is null or points
/// at the capacity; `passes` is null or points at that many numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_replace_plan(
    renderer: *mut RidgelightRenderer,
    plan: *const RidgelightPlan,
    passes: *mut u32,
    count: *mut u32,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let plan = handle(plan, "plan")?.0.clone();
        let renderer = &mut handle_mut(renderer, "renderer")?.0;
        let room = room(passes, count, "passes")?;
        write_indices(&renderer.replace_plan(plan)?, (passes, room), count);
        Ok(())
    })
}

/// Writes to `passes` the indices of the passes to record next with ridgelight_record_passes, if only the inputs `changed`
/// have new contents since the last recording. `changed` holds positions in the plan's list of inputs. The result includes
/// passes that have not been recorded since the renderer was created or ridgelight_replace_plan changed them.
///
/// In a series of frames with new heights, only the first frame then computes the tables of an environment.
/// ridgelight_record computes them in every frame. What is recorded counts as run: after a command buffer that
/// was not submitted, call ridgelight_record.
///
/// `count` is as in ridgelight_replace_plan.
///
/// Returns OK, or ARGUMENT.
///
/// # Safety
/// `renderer` is alive or null, and used only by this thread meanwhile. `changed` is null or points at `changed_count`
/// numbers. `count` is null or points at the capacity; `passes` is null or points at that many numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_passes_after(
    renderer: *const RidgelightRenderer,
    changed: *const u32,
    changed_count: u32,
    passes: *mut u32,
    count: *mut u32,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let renderer = &handle(renderer, "renderer")?.0;
        let inputs: Vec<_> = renderer.plan().inputs().map(|(id, _)| id).collect();
        let expected = format!("less than {}, the number of inputs", inputs.len());
        let input = |index: usize| {
            let id = inputs.get(index).copied();
            id.ok_or_else(|| Failure::argument("changed", index, &expected))
        };
        let changed = indices(changed, changed_count, "changed")?;
        let changed = changed.into_iter().map(input).collect::<Done<Vec<_>>>()?;
        let room = room(passes, count, "passes")?;
        write_indices(&renderer.passes_after(&changed), (passes, room), count);
        Ok(())
    })
}

/// # Safety
/// `passes` has room for that many numbers; `count` is null or may be written to.
unsafe fn write_indices(all: &[usize], (passes, room): (*mut u32, usize), count: *mut u32) {
    // SAFETY: as the caller says.
    unsafe {
        all.iter().take(room).enumerate().for_each(|(i, pass)| passes.add(i).write(*pass as u32));
        if !count.is_null() {
            count.write(all.len() as u32);
        }
    }
}

/// GPU time of one pass.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightTiming {
    /// sizeof(RidgelightTiming).
    pub struct_size: u32,
    /// The pass's name and part: UTF-8, nul-terminated.
    pub label: [c_char; 60],
    /// Nanoseconds.
    pub ns: f64,
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightTiming {}

/// Sets whether later recordings write a timestamp after every pass (`each` VK_TRUE, the default) or only one
/// after the last (VK_FALSE). A timestamp after every pass can keep a GPU from overlapping passes.
///
/// Returns OK, or ARGUMENT.
///
/// # Safety
/// `renderer` is alive or null, and used only by this thread meanwhile.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_time_passes(
    renderer: *mut RidgelightRenderer,
    each: vk::Bool32,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        handle_mut(renderer, "renderer")?.0.time_passes(each != vk::FALSE);
        Ok(())
    })
}

/// GPU times of the passes that `slot` recorded last, in order; after ridgelight_time_passes with VK_FALSE one
/// time, labelled "all passes". Never waits: `count` becomes 0 while some are not available, and where the queue
/// family has no timestamps.
///
/// `count` is the capacity of `timings`, and becomes their number; those beyond the capacity are left out.
///
/// Returns OK, or ARGUMENT.
///
/// # Safety
/// `renderer` is alive or null; `timings` has `count` structs, each with its struct_size set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_timings(
    renderer: *const RidgelightRenderer,
    slot: u32,
    timings: *mut RidgelightTiming,
    count: *mut u32,
) -> RidgelightResult {
    // SAFETY: as the caller says.
    done(|| unsafe {
        let times = handle(renderer, "renderer")?.0.timings(slot as usize).unwrap_or_default();
        write_timings(&times, timings, count)
    })
}

/// # Safety
/// `count` is null or the number of structs in `timings`, each with its struct_size set.
pub(crate) unsafe fn write_timings(
    times: &[Timing],
    timings: *mut RidgelightTiming,
    count: *mut u32,
) -> Done {
    // SAFETY: as the caller says.
    unsafe {
        let count = handle_mut(count, "count")?;
        let room = read_all(timings.cast_const(), *count, "timing")?;
        *count = times.len() as u32;
        let mut at = timings;
        for (timing, room) in times.iter().zip(room) {
            let mut value = RidgelightTiming { struct_size: 0, label: [0; 60], ns: timing.ns };
            text(&mut value.label, &timing.label);
            write(at, &value, "timing")?;
            at = at.byte_add(room.struct_size as usize);
        }
        Ok(())
    }
}

//! Camera pictures of a lit field: graphics passes, recorded after the compute passes or instead of them, into
//! a caller's command buffer.

mod checks;
mod pipelines;
mod record_view;
mod resources;
mod targets;

use ash::vk;

use super::allocator::{Allocator, Blocks};
use super::memory::{Backed, Memory};
use super::pipelines::Pipeline;
use super::renderer::{ImageArg, Timing};
use super::timestamps::Timestamps;
use super::{Host, requirements};
use crate::plan::View;
use crate::{Error, Result};

use targets::{Framebuffers, RenderPasses};

/// Images that a [`ViewRenderer`] reads, in any state; they are left as before.
///
/// They are those of the plan that lit the field: its input "heights", its output "radiance", its input
/// "environment". Another format of [`Format::vk_read`](crate::graph::Format::vk_read) that the device can
/// sample is allowed.
#[derive(Clone, Copy, Debug)]
pub struct ViewInputs {
    /// Heights above the field's base, one texel per grid point.
    pub heights: ImageArg,
    /// Exit radiance, one texel per grid point, one channel or four.
    pub radiance: ImageArg,
    /// The environment behind the field, where the view has one.
    pub environment: Option<ImageArg>,
    /// The mask of voids, where the view has any: one channel, one texel per grid point, 0 on ground, 1 on
    /// voids.
    pub voids: Option<ImageArg>,
}

/// Attachments of a [`ViewRenderer`], with one MSAA sample and the picture's size; their old contents are lost.
#[derive(Clone, Copy, Debug)]
pub struct ViewOutputs {
    /// Of the format that the renderer was made for, with usage COLOR_ATTACHMENT: your own image, or a
    /// swapchain's.
    pub picture: ImageArg,
    /// D32_SFLOAT with usage DEPTH_STENCIL_ATTACHMENT; [`View::distance_m`] converts to metres. With several
    /// MSAA samples it holds the first one's depth.
    pub depth: Option<ImageArg>,
}

/// Records a [`View`] into command buffers of a borrowed device: a mesh without vertex buffers, the sky behind it, and
/// the tone curve where the picture is for a screen.
///
/// As [`Renderer`](super::Renderer), it takes its memory when it is made. Recording makes a framebuffer for the
/// caller's images, submits nothing and waits for nothing; internal images serve all slots in turn. Besides what
/// [`missing`](super::missing) checks, the host's queue family needs graphics.
pub struct ViewRenderer {
    host: Host,
    /// The view that it was made for.
    shape: View,
    format: vk::Format,
    memory: Memory,
    /// Formats that inputs may have.
    readable: Vec<vk::Format>,
    samples: vk::SampleCountFlags,
    /// With several MSAA samples.
    many: Option<Backed>,
    /// With the view's MSAA samples.
    depth: Option<Backed>,
    /// Input of the tone curve.
    linear: Option<Backed>,
    indices: Option<Backed>,
    /// By [`LABELS`].
    drawings: [Option<Pipeline>; LABELS.len()],
    render_passes: RenderPasses,
    descriptor_pool: vk::DescriptorPool,
    slots: Vec<Slot>,
}

/// One frame in flight.
struct Slot {
    /// By [`LABELS`]; null where there is no such pass.
    sets: [vk::DescriptorSet; LABELS.len()],
    framebuffers: Framebuffers,
    /// None where the host's queue family has no timestamps.
    timestamps: Option<Timestamps>,
    /// Labels of what was recorded last.
    recorded: Vec<&'static str>,
}

const fn is_send<T: Send>() {}
const _: () = is_send::<ViewRenderer>();

/// How radiance is stored in a picture's format.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Curve {
    /// Unchanged: the image holds floats.
    None,
    /// Exposure and clip; the format itself encodes sRGB.
    Clip,
    /// Exposure, clip, sRGB.
    Encode,
}

impl Curve {
    fn of(format: vk::Format) -> Option<Self> {
        Some(match format {
            vk::Format::R32G32B32A32_SFLOAT | vk::Format::R16G16B16A16_SFLOAT => Self::None,
            vk::Format::R8G8B8A8_SRGB
            | vk::Format::B8G8R8A8_SRGB
            | vk::Format::A8B8G8R8_SRGB_PACK32 => Self::Clip,
            vk::Format::R8G8B8A8_UNORM
            | vk::Format::B8G8R8A8_UNORM
            | vk::Format::A8B8G8R8_UNORM_PACK32
            | vk::Format::A2B10G10R10_UNORM_PACK32
            | vk::Format::A2R10G10B10_UNORM_PACK32 => Self::Encode,
            _ => return None,
        })
    }
}

/// Format of the images before the tone curve.
const LINEAR: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// Labels of the GPU times, in pass order. The last three passes are optional: a plinth; the depth of sample 0, where the
/// view uses MSAA; the tone curve.
const LABELS: [&str; 5] =
    ["terrain_draw", "sky_draw", "plinth_draw", "depth_resolve", "picture_tone"];
/// Places in [`LABELS`].
const TERRAIN: usize = 0;
const SKY: usize = 1;
const PLINTH: usize = 2;
const DEPTH_RESOLVE: usize = 3;
const TONE: usize = 4;

impl ViewRenderer {
    /// Makes the resources for views with the shape of `view`, for pictures of a format and `slots` frames in
    /// flight (1 or more).
    ///
    /// `format` is R32G32B32A32 or R16G16B16A16 SFLOAT for linear radiance; or a screen format, which gets
    /// radiance times exposure through the tone curve, as in a PNG: R8G8B8A8, B8G8R8A8 or A8B8G8R8_PACK32,
    /// UNORM or SRGB, or 10 bits per colour.
    ///
    /// # Errors
    /// A device that lacks something (named): the MSAA count, graphics; or is out of memory.
    pub fn new(host: &Host, view: &View, format: vk::Format, slots: usize) -> Result<Self> {
        Self::with_memory(host, (view, format), slots, Box::new(Blocks::new(host)?))
    }

    /// [`new`](Self::new) with memory from an engine's own allocator, which is dropped after everything has
    /// been freed.
    ///
    /// # Errors
    /// As there, and the allocator's own.
    pub fn with_memory(
        host: &Host,
        (view, format): (&View, vk::Format),
        slots: usize,
        allocator: Box<dyn Allocator>,
    ) -> Result<Self> {
        let curve = checks::check_device(host, view, format)?;
        let mut renderer = Self {
            host: host.clone(),
            shape: view.clone(),
            format,
            memory: Memory::new(host, allocator),
            readable: requirements::readable(host),
            samples: vk::SampleCountFlags::from_raw(view.samples),
            many: None,
            depth: None,
            linear: None,
            indices: None,
            drawings: Default::default(),
            render_passes: RenderPasses::default(),
            descriptor_pool: vk::DescriptorPool::null(),
            slots: Vec::new(),
        };
        match renderer.make(curve, slots.max(1)) {
            Ok(()) => Ok(renderer),
            Err(error) => {
                renderer.destroy();
                Err(error)
            }
        }
    }

    /// Bytes of device memory in use.
    pub fn device_bytes(&self) -> u64 {
        self.memory.bytes()
    }

    /// Appends the drawing of `view` to `commands`, which is being recorded outside a render pass for the host's
    /// family.
    ///
    /// `slot` is the frame in flight (0..slots); its last command buffer must have run. Camera and light may
    /// change each time. `exposure` is the factor before the tone curve, where the format has one. All
    /// arguments are checked first: after an error nothing has been recorded.
    ///
    /// # Errors
    /// An argument that does not match the view, by name; a view of another shape; a device without memory for a
    /// framebuffer.
    pub fn record(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        (view, exposure): (&View, f32),
        inputs: &ViewInputs,
        outputs: &ViewOutputs,
    ) -> Result<()> {
        self.check(slot, (view, exposure), inputs, outputs)?;
        self.make_framebuffers(slot, outputs)?;
        self.append(commands, slot, (view, exposure), inputs, outputs);
        Ok(())
    }

    /// GPU times of what `slot` recorded last. None while some are not available, and where the host's queue
    /// family has no timestamps. Never waits.
    pub fn timings(&self, slot: usize) -> Option<Vec<Timing>> {
        let slot = self.slots.get(slot).filter(|slot| !slot.recorded.is_empty())?;
        let times = slot.timestamps.as_ref()?.ns(slot.recorded.len() + 1)?;
        let labelled = slot.recorded.iter().zip(times);
        Some(labelled.map(|(label, ns)| Timing { label: (*label).to_owned(), ns }).collect())
    }

    /// Frees everything. All recorded commands must have finished.
    pub fn destroy(mut self) {
        self.free();
    }
}

impl Drop for ViewRenderer {
    fn drop(&mut self) {
        self.memory.leak("a view renderer");
    }
}

/// An error for a setting.
fn wrong<T>(name: &str, found: impl Into<String>, expected: impl Into<String>) -> Result<T> {
    Err(Error::setting(name, found, expected))
}

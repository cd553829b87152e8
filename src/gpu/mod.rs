//! The Vulkan backend: device, memory, pipelines, barriers, recording, timing. It holds nearly all of the
//! crate's `unsafe` code.
//!
//! There are three entry points, by owner of the device:
//!
//! - **an engine's device**: [`Renderer`] records a [plan](crate::plan) into the engine's command buffers;
//!   [`ViewRenderer`] records a [view](crate::plan::View) of the result;
//! - **a device of our own**, for tools and tests: [`Headless`] makes a [`Frame`] with images for a plan's
//!   inputs and outputs, fills, draws and reads it, and draws camera pictures ([`look`](Headless::look));
//! - **a window's device**: the crate `ridgelight-viewer`.
//!
//! # Before there is a device
//!
//! [`requirements`] lists what a device needs: Vulkan 1.1, a queue with compute, and subgroup votes in compute shaders; no
//! feature and no extension.
//! [`missing`] names what a physical device lacks. [`devices`] lists all devices. [`limits`] are the limits for
//! a plan.
//!
//! # States
//!
//! The caller passes each image with its [state](ImageState): the stages and accesses that used it last, and
//! its layout. [`Renderer::record`] begins with the barriers from that state, and ends with barriers to the
//! requested state:
//!
//! | image | state before | used as | state after |
//! |---|---|---|---|
//! | inputs | any state with contents | SHADER_READ_ONLY_OPTIMAL, compute | as before |
//! | inputs in buffers | any stage and access | copied from | as before |
//! | outputs | any, also UNDEFINED | GENERAL, compute | as requested |
//!
//! An invalid argument is refused with the image and field named ("heights: layout before: found …"); nothing
//! has been recorded then. Images of exclusive sharing belong to the host's queue family throughout.
//!
//! # Formats, and buffers
//!
//! These parts of a scene may exist only on the device, in these formats ([`Format::vk_read`]) and with this
//! many copies:
//!
//! | part | in an image | copies | in a buffer | copies |
//! |---|---|---|---|---|
//! | heights ([`HeightField::unknown`]) | R32F, R16F, R16 UNORM | 0 | the same | 1 |
//! | albedo ([`Albedo::unknown`]) | RGBA32F, RGBA16F, RGBA8 UNORM, SRGB | 0 | the same | 1 |
//! | environment ([`Environment::unknown`]) | as albedo | 0 | the same | 1 |
//! | colours of sky, suns, key lights ([`colours_on_device`](crate::plan::Picture::colours_on_device)) | as albedo | 0 | the same | 1 |
//! | specular ([`Specular::unknown`]) | RGBA32F | 0 | the same | 1 |
//! | colours of sphere lights; directions, positions and sizes of lights | no | | no | |
//!
//! Formats narrower than 32 bits are accepted where the device can sample them. A
//! [`plan::reference`](crate::plan::reference()) reads only the formats of its plan, and needs known heights.
//!
//! Shaders fetch from an [`ImageArg`] directly. Rows of texels in a buffer ([`BufferArg`]) are accepted where
//! the plan allows it ([`Plan::take_buffer`](crate::plan::Plan::take_buffer)). Each recording then begins with
//! one vkCmdCopyBufferToImage per buffer, into an image of the renderer ([`Renderer::taken`]); an
//! [edit](Renderer::record_edit) copies only the edited rectangle.
//!
//! Heights are never NaN. Voids are filled beforehand ([`fill_voids`]), and the caller masks their light. A
//! [`ViewRenderer`] leaves holes where a mask marks voids ([`ViewInputs::voids`]).
//!
//! [`HeightField::unknown`]: crate::scene::HeightField::unknown
//! [`Albedo::unknown`]: crate::scene::Albedo::unknown
//! [`Environment::unknown`]: crate::scene::Environment::unknown
//! [`Specular::unknown`]: crate::scene::Specular::unknown
//! [`fill_voids`]: crate::scene::fill_voids
//!
//! # Lights that change
//!
//! Some properties of lights may change per recording, others need a new plan or a new renderer:
//!
//! | what changes | how |
//! |---|---|
//! | texels of an environment, an albedo or a specular map; colours of sky, suns and key lights, where the plan takes them | on the device: they are inputs of each recording |
//! | colours of sky, suns, key lights and sphere lights; directions, positions, sizes | [`Renderer::replace_plan`] with a plan of the new scene: no pipeline, no memory, no wait, also while frames are in flight |
//! | number and kind of lights, a sun across a diagonal of the grid, grey to coloured | a second renderer |
//!
//! The page `docs/embedding.md` lists every change of a light that `replace_plan` refuses. [`Renderer::passes_after`] returns
//! the passes that a change of some inputs needs.
//!
//! Directions decide which lines a sweep follows, and how many. The position of a sphere light decides which
//! texels it reaches. Both change workgroups, memory and constants of a plan, so the host must know them.
//! Colours of sphere lights are part of their sum. With [`light_layers`](crate::plan::Picture::light_layers), a
//! sphere light of radiance 1 has an image of its own; that image times a colour on the device is its share of
//! the picture.
//!
//! # Frames in flight
//!
//! The number of slots is given when a renderer is made. A slot's last command buffer must have run before the
//! slot is recorded again; those of other slots may be in flight. Internal images serve all slots, in turn on
//! one queue. Recording may move to another thread ([`Renderer`] is `Send`). [`Renderer::timings`] never waits.
//!
//! # Memory
//!
//! Memory comes in [`Blocks`] of 4 MiB, or from an engine's own [`Allocator`]. A renderer takes all of it when
//! it is made; `destroy` returns it. A renderer that is dropped leaks and prints a warning, since its commands
//! may still run.

mod allocator;
mod barriers;
mod headless;
mod instance;
mod memory;
mod pipelines;
mod renderer;
mod requirements;
mod specialise;
mod surface;
mod timestamps;
mod validation;
mod view;

pub use crate::graph::shaders;
pub use allocator::{Allocation, Allocator, Blocks, MemoryRequest, MemoryUse};
#[doc(hidden)]
pub use headless::frame::Owned;
pub use headless::frame::{Frame, Pixels};
pub use headless::look::ViewPixels;
#[doc(hidden)]
pub use headless::look::view_inputs;
pub use headless::{Headless, HeadlessOptions};
pub use instance::{choose, devices};
#[doc(hidden)]
pub use memory::{Backed, region, whole};
#[doc(hidden)]
pub use renderer::transition;
pub use renderer::{BufferArg, ImageArg, ImageState, InputArg, Renderer, Timing, Work};
pub use requirements::{DeviceReport, Requirements, limits, missing, requirements};
#[doc(hidden)]
pub use surface::{Surface, SurfaceSource};
pub use view::{ViewInputs, ViewOutputs, ViewRenderer};

use ash::vk;

use crate::Error;
use crate::graph::Format;

/// The device that a renderer records for. The renderer borrows it and never destroys it.
///
/// It must outlive every renderer made on it. Calls use it from the calling thread: objects that Vulkan
/// requires to be externally synchronised (a command buffer, a queue) remain the caller's responsibility.
#[derive(Clone)]
pub struct Host {
    /// The instance of the device.
    pub instance: ash::Instance,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: ash::Device,
    /// The family of the queue that runs the commands; it must support compute. Images of exclusive sharing
    /// belong to it before and after a recording: a renderer transfers none between families.
    pub queue_family: u32,
    /// Cache for compiled pipelines, or null. Its owner fills it from an earlier run's vkGetPipelineCacheData
    /// and saves it. It must not be created as externally synchronised.
    pub pipeline_cache: vk::PipelineCache,
    /// For names and labels in debuggers, where the instance has VK_EXT_debug_utils enabled.
    pub debug_utils: Option<ash::ext::debug_utils::Device>,
}

impl Host {
    /// Names an object for debuggers.
    pub fn name(&self, handle: impl vk::Handle, name: &str) {
        let (Some(debug), Ok(name)) = (&self.debug_utils, std::ffi::CString::new(name)) else {
            return;
        };
        let info =
            vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // A missing name is not an error.
        // SAFETY: the handle was made on this device and is alive.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    /// Records commands, which a debugger shows below a label.
    fn labelled(
        &self,
        commands: vk::CommandBuffer,
        label: impl FnOnce() -> String,
        record: impl FnOnce(),
    ) {
        let Some(debug) = &self.debug_utils else { return record() };
        let name = std::ffi::CString::new(label()).unwrap_or_default();
        let info = vk::DebugUtilsLabelEXT::default().label_name(&name);
        // SAFETY: `commands` is being recorded; the name lives across the call.
        unsafe { debug.cmd_begin_debug_utils_label(commands, &info) };
        record();
        // SAFETY: as above; the label is open.
        unsafe { debug.cmd_end_debug_utils_label(commands) };
    }
}

impl Format {
    /// The Vulkan format.
    pub fn vk(self) -> vk::Format {
        match self {
            Format::R32Float => vk::Format::R32_SFLOAT,
            Format::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
            Format::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
            Format::R32Uint => vk::Format::R32_UINT,
            Format::Rgba16Uint => vk::Format::R16G16B16A16_UINT,
            Format::Rgba32Uint => vk::Format::R32G32B32A32_UINT,
            Format::R16Float => vk::Format::R16_SFLOAT,
            Format::R16Unorm => vk::Format::R16_UNORM,
            Format::Rgba8Unorm => vk::Format::R8G8B8A8_UNORM,
            Format::Rgba8Srgb => vk::Format::R8G8B8A8_SRGB,
        }
    }

    /// Formats that a caller's image may have where a plan only fetches from this format; the first is the
    /// format itself. Texels are decoded by Vulkan: UNORM to 0..1, SRGB to linear light.
    pub fn vk_read(self) -> &'static [vk::Format] {
        match self {
            Format::R32Float => {
                &[vk::Format::R32_SFLOAT, vk::Format::R16_SFLOAT, vk::Format::R16_UNORM]
            }
            Format::Rgba32Float => &[
                vk::Format::R32G32B32A32_SFLOAT,
                vk::Format::R16G16B16A16_SFLOAT,
                vk::Format::R8G8B8A8_UNORM,
                vk::Format::R8G8B8A8_SRGB,
            ],
            Format::Rgba16Float => &[vk::Format::R16G16B16A16_SFLOAT],
            Format::R32Uint => &[vk::Format::R32_UINT],
            Format::Rgba16Uint => &[vk::Format::R16G16B16A16_UINT],
            Format::Rgba32Uint => &[vk::Format::R32G32B32A32_UINT],
            Format::R16Float => &[vk::Format::R16_SFLOAT],
            Format::R16Unorm => &[vk::Format::R16_UNORM],
            Format::Rgba8Unorm => &[vk::Format::R8G8B8A8_UNORM],
            Format::Rgba8Srgb => &[vk::Format::R8G8B8A8_SRGB],
        }
    }
}

/// A failed Vulkan call as an error.
#[doc(hidden)]
pub fn failed(doing: impl Into<String>) -> impl FnOnce(vk::Result) -> Error {
    let doing = doing.into();
    move |result| Error::Device { doing, reason: result.to_string() }
}

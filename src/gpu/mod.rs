//! Vulkan: device, memory, pipelines, barriers, recording, timing. All of the crate's `unsafe`.
//!
//! Three ways in, by whose device it is:
//!
//! - **an engine's**: [`Renderer`] records a [plan](crate::plan), [`ViewRenderer`] a [view](crate::plan::View) of what
//!   it has lit, into the engine's command buffers;
//! - **one of its own**, for tools and tests: [`Headless`] makes images for a plan's inputs and outputs
//!   ([`Frame`]), fills, draws and reads them, and [`look`](Headless::look)s at them before a camera;
//! - **a window's**: the crate `ridgelight-viewer`.
//!
//! # Before there is a device
//!
//! [`requirements`] says what to enable: Vulkan 1.3, four features, no extension, a queue with compute. [`missing`]
//! names what a physical device lacks, [`devices`] lists all, [`limits`] is what a plan may count on.
//!
//! # States
//!
//! Each image comes with the [state](ImageState) that it is in: stages and accesses that used it last, and its
//! layout. [`Renderer::record`] begins with the barriers from there and ends with those to where it is to be left:
//!
//! | image | comes as | is used as | is left as |
//! |---|---|---|---|
//! | inputs | any state with contents | SHADER_READ_ONLY_OPTIMAL, compute | as it came |
//! | inputs in buffers | any stage and access | copied from | as it came |
//! | outputs | any, UNDEFINED too | GENERAL, compute | the state asked for |
//!
//! What cannot be is refused by a sentence that names image and field ("heights: layout before: found …"), and
//! then nothing has been recorded. Images of exclusive sharing belong to the host's queue family throughout.
//!
//! # Formats, and buffers
//!
//! What of a scene may be the device's alone, in which formats ([`Format::vk_read`]), and with how many copies:
//!
//! | what | in an image | copies | in a buffer | copies |
//! |---|---|---|---|---|
//! | heights ([`HeightField::unknown`]) | R32F, R16F, R16 UNORM | 0 | the same | 1 |
//! | albedo ([`Albedo::unknown`]) | RGBA32F, RGBA16F, RGBA8 UNORM, SRGB | 0 | the same | 1 |
//! | environment ([`Environment::unknown`]) | as albedo | 0 | the same | 1 |
//! | colours of sky, suns, keys ([`colours_on_device`](crate::plan::Picture::colours_on_device)) | as albedo | 0 | the same | 1 |
//! | specular ([`Specular::unknown`]) | RGBA32F | 0 | the same | 1 |
//! | colours of balls, directions, positions and sizes of lights | no | | no | |
//!
//! An [`ImageArg`] is read where it is. Rows of texels in a buffer ([`BufferArg`]) are taken where the plan was told so
//! ([`Plan::take_buffer`](crate::plan::Plan::take_buffer)): shaders fetch from images, so that each recording begins
//! with one vkCmdCopyBufferToImage per buffer, into an image of the renderer's
//! ([`Renderer::taken`]); an [edit](Renderer::record_edit) copies the edited rectangle alone.
//!
//! Heights are never NaN: those without data are filled beforehand ([`fill_voids`]), and their light is the caller's to
//! mask. A [`ViewRenderer`] leaves holes where an image of marks says so ([`ViewInputs::voids`]).
//!
//! [`HeightField::unknown`]: crate::scene::HeightField::unknown
//! [`Albedo::unknown`]: crate::scene::Albedo::unknown
//! [`Environment::unknown`]: crate::scene::Environment::unknown
//! [`Specular::unknown`]: crate::scene::Specular::unknown
//! [`fill_voids`]: crate::scene::fill_voids
//!
//! # Lights that change
//!
//! What of the light is a frame's own, and what is the plan's:
//!
//! | what | how it changes |
//! |---|---|
//! | texels of an environment, an albedo, a lobe's map; colours of sky, suns and keys, where the plan has them so | on the device: they are inputs of each recording |
//! | colours of sky, suns, keys and balls; directions, positions, sizes | [`Renderer::replace_plan`], a plan of the new scene: no pipeline, no memory, no wait, also while frames are in flight |
//! | number and kind of lights, a sun into another octant, grey to coloured | a renderer of its own, beside the old one |
//!
//! Directions decide which lines a sweep follows and how many, and where a ball is, which samples it may reach: workgroups,
//! memory and constants of a plan, so that they are the host's to know. Colours of balls are summed up with their light;
//! with [`light_layers`](crate::plan::Picture::light_layers), a ball of radiance 1 has an image of its own, which times a
//! colour that the device alone knows is its share of the picture.
//!
//! # Frames in flight
//!
//! A renderer has as many slots as it was made for. A slot's last command buffer must have run before it is recorded
//! again; those of other slots may be in flight. Internal images serve all slots, in turn on one queue. Recording
//! may move to another thread ([`Renderer`] is `Send`); [`Renderer::timings`] never waits.
//!
//! # Memory
//!
//! By [`Blocks`] of 4 MiB, or an engine's own [`Allocator`]; all of it taken when a renderer is made, given back by
//! `destroy`. A renderer that is dropped leaks and says so: what was recorded may still run.

mod allocator;
mod headless;
mod instance;
mod memory;
mod pipelines;
mod renderer;
mod requirements;
mod specialise;
mod surface;
mod validation;
mod view;

pub use crate::graph::shaders;
pub use allocator::{Allocation, Allocator, Blocks, MemoryRequest, MemoryUse};
#[doc(hidden)]
pub use headless::frame::Owned;
pub use headless::frame::{Frame, Pixels};
pub use headless::host_image::{HostBuffer, HostImage};
pub use headless::look::Seen;
#[doc(hidden)]
pub use headless::look::view_inputs;
pub use headless::{Headless, HeadlessOptions};
pub use instance::{choose, devices};
#[doc(hidden)]
pub use memory::{Backed, whole};
pub use renderer::{BufferArg, ImageArg, ImageState, InputArg, Renderer, Timing, Work};
pub use requirements::{DeviceReport, Requirements, limits, missing, requirements};
#[doc(hidden)]
pub use surface::{Surface, SurfaceSource};
pub use view::{ViewInputs, ViewOutputs, ViewRenderer};

use ash::vk;

use crate::Error;
use crate::graph::Format;

/// A device that a renderer records for: borrowed, never destroyed by it.
///
/// It must outlive every renderer that was made on it, and is used from the thread that calls: what Vulkan
/// wants synchronised from outside (a command buffer, a queue) stays the caller's to synchronise.
#[derive(Clone)]
pub struct Host {
    /// The instance that the device came from.
    pub instance: ash::Instance,
    /// Its physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device, with what [`requirements`] asks for enabled.
    pub device: ash::Device,
    /// The family of the queue that commands go to; it must offer compute. Images of exclusive sharing belong
    /// to it when a recording runs, and still do afterwards: a renderer transfers none between families.
    pub queue_family: u32,
    /// Where compiled pipelines are looked for and kept, or null. Filled from what an earlier run had of
    /// vkGetPipelineCacheData, and read by it again, by whom it belongs to; not created as externally
    /// synchronised.
    pub pipeline_cache: vk::PipelineCache,
    /// Names and labels for debuggers, where the instance has VK_EXT_debug_utils enabled.
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
        // A name that could not be set is no reason to fail.
        // SAFETY: the handle was made on this device and is alive.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }
}

impl Format {
    /// Vulkan's name.
    pub fn vk(self) -> vk::Format {
        match self {
            Format::R32Float => vk::Format::R32_SFLOAT,
            Format::Rgba16Float => vk::Format::R16G16B16A16_SFLOAT,
            Format::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
            Format::R32Uint => vk::Format::R32_UINT,
            Format::Rg32Uint => vk::Format::R32G32_UINT,
            Format::Rgba32Uint => vk::Format::R32G32B32A32_UINT,
            Format::R16Float => vk::Format::R16_SFLOAT,
            Format::R16Unorm => vk::Format::R16_UNORM,
            Format::Rgba8Unorm => vk::Format::R8G8B8A8_UNORM,
            Format::Rgba8Srgb => vk::Format::R8G8B8A8_SRGB,
        }
    }

    /// Formats that a caller's image may have where a plan says this format and only fetches from it: itself first.
    /// Texels are what Vulkan makes of them: UNORM from 0 to 1, SRGB decoded to linear light.
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
            Format::Rg32Uint => &[vk::Format::R32G32_UINT],
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

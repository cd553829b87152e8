//! Vulkan: device, memory, pipelines, barriers, recording, timing. All of the crate's `unsafe`.

mod allocator;
mod copy;
mod frame;
mod headless;
mod instance;
mod lend;
mod look;
mod memory;
mod pipelines;
mod read;
mod renderer;
mod requirements;
mod screen;
pub mod shaders;
mod specialise;
mod surface;
mod validation;
mod view;

pub use allocator::{Allocation, Allocator, Blocks, MemoryRequest, MemoryUse};
pub use frame::{Frame, Pixels};
pub use headless::{Headless, HeadlessOptions};
pub use instance::{choose, devices};
pub use lend::Lent;
pub use look::Seen;
pub use renderer::{ImageArg, ImageState, Renderer, Timing};
pub use requirements::{DeviceReport, Requirements, limits, missing, requirements};
pub use screen::{Panel, Part, PartTimes, Screen, Shot, Shown, Sight, Work};
pub use view::{ViewInputs, ViewOutputs, ViewRenderer};

use ash::vk;

use crate::Error;
use crate::plan::Format;

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
    pub(crate) fn name(&self, handle: impl vk::Handle, name: &str) {
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
        }
    }

    /// What a caller's image may have where a plan says this format and only fetches from it: itself first.
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
        }
    }
}

/// A failed Vulkan call as an error.
pub(crate) fn failed(doing: impl Into<String>) -> impl FnOnce(vk::Result) -> Error {
    let doing = doing.into();
    move |result| Error::Device { doing, reason: result.to_string() }
}

//! Vulkan: device, memory, pipelines, barriers, recording, timing. All of the crate's `unsafe`.

mod copy;
mod frame;
mod headless;
mod instance;
mod look;
mod memory;
mod pipelines;
mod read;
mod renderer;
mod requirements;
pub mod shaders;
mod specialise;
mod validation;
mod view;

pub use frame::{Frame, Pixels};
pub use headless::{Headless, HeadlessOptions};
pub use instance::{choose, devices};
pub use look::Seen;
pub use renderer::{ImageArg, ImageState, Renderer, Timing};
pub use requirements::{DeviceReport, limits, missing};
pub use view::{ViewInputs, ViewOutputs, ViewRenderer};

use ash::vk;

use crate::Error;
use crate::plan::Format;

/// A device that a renderer records for: borrowed, never destroyed by it.
#[derive(Clone)]
pub struct Host {
    /// The instance that the device came from.
    pub instance: ash::Instance,
    /// Its physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device, with what [`missing`] asks for enabled.
    pub device: ash::Device,
    /// The family of the queue that commands go to; it must offer compute.
    pub queue_family: u32,
    /// Names and labels for debuggers, where the instance has VK_EXT_debug_utils enabled.
    pub debug_utils: Option<ash::ext::debug_utils::Device>,
}

impl Format {
    /// Vulkan's name.
    pub fn vk(self) -> vk::Format {
        match self {
            Format::R32Float => vk::Format::R32_SFLOAT,
            Format::Rgba32Float => vk::Format::R32G32B32A32_SFLOAT,
            Format::R32Uint => vk::Format::R32_UINT,
            Format::Rg32Uint => vk::Format::R32G32_UINT,
            Format::Rgba32Uint => vk::Format::R32G32B32A32_UINT,
        }
    }
}

/// A failed Vulkan call as an error.
pub(crate) fn failed(doing: impl Into<String>) -> impl FnOnce(vk::Result) -> Error {
    let doing = doing.into();
    move |result| Error::Device { doing, reason: result.to_string() }
}

//! Instance and device for pictures in a window.

use std::ffi::{CStr, c_char};

use ash::prelude::VkResult;
use ash::{khr, vk};

use super::failed;
use crate::{Error, Result};

/// Vulkan version for a window, whose panel is drawn by dynamic rendering.
pub(super) const WINDOW_VERSION: u32 = vk::API_VERSION_1_3;

/// Makes a surface for a window that is alive.
#[doc(hidden)]
pub(crate) type CreateSurface =
    Box<dyn Fn(&ash::Entry, &ash::Instance) -> VkResult<vk::SurfaceKHR>>;

/// Makes the surface of a window; supplied by the crate that knows window systems.
#[doc(hidden)]
pub struct SurfaceSource {
    /// Instance extensions for surfaces of its window system.
    pub extensions: &'static [*const c_char],
    /// Makes a surface of the window, which outlives it.
    pub create: CreateSurface,
}

impl SurfaceSource {
    /// Instance extensions for surfaces of its window system; refuses where no driver has one of them.
    pub(super) fn extensions(&self, entry: &ash::Entry) -> Result<&'static [*const c_char]> {
        // SAFETY: a query without preconditions.
        let known = unsafe { entry.enumerate_instance_extension_properties(None) };
        let known = known.map_err(failed("listing extensions"))?;
        let is_known = |name: &CStr| known.iter().any(|e| e.extension_name_as_c_str() == Ok(name));
        // SAFETY: nul-terminated, as the source promises.
        let mut names = self.extensions.iter().map(|name| unsafe { CStr::from_ptr(*name) });
        match names.find(|name| !is_known(name)) {
            Some(name) => {
                let reason = format!("no Vulkan driver here has {}", name.to_string_lossy());
                let doing = "showing pictures in a window".into();
                Err(Error::Device { doing, reason })
            }
            None => Ok(self.extensions),
        }
    }
}

/// A window's surface; only [`Surface::end`] destroys it.
#[doc(hidden)]
pub struct Surface {
    pub loader: khr::surface::Instance,
    pub surface: vk::SurfaceKHR,
    source: SurfaceSource,
}

impl Surface {
    pub(super) fn new(
        entry: &ash::Entry,
        instance: &ash::Instance,
        source: SurfaceSource,
    ) -> Result<Self> {
        let loader = khr::surface::Instance::new(entry, instance);
        let mut made = Self { loader, surface: vk::SurfaceKHR::null(), source };
        made.renew(entry, instance)?;
        Ok(made)
    }

    /// Makes another surface of the window, after the first was lost. No swapchain of it may be alive.
    ///
    /// # Errors
    /// A window that no longer exists, a device that is lost.
    pub fn renew(&mut self, entry: &ash::Entry, instance: &ash::Instance) -> Result<()> {
        self.end();
        self.surface = (self.source.create)(entry, instance)
            .map_err(failed("making the surface of a window"))?;
        Ok(())
    }

    /// What a device lacks to show pictures on the surface.
    pub(super) fn missing(
        &self,
        instance: &ash::Instance,
        device: vk::PhysicalDevice,
    ) -> Option<String> {
        // SAFETY: the physical device is the instance's.
        let (properties, known) = unsafe {
            (
                instance.get_physical_device_properties(device),
                instance.enumerate_device_extension_properties(device),
            )
        };
        if properties.api_version < WINDOW_VERSION {
            return Some("Vulkan 1.3, for a window".into());
        }
        let mut known = known.iter().flatten();
        let name = khr::swapchain::NAME;
        if !known.any(|e| e.extension_name_as_c_str() == Ok(name)) {
            return Some(name.to_string_lossy().into_owned());
        }
        let has_family = queue_family(instance, device, Some(self)).is_some();
        (!has_family).then(|| "a queue that computes and shows pictures in this window".into())
    }

    /// Destroys it, if there is one: before the instance, after its swapchains.
    pub(super) fn end(&mut self) {
        // SAFETY: made by this loader's instance, or null; the caller guarantees that no swapchain is left.
        unsafe { self.loader.destroy_surface(std::mem::take(&mut self.surface), None) };
    }
}

/// The family of a device's one queue: with compute, and able to present to the surface where there is one.
pub(super) fn queue_family(
    instance: &ash::Instance,
    device: vk::PhysicalDevice,
    surface: Option<&Surface>,
) -> Option<u32> {
    // SAFETY: the physical device is the instance's.
    let families = unsafe { instance.get_physical_device_queue_family_properties(device) };
    let shows = |family: u32| {
        surface.is_none_or(|s| {
            // SAFETY: the family is one of the device's, the surface is alive.
            let shows =
                unsafe { s.loader.get_physical_device_surface_support(device, family, s.surface) };
            shows.unwrap_or(false)
        })
    };
    let with = |flags| {
        let mut all = families.iter().zip(0_u32..);
        let found = all.find(|(f, index)| f.queue_flags.contains(flags) && shows(*index));
        found.map(|(_, index)| index)
    };
    // Prefers graphics, for views.
    let compute = vk::QueueFlags::COMPUTE;
    with(compute | vk::QueueFlags::GRAPHICS).or_else(|| with(compute))
}

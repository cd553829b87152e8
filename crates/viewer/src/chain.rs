//! The swapchain of a window.

use ash::{khr, vk};

use ridgelight::gpu::{Headless, failed, whole};
use ridgelight::{Error, Result};

/// A swapchain and the semaphores that its pictures wait for before presentation.
pub(super) struct Chain {
    pub swapchain: vk::SwapchainKHR,
    pub images: Vec<vk::Image>,
    /// A view of each.
    pub views: Vec<vk::ImageView>,
    pub finished: Vec<vk::Semaphore>,
    /// Columns and rows.
    pub size: [u32; 2],
    /// Whether pictures can be read back.
    pub is_readable: bool,
    /// Whether the window has changed, so that another swapchain is better or needed.
    pub is_stale: bool,
    pub format: vk::Format,
}

/// Formats that are presented without conversion, by preference, and whether blue comes first.
const FORMATS: [(vk::Format, bool); 4] = [
    (vk::Format::B8G8R8A8_UNORM, true),
    (vk::Format::R8G8B8A8_UNORM, false),
    (vk::Format::B8G8R8A8_SRGB, true),
    (vk::Format::R8G8B8A8_SRGB, false),
];

/// The current capabilities of the window's surface.
pub(super) fn capabilities(
    gpu: &mut Headless,
) -> std::result::Result<vk::SurfaceCapabilitiesKHR, vk::Result> {
    let device = gpu.host().physical_device;
    // Null where the last one could not be made.
    let surface = gpu.surface().filter(|(_, _, made)| made.surface != vk::SurfaceKHR::null());
    let (_, _, surface) = surface.ok_or(vk::Result::ERROR_SURFACE_LOST_KHR)?;
    let (loader, surface) = (&surface.loader, surface.surface);
    // SAFETY: device and surface are alive and of one instance.
    unsafe { loader.get_physical_device_surface_capabilities(device, surface) }
}

/// Columns and rows of pictures; 0 where the window has no area.
pub(super) fn size(known: &vk::SurfaceCapabilitiesKHR, wanted: [u32; 2]) -> [u32; 2] {
    let vk::Extent2D { width, height } = known.current_extent;
    // A surface without a size of its own.
    if width == u32::MAX {
        let (least, most) = (known.min_image_extent, known.max_image_extent);
        let [width, height] = wanted;
        return [width.min(most.width).max(least.width), height.min(most.height).max(least.height)];
    }
    [width, height]
}

impl Chain {
    /// A swapchain of a `size` that is not 0, which replaces `old`; `old` can then only be ended.
    pub fn new(
        gpu: &mut Headless,
        swapchains: &khr::swapchain::Device,
        (known, size): (&vk::SurfaceCapabilitiesKHR, [u32; 2]),
        old: Option<&Self>,
    ) -> Result<Self> {
        let physical_device = gpu.host().physical_device;
        let (_, _, surface) = gpu.surface().expect("a screen has one");
        let (loader, surface) = (surface.loader.clone(), surface.surface);
        // SAFETY: device and surface are alive and of one instance.
        let formats =
            unsafe { loader.get_physical_device_surface_formats(physical_device, surface) };
        let formats = formats.map_err(failed("asking a window for its formats"))?;
        let is_taken = |wanted: &&(vk::Format, bool)| {
            let linear = vk::ColorSpaceKHR::SRGB_NONLINEAR;
            formats.iter().any(|f| f.format == wanted.0 && f.color_space == linear)
        };
        let lacks = |what: &str| Error::Device {
            doing: "showing pictures in a window".into(),
            reason: format!("{} {what}", gpu.report().name),
        };
        let format = FORMATS.iter().find(is_taken);
        let format = format.ok_or_else(|| lacks("shows none of 8 bits a colour"))?.0;
        let (into, from) = (vk::ImageUsageFlags::TRANSFER_DST, vk::ImageUsageFlags::TRANSFER_SRC);
        if !known.supported_usage_flags.contains(into) {
            return Err(lacks("takes none by copying"));
        }
        // SAFETY: as above.
        let modes =
            unsafe { loader.get_physical_device_surface_present_modes(physical_device, surface) };
        let modes = modes.map_err(failed("asking a window how it presents"))?;
        // Every surface supports FIFO, where pictures wait for a refresh. A slow one of a CPU device would wait for one more.
        let mailbox = vk::PresentModeKHR::MAILBOX;
        let is_slow = gpu.report().limits.is_cpu;
        let is_better = is_slow && modes.contains(&mailbox);
        let mode = if is_better { mailbox } else { vk::PresentModeKHR::FIFO };
        // Every surface has images to draw into.
        let usage = into | vk::ImageUsageFlags::COLOR_ATTACHMENT;
        let is_readable = known.supported_usage_flags.contains(from);
        let most = if known.max_image_count == 0 { u32::MAX } else { known.max_image_count };
        let alphas = known.supported_composite_alpha;
        let opaque = vk::CompositeAlphaFlagsKHR::OPAQUE;
        let any = vk::CompositeAlphaFlagsKHR::from_raw(1 << alphas.as_raw().trailing_zeros());
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface)
            .min_image_count((known.min_image_count + 1).min(most))
            .image_format(format)
            .image_color_space(vk::ColorSpaceKHR::SRGB_NONLINEAR)
            .image_extent(vk::Extent2D { width: size[0], height: size[1] })
            .image_array_layers(1)
            .image_usage(if is_readable { usage | from } else { usage })
            .pre_transform(known.current_transform)
            .composite_alpha(if alphas.contains(opaque) { opaque } else { any })
            .present_mode(mode)
            .clipped(true)
            .old_swapchain(old.map_or_else(Default::default, |c| c.swapchain));
        // SAFETY: the surface supports what `info` asks for; the old swapchain, if any, is its own.
        let swapchain = unsafe { swapchains.create_swapchain(&info, None) }
            .map_err(failed(format!("making pictures of {} × {}", size[0], size[1])))?;
        let mut chain = Self {
            swapchain,
            images: Vec::new(),
            views: Vec::new(),
            finished: Vec::new(),
            size,
            is_readable,
            is_stale: false,
            format,
        };
        match chain.fill(gpu, swapchains) {
            Ok(()) => Ok(chain),
            Err(result) => {
                chain.end(gpu, swapchains);
                Err(failed("making pictures of a window")(result))
            }
        }
    }

    fn fill(
        &mut self,
        gpu: &Headless,
        swapchains: &khr::swapchain::Device,
    ) -> std::result::Result<(), vk::Result> {
        // SAFETY: the swapchain was made above.
        self.images = unsafe { swapchains.get_swapchain_images(self.swapchain)? };
        for image in &self.images {
            let info = vk::SemaphoreCreateInfo::default();
            // SAFETY: the device is alive.
            self.finished.push(unsafe { gpu.host().device.create_semaphore(&info, None)? });
            gpu.host().name(*image, "window");
            let view = vk::ImageViewCreateInfo::default()
                .image(*image)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(self.format)
                .subresource_range(whole(1));
            // SAFETY: the image is the swapchain's, of this format.
            self.views.push(unsafe { gpu.host().device.create_image_view(&view, None)? });
        }
        Ok(())
    }

    /// Whether blue comes first in its pictures' bytes.
    pub fn swaps(&self) -> bool {
        FORMATS.contains(&(self.format, true))
    }

    /// The device must have finished with it.
    pub fn end(self, gpu: &Headless, swapchains: &khr::swapchain::Device) {
        // SAFETY: made by this device; the caller guarantees that the device has finished with them.
        unsafe {
            for semaphore in self.finished {
                gpu.host().device.destroy_semaphore(semaphore, None);
            }
            for view in self.views {
                gpu.host().device.destroy_image_view(view, None);
            }
            swapchains.destroy_swapchain(self.swapchain, None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A minimised window has no area where surfaces have sizes. Where they have none, the window's size
    /// counts, within limits.
    #[test]
    fn pictures_are_as_large_as_the_window_or_none() {
        let extent = |width, height| vk::Extent2D { width, height };
        let known = |current| vk::SurfaceCapabilitiesKHR {
            current_extent: current,
            min_image_extent: extent(1, 1),
            max_image_extent: extent(500, 400),
            ..Default::default()
        };
        assert_eq!(size(&known(extent(0, 0)), [300, 200]), [0, 0]);
        assert_eq!(size(&known(extent(64, 48)), [300, 200]), [64, 48]);
        let any = known(extent(u32::MAX, u32::MAX));
        assert_eq!(size(&any, [300, 200]), [300, 200]);
        assert_eq!(size(&any, [600, 0]), [500, 1]);
    }
}

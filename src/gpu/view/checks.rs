//! Checks before anything is made or recorded.

use ash::vk;

use super::super::Host;
use super::super::memory::DEPTH;
use super::{Curve, LINEAR, ViewInputs, ViewOutputs, ViewRenderer, wrong};
use crate::gpu::ImageArg;
use crate::gpu::renderer::{
    check_apart, check_contents, check_image, check_left, check_stage, check_state,
};
use crate::gpu::requirements::family_flags;
use crate::graph::Format;
use crate::plan::View;
use crate::{Error, Result};

/// Checks what a device must support for a view; how its radiance is stored in a picture.
pub(super) fn check_device(host: &Host, view: &View, format: vk::Format) -> Result<Curve> {
    let Some(curve) = Curve::of(format) else {
        let known = "one of 8 or 10 bits, UNORM or SRGB, or four floats";
        return wrong("picture: format", format!("{format:?}"), known);
    };
    let lacks =
        |reason: String| Err(Error::Device { doing: "making a renderer of views".into(), reason });
    family_flags(host, vk::QueueFlags::GRAPHICS)?;
    let drawn = if curve == Curve::None { format } else { LINEAR };
    let colour = vk::ImageUsageFlags::COLOR_ATTACHMENT;
    let mut depth = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
    if view.samples > 1 {
        depth |= vk::ImageUsageFlags::SAMPLED;
    }
    let [of_colour, of_depth] = [(drawn, colour), (DEPTH, depth)].map(|(format, usage)| {
        // SAFETY: the physical device is the instance's.
        unsafe {
            host.instance.get_physical_device_image_format_properties(
                host.physical_device,
                format,
                vk::ImageType::TYPE_2D,
                vk::ImageTiling::OPTIMAL,
                usage,
                vk::ImageCreateFlags::empty(),
            )
        }
    });
    let (Ok(of_colour), Ok(of_depth)) = (of_colour, of_depth) else {
        return lacks(format!("the device draws no images of {drawn:?} and {DEPTH:?}"));
    };
    // SAFETY: as above.
    let limits =
        unsafe { host.instance.get_physical_device_properties(host.physical_device) }.limits;
    let samples = of_colour.sample_counts
        & of_depth.sample_counts
        & limits.framebuffer_color_sample_counts
        & limits.framebuffer_depth_sample_counts;
    if !samples.contains(vk::SampleCountFlags::from_raw(view.samples)) {
        let all = [1, 2, 4, 8].map(|n| (n, vk::SampleCountFlags::from_raw(n)));
        let has = all.iter().filter(|(_, flag)| samples.contains(*flag));
        let has: Vec<_> = has.map(|(n, _)| n.to_string()).collect();
        return wrong(
            "samples a pixel",
            view.samples.to_string(),
            format!("{}, which this device has", has.join(" or ")),
        );
    }
    let [width, height] = view.size;
    let is_beyond = |e: vk::Extent3D| width > e.width || height > e.height;
    if is_beyond(of_colour.max_extent)
        || is_beyond(of_depth.max_extent)
        || width > limits.max_framebuffer_width
        || height > limits.max_framebuffer_height
    {
        return lacks(format!("the device draws no pictures of {width} × {height}"));
    }
    Ok(curve)
}

impl ViewRenderer {
    pub(super) fn check(
        &self,
        slot: usize,
        (view, exposure): (&View, f32),
        inputs: &ViewInputs,
        outputs: &ViewOutputs,
    ) -> Result<()> {
        if slot >= self.slots.len() {
            return wrong("slot", slot.to_string(), format!("less than {}", self.slots.len()));
        }
        if !view.is_shaped_like(&self.shape) {
            return wrong("view", "another shape", "the sizes and images that it was made for");
        }
        if self.linear.is_some() && !(exposure.is_finite() && exposure >= 0.0) {
            return wrong("exposure", exposure.to_string(), "a number, 0 or more");
        }
        let single = Format::R32Float.vk_read();
        let light = view.radiance.vk_read();
        self.check_read("heights", &inputs.heights, single, view.field)?;
        self.check_read("radiance", &inputs.radiance, light, view.field)?;
        let environment = view.environment.map(|size| (Format::Rgba32Float.vk_read(), size));
        let voids = view.has_voids.then_some((single, view.field));
        for (name, arg, wanted) in
            [("environment", &inputs.environment, environment), ("voids", &inputs.voids, voids)]
        {
            match (arg, wanted) {
                (Some(arg), Some((formats, size))) => self.check_read(name, arg, formats, size)?,
                (None, Some(_)) => return wrong(name, "no image", "one"),
                (_, None) => {}
            }
        }
        let extent = [view.size[0], view.size[1], 1];
        check_image("picture", &outputs.picture, &[self.format], extent)?;
        check_left("picture", &outputs.picture)?;
        check_state("picture", "before", outputs.picture.before)?;
        check_state("picture", "after", outputs.picture.after)?;
        if let Some(depth) = &outputs.depth {
            check_image("depth", depth, &[DEPTH], extent)?;
            check_left("depth", depth)?;
            check_stage("depth", "before", depth.before)?;
            check_stage("depth", "after", depth.after)?;
            if depth.after.layout == vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL {
                let found = "COLOR_ATTACHMENT_OPTIMAL";
                return wrong("depth: layout after", found, "a layout of a depth image");
            }
        }
        let all = [
            ("heights", Some(&inputs.heights)),
            ("radiance", Some(&inputs.radiance)),
            ("environment", inputs.environment.as_ref()),
            ("voids", inputs.voids.as_ref()),
            ("picture", Some(&outputs.picture)),
            ("depth", outputs.depth.as_ref()),
        ];
        check_apart(all.into_iter().filter_map(|(name, arg)| Some((name, arg?))))
    }

    /// An image that is fetched from.
    fn check_read(
        &self,
        name: &str,
        arg: &ImageArg,
        formats: &[vk::Format],
        size: [u32; 2],
    ) -> Result<()> {
        let is_readable = |format: &vk::Format| self.readable.contains(format);
        let formats: Vec<_> = formats.iter().copied().filter(is_readable).collect();
        check_image(name, arg, &formats, [size[0], size[1], 1])?;
        check_contents(name, arg)?;
        check_state(name, "before", arg.before)
    }
}

//! Camera pictures of a frame, on a device of our own.

use ash::vk;

use crate::gpu::allocator::MemoryUse;
use crate::gpu::headless::frame::Owned;
use crate::gpu::memory::{Backed, DEPTH, region, whole_attachment};
use crate::gpu::{
    Frame, Headless, ImageArg, ImageState, Timing, ViewInputs, ViewOutputs, ViewRenderer,
};
use crate::graph::Format;
use crate::plan::View;
use crate::{Error, Result};

/// A camera picture of a lit field.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewPixels {
    /// Radiance, linear RGB, row after row from the top.
    pub radiance: Vec<[f32; 3]>,
    /// Distance along the view direction at the first MSAA sample of each pixel, in the field's length unit;
    /// infinite where no ground is visible.
    pub distances_m: Vec<f32>,
    /// GPU time by pass, where the device has timestamps.
    pub timings: Vec<Timing>,
}

/// The bytes of a picture, of its depths, and its GPU times.
struct Drawn {
    picture: Vec<u8>,
    depths: Vec<f32>,
    timings: Vec<Timing>,
}

/// The state for copies from an image.
const COPIED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::COPY,
    access: vk::AccessFlags2::TRANSFER_READ,
    layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
};

/// The state of a new image.
const NEW: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::NONE,
    access: vk::AccessFlags2::NONE,
    layout: vk::ImageLayout::UNDEFINED,
};

impl Headless {
    /// Draws a camera picture of a lit frame, and waits. `voids` are the field's, where it has any.
    ///
    /// # Errors
    /// A view of another plan's field, an MSAA count that the device does not support, or a device out of
    /// memory.
    pub fn look(
        &mut self,
        frame: &Frame,
        view: &View,
        voids: Option<&[bool]>,
    ) -> Result<ViewPixels> {
        let format = vk::Format::R32G32B32A32_SFLOAT;
        let drawn = self.look_as(frame, (view, 1.0), format, voids)?;
        let texels: Vec<f32> = bytemuck::pod_collect_to_vec(&drawn.picture);
        Ok(ViewPixels {
            radiance: texels.chunks_exact(4).map(|t| [t[0], t[1], t[2]]).collect(),
            distances_m: drawn.depths.iter().map(|d| view.distance_m(*d) as f32).collect(),
            timings: drawn.timings,
        })
    }

    /// The same for a screen of four bytes per pixel: radiance times `exposure` through the tone curve, in
    /// the format's channel order.
    ///
    /// # Errors
    /// As [`look`](Self::look), and a format of another kind.
    pub fn look_encoded(
        &mut self,
        frame: &Frame,
        (view, exposure): (&View, f32),
        format: vk::Format,
        voids: Option<&[bool]>,
    ) -> Result<Vec<[u8; 4]>> {
        let drawn = self.look_as(frame, (view, exposure), format, voids)?;
        Ok(drawn.picture.as_chunks::<4>().0.to_vec())
    }

    fn look_as(
        &mut self,
        frame: &Frame,
        of: (&View, f32),
        format: vk::Format,
        voids: Option<&[bool]>,
    ) -> Result<Drawn> {
        let mut renderer = ViewRenderer::new(self.host(), of.0, format, 1)?;
        let mut made = Vec::new();
        let drawn = self.draw_view(&mut renderer, &mut made, frame, of, format, voids);
        made.iter_mut().for_each(|backed| self.memory.free(backed));
        renderer.destroy();
        drawn
    }

    /// The caller frees `made`.
    fn draw_view(
        &mut self,
        renderer: &mut ViewRenderer,
        made: &mut Vec<Backed>,
        frame: &Frame,
        of: (&View, f32),
        format: vk::Format,
        voids: Option<&[bool]>,
    ) -> Result<Drawn> {
        let view = of.0;
        let one = vk::SampleCountFlags::TYPE_1;
        let pixels = view.size[0] as usize * view.size[1] as usize;
        let wide = format == vk::Format::R32G32B32A32_SFLOAT;
        let sizes = [pixels * if wide { 16 } else { 4 }, pixels * 4];
        for (name, format) in [("picture", format), ("depth", DEPTH)] {
            made.push(self.memory.attachment(name, format, view.size, one)?);
        }
        for bytes in sizes {
            let usage = vk::BufferUsageFlags::TRANSFER_DST;
            made.push(self.memory.buffer("staging", bytes as u64, usage, MemoryUse::Readback)?);
        }
        let [picture, depth] = [(0, format), (1, DEPTH)].map(|(i, format)| ImageArg {
            image: made[i].image,
            view: made[i].view,
            format,
            extent: [view.size[0], view.size[1], 1],
            before: NEW,
            after: COPIED,
        });
        let voids = voids.filter(|_| view.has_voids).map(|v| self.mask(made, view, v));
        let inputs = view_inputs(frame, voids.transpose()?)?;
        let outputs = ViewOutputs { picture, depth: Some(depth) };
        let buffers = [made[2].buffer, made[3].buffer];
        self.run(|commands| {
            renderer.record(commands, 0, of, &inputs, &outputs)?;
            for (image, buffer) in [picture, depth].iter().zip(buffers) {
                self.copy_to_host(commands, image, buffer);
            }
            Ok(())
        })?;
        Ok(Drawn {
            picture: made[2].mapped()[..sizes[0]].to_vec(),
            depths: bytemuck::pod_collect_to_vec(&made[3].mapped()[..sizes[1]]),
            timings: renderer.timings(0).unwrap_or_default(),
        })
    }

    /// A mask image of the field's voids, added to `made`.
    ///
    /// # Errors
    /// A device out of memory or lost.
    #[doc(hidden)]
    pub fn mask(
        &mut self,
        made: &mut Vec<Backed>,
        view: &View,
        voids: &[bool],
    ) -> Result<ImageArg> {
        let (format, name) = (Format::R32Float, "voids".to_owned());
        let extent = [view.field[0], view.field[1], 1];
        let backed = self.memory.image(&name, format, extent, false)?;
        let image = Owned { backed, format, extent, name };
        let marks: Vec<f32> = voids.iter().map(|v| f32::from(u8::from(*v))).collect();
        let filled = self.upload(&image, &marks);
        let arg = image.arg();
        made.push(image.backed);
        filled.map(|()| arg)
    }

    fn copy_to_host(&self, commands: vk::CommandBuffer, image: &ImageArg, buffer: vk::Buffer) {
        let [width, height, _] = image.extent;
        let mut region = [region([width, height, 1])];
        region[0].image_subresource.aspect_mask = whole_attachment(image.format).aspect_mask;
        let device = &self.host().device;
        // SAFETY: the image is left for copies by the view's recording; the buffer holds all its texels.
        unsafe {
            let layout = COPIED.layout;
            device.cmd_copy_image_to_buffer(commands, image.image, layout, buffer, &region);
        }
        self.wait_for_all(commands);
    }
}

/// The inputs of a view, from a frame.
///
/// # Errors
/// A frame without radiance.
#[doc(hidden)]
pub fn view_inputs(frame: &Frame, voids: Option<ImageArg>) -> Result<ViewInputs> {
    let plan = frame.plan();
    let found = |name: &str, images: Vec<ImageArg>, names: Vec<&str>| {
        let at = names.iter().position(|n| *n == name);
        at.and_then(|at| images.get(at).copied())
    };
    let input =
        |name| found(name, frame.inputs(), plan.inputs().map(|r| r.1.name.as_str()).collect());
    let output =
        |name| found(name, frame.outputs(), plan.outputs().map(|r| r.1.name.as_str()).collect());
    let missing = || Error::setting("frame of a view", "no radiance", "that of a picture");
    Ok(ViewInputs {
        heights: input("heights").ok_or_else(missing)?,
        radiance: output("radiance").ok_or_else(missing)?,
        environment: input("environment"),
        voids,
    })
}

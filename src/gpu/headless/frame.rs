use ash::vk;

use crate::gpu::allocator::Blocks;
use crate::gpu::memory::Backed;
use crate::gpu::{Headless, ImageArg, ImageState, Renderer, Timing};
use crate::graph::{Format, Kind, Owner, Rectangle, Resource};
use crate::plan::Plan;
use crate::{Error, Result};

/// A renderer with images for its inputs and outputs; freed by [`Headless::end`].
pub struct Frame {
    pub(in crate::gpu) renderer: Renderer,
    pub(in crate::gpu) inputs: Vec<Owned>,
    /// Images of the outputs.
    #[doc(hidden)]
    pub outputs: Vec<Owned>,
}

impl Frame {
    /// The plan that it draws.
    pub fn plan(&self) -> &Plan {
        self.renderer.plan()
    }

    /// Calls [`Renderer::time_passes`].
    pub fn time_passes(&mut self, each: bool) {
        self.renderer.time_passes(each);
    }
}

/// An image of a frame, in GENERAL layout.
#[doc(hidden)]
pub struct Owned {
    /// The image and its memory.
    pub backed: Backed,
    /// Its texels.
    pub format: Format,
    /// Columns, rows, layers.
    pub extent: [u32; 3],
    pub(in crate::gpu) name: String,
}

impl Owned {
    /// As an argument, left in GENERAL.
    pub fn arg(&self) -> ImageArg {
        ImageArg {
            image: self.backed.image,
            view: self.backed.view,
            format: self.format.vk(),
            extent: self.extent,
            before: ImageState::ANY_USE,
            after: ImageState::ANY_USE,
        }
    }
}

/// Contents of an image: rows of texels of one or four f32.
#[derive(Clone, Debug, PartialEq)]
pub struct Pixels {
    /// The image's name in the plan.
    pub name: String,
    /// f32 values per texel: 1 or 4.
    pub channels: usize,
    /// Layer after layer, row after row.
    pub values: Vec<f32>,
}

impl Headless {
    /// Makes an image for an input or output of a plan, in GENERAL layout after [`frame`](Self::frame).
    #[doc(hidden)]
    pub fn image_for(&mut self, resource: &Resource) -> Result<Owned> {
        let Kind::Image { format, width, height, layers, layered } = resource.kind else {
            return Err(Error::setting(&resource.name, "a buffer", "an image"));
        };
        let extent = [width, height, layers];
        let backed = self.memory.image(&resource.name, format, extent, layered)?;
        Ok(Owned { backed, format, extent, name: resource.name.clone() })
    }

    /// Makes a renderer for `plan` with images for all its inputs and outputs, and fills the inputs. `contents`
    /// are their texels in the plan's order, 1 or 4 f32 each.
    ///
    /// # Errors
    /// Contents of another size, or a device out of memory.
    pub fn frame(&mut self, plan: Plan, contents: &[impl AsRef<[f32]>]) -> Result<Frame> {
        self.frame_in_flight(plan, contents, 1)
    }

    /// The same for several frames in flight, `slots`.
    #[doc(hidden)]
    pub fn frame_in_flight(
        &mut self,
        plan: Plan,
        contents: &[impl AsRef<[f32]>],
        slots: usize,
    ) -> Result<Frame> {
        if let Some((_, taken)) = plan.inputs().find(|(_, r)| r.owner == Owner::InputBuffer) {
            let expected = "images alone: a frame has its own";
            return Err(Error::setting(&taken.name, "an input in a buffer", expected));
        }
        let inputs: Vec<Resource> = plan.inputs().map(|(_, r)| r.clone()).collect();
        let outputs: Vec<Resource> = plan.outputs().map(|(_, r)| r.clone()).collect();
        let (host, pipelines) = (self.host(), self.pipelines.clone());
        let blocks = Box::new(Blocks::new(host)?);
        let mut frame = Frame {
            renderer: Renderer::sharing(host, plan, slots, pipelines, blocks)?,
            inputs: Vec::new(),
            outputs: Vec::new(),
        };
        match self.fill(&mut frame, &inputs, &outputs, contents) {
            Ok(()) => Ok(frame),
            Err(error) => {
                self.end(frame);
                Err(error)
            }
        }
    }

    /// Makes a frame ([`frame`](Self::frame)), passes it to `work` and frees it, also after an error.
    ///
    /// # Errors
    /// As there, or `work`'s own.
    pub fn with_frame<T>(
        &mut self,
        plan: Plan,
        contents: &[impl AsRef<[f32]>],
        work: impl FnOnce(&mut Self, &mut Frame) -> Result<T>,
    ) -> Result<T> {
        let mut frame = self.frame(plan, contents)?;
        let done = work(self, &mut frame);
        self.end(frame);
        done
    }

    fn fill(
        &mut self,
        frame: &mut Frame,
        inputs: &[Resource],
        outputs: &[Resource],
        contents: &[impl AsRef<[f32]>],
    ) -> Result<()> {
        if inputs.len() != contents.len() {
            return Err(Error::setting(
                "inputs",
                contents.len().to_string(),
                inputs.len().to_string(),
            ));
        }
        for resource in inputs {
            let image = self.image_for(resource)?;
            frame.inputs.push(image);
        }
        for resource in outputs {
            let image = self.image_for(resource)?;
            frame.outputs.push(image);
        }
        for (image, values) in frame.inputs.iter().zip(contents) {
            self.upload(image, values.as_ref())?;
        }
        self.run(|commands| {
            for image in &frame.outputs {
                self.to_general(commands, image);
            }
            Ok(())
        })
    }

    /// Writes new texels into input `input` of a frame.
    ///
    /// # Errors
    /// Contents of another size.
    pub fn refill(&mut self, frame: &Frame, input: usize, values: &[f32]) -> Result<()> {
        let image = frame.inputs.get(input).ok_or_else(|| {
            Error::setting("input", input.to_string(), format!("less than {}", frame.inputs.len()))
        })?;
        self.upload(image, values)
    }

    /// [`Renderer::replace_plan`] of a frame's renderer.
    ///
    /// # Errors
    /// As there.
    pub fn replace_plan(&mut self, frame: &mut Frame, plan: Plan) -> Result<Vec<usize>> {
        frame.renderer.replace_plan(plan)
    }

    /// Runs a frame once and waits. Returns the GPU time of each pass, or one total after [`Frame::time_passes`]`(false)`, where the device has timestamps.
    ///
    /// # Errors
    /// The device's.
    pub fn draw(&self, frame: &mut Frame) -> Result<Vec<Timing>> {
        let all: Vec<usize> = (0..frame.plan().passes.len()).collect();
        self.draw_passes(frame, &all)
    }

    /// Runs some passes of a frame that has been drawn, and waits.
    ///
    /// # Errors
    /// The device's.
    pub fn draw_passes(&self, frame: &mut Frame, passes: &[usize]) -> Result<Vec<Timing>> {
        self.run_frame(frame, |renderer, commands, inputs, outputs| {
            renderer.record_passes(commands, 0, inputs, outputs, passes)
        })
    }

    /// Runs the edit of a rectangle of heights, and waits: [`Renderer::record_edit`]. The frame must have been
    /// drawn, and its heights refilled.
    ///
    /// # Errors
    /// As there.
    pub fn draw_edit(&self, frame: &mut Frame, rectangle: Rectangle) -> Result<Vec<Timing>> {
        self.run_frame(frame, |renderer, commands, inputs, outputs| {
            renderer.record_edit(commands, 0, inputs, outputs, rectangle)
        })
    }

    /// Runs what `record` records of a frame, and waits. Where it was recorded and did not run, nothing counts as recorded.
    fn run_frame(
        &self,
        frame: &mut Frame,
        record: impl FnOnce(&mut Renderer, vk::CommandBuffer, &[ImageArg], &[ImageArg]) -> Result<()>,
    ) -> Result<Vec<Timing>> {
        let (inputs, outputs) = (frame.inputs(), frame.outputs());
        let renderer = &mut frame.renderer;
        let mut is_recorded = false;
        let ran = self.run(|commands| {
            record(renderer, commands, &inputs, &outputs)?;
            is_recorded = true;
            Ok(())
        });
        if ran.is_err() && is_recorded {
            renderer.forget();
        }
        ran.map(|()| renderer.timings(0).unwrap_or_default())
    }

    /// Texels of output `output` of a frame.
    ///
    /// # Errors
    /// No such output, or the device's.
    pub fn pixels(&mut self, frame: &Frame, output: usize) -> Result<Pixels> {
        let image = frame.outputs.get(output).ok_or_else(|| {
            Error::setting(
                "output",
                output.to_string(),
                format!("less than {}", frame.outputs.len()),
            )
        })?;
        let channels = (image.format.bytes() / 4) as usize;
        let count = image.extent.iter().map(|e| *e as usize).product::<usize>() * channels;
        let mut values = vec![0.0_f32; count];
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut values);
        self.copy(image, false, |staging, from| {
            bytes[from..from + staging.len()].copy_from_slice(staging);
            Ok(())
        })?;
        Ok(Pixels { name: image.name.clone(), channels, values })
    }

    /// Frees a frame.
    pub fn end(&mut self, frame: Frame) {
        frame.renderer.destroy();
        for mut image in frame.inputs.into_iter().chain(frame.outputs) {
            self.memory.free(&mut image.backed);
        }
    }
}

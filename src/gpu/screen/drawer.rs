//! The pass that turns radiance into a screen's bytes, and its images.

use ash::vk;

use super::super::allocator::Blocks;
use super::super::frame::Owned;
use super::super::{Frame, Headless, ImageArg, ImageState, Renderer, Timing};
use super::SLOTS;
use crate::files::Tone;
use crate::plan::{self, Map};
use crate::{Error, Result};

/// How pictures are left for copies.
pub(super) const COPIED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::COPY,
    access: vk::AccessFlags2::TRANSFER_READ,
    layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
};

/// A renderer of maps of one size, with the images that it reads beside radiance, and its picture.
pub(super) struct Drawer {
    renderer: Renderer,
    map: Map,
    tone: Tone,
    steps: Owned,
    voids: Option<Owned>,
    picture: Owned,
}

impl Drawer {
    pub fn new(gpu: &mut Headless, map: &Map, tone: Tone, voids: Option<&[bool]>) -> Result<Self> {
        let plan = plan::map(map, &gpu.report().limits)?;
        let resource = |name: &str| {
            let id = plan.find(name)?;
            Some(plan.resources[id.0].clone())
        };
        let wanted = ["tone_steps", "picture", "voids"].map(resource);
        let pipelines = gpu.pipelines.clone();
        let blocks = Box::new(Blocks::new(gpu.host())?);
        let renderer = Renderer::sharing(gpu.host(), plan, SLOTS, pipelines, blocks)?;
        let mut made = Vec::new();
        let filled = wanted.iter().flatten().try_for_each(|resource| {
            made.push(gpu.image_for(resource)?);
            Ok(())
        });
        let filled = filled.and_then(|()| {
            gpu.upload(&made[0], &tone.steps())?;
            match (made.get(2), voids) {
                (Some(image), Some(voids)) => {
                    let marks: Vec<f32> = voids.iter().map(|v| f32::from(u8::from(*v))).collect();
                    gpu.upload(image, &marks)
                }
                (Some(_), None) => Err(Error::setting("voids", "none", "marks, one a sample")),
                (None, _) => Ok(()),
            }
        });
        if let Err(error) = filled {
            made.iter_mut().for_each(|image| gpu.memory.free(&mut image.backed));
            renderer.destroy();
            return Err(error);
        }
        let mut made = made.into_iter();
        let [steps, picture] = [(); 2].map(|()| made.next().expect("made above"));
        Ok(Self { renderer, map: *map, tone, steps, voids: made.next(), picture })
    }

    /// Whether it can draw a map without being made anew.
    pub fn fits(&self, map: &Map) -> bool {
        let of = |m: &Map| (m.field, m.has_colour, m.has_voids, m.size);
        of(&self.map) == of(map)
    }

    /// Goes over to another tone; waits.
    pub fn set_tone(&mut self, gpu: &mut Headless, tone: Tone) -> Result<()> {
        if tone != self.tone {
            gpu.upload(&self.steps, &tone.steps())?;
            self.tone = tone;
        }
        Ok(())
    }

    /// Draws a map that fits, of a frame that has been lit; the picture is left for copies.
    pub fn record(
        &mut self,
        gpu: &Headless,
        commands: vk::CommandBuffer,
        slot: usize,
        (map, frame): (&Map, &Frame),
    ) -> Result<()> {
        if self.map != *map {
            // Nothing that a device at work reads: what this plan's pass is told stands in commands.
            self.renderer.replace_plan(plan::map(map, &gpu.report().limits)?)?;
            self.map = *map;
        }
        let mut inputs = vec![frame.outputs()[0], self.steps.arg()];
        inputs.extend(self.voids.as_ref().map(Owned::arg));
        let before = ImageState { layout: vk::ImageLayout::UNDEFINED, ..COPIED };
        let picture = ImageArg { before, after: COPIED, ..self.picture.arg() };
        self.renderer.record(commands, slot, &inputs, &[picture])
    }

    /// What copies read.
    pub fn picture(&self) -> vk::Image {
        self.picture.backed.image
    }

    pub fn timings(&self, slot: usize) -> Vec<Timing> {
        self.renderer.timings(slot).unwrap_or_default()
    }

    /// The device must be done with it.
    pub fn end(self, gpu: &mut Headless) {
        self.renderer.destroy();
        let images = [Some(self.steps), self.voids, Some(self.picture)];
        images.into_iter().flatten().for_each(|mut image| gpu.memory.free(&mut image.backed));
    }
}

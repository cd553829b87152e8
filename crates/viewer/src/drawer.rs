//! Renderers that turn radiance into a screen's bytes, and their images.

use ash::vk;

use super::{SLOTS, Viewpoint};
use ridgelight::gpu::{
    Backed, Blocks, Frame, Headless, ImageArg, ImageState, Owned, Renderer, Timing, ViewOutputs,
    ViewRenderer, view_inputs,
};
use ridgelight::plan::{self, Map, View};
use ridgelight::scene::Tone;
use ridgelight::{Error, Result};

/// State of pictures for copies.
pub(super) const COPIED: ImageState = ImageState {
    stage: vk::PipelineStageFlags2::COPY,
    access: vk::AccessFlags2::TRANSFER_READ,
    layout: vk::ImageLayout::TRANSFER_SRC_OPTIMAL,
};

/// State of a picture whose contents are not kept.
const LOST: ImageState = ImageState { layout: vk::ImageLayout::UNDEFINED, ..COPIED };

/// A renderer of maps or of camera views of one size.
pub(super) enum Drawer {
    Map(Box<MapDrawer>),
    View(Box<ViewDrawer>),
}

impl Drawer {
    pub fn new(
        gpu: &mut Headless,
        viewpoint: Viewpoint<'_>,
        (voids, swaps): (Option<&[bool]>, bool),
    ) -> Result<Self> {
        Ok(match viewpoint {
            Viewpoint::Map(map) => Self::Map(Box::new(MapDrawer::new(gpu, map, voids)?)),
            Viewpoint::Camera(view, _) => {
                Self::View(Box::new(ViewDrawer::new(gpu, view, voids, swaps)?))
            }
        })
    }

    /// Whether it can draw this viewpoint as it is.
    pub fn fits(&self, gpu: &Headless, viewpoint: Viewpoint<'_>) -> bool {
        match (self, viewpoint) {
            (Self::Map(drawer), Viewpoint::Map(map)) => drawer.fits(gpu, map),
            (Self::View(drawer), Viewpoint::Camera(view, _)) => drawer.view.is_shaped_like(view),
            _ => false,
        }
    }

    /// Sets the viewpoint's tone. If it changed, waits for the device.
    pub fn set_tone(&mut self, gpu: &mut Headless, viewpoint: Viewpoint<'_>) -> Result<()> {
        match (self, viewpoint) {
            (Self::Map(drawer), Viewpoint::Map(map)) => drawer.set_tone(gpu, map.tone),
            _ => Ok(()),
        }
    }

    /// Draws a lit frame from a viewpoint that fits; leaves the picture for copies.
    pub fn record(
        &mut self,
        gpu: &Headless,
        commands: vk::CommandBuffer,
        slot: usize,
        (frame, viewpoint): (&Frame, Viewpoint<'_>),
    ) -> Result<()> {
        match (self, viewpoint) {
            (Self::Map(drawer), Viewpoint::Map(map)) => {
                drawer.record(gpu, commands, slot, (map, frame))
            }
            (Self::View(drawer), Viewpoint::Camera(view, exposure)) => {
                drawer.record(commands, slot, (view, exposure), frame)
            }
            _ => Err(Error::setting("viewpoint", "another", "the one that was prepared")),
        }
    }

    /// The picture, for copies.
    pub fn picture(&self) -> vk::Image {
        match self {
            Self::Map(drawer) => drawer.picture.backed.image,
            Self::View(drawer) => drawer.picture.image,
        }
    }

    pub fn timings(&self, slot: usize) -> Vec<Timing> {
        let timings = match self {
            Self::Map(drawer) => drawer.renderer.timings(slot),
            Self::View(drawer) => drawer.renderer.timings(slot),
        };
        timings.unwrap_or_default()
    }

    /// The device must have finished with it.
    pub fn end(self, gpu: &mut Headless) {
        match self {
            Self::Map(drawer) => drawer.end(gpu),
            Self::View(drawer) => drawer.end(gpu),
        }
    }
}

/// A renderer of views of one size, with its picture.
pub(super) struct ViewDrawer {
    renderer: ViewRenderer,
    view: View,
    /// The picture, then the mask of voids, if any.
    made: Vec<Backed>,
    picture: ImageArg,
    voids: Option<ImageArg>,
}

impl ViewDrawer {
    fn new(gpu: &mut Headless, view: &View, voids: Option<&[bool]>, swaps: bool) -> Result<Self> {
        let format = if swaps { vk::Format::B8G8R8A8_UNORM } else { vk::Format::R8G8B8A8_UNORM };
        let renderer = ViewRenderer::new(gpu.host(), view, format, SLOTS)?;
        let mut made = Vec::new();
        let one = vk::SampleCountFlags::TYPE_1;
        let filled = gpu.memory.attachment("picture", format, view.size, one).and_then(|picture| {
            made.push(picture);
            let voids = voids.filter(|_| view.has_voids);
            voids.map(|v| gpu.mask(&mut made, view, v)).transpose()
        });
        match filled {
            Ok(voids) => {
                let [width, height] = view.size;
                let picture = ImageArg {
                    image: made[0].image,
                    view: made[0].view,
                    format,
                    extent: [width, height, 1],
                    before: LOST,
                    after: COPIED,
                };
                Ok(Self { renderer, view: view.clone(), made, picture, voids })
            }
            Err(error) => {
                made.iter_mut().for_each(|backed| gpu.memory.free(backed));
                renderer.destroy();
                Err(error)
            }
        }
    }

    fn record(
        &mut self,
        commands: vk::CommandBuffer,
        slot: usize,
        of: (&View, f32),
        frame: &Frame,
    ) -> Result<()> {
        let inputs = view_inputs(frame, self.voids)?;
        let outputs = ViewOutputs { picture: self.picture, depth: None };
        self.renderer.record(commands, slot, of, &inputs, &outputs)
    }

    fn end(mut self, gpu: &mut Headless) {
        self.renderer.destroy();
        self.made.iter_mut().for_each(|backed| gpu.memory.free(backed));
    }
}

/// A renderer of maps of one size, with its picture and its inputs besides radiance.
pub(super) struct MapDrawer {
    renderer: Renderer,
    map: Map,
    /// The tone that `steps` were made for.
    tone: Tone,
    steps: Owned,
    voids: Option<Owned>,
    picture: Owned,
}

impl MapDrawer {
    pub fn new(gpu: &mut Headless, map: &Map, voids: Option<&[bool]>) -> Result<Self> {
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
            gpu.upload(&made[0], &map.tone.steps())?;
            match (made.get(2), voids) {
                (Some(image), Some(voids)) => {
                    let marks: Vec<f32> = voids.iter().map(|v| f32::from(u8::from(*v))).collect();
                    gpu.upload(image, &marks)
                }
                (Some(_), None) => {
                    Err(Error::setting("voids", "none", "a mask, one byte per texel"))
                }
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
        let (map, tone) = (*map, map.tone);
        Ok(Self { renderer, map, tone, steps, voids: made.next(), picture })
    }

    /// Whether it can draw a map as it is.
    pub fn fits(&self, gpu: &Headless, map: &Map) -> bool {
        let own = self.renderer.plan();
        plan::map(map, &gpu.report().limits).is_ok_and(|plan| {
            plan.resources == own.resources && plan.passes[0].constants == own.passes[0].constants
        })
    }

    /// Changes the tone; waits.
    pub fn set_tone(&mut self, gpu: &mut Headless, tone: Tone) -> Result<()> {
        if tone != self.tone {
            gpu.upload(&self.steps, &tone.steps())?;
            self.tone = tone;
        }
        Ok(())
    }

    /// Draws a map that fits, of a lit frame; leaves the picture for copies.
    pub fn record(
        &mut self,
        gpu: &Headless,
        commands: vk::CommandBuffer,
        slot: usize,
        (map, frame): (&Map, &Frame),
    ) -> Result<()> {
        if self.map != *map {
            // Nothing that the device is reading: this plan's push constants are in the commands.
            self.renderer.replace_plan(plan::map(map, &gpu.report().limits)?)?;
            self.map = *map;
        }
        let mut inputs = vec![frame.outputs()[0], self.steps.arg()];
        inputs.extend(self.voids.as_ref().map(Owned::arg));
        let picture = ImageArg { before: LOST, after: COPIED, ..self.picture.arg() };
        self.renderer.record(commands, slot, &inputs, &[picture])
    }

    /// The device must have finished with it.
    pub fn end(self, gpu: &mut Headless) {
        self.renderer.destroy();
        let images = [Some(self.steps), self.voids, Some(self.picture)];
        images.into_iter().flatten().for_each(|mut image| gpu.memory.free(&mut image.backed));
    }
}

//! Pictures of a lit field in a window, and shapes of egui over them.

#![deny(clippy::missing_errors_doc)]

mod chain;
mod drawer;
mod painter;
mod queue;
mod record_frame;
mod slot;

use std::any::Any;
use std::sync::Arc;

use ash::{khr, vk};
use egui::TexturesDelta;
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};

use ridgelight::gpu::{
    Frame, Headless, HeadlessOptions, ImageArg, SurfaceSource, Timing, Work, failed,
};
use ridgelight::plan::{Map, Plan, Rectangle, View};
use ridgelight::{Error, Result};

use chain::Chain;
use drawer::Drawer;
use painter::Painter;
use slot::Slot;

pub use painter::Overlay;

/// Frames in flight.
const SLOTS: usize = 2;

/// A device that presents pictures in a window: its swapchain, and two frames in flight.
pub struct Screen {
    gpu: Headless,
    swapchains: khr::swapchain::Device,
    /// None before the first picture and where the last swapchain can no longer be used.
    chain: Option<Chain>,
    slots: Vec<Slot>,
    next: usize,
    /// One per pane of the last picture.
    drawers: Vec<Drawer>,
    painter: Painter,
    /// Outlives its surface, which is destroyed with the device.
    _window: Arc<dyn Any>,
}

/// How a lit field is viewed.
#[derive(Clone, Copy, Debug)]
pub enum Viewpoint<'a> {
    /// From straight above, byte for byte as in a PNG; the byte order is [`Screen::swaps`].
    Map(&'a Map),
    /// From a camera: the view, and the exposure for [`Tone::picture`](ridgelight::scene::Tone::picture).
    Camera(&'a View, f32),
}

/// A part of a picture: a frame, how it is lit, and where it is shown.
pub struct Pane<'a> {
    /// Made by [`Screen::frame`].
    pub frame: &'a mut Frame,
    /// The heights above the field's base, one per grid point, and the rectangle that changed; none: unchanged.
    pub heights: Option<(&'a [f32], Rectangle)>,
    /// Passes to run first.
    pub work: Work<'a>,
    /// Its viewpoint and size.
    pub viewpoint: Viewpoint<'a>,
    /// The pane's first column in the picture; all panes begin in the first row.
    pub left: u32,
}

/// Options of one picture, besides its panes.
#[derive(Clone, Copy, Debug)]
pub struct PresentOptions<'a> {
    /// The field's voids, if any.
    pub voids: Option<&'a [bool]>,
    /// Drawn over the picture.
    pub overlay: Overlay<'a>,
    /// Whether the picture is read back, which waits for it.
    pub keeps: bool,
}

/// GPU times of one pane of a picture.
#[derive(Clone, Debug, Default)]
pub struct PaneTimes {
    /// Passes that lit its frame; empty where none ran.
    pub light: Vec<Timing>,
    /// Passes that drew it.
    pub drawing: Vec<Timing>,
}

/// The result of presenting a picture.
#[derive(Clone, Debug, Default)]
pub struct Presented {
    /// GPU times of the picture before the last, by pane, where available.
    pub timings: Vec<PaneTimes>,
    /// Red, green, blue, 255 of each pixel, row after row, where they were requested.
    pub pixels: Option<Vec<[u8; 4]>>,
    /// The slot of this picture, for [`Screen::is_finished`].
    pub slot: usize,
    /// Whether the window presented it. False where the window has changed meanwhile, or lost its surface: draw
    /// again.
    pub is_taken: bool,
}

impl Screen {
    /// A device for a window: the one that `options` name, or the first that can present to it.
    ///
    /// # Errors
    /// As [`Headless::new`]; a window or a device that cannot present pictures.
    pub fn new<W>(window: Arc<W>, options: &HeadlessOptions) -> Result<Self>
    where
        W: HasDisplayHandle + HasWindowHandle + 'static,
    {
        let unknown = |e: raw_window_handle::HandleError| Error::Device {
            doing: "showing pictures in a window".into(),
            reason: e.to_string(),
        };
        let display = window.display_handle().map_err(unknown)?.as_raw();
        let handle = window.window_handle().map_err(unknown)?.as_raw();
        let source = SurfaceSource {
            extensions: ash_window::enumerate_required_extensions(display)
                .map_err(failed("showing pictures in a window"))?,
            // SAFETY: the instance is made with the extensions above; the window is alive, as `_window` is kept.
            create: Box::new(move |entry, instance| unsafe {
                ash_window::create_surface(entry, instance, display, handle, None)
            }),
        };
        let gpu = Headless::showing(options, Some(source))?;
        let host = gpu.host();
        let swapchains = khr::swapchain::Device::new(&host.instance, &host.device);
        let (slots, _window) = (Vec::new(), window as Arc<dyn Any>);
        let (drawers, painter) = (Vec::new(), Painter::default());
        let mut screen =
            Self { gpu, swapchains, chain: None, slots, next: 0, drawers, painter, _window };
        for _ in 0..SLOTS {
            let slot = Slot::new(&screen.gpu)?;
            screen.slots.push(slot);
        }
        Ok(screen)
    }

    /// The device.
    pub fn gpu(&mut self) -> &mut Headless {
        &mut self.gpu
    }

    /// A frame whose light it can present: as [`Headless::frame`], for frames in flight, dark until it is lit.
    /// Freed by [`end`](Self::end).
    ///
    /// # Errors
    /// As there.
    pub fn frame(&mut self, plan: Plan, contents: &[impl AsRef<[f32]>]) -> Result<Frame> {
        let frame = self.gpu.frame_in_flight(plan, contents, SLOTS)?;
        let darkened = frame.outputs.iter().try_for_each(|image| {
            let texels = image.extent.iter().map(|n| *n as usize).product::<usize>();
            let dark = vec![0.0; texels * (image.format.bytes() / 4) as usize];
            self.gpu.upload(image, &dark)
        });
        match darkened {
            Ok(()) => Ok(frame),
            Err(error) => {
                self.gpu.end(frame);
                Err(error)
            }
        }
    }

    /// Frees a frame, once the device has finished with it.
    ///
    /// # Errors
    /// A lost device.
    pub fn end(&mut self, frame: Frame) -> Result<()> {
        self.wait()?;
        self.gpu.end(frame);
        Ok(())
    }

    /// Waits for all submitted work.
    ///
    /// # Errors
    /// A lost device.
    pub fn wait(&self) -> Result<()> {
        // SAFETY: only one thread, the owner of this, submits commands to the device.
        unsafe { self.gpu.host().device.device_wait_idle() }.map_err(failed("waiting"))
    }

    /// Columns and rows of the next picture, made ready; none while the window has no area. `wanted` is the
    /// window's size, for systems where a surface has none.
    ///
    /// # Errors
    /// A device that is out of memory or lost, or that cannot present 8 bits per colour; a window that no
    /// longer exists.
    pub fn size(&mut self, wanted: [u32; 2]) -> Result<Option<[u32; 2]>> {
        let known = match chain::capabilities(&mut self.gpu) {
            Err(vk::Result::ERROR_SURFACE_LOST_KHR) => {
                self.renew()?;
                chain::capabilities(&mut self.gpu)
            }
            known => known,
        };
        let known = known.map_err(|result| match result {
            vk::Result::ERROR_SURFACE_LOST_KHR => Error::Device {
                doing: "showing pictures in a window".into(),
                reason: "its surface was lost, and so was the next: the window is gone".into(),
            },
            other => failed("asking a window for its size")(other),
        })?;
        let size = chain::size(&known, wanted);
        if size.contains(&0) {
            return Ok(None);
        }
        if self.chain.as_ref().is_none_or(|c| c.is_stale || c.size != size) {
            self.wait()?;
            let old = self.chain.take();
            let made = Chain::new(&mut self.gpu, &self.swapchains, (&known, size), old.as_ref());
            if let Some(old) = old {
                old.end(&self.gpu, &self.swapchains);
            }
            self.chain = Some(made?);
        }
        Ok(Some(size))
    }

    /// Takes textures of overlays, once each: `textures_delta` of egui's output. They are uploaded with the next picture,
    /// also where a picture has failed since, and those to be freed are kept for one more picture.
    pub fn set_textures(&mut self, delta: TexturesDelta) {
        self.painter.set_textures(delta);
    }

    /// Whether blue comes first in the bytes of its pictures; known after the first one.
    pub fn swaps(&self) -> bool {
        self.chain.as_ref().is_some_and(Chain::swaps)
    }

    /// Starts again with another surface of the window, as after the loss of one.
    ///
    /// # Errors
    /// A device that is lost, a window that no longer exists.
    pub fn renew(&mut self) -> Result<()> {
        self.wait()?;
        self.end_chain();
        match self.gpu.surface() {
            Some((entry, instance, surface)) => surface.renew(entry, instance),
            None => Ok(()),
        }
    }

    /// Whether all submitted work has run, so that the next [`draw`](Self::draw) or [`light`](Self::light) does not wait.
    ///
    /// # Errors
    /// A lost device.
    pub fn is_idle(&self) -> Result<bool> {
        for slot in 0..self.slots.len() {
            if !self.is_finished(slot)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Whether the last work of a slot has run.
    ///
    /// # Errors
    /// A lost device.
    pub fn is_finished(&self, slot: usize) -> Result<bool> {
        let Some(slot) = self.slots.get(slot).filter(|slot| slot.is_in_flight) else {
            return Ok(true);
        };
        let device = &self.gpu.host().device;
        // SAFETY: the fence is the slot's.
        unsafe { device.get_fence_status(slot.done) }.map_err(failed("polling a frame"))
    }

    /// Computes the light of a frame without presenting it. Waits only if the slot's previous work still runs. The first
    /// inputs are the frame's own; `borrowed` are the last ones, images of other frames. Returns the slot that holds its GPU
    /// times once
    /// [`is_idle`](Self::is_idle) is true: `Renderer::timings` of the frame's renderer.
    ///
    /// # Errors
    /// Heights beyond the field, passes that the plan lacks, a device out of memory or lost. The frame must then be lit
    /// again.
    pub fn light(
        &mut self,
        frame: &mut Frame,
        heights: Option<(&[f32], Rectangle)>,
        (work, borrowed): (Work<'_>, &[ImageArg]),
    ) -> Result<usize> {
        let slot = self.next;
        self.slots[slot].settle(&self.gpu)?;
        self.slots[slot].was_lit.clear();
        let lit = self.record_light(slot, frame, heights, (work, borrowed));
        if let Err(error) = lit.and_then(|()| self.submit(slot, None)) {
            frame.renderer().forget();
            return Err(error);
        }
        self.next = (slot + 1) % SLOTS;
        Ok(slot)
    }

    /// Lights the frames of a picture's panes, draws and presents it. None where there was no picture to draw
    /// into: call [`size`](Self::size) for the next one; the panes are unchanged.
    ///
    /// # Errors
    /// Panes that do not fit, or a device out of memory or lost. The panes are unchanged then, and the
    /// swapchain is dropped: the next [`size`](Self::size) makes another.
    pub fn draw(
        &mut self,
        panes: &mut [Pane<'_>],
        options: &PresentOptions<'_>,
    ) -> Result<Option<Presented>> {
        let slot = self.next;
        let Some(chain) = &self.chain else { return Ok(None) };
        let (size, swaps) = (chain.size, chain.swaps());
        self.slots[slot].settle(&self.gpu)?;
        let mut timings = Vec::new();
        for (n, pane) in panes.iter_mut().enumerate() {
            let was_lit = self.slots[slot].was_lit.get(n).is_some_and(|was| *was);
            let light = pane.frame.renderer().timings(slot).filter(|_| was_lit);
            let drawing = self.drawers.get(n).map(|d| d.timings(slot)).unwrap_or_default();
            timings.push(PaneTimes { light: light.unwrap_or_default(), drawing });
        }
        // All checks come before a picture is acquired.
        self.prepare(slot, panes, options)?;
        let Some(image) = self.acquire(slot)? else { return Ok(None) };
        let is_taken = match self.hand_over(slot, image, panes, options) {
            Ok(is_taken) => is_taken,
            Err(error) => {
                for pane in panes.iter_mut().filter(|pane| !pane.work.is_none()) {
                    pane.frame.renderer().forget();
                }
                self.give_up(slot);
                return Err(error);
            }
        };
        self.slots[slot].was_lit = panes.iter().map(|pane| !pane.work.is_none()).collect();
        self.next = (slot + 1) % SLOTS;
        let pixels = if options.keeps { Some(self.read_back(slot, (size, swaps))?) } else { None };
        Ok(Some(Presented { timings, pixels, slot, is_taken }))
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // A lost device has finished with everything.
        let _ = self.wait();
        self.painter.end();
        for drawer in self.drawers.drain(..) {
            drawer.end(&mut self.gpu);
        }
        self.end_chain();
        for mut slot in self.slots.drain(..) {
            slot.free(&mut self.gpu);
            slot.end(&self.gpu);
        }
    }
}

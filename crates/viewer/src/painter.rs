//! Shapes of egui over the window's pictures.

use std::collections::HashMap;
use std::sync::Arc;

use ash::vk;
use egui::epaint::ImageDelta;
use egui::{ClippedPrimitive, ColorImage, ImageData, TextureId, TextureOptions, TexturesDelta};
use egui_ash_renderer::allocator::DefaultAllocator;
use egui_ash_renderer::{DynamicRendering, Options, RenderMode, Renderer, RendererError};

use super::SLOTS;
use ridgelight::gpu::{Headless, failed};
use ridgelight::{Error, Result};

/// Shapes over a picture: the result of [`egui::Context::tessellate`].
#[derive(Clone, Copy, Debug)]
pub struct Overlay<'a> {
    /// Triangles, back to front; their textures were given to [`Screen::set_textures`](super::Screen::set_textures).
    pub primitives: &'a [ClippedPrimitive],
    /// Pixels per unit of their coordinates.
    pub pixels_per_point: f32,
}

/// Contents of a texture.
struct Texture {
    image: Arc<ColorImage>,
    options: TextureOptions,
    /// Whether the renderer has these contents.
    is_uploaded: bool,
}

/// egui's renderer and its textures. The contents are kept here as well: the renderer loses the rest of a texture when it
/// changes a part of it, and another swapchain may need another renderer.
#[derive(Default)]
pub(super) struct Painter {
    /// None before the first picture with shapes.
    renderer: Option<(vk::Format, Renderer<DefaultAllocator>)>,
    textures: HashMap<TextureId, Texture>,
    /// Textures that no later picture uses, and those that only the next one does.
    unused: Vec<TextureId>,
    used_last: Vec<TextureId>,
}

impl Painter {
    /// Takes changed textures; the renderer gets them with the next picture.
    pub fn set_textures(&mut self, mut delta: TexturesDelta) {
        for (id, changes) in std::mem::take(&mut delta.set) {
            for ImageDelta { image: ImageData::Color(new), options, pos } in changes {
                match (pos, self.textures.get_mut(&id)) {
                    (Some(at), Some(texture)) => {
                        patch(Arc::make_mut(&mut texture.image), &new, at);
                        texture.is_uploaded = false;
                    }
                    _ => {
                        let texture = Texture { image: new, options, is_uploaded: false };
                        self.textures.insert(id, texture);
                    }
                }
            }
        }
        self.unused.append(&mut self.used_last);
        self.used_last.extend(std::mem::take(&mut delta.free));
    }

    /// Makes the renderer and uploads changed textures for a picture of a format. No commands of the pool are in flight.
    pub fn prepare(
        &mut self,
        gpu: &Headless,
        (pool, format): (vk::CommandPool, vk::Format),
    ) -> Result<()> {
        let host = gpu.host();
        let is_other = self.renderer.as_ref().is_some_and(|(known, _)| *known != format);
        if is_other || !self.unused.is_empty() {
            // SAFETY: one thread, the owner of the screen, submits commands to the device.
            unsafe { host.device.device_wait_idle() }.map_err(failed("waiting"))?;
        }
        if is_other {
            self.end();
        }
        let (_, renderer) = match &mut self.renderer {
            Some(made) => made,
            none => {
                let mode = RenderMode::DynamicRendering(DynamicRendering {
                    color_attachment_format: format,
                    depth_attachment_format: None,
                    stencil_attachment_format: None,
                });
                let options = Options {
                    in_flight_frames: SLOTS,
                    srgb_framebuffer: is_srgb(format),
                    ..Options::default()
                };
                let (instance, device) = (&host.instance, host.device.clone());
                let made = Renderer::with_default_allocator(
                    instance,
                    host.physical_device,
                    device,
                    mode,
                    options,
                );
                none.insert((format, made.map_err(refused)?))
            }
        };
        for id in self.unused.drain(..) {
            self.textures.remove(&id);
            renderer.free_texture(id).map_err(refused)?;
        }
        for (id, texture) in self.textures.iter_mut().filter(|(_, t)| !t.is_uploaded) {
            let all = ImageDelta::full(Arc::clone(&texture.image), texture.options);
            // Waits for the queue, so that no picture in flight uses the texture that this one replaces.
            renderer.set_texture(gpu.queue, pool, *id, &all).map_err(refused)?;
            texture.is_uploaded = true;
        }
        Ok(())
    }

    /// Records the shapes, within rendering. The renderer has a vertex buffer per frame in flight and takes them in turn:
    /// the picture before the last has run, as its slot, or a later one, is free.
    pub fn record(
        &mut self,
        commands: vk::CommandBuffer,
        [width, height]: [u32; 2],
        overlay: Overlay<'_>,
    ) -> Result<()> {
        let Some((_, renderer)) = &mut self.renderer else { return Ok(()) };
        let extent = vk::Extent2D { width, height };
        let Overlay { primitives, pixels_per_point } = overlay;
        renderer.cmd_draw(commands, extent, pixels_per_point, primitives).map_err(refused)
    }

    /// Frees the renderer; the device must have finished with it.
    pub fn end(&mut self) {
        self.renderer = None;
        self.textures.values_mut().for_each(|texture| texture.is_uploaded = false);
    }
}

/// Whether the device encodes what it writes.
fn is_srgb(format: vk::Format) -> bool {
    matches!(format, vk::Format::B8G8R8A8_SRGB | vk::Format::R8G8B8A8_SRGB)
}

fn refused(error: RendererError) -> Error {
    let doing = "drawing the panel";
    match error {
        RendererError::Vulkan(result) => failed(doing)(result),
        other => Error::Device { doing: doing.into(), reason: other.to_string() },
    }
}

/// Replaces a part of an image, from a column and a row.
fn patch(image: &mut ColorImage, new: &ColorImage, [col, row]: [usize; 2]) {
    let ([cols, _], [width, _]) = (image.size, new.size);
    for (n, pixels) in new.pixels.chunks_exact(width.max(1)).enumerate() {
        let first = (row + n) * cols + col;
        image.pixels[first..first + width].copy_from_slice(pixels);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui::Color32;

    fn filled(size: [usize; 2], colour: Color32) -> ColorImage {
        ColorImage::filled(size, colour)
    }

    /// A change of a part leaves the rest, and is uploaded again.
    #[test]
    fn a_changed_part_leaves_the_rest() {
        let (id, mut painter) = (TextureId::Managed(0), Painter::default());
        let mut delta = TexturesDelta::default();
        delta.push(id, ImageDelta::full(filled([4, 3], Color32::BLACK), TextureOptions::LINEAR));
        painter.set_textures(delta);
        painter.textures.get_mut(&id).unwrap().is_uploaded = true;
        let mut delta = TexturesDelta::default();
        let part = filled([2, 1], Color32::WHITE);
        delta.push(id, ImageDelta::partial([1, 2], part, TextureOptions::LINEAR));
        painter.set_textures(delta);
        let texture = &painter.textures[&id];
        let white: Vec<usize> =
            (0..12).filter(|i| texture.image.pixels[*i] == Color32::WHITE).collect();
        assert_eq!(white, [9, 10]);
        assert!(!texture.is_uploaded);
    }

    /// The picture that is drawn with a freed texture comes first.
    #[test]
    fn freed_textures_stay_for_one_picture() {
        let (id, mut painter) = (TextureId::Managed(1), Painter::default());
        let mut delta = TexturesDelta::default();
        delta.free(id);
        painter.set_textures(delta);
        assert!(painter.unused.is_empty());
        painter.set_textures(TexturesDelta::default());
        assert_eq!(painter.unused, [id]);
    }
}

//! Reads back any resource of a plan, and passes a frame's images to other renderers: for tools and tests.

use ash::vk;

use crate::gpu::allocator::MemoryUse;
use crate::gpu::barriers::Barriers;
use crate::gpu::headless::frame::Owned;
use crate::gpu::memory::region;
use crate::gpu::{Frame, Headless, ImageArg, ImageState, Renderer, transition};
use crate::graph::{Kind, Owner, ResourceId};
use crate::{Error, Result};

impl Frame {
    /// The frame's renderer, to record it into command buffers with others.
    pub fn renderer(&mut self) -> &mut Renderer {
        &mut self.renderer
    }

    /// The plan's inputs, in its order: in GENERAL, before and after.
    pub fn inputs(&self) -> Vec<ImageArg> {
        self.inputs.iter().map(Owned::arg).collect()
    }

    /// The plan's outputs, in its order: in GENERAL, before and after.
    pub fn outputs(&self) -> Vec<ImageArg> {
        self.outputs.iter().map(Owned::arg).collect()
    }

    /// The image or buffer of a resource of the plan.
    fn handles(&self, id: ResourceId) -> Option<(vk::Image, vk::Buffer)> {
        let owner = self.plan().resources.get(id.0)?.owner;
        let backed = match owner {
            Owner::Internal | Owner::InputBuffer => self.renderer.internal(id)?,
            Owner::Input | Owner::Output => {
                let before = &self.plan().resources[..id.0];
                let n = before.iter().filter(|r| r.owner == owner).count();
                let images = if owner == Owner::Input { &self.inputs } else { &self.outputs };
                &images.get(n)?.backed
            }
        };
        Some((backed.image, backed.buffer))
    }
}

impl Headless {
    /// Words of any resource of a frame that has been drawn, as its passes left it. An image is layer after
    /// layer, row after row, texel after texel; a buffer from its first byte. f32 values as their bits.
    ///
    /// An image that several passes write in turn holds the last result. To read an earlier one, run the passes
    /// one by one ([`draw_passes`](Self::draw_passes)).
    ///
    /// # Errors
    /// A resource that the plan does not have, or a device out of memory: all of it is staged at once.
    pub fn read(&mut self, frame: &Frame, id: ResourceId) -> Result<Vec<u32>> {
        let (image, buffer) = frame.handles(id).ok_or_else(|| {
            let count = frame.plan().resources.len();
            Error::setting("resource", id.0.to_string(), format!("less than {count}"))
        })?;
        let resource = &frame.plan().resources[id.0];
        let (bytes, kind) = (resource.bytes(), resource.kind);
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let mut staging =
            self.memory.buffer("staging", bytes.max(4), usage, MemoryUse::Readback)?;
        let to = staging.buffer;
        let device = &self.host().device;
        let done = self.run(|commands| {
            self.wait_for_all(commands);
            // SAFETY: the frame's image is in GENERAL and its buffer may be copied from; both are
            // alive while `frame` is, and the staging buffer holds all their bytes.
            unsafe {
                match kind {
                    Kind::Image { width, height, layers, .. } => {
                        let region = [region([width, height, layers])];
                        let layout = vk::ImageLayout::GENERAL;
                        device.cmd_copy_image_to_buffer(commands, image, layout, to, &region);
                    }
                    Kind::Buffer { .. } => {
                        let region = [vk::BufferCopy { src_offset: 0, dst_offset: 0, size: bytes }];
                        device.cmd_copy_buffer(commands, buffer, to, &region);
                    }
                }
            }
            self.wait_for_all(commands);
            Ok(())
        });
        let words = staging.mapped()[..bytes as usize].as_chunks::<4>().0;
        let words = words.iter().map(|word| u32::from_ne_bytes(*word)).collect();
        self.memory.free(&mut staging);
        done.map(|()| words)
    }

    /// Share of the texels, [0..1], where SH light rang below 0 in a channel and was set to 0: of an
    /// environment, or of specular reflection, in a frame that has been drawn. None without SH.
    ///
    /// # Errors
    /// As [`read`](Self::read).
    pub fn negative_share(&mut self, frame: &Frame) -> Result<Option<f64>> {
        let plan = frame.plan();
        if plan.find("visibility").is_none() {
            return Ok(None);
        }
        let sums = ["env_sum", "specular_sum"].map(|name| plan.find(name));
        let mut is_negative = Vec::new();
        for sum in sums.into_iter().flatten() {
            let words = self.read(frame, sum)?;
            is_negative.resize(words.len() / 4, false);
            let marks = words.chunks_exact(4).map(|texel| f32::from_bits(texel[3]) > 0.0);
            is_negative.iter_mut().zip(marks).for_each(|(is, mark)| *is |= mark);
        }
        let count = is_negative.iter().filter(|is| **is).count();
        Ok(Some(count as f64 / is_negative.len().max(1) as f64))
    }

    /// Changes an image from state `before` to state `after`, within `commands`, which is being recorded
    /// ([`run`](Self::run)).
    pub fn transition(&self, commands: vk::CommandBuffer, image: &ImageArg) {
        let ImageArg { before, after, extent: [.., layers], .. } = *image;
        let barrier = [transition(image.image, layers, before, after)];
        // SAFETY: the caller guarantees that `commands` is being recorded and that the image is alive and in
        // its state `before`.
        unsafe { Barriers::default().images(&barrier).record(&self.host().device, commands) };
    }
}

impl ImageState {
    /// The state of a [`Frame`]'s images between recordings: GENERAL, any use.
    pub const ANY_USE: Self = Self {
        stage: vk::PipelineStageFlags2::ALL_COMMANDS,
        access: vk::AccessFlags2::from_raw(
            vk::AccessFlags2::MEMORY_READ.as_raw() | vk::AccessFlags2::MEMORY_WRITE.as_raw(),
        ),
        layout: vk::ImageLayout::GENERAL,
    };
}

//! Creates and destroys the device resources of a renderer of views.

use ash::vk;

use super::super::allocator::MemoryUse;
use super::super::memory::DEPTH;
use super::super::pipelines::descriptors;
use super::super::shaders;
use super::super::timestamps::Timestamps;
use super::pipelines::Recipe;
use super::targets::Framebuffers;
use super::{Curve, LABELS, LINEAR, Slot, ViewRenderer};
use crate::Result;
use crate::graph::Format;
use crate::passes::terrain_draw::tile_indices;
use crate::plan::View;

impl ViewRenderer {
    pub(super) fn make(&mut self, curve: Curve, slots: usize) -> Result<()> {
        let (size, one) = (self.shape.size, vk::SampleCountFlags::TYPE_1);
        let drawn = if curve == Curve::None { self.format } else { LINEAR };
        if self.samples != one {
            self.many =
                Some(self.memory.attachment("picture_samples", drawn, size, self.samples)?);
        }
        self.depth = Some(self.memory.attachment("picture_depth", DEPTH, size, self.samples)?);
        if curve != Curve::None {
            self.linear = Some(self.memory.attachment("picture_radiance", LINEAR, size, one)?);
        }
        self.make_indices()?;
        self.render_passes.make(&self.host, (drawn, self.samples), self.format)?;
        let (scene, samples) = (self.render_passes.scene[0], self.samples);
        let is_grey = self.shape.radiance == Format::R32Float;
        let View { has_voids, .. } = self.shape;
        let over = |shaders, depth| Recipe {
            shaders,
            render_pass: scene,
            has_colour: true,
            samples,
            depth: Some(depth),
        };
        let terrain = [
            shaders::TerrainDrawVert {}.into(),
            shaders::TerrainDrawFrag { is_grey, has_voids }.into(),
        ];
        let has_environment = self.shape.environment.is_some();
        let sky = [shaders::SkyDrawVert {}.into(), shaders::SkyDrawFrag { has_environment }.into()];
        let plinth = [
            shaders::PlinthDrawVert { is_grey, has_voids }.into(),
            shaders::PlinthDrawFrag { has_voids }.into(),
        ];
        let whole = |fragment, render_pass, has_colour, depth| Recipe {
            shaders: [shaders::PictureToneVert {}.into(), fragment],
            render_pass,
            has_colour,
            samples: one,
            depth,
        };
        let recipes = [
            Some(over(terrain, (vk::CompareOp::GREATER, true))),
            // Background, where nothing is drawn.
            Some(over(sky, (vk::CompareOp::GREATER_OR_EQUAL, false))),
            // Over everything, without depths.
            self.shape.plinth.is_some().then(|| over(plinth, (vk::CompareOp::ALWAYS, false))),
            (self.samples != one).then(|| {
                let depth = Some((vk::CompareOp::ALWAYS, true));
                whole(shaders::DepthResolveFrag {}.into(), self.render_passes.depth, false, depth)
            }),
            (curve != Curve::None).then(|| {
                let fragment = shaders::PictureToneFrag { encodes: curve == Curve::Encode };
                whole(fragment.into(), self.render_passes.tone, true, None)
            }),
        ];
        for (drawing, recipe) in self.drawings.iter_mut().zip(recipes) {
            *drawing = recipe.map(|recipe| recipe.make(&self.host)).transpose()?;
        }
        self.make_slots(slots)
    }

    fn make_indices(&mut self) -> Result<()> {
        let indices = tile_indices();
        let bytes: &[u8] = bytemuck::cast_slice(&indices);
        let usage = vk::BufferUsageFlags::INDEX_BUFFER;
        let size = bytes.len() as u64;
        let buffer = self.memory.buffer("tile_indices", size, usage, MemoryUse::Upload)?;
        self.indices.insert(buffer).mapped()[..bytes.len()].copy_from_slice(bytes);
        Ok(())
    }

    fn make_slots(&mut self, slots: usize) -> Result<()> {
        let drawings = self.drawings;
        let layouts: Vec<_> = drawings.iter().flatten().map(|d| d.set_layout).collect();
        // Heights, radiance, voids, twice; the environment; depths; the input of the tone curve.
        let sizes = [vk::DescriptorPoolSize {
            ty: vk::DescriptorType::SAMPLED_IMAGE,
            descriptor_count: 9 * slots as u32,
        }];
        let pool = (&mut self.descriptor_pool, "ridgelight views");
        let all = descriptors(&self.host, pool, &sizes, &layouts.repeat(slots))?;
        let mut all = all.into_iter();
        for number in 0..slots {
            let sets = drawings.map(|drawing| drawing.and_then(|_| all.next()).unwrap_or_default());
            let named = LABELS.iter().zip(&sets);
            for (label, set) in named.filter(|(_, set)| **set != vk::DescriptorSet::null()) {
                self.host.name(*set, &format!("{label}, slot {number}"));
            }
            let name = format!("ridgelight views, slot {number}");
            let timestamps =
                Timestamps::new(&self.host, &mut self.memory, &name, LABELS.len() + 1)?;
            let framebuffers = Framebuffers::default();
            self.slots.push(Slot { sets, framebuffers, timestamps, recorded: Vec::new() });
        }
        Ok(())
    }

    pub(super) fn free(&mut self) {
        let own = [&mut self.many, &mut self.depth, &mut self.linear, &mut self.indices];
        for mut backed in own.into_iter().filter_map(Option::take) {
            self.memory.free(&mut backed);
        }
        (0..self.slots.len()).for_each(|slot| self.free_framebuffers(slot));
        for timestamps in self.slots.drain(..).filter_map(|slot| slot.timestamps) {
            timestamps.free(&self.host, &mut self.memory);
        }
        self.render_passes.free(&self.host);
        // SAFETY: made by this device; the caller of `destroy` guarantees that nothing in flight uses it. Null is
        // allowed.
        unsafe { self.host.device.destroy_descriptor_pool(self.descriptor_pool, None) };
        let drawings = std::mem::take(&mut self.drawings);
        drawings.into_iter().flatten().for_each(|drawing| drawing.free(&self.host));
        self.memory.end();
    }
}

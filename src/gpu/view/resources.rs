//! Creates and destroys the device resources of a renderer of views.

use ash::vk;

use super::super::allocator::MemoryUse;
use super::super::memory::DEPTH;
use super::super::timestamps::Timestamps;
use super::super::{failed, shaders};
use super::pipelines::{Drawing, Recipe};
use super::targets::Framebuffers;
use super::{Curve, LABELS, LINEAR, Slot, ViewRenderer};
use crate::graph::Format;
use crate::passes::terrain_draw::tile_indices;
use crate::{Error, Result};

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
        self.terrain.make(
            &self.host,
            &Recipe {
                shaders: [
                    shaders::TerrainDrawVert {}.into(),
                    shaders::TerrainDrawFrag { is_grey, has_voids: self.shape.has_voids }.into(),
                ],
                render_pass: scene,
                has_colour: true,
                samples,
                depth: Some((vk::CompareOp::GREATER, true)),
            },
        )?;
        self.sky.make(
            &self.host,
            &Recipe {
                shaders: [
                    shaders::SkyDrawVert {}.into(),
                    shaders::SkyDrawFrag { has_environment: self.shape.environment.is_some() }
                        .into(),
                ],
                render_pass: scene,
                has_colour: true,
                samples,
                // Background, where nothing is drawn.
                depth: Some((vk::CompareOp::GREATER_OR_EQUAL, false)),
            },
        )?;
        if self.shape.plinth.is_some() {
            let has_voids = self.shape.has_voids;
            self.plinth.insert(Drawing::default()).make(
                &self.host,
                &Recipe {
                    shaders: [
                        shaders::PlinthDrawVert { is_grey, has_voids }.into(),
                        shaders::PlinthDrawFrag { has_voids }.into(),
                    ],
                    render_pass: scene,
                    has_colour: true,
                    samples,
                    // Over everything, without depths.
                    depth: Some((vk::CompareOp::ALWAYS, false)),
                },
            )?;
        }
        if self.samples != one {
            self.depth_resolve.insert(Drawing::default()).make(
                &self.host,
                &Recipe {
                    shaders: [
                        shaders::PictureToneVert {}.into(),
                        shaders::DepthResolveFrag {}.into(),
                    ],
                    render_pass: self.render_passes.depth,
                    has_colour: false,
                    samples: one,
                    depth: Some((vk::CompareOp::ALWAYS, true)),
                },
            )?;
        }
        if curve != Curve::None {
            self.tone.insert(Drawing::default()).make(
                &self.host,
                &Recipe {
                    shaders: [
                        shaders::PictureToneVert {}.into(),
                        shaders::PictureToneFrag { encodes: curve == Curve::Encode }.into(),
                    ],
                    render_pass: self.render_passes.tone,
                    has_colour: true,
                    samples: one,
                    depth: None,
                },
            )?;
        }
        self.make_slots(slots)
    }

    fn make_indices(&mut self) -> Result<()> {
        let indices = tile_indices();
        let bytes: &[u8] = bytemuck::cast_slice(&indices);
        let usage = vk::BufferUsageFlags::INDEX_BUFFER;
        let size = bytes.len() as u64;
        let buffer = self.memory.buffer("tile_indices", size, usage, MemoryUse::Upload)?;
        let mapped = self.indices.insert(buffer).mapped();
        let mapped = mapped.ok_or_else(|| Error::Device {
            doing: "writing the indices of a tile".into(),
            reason: "the device has no memory that the host can write".into(),
        })?;
        mapped[..bytes.len()].copy_from_slice(bytes);
        Ok(())
    }

    fn make_slots(&mut self, slots: usize) -> Result<()> {
        let device = self.host.device.clone();
        let drawings = self.drawings();
        let layouts: Vec<_> = drawings.iter().flatten().map(|d| d.set_layout).collect();
        // Heights, radiance, voids, twice; the environment; depths; the input of the tone curve.
        let sizes = [vk::DescriptorPoolSize {
            ty: vk::DescriptorType::SAMPLED_IMAGE,
            descriptor_count: 9 * slots as u32,
        }];
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets((slots * layouts.len()) as u32)
            .pool_sizes(&sizes);
        // SAFETY: the device is alive.
        self.descriptor_pool = unsafe { device.create_descriptor_pool(&info, None) }
            .map_err(failed("making the descriptor pool"))?;
        self.host.name(self.descriptor_pool, "ridgelight views");
        for number in 0..slots {
            let sets_info = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(self.descriptor_pool)
                .set_layouts(&layouts);
            // SAFETY: the pool was sized for exactly these sets; the layouts are alive.
            let all = unsafe { device.allocate_descriptor_sets(&sets_info) }
                .map_err(failed("making a frame's descriptors"))?;
            let mut all = all.into_iter();
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
        let optional = [self.plinth.as_mut(), self.depth_resolve.as_mut(), self.tone.as_mut()];
        let drawings = [Some(&mut self.terrain), Some(&mut self.sky)].into_iter().chain(optional);
        drawings.flatten().for_each(|drawing| drawing.free(&self.host));
        self.memory.end();
        self.destroyed = true;
    }
}

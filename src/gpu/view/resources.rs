//! Creates and destroys the device resources of a renderer of views.

use ash::vk;

use super::super::allocator::MemoryUse;
use super::super::memory::DEPTH;
use super::super::{failed, shaders};
use super::pipelines::{Drawing, Recipe};
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
        let is_grey = self.shape.radiance == Format::R32Float;
        self.terrain.make(
            &self.host,
            &Recipe {
                shaders: [
                    shaders::TerrainDrawVert {}.into(),
                    shaders::TerrainDrawFrag { is_grey, has_voids: self.shape.has_voids }.into(),
                ],
                format: drawn,
                samples: self.samples,
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
                format: drawn,
                samples: self.samples,
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
                    format: drawn,
                    samples: self.samples,
                    // Over everything, without depths.
                    depth: Some((vk::CompareOp::ALWAYS, false)),
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
                    format: self.format,
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
        let device = &self.host.device;
        let drawings = self.drawings();
        let layouts: Vec<_> = drawings.iter().flatten().map(|d| d.set_layout).collect();
        // Heights, radiance, voids, twice; the environment; the input of the tone curve.
        let sizes = [vk::DescriptorPoolSize {
            ty: vk::DescriptorType::SAMPLED_IMAGE,
            descriptor_count: 8 * slots as u32,
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
            let queries_info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::TIMESTAMP)
                .query_count(LABELS.len() as u32 + 1);
            // SAFETY: the pool was sized for exactly these sets; the layouts are alive.
            let slot = unsafe {
                device.allocate_descriptor_sets(&sets_info).and_then(|all| {
                    let queries = match self.timestamps {
                        Some(_) => device.create_query_pool(&queries_info, None)?,
                        None => vk::QueryPool::null(),
                    };
                    let mut all = all.into_iter();
                    let sets = drawings
                        .map(|drawing| drawing.and_then(|_| all.next()).unwrap_or_default());
                    Ok(Slot { sets, queries, is_recorded: false })
                })
            };
            let slot = slot.map_err(failed("making a frame's descriptors"))?;
            let named = LABELS.iter().zip(&slot.sets);
            for (label, set) in named.filter(|(_, set)| **set != vk::DescriptorSet::null()) {
                self.host.name(*set, &format!("{label}, slot {number}"));
            }
            if slot.queries != vk::QueryPool::null() {
                self.host.name(slot.queries, &format!("ridgelight views, slot {number}"));
            }
            self.slots.push(slot);
        }
        Ok(())
    }

    pub(super) fn free(&mut self) {
        let own = [&mut self.many, &mut self.depth, &mut self.linear, &mut self.indices];
        for mut backed in own.into_iter().filter_map(Option::take) {
            self.memory.free(&mut backed);
        }
        for slot in self.slots.drain(..) {
            // SAFETY: made by this device; the caller of `destroy` guarantees that nothing in flight uses it.
            // Null is allowed.
            unsafe { self.host.device.destroy_query_pool(slot.queries, None) };
        }
        // SAFETY: as above.
        unsafe { self.host.device.destroy_descriptor_pool(self.descriptor_pool, None) };
        let optional = [self.plinth.as_mut(), self.tone.as_mut()];
        let drawings = [Some(&mut self.terrain), Some(&mut self.sky)].into_iter().chain(optional);
        drawings.flatten().for_each(|drawing| drawing.free(&self.host));
        self.memory.end();
        self.destroyed = true;
    }
}

//! Creates and destroys a renderer's device resources.

use ash::vk;

use super::super::allocator::MemoryUse;
use super::super::memory::{Backed, Memory};
use super::super::pipelines::{descriptor_type, descriptors};
use super::super::shaders::BindingKind;
use super::super::timestamps::Timestamps;
use super::{Renderer, Slot};
use crate::graph::{Format, Kind, Owner, Resource};
use crate::plan::Plan;
use crate::{Error, Result};

/// Buffers that the host writes, by name: the plan's azimuths and its constants.
const TABLES: [&str; 2] = ["azimuths", "constants"];

impl Renderer {
    pub(super) fn make(&mut self, slots: usize) -> Result<()> {
        self.pipeline_of_pass = self.pipelines.of(&self.host, self.plan.every_pass())?;
        for resource in &self.plan.resources {
            let is_slots = TABLES.contains(&resource.name.as_str());
            let backed = match resource.owner {
                Owner::Internal if !is_slots => {
                    Some(self.memory.make(&resource.name, resource.kind, MemoryUse::Device)?)
                }
                Owner::InputBuffer => Some(Self::take(&mut self.memory, &self.readable, resource)?),
                _ => None,
            };
            self.resources.push(backed);
        }
        // A resource that a shader might write belongs to its pass only: two passes that "write" one unused
        // image would need a barrier for nothing.
        for (index, pass) in self.plan.every_pass().enumerate() {
            for (binding, id) in pass.shader.bindings.iter().zip(&pass.bindings) {
                let writer = binding.written.then_some(index);
                let known =
                    |u: &(BindingKind, Option<usize>, Backed)| u.0 == binding.kind && u.1 == writer;
                if id.is_none() && !self.unused.iter().any(known) {
                    let kind = smallest(binding.kind);
                    let backed = self.memory.make("unused", kind, MemoryUse::Device)?;
                    self.unused.push((binding.kind, writer, backed));
                }
            }
        }
        self.make_slots(slots)
    }

    /// An image for an input in a buffer: only copied to and fetched from, so that any format works.
    fn take(memory: &mut Memory, readable: &[vk::Format], resource: &Resource) -> Result<Backed> {
        let Kind::Image { format, width, height, layers, layered } = resource.kind else {
            return memory.make(&resource.name, resource.kind, MemoryUse::Device);
        };
        let format = format.vk();
        if !readable.contains(&format) {
            let (name, found) = (format!("{}: texels", resource.name), format!("{format:?}"));
            return Err(Error::setting(name, found, "a format that the device samples"));
        }
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        let usage = usage | vk::ImageUsageFlags::TRANSFER_SRC;
        let of = (format, usage, vk::SampleCountFlags::TYPE_1);
        memory.image_for(&resource.name, of, [width, height, layers], layered)
    }

    /// Writes the plan's azimuths and constants where the slot does not hold the current ones.
    pub(super) fn write_tables(&mut self, slot: usize) {
        let Plan { azimuths, constants, .. } = &self.plan;
        let contents: [&[u8]; 2] =
            [bytemuck::cast_slice(azimuths), bytemuck::cast_slice(constants)];
        let slot = &mut self.slots[slot];
        if std::mem::replace(&mut slot.is_current, true) {
            return;
        }
        for (id, backed) in &mut slot.tables {
            let which = TABLES.iter().position(|name| self.plan.find(name) == Some(*id));
            let Some(which) = which else { continue };
            backed.mapped()[..contents[which].len()].copy_from_slice(contents[which]);
        }
    }

    fn make_slots(&mut self, slots: usize) -> Result<()> {
        let mut sizes: Vec<vk::DescriptorPoolSize> = Vec::new();
        for binding in self.plan.every_pass().flat_map(|p| p.shader.bindings) {
            let ty = descriptor_type(binding.kind);
            match sizes.iter_mut().find(|s| s.ty == ty) {
                Some(size) => size.descriptor_count += slots as u32,
                None => sizes.push(vk::DescriptorPoolSize { ty, descriptor_count: slots as u32 }),
            }
        }
        let passes = self.plan.every_pass().count();
        let layouts: Vec<_> = self.pipeline_of_pass.iter().map(|p| p.set_layout).collect();
        let pool = (&mut self.descriptor_pool, "ridgelight");
        let all = descriptors(&self.host, pool, &sizes, &layouts.repeat(slots))?;
        for (number, sets) in all.chunks(passes).enumerate() {
            for (pass, set) in self.plan.every_pass().zip(sets) {
                self.host.name(*set, &format!("{}, slot {number}", pass.label()));
            }
            let name = format!("ridgelight, slot {number}");
            let timestamps = Timestamps::new(&self.host, &mut self.memory, &name, passes + 1)?;
            self.slots.push(Slot {
                sets: sets.to_vec(),
                tables: Vec::new(),
                is_current: false,
                timestamps,
                recorded: Vec::new(),
                times_passes: true,
            });
            // Tables made before one that fails are freed with their slot.
            for id in TABLES.into_iter().filter_map(|name| self.plan.find(name)) {
                let resource = &self.plan.resources[id.0];
                let table = self.memory.make(&resource.name, resource.kind, MemoryUse::Upload)?;
                self.slots[number].tables.push((id, table));
            }
        }
        Ok(())
    }

    pub(super) fn free(&mut self) {
        let unused = self.unused.drain(..).map(|(_, _, backed)| backed);
        for mut backed in self.resources.drain(..).flatten().chain(unused) {
            self.memory.free(&mut backed);
        }
        for mut slot in self.slots.drain(..) {
            slot.tables.iter_mut().for_each(|table| self.memory.free(&mut table.1));
            if let Some(timestamps) = slot.timestamps {
                timestamps.free(&self.host, &mut self.memory);
            }
        }
        // SAFETY: made by this device; the caller of `destroy` guarantees that nothing in flight uses it. Null is
        // allowed.
        unsafe { self.host.device.destroy_descriptor_pool(self.descriptor_pool, None) };
        std::mem::take(&mut self.pipelines).end(&self.host);
        self.memory.end();
    }
}

/// An image or buffer for a binding that a pass leaves unused.
fn smallest(kind: BindingKind) -> Kind {
    let image = |format, layered| Kind::Image { format, width: 1, height: 1, layers: 1, layered };
    match kind {
        BindingKind::StorageBuffer => Kind::Buffer { bytes: 16, texels: false },
        BindingKind::TexelBuffer => Kind::Buffer { bytes: 16, texels: true },
        BindingKind::SampledImage { uint: true, layered } => image(Format::R32Uint, layered),
        BindingKind::SampledImage { uint: false, layered } => image(Format::R32Float, layered),
        BindingKind::StorageImage { format, uint, layered } => {
            let all = [
                Format::R32Float,
                Format::Rgba16Float,
                Format::Rgba32Float,
                Format::R32Uint,
                Format::Rgba16Uint,
                Format::Rgba32Uint,
            ];
            let fitting = all.into_iter().find(|f| f.spirv() == format);
            image(fitting.unwrap_or(if uint { Format::R32Uint } else { Format::R32Float }), layered)
        }
    }
}

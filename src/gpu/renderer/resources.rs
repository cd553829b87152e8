//! What a renderer makes on the device when it is made, and gives back at its end.

use ash::vk;

use super::super::allocator::MemoryUse;
use super::super::failed;
use super::super::memory::Backed;
use super::super::pipelines::descriptor_type;
use super::super::shaders::BindingKind;
use super::{Renderer, Slot};
use crate::plan::{Format, Kind, Owner, ResourceId};
use crate::{Error, Result};

impl Renderer {
    pub(super) fn make(&mut self, slots: usize) -> Result<()> {
        self.pipeline_of_pass = self.pipelines.of(&self.host, self.plan.every_pass())?;
        let tables = ["azimuths", "constants"].map(|name| self.plan.find(name));
        for (i, resource) in self.plan.resources.iter().enumerate() {
            // Those that the host writes.
            let used_by = if tables.contains(&Some(ResourceId(i))) {
                MemoryUse::Upload
            } else {
                MemoryUse::Device
            };
            let backed = match resource.owner {
                Owner::Internal => {
                    Some(self.memory.make(&resource.name, resource.kind, used_by)?)
                }
                Owner::Input | Owner::Output => None,
            };
            self.resources.push(backed);
        }
        self.write_tables()?;
        // What a shader might write is its pass's alone: two passes that "write" one unused image
        // would need a barrier for nothing.
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

    /// What the host tells passes beside push constants.
    pub(super) fn write_tables(&mut self) -> Result<()> {
        let azimuths: &[u8] = bytemuck::cast_slice(&self.plan.azimuths);
        let constants: &[u8] = bytemuck::cast_slice(&self.plan.constants);
        for (name, bytes) in [("azimuths", azimuths), ("constants", constants)] {
            let Some(id) = self.plan.find(name) else { continue };
            let backed = self.resources[id.0].as_mut();
            let mapped = backed.and_then(Backed::mapped);
            let mapped = mapped.ok_or_else(|| Error::Device {
                doing: format!("writing the {name}"),
                reason: "the device has no memory that the host can write".into(),
            })?;
            mapped[..bytes.len()].copy_from_slice(bytes);
        }
        Ok(())
    }

    fn make_slots(&mut self, slots: usize) -> Result<()> {
        let device = &self.host.device;
        let mut sizes: Vec<vk::DescriptorPoolSize> = Vec::new();
        for binding in self.plan.every_pass().flat_map(|p| p.shader.bindings) {
            let ty = descriptor_type(binding.kind);
            match sizes.iter_mut().find(|s| s.ty == ty) {
                Some(size) => size.descriptor_count += slots as u32,
                None => sizes.push(vk::DescriptorPoolSize { ty, descriptor_count: slots as u32 }),
            }
        }
        let passes = self.plan.every_pass().count();
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets((slots * passes) as u32)
            .pool_sizes(&sizes);
        // SAFETY: the device is alive; a plan has at least one pass, a pass at least one binding.
        self.descriptor_pool = unsafe { device.create_descriptor_pool(&info, None) }
            .map_err(failed("making the descriptor pool"))?;
        self.host.name(self.descriptor_pool, "ridgelight");
        for number in 0..slots {
            let layouts: Vec<_> = self.pipeline_of_pass.iter().map(|p| p.set_layout).collect();
            let sets_info = vk::DescriptorSetAllocateInfo::default()
                .descriptor_pool(self.descriptor_pool)
                .set_layouts(&layouts);
            let queries_info = vk::QueryPoolCreateInfo::default()
                .query_type(vk::QueryType::TIMESTAMP)
                .query_count(passes as u32 + 1);
            // SAFETY: the pool was sized for exactly these sets; the layouts are alive.
            let slot = unsafe {
                device.allocate_descriptor_sets(&sets_info).and_then(|sets| {
                    let queries = match self.timestamps {
                        Some(_) => device.create_query_pool(&queries_info, None)?,
                        None => vk::QueryPool::null(),
                    };
                    Ok(Slot { sets, queries, recorded: Vec::new() })
                })
            };
            let slot = slot.map_err(failed("making a frame's descriptors"))?;
            for (pass, set) in self.plan.every_pass().zip(&slot.sets) {
                self.host.name(*set, &format!("{}, slot {number}", pass.label()));
            }
            if slot.queries != vk::QueryPool::null() {
                self.host.name(slot.queries, &format!("ridgelight, slot {number}"));
            }
            self.slots.push(slot);
        }
        Ok(())
    }

    pub(super) fn free(&mut self) {
        for mut backed in self.resources.drain(..).flatten() {
            self.memory.free(&mut backed);
        }
        for (_, _, mut backed) in self.unused.drain(..) {
            self.memory.free(&mut backed);
        }
        for slot in self.slots.drain(..) {
            // SAFETY: made by this device; the caller of `destroy` says that nothing in flight uses it.
            // Null is allowed.
            unsafe { self.host.device.destroy_query_pool(slot.queries, None) };
        }
        // SAFETY: as above; null is allowed.
        unsafe { self.host.device.destroy_descriptor_pool(self.descriptor_pool, None) };
        std::mem::take(&mut self.pipelines).end(&self.host);
        self.memory.end();
        self.destroyed = true;
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
                Format::Rgba32Float,
                Format::R32Uint,
                Format::Rg32Uint,
                Format::Rgba32Uint,
            ];
            let fitting = all.into_iter().find(|f| f.spirv() == format);
            image(fitting.unwrap_or(if uint { Format::R32Uint } else { Format::R32Float }), layered)
        }
    }
}

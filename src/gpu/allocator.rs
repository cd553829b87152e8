use std::collections::HashMap;
use std::ptr::NonNull;

use ash::vk;
use gpu_allocator::vulkan as blocks;
use gpu_allocator::{AllocationSizes, AllocatorDebugSettings, MemoryLocation};

use super::Host;
use crate::{Error, Result};

/// Block size for memory from the device; larger requests get memory of their own. It is the least that
/// gpu-allocator offers, so that the memory in use is close to a plan's.
const BLOCK_BYTES: u64 = 4 << 20;

/// Who reads and writes a piece of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryUse {
    /// The device only; device-local where available.
    Device,
    /// The host writes, the device reads: host-visible and host-coherent, mapped.
    Upload,
    /// The device writes, the host reads: host-visible and host-coherent, mapped; cached where available.
    Readback,
}

/// Requirements of an image or buffer.
#[derive(Clone, Copy, Debug)]
pub struct MemoryRequest<'a> {
    /// Name of the image or buffer, for debuggers and reports.
    pub name: &'a str,
    /// Size, alignment and permitted memory types, from the device.
    pub requirements: vk::MemoryRequirements,
    /// Who reads and writes it.
    pub used_by: MemoryUse,
    /// Whether it is a buffer. Else it is an image of optimal tiling, which `bufferImageGranularity` separates
    /// from buffers.
    pub is_linear: bool,
}

/// A piece of memory for one image or buffer.
#[derive(Debug)]
pub struct Allocation {
    /// The memory object.
    pub memory: vk::DeviceMemory,
    /// Offset of its first byte, in bytes.
    pub offset: u64,
    /// Host address of that byte; none for [`MemoryUse::Device`].
    pub mapped: Option<NonNull<u8>>,
    /// The allocator's own key, passed back to [`Allocator::free`].
    pub key: u64,
}

// SAFETY: the pointer is to device memory that only this value owns; it is bound to no thread.
unsafe impl Send for Allocation {}

/// Supplies memory for images and buffers: [`Blocks`], or an engine's own.
///
/// # Safety
/// `allocate` must return what was requested: one of the memory types, the alignment, at least the size, owned
/// by nobody else until it is freed, and mapped for as long unless it is for the device only.
pub unsafe trait Allocator: Send {
    /// Memory for one image or buffer.
    ///
    /// # Errors
    /// Out of memory.
    fn allocate(&mut self, request: &MemoryRequest<'_>) -> Result<Allocation>;

    /// Frees what `allocate` returned, after its image or buffer was destroyed.
    fn free(&mut self, allocation: Allocation);

    /// Bytes taken from the device, in use or not.
    fn bytes(&self) -> u64;
}

/// The default allocator: blocks of 4 MiB; larger requests get memory of their own.
pub struct Blocks {
    allocator: blocks::Allocator,
    given: HashMap<u64, blocks::Allocation>,
    next: u64,
}

impl Blocks {
    /// Allocates nothing yet.
    ///
    /// # Errors
    /// The device's.
    pub fn new(host: &Host) -> Result<Self> {
        let allocator = blocks::Allocator::new(&blocks::AllocatorCreateDesc {
            instance: host.instance.clone(),
            device: host.device.clone(),
            physical_device: host.physical_device,
            debug_settings: AllocatorDebugSettings::default(),
            buffer_device_address: false,
            allocation_sizes: AllocationSizes::new(BLOCK_BYTES, BLOCK_BYTES),
        });
        let allocator = allocator.map_err(|e| Error::Device {
            doing: "starting the allocator".into(),
            reason: e.to_string(),
        })?;
        Ok(Self { allocator, given: HashMap::new(), next: 0 })
    }
}

// SAFETY: gpu-allocator returns what was requested; pieces are kept in `given` until they are freed.
unsafe impl Allocator for Blocks {
    fn allocate(&mut self, request: &MemoryRequest<'_>) -> Result<Allocation> {
        let MemoryRequest { name, requirements, used_by, is_linear } = *request;
        let location = match used_by {
            MemoryUse::Device => MemoryLocation::GpuOnly,
            MemoryUse::Upload => MemoryLocation::CpuToGpu,
            MemoryUse::Readback => MemoryLocation::GpuToCpu,
        };
        let scheme = blocks::AllocationScheme::GpuAllocatorManaged;
        let piece = self.allocator.allocate(&blocks::AllocationCreateDesc {
            name,
            requirements,
            location,
            linear: is_linear,
            allocation_scheme: scheme,
        });
        let piece = piece.map_err(|e| Error::Device {
            doing: format!("allocating {} bytes for {name}", requirements.size),
            reason: e.to_string(),
        })?;
        self.next += 1;
        let allocation = Allocation {
            // SAFETY: freed only by `free`, after the image or buffer in it.
            memory: unsafe { piece.memory() },
            offset: piece.offset(),
            mapped: piece.mapped_ptr().map(NonNull::cast),
            key: self.next,
        };
        self.given.insert(self.next, piece);
        Ok(allocation)
    }

    fn free(&mut self, allocation: Allocation) {
        // Freeing a piece of this allocator cannot fail. If it did, memory is lost until the device is
        // destroyed.
        let _ = self.given.remove(&allocation.key).map(|piece| self.allocator.free(piece));
    }

    fn bytes(&self) -> u64 {
        self.allocator.capacity()
    }
}

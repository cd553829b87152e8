use std::collections::HashMap;
use std::ptr::NonNull;

use ash::vk;
use gpu_allocator::vulkan as blocks;
use gpu_allocator::{AllocationSizes, AllocatorDebugSettings, MemoryLocation};

use super::Host;
use crate::{Error, Result};

/// Memory is taken from the device in blocks of this size, and what is larger alone: the least that the
/// allocator offers, so that what is held is near what a plan says.
const BLOCK_BYTES: u64 = 4 << 20;

/// Who reads and writes a piece of memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryUse {
    /// The device alone: device-local where there is such memory.
    Device,
    /// The host writes, the device reads: host-visible and host-coherent, mapped.
    Upload,
    /// The device writes, the host reads: host-visible and host-coherent, mapped; cached where there is such.
    Readback,
}

/// What an image or buffer needs.
#[derive(Clone, Copy, Debug)]
pub struct MemoryRequest<'a> {
    /// Of the image or buffer, for debuggers and reports.
    pub name: &'a str,
    /// Size, alignment and the types of memory that will do, as the device says.
    pub requirements: vk::MemoryRequirements,
    /// Who reads and writes it.
    pub used_by: MemoryUse,
    /// A buffer; else an image of optimal tiling, which `bufferImageGranularity` keeps apart from buffers.
    pub is_linear: bool,
}

/// A piece of memory for one image or buffer.
#[derive(Debug)]
pub struct Allocation {
    /// The memory that it lies in.
    pub memory: vk::DeviceMemory,
    /// Its first byte there.
    pub offset: u64,
    /// Where the host sees that byte; none for [`MemoryUse::Device`], where nobody looks.
    pub mapped: Option<NonNull<u8>>,
    /// The allocator's own mark, handed back with [`Allocator::free`].
    pub key: u64,
}

// SAFETY: the pointer is to device memory that this value alone stands for; nothing of it is bound to a
// thread.
unsafe impl Send for Allocation {}

/// Where images and buffers get their memory: [`Blocks`], or an engine's own.
///
/// # Safety
/// What `allocate` returns is what the request asks for: of one of its types of memory, at its alignment, as
/// large, given to nobody else until it is freed, and mapped as long unless it is for the device alone.
pub unsafe trait Allocator: Send {
    /// Memory for one image or buffer.
    ///
    /// # Errors
    /// No such memory left.
    fn allocate(&mut self, request: &MemoryRequest<'_>) -> Result<Allocation>;

    /// Takes back what `allocate` returned; its image or buffer has been destroyed.
    fn free(&mut self, allocation: Allocation);

    /// Bytes that are held of the device: what is handed out, and what is kept besides.
    fn bytes(&self) -> u64;
}

/// The allocator of renderers that are given none: blocks of 4 MiB, and what is larger alone.
pub struct Blocks {
    allocator: blocks::Allocator,
    given: HashMap<u64, blocks::Allocation>,
    next: u64,
}

impl Blocks {
    /// Takes nothing from the device yet.
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

// SAFETY: gpu-allocator gives what is asked for; pieces are kept in `given` until they are freed.
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
            // SAFETY: freed only by `free`, after what lies there.
            memory: unsafe { piece.memory() },
            offset: piece.offset(),
            mapped: piece.mapped_ptr().map(NonNull::cast),
            key: self.next,
        };
        self.given.insert(self.next, piece);
        Ok(allocation)
    }

    fn free(&mut self, allocation: Allocation) {
        // Freeing a piece of this allocator cannot fail; if it did, memory is lost until the device goes.
        let _ = self.given.remove(&allocation.key).map(|piece| self.allocator.free(piece));
    }

    fn bytes(&self) -> u64 {
        self.allocator.capacity()
    }
}

use std::ffi::{CString, c_char, c_void};
use std::ptr::NonNull;

use ash::vk;
use ridgelight::gpu::{Allocation, Allocator, MemoryRequest, MemoryUse};
use ridgelight::{Error, Result};

use crate::read::SizeFirst;

/// Who reads and writes a piece of memory: the device only, device-local where available.
pub const RIDGELIGHT_MEMORY_DEVICE: u32 = 0;
/// The host writes, the device reads: host-visible, host-coherent, mapped.
pub const RIDGELIGHT_MEMORY_UPLOAD: u32 = 1;
/// The device writes, the host reads: host-visible, host-coherent, mapped.
pub const RIDGELIGHT_MEMORY_READBACK: u32 = 2;

/// Requirements of an image or buffer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightMemoryRequest {
    /// sizeof(RidgelightMemoryRequest).
    pub struct_size: u32,
    /// Who reads and writes it: RIDGELIGHT_MEMORY_DEVICE, _UPLOAD or _READBACK.
    pub used_by: u32,
    /// Name of the image or buffer; valid during the call.
    pub name: *const c_char,
    /// Size, alignment and permitted memory types.
    pub requirements: vk::MemoryRequirements,
    /// VK_TRUE for a buffer; else an image of optimal tiling, which bufferImageGranularity separates from
    /// buffers.
    pub is_linear: vk::Bool32,
}

/// A piece of memory for one image or buffer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightAllocation {
    /// The memory object.
    pub memory: vk::DeviceMemory,
    /// Offset of its first byte, in bytes.
    pub offset: u64,
    /// Host address of that byte; null for RIDGELIGHT_MEMORY_DEVICE.
    pub mapped: *mut c_void,
    /// The allocator's own key.
    pub key: u64,
}

/// An engine's own memory. It is called by the thread that makes, changes or destroys a renderer, one call at a
/// time.
///
/// `allocate` must return what was requested: one of the memory types, the alignment, at least the size, owned
/// by nobody else until `free`, and mapped for as long unless it is for the device only.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightAllocator {
    /// sizeof(RidgelightAllocator).
    pub struct_size: u32,
    /// Passed back with every call.
    pub user: *mut c_void,
    /// Fills `allocation`; VK_FALSE where no such memory is left.
    pub allocate: Option<
        unsafe extern "C" fn(
            user: *mut c_void,
            request: *const RidgelightMemoryRequest,
            allocation: *mut RidgelightAllocation,
        ) -> vk::Bool32,
    >,
    /// Frees what `allocate` returned, after its image or buffer was destroyed.
    pub free:
        Option<unsafe extern "C" fn(user: *mut c_void, allocation: *const RidgelightAllocation)>,
}

// SAFETY: pointers that may be null; the size is first.
unsafe impl SizeFirst for RidgelightAllocator {}

type Allocate = unsafe extern "C" fn(
    *mut c_void,
    *const RidgelightMemoryRequest,
    *mut RidgelightAllocation,
) -> vk::Bool32;
type Free = unsafe extern "C" fn(*mut c_void, *const RidgelightAllocation);

/// Adapts it to the library's own trait.
pub(crate) struct Callbacks {
    pub user: *mut c_void,
    pub allocate: Allocate,
    pub free: Free,
    /// Sizes of the pieces in use, by memory and offset.
    pub held: std::collections::HashMap<(vk::DeviceMemory, u64), u64>,
}

// SAFETY: calls come one at a time, by whichever thread has the renderer, as the header requires.
unsafe impl Send for Callbacks {}

// SAFETY: the header requires it of the caller.
unsafe impl Allocator for Callbacks {
    fn allocate(&mut self, request: &MemoryRequest<'_>) -> Result<Allocation> {
        let name = CString::new(request.name).unwrap_or_default();
        let requested = RidgelightMemoryRequest {
            struct_size: size_of::<RidgelightMemoryRequest>() as u32,
            used_by: match request.used_by {
                MemoryUse::Device => RIDGELIGHT_MEMORY_DEVICE,
                MemoryUse::Upload => RIDGELIGHT_MEMORY_UPLOAD,
                MemoryUse::Readback => RIDGELIGHT_MEMORY_READBACK,
            },
            name: name.as_ptr(),
            requirements: request.requirements,
            is_linear: vk::Bool32::from(request.is_linear),
        };
        let mut given = RidgelightAllocation {
            memory: vk::DeviceMemory::null(),
            offset: 0,
            mapped: std::ptr::null_mut(),
            key: 0,
        };
        // SAFETY: the caller's function; both structs live across the call.
        if unsafe { (self.allocate)(self.user, &requested, &mut given) } == vk::FALSE {
            return Err(Error::Device {
                doing: format!(
                    "allocating {} bytes for {}",
                    requested.requirements.size, request.name
                ),
                reason: "the allocator has no such memory".into(),
            });
        }
        self.held.insert((given.memory, given.offset), requested.requirements.size);
        let RidgelightAllocation { memory, offset, mapped, key } = given;
        Ok(Allocation { memory, offset, mapped: NonNull::new(mapped.cast()), key })
    }

    fn free(&mut self, allocation: Allocation) {
        let Allocation { memory, offset, mapped, key } = allocation;
        self.held.remove(&(memory, offset));
        let mapped = mapped.map_or(std::ptr::null_mut(), |m| m.as_ptr().cast());
        let given = RidgelightAllocation { memory, offset, mapped, key };
        // SAFETY: the caller's function; the struct lives across the call.
        unsafe { (self.free)(self.user, &given) };
    }

    fn bytes(&self) -> u64 {
        self.held.values().sum()
    }
}

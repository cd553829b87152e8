use std::ffi::{CString, c_char, c_void};
use std::ptr::NonNull;

use ash::vk;
use ridgelight::gpu::{Allocation, Allocator, MemoryRequest, MemoryUse};
use ridgelight::{Error, Result};

use crate::read::SizeFirst;

/// Who reads and writes a piece of memory: the device alone, device-local where there is such memory.
pub const RIDGELIGHT_MEMORY_DEVICE: u32 = 0;
/// The host writes, the device reads: host-visible, host-coherent, mapped.
pub const RIDGELIGHT_MEMORY_UPLOAD: u32 = 1;
/// The device writes, the host reads: host-visible, host-coherent, mapped.
pub const RIDGELIGHT_MEMORY_READBACK: u32 = 2;

/// What an image or buffer needs.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightMemoryRequest {
    /// sizeof(RidgelightMemoryRequest).
    pub struct_size: u32,
    /// Who reads and writes it: RIDGELIGHT_MEMORY_DEVICE, _UPLOAD or _READBACK.
    pub used_by: u32,
    /// Of the image or buffer; good during the call.
    pub name: *const c_char,
    /// Size, alignment and the types of memory that will do.
    pub requirements: vk::MemoryRequirements,
    /// VK_TRUE for a buffer; else an image of optimal tiling, which bufferImageGranularity keeps apart.
    pub is_linear: vk::Bool32,
}

/// A piece of memory for one image or buffer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightAllocation {
    /// The memory that it lies in.
    pub memory: vk::DeviceMemory,
    /// Its first byte there.
    pub offset: u64,
    /// Where the host sees that byte; null for RIDGELIGHT_MEMORY_DEVICE.
    pub mapped: *mut c_void,
    /// The allocator's own mark.
    pub key: u64,
}

/// An engine's own memory: called by the thread that makes, changes or destroys a renderer, one call at a time.
///
/// What `allocate` gives is what the request asks for: of one of its types of memory, at its alignment, as
/// large, nobody else's until `free`, and mapped as long unless it is for the device alone.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightAllocator {
    /// sizeof(RidgelightAllocator).
    pub struct_size: u32,
    /// Handed back with every call.
    pub user: *mut c_void,
    /// Fills `allocation`; VK_FALSE where there is no such memory left.
    pub allocate: Option<
        unsafe extern "C" fn(
            user: *mut c_void,
            request: *const RidgelightMemoryRequest,
            allocation: *mut RidgelightAllocation,
        ) -> vk::Bool32,
    >,
    /// Takes back what `allocate` gave: its image or buffer has been destroyed.
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

/// The same as the library's own trait.
pub(crate) struct Callbacks {
    pub user: *mut c_void,
    pub allocate: Allocate,
    pub free: Free,
    /// Sizes of what is held, by what they lie at.
    pub held: std::collections::HashMap<(vk::DeviceMemory, u64), u64>,
}

// SAFETY: calls come one at a time, by whichever thread has the renderer: the header says so.
unsafe impl Send for Callbacks {}

// SAFETY: the caller's word, in the header.
unsafe impl Allocator for Callbacks {
    fn allocate(&mut self, request: &MemoryRequest<'_>) -> Result<Allocation> {
        let name = CString::new(request.name).unwrap_or_default();
        let asked = RidgelightMemoryRequest {
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
        if unsafe { (self.allocate)(self.user, &asked, &mut given) } == vk::FALSE {
            return Err(Error::Device {
                doing: format!("allocating {} bytes for {}", asked.requirements.size, request.name),
                reason: "the allocator has no such memory".into(),
            });
        }
        self.held.insert((given.memory, given.offset), asked.requirements.size);
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

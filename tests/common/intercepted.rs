//! A device of which a test replaces one function.

use std::ffi::{CStr, c_void};

use ash::vk;
use ridgelight::gpu::Host;

/// The host's device with `function` in place of its own function of that name.
///
/// # Safety
/// `function` has the type of the Vulkan function `name`, and keeps what that one promises.
pub(crate) unsafe fn with_function(
    host: &Host,
    name: &CStr,
    function: *const c_void,
) -> ash::Device {
    let (real, handle) = (host.instance.fp_v1_0(), host.device.handle());
    // SAFETY: all functions are the device's own, except the caller's.
    unsafe {
        ash::Device::load_with(
            |wanted| {
                if wanted == name {
                    return function;
                }
                let own = (real.get_device_proc_addr)(handle, wanted.as_ptr());
                std::mem::transmute::<vk::PFN_vkVoidFunction, *const c_void>(own)
            },
            handle,
        )
    }
}

use ash::{ext, vk};
use ridgelight::gpu::{self, BufferArg, Host, ImageArg, ImageState, InputArg};
use ridgelight::plan::{Kind, Resource};

use crate::PFN_vkGetInstanceProcAddr;
use crate::errors::{Done, Failure, RidgelightResult, done};
use crate::read::{SizeFirst, read, write};

/// A borrowed device, never destroyed by Ridgelight: it must outlive every renderer made on it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightHost {
    /// sizeof(RidgelightHost).
    pub struct_size: u32,
    /// The family of the queue that runs the commands; it must support compute. Images of exclusive sharing
    /// belong to it before and after a recording.
    pub queue_family: u32,
    /// The instance of the device, for Vulkan 1.1 or higher.
    pub instance: vk::Instance,
    /// The physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device.
    pub device: vk::Device,
    /// The loader's vkGetInstanceProcAddr, through which all functions are loaded.
    pub get_instance_proc_addr: PFN_vkGetInstanceProcAddr,
    /// Cache for compiled pipelines, or null; not created as externally synchronised.
    pub pipeline_cache: vk::PipelineCache,
    /// VK_TRUE where the instance has VK_EXT_debug_utils enabled: for names and labels.
    pub debug_utils: vk::Bool32,
}

// SAFETY: handles and pointers may be null; the size is first.
unsafe impl SizeFirst for RidgelightHost {}

/// The host that a struct describes.
///
/// # Safety
/// As [`read`]; its handles are alive, and belong together.
pub(crate) unsafe fn host(from: *const RidgelightHost) -> Done<Host> {
    // SAFETY: as the caller says.
    let host = unsafe { read(from, "host") }?;
    let null = |name: &str| Failure::argument(&format!("host: {name}"), "null", "a handle");
    if host.instance == vk::Instance::null() {
        return Err(null("instance"));
    }
    if host.physical_device == vk::PhysicalDevice::null() {
        return Err(null("physical_device"));
    }
    if host.device == vk::Device::null() {
        return Err(null("device"));
    }
    let get = host.get_instance_proc_addr.ok_or_else(|| null("get_instance_proc_addr"))?;
    // SAFETY: the loader's own function, and handles that the caller guarantees are alive.
    unsafe {
        let entry = ash::StaticFn { get_instance_proc_addr: get };
        let instance = ash::Instance::load(&entry, host.instance);
        let device = ash::Device::load(instance.fp_v1_0(), host.device);
        let is_named = host.debug_utils != vk::FALSE;
        let debug_utils = is_named.then(|| ext::debug_utils::Device::new(&instance, &device));
        Ok(Host {
            instance,
            physical_device: host.physical_device,
            device,
            queue_family: host.queue_family,
            pipeline_cache: host.pipeline_cache,
            debug_utils,
        })
    }
}

/// What a device needs. No extension or feature has to be enabled on the instance or the device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightRequirements {
    /// sizeof(RidgelightRequirements).
    pub struct_size: u32,
    /// The Vulkan version of instance and device, and the instance's apiVersion.
    pub api_version: u32,
    /// Capabilities of the queue's family.
    pub queue_flags: vk::QueueFlags,
}

// SAFETY: numbers; the size is first.
unsafe impl SizeFirst for RidgelightRequirements {}

/// Writes what Ridgelight needs from a device. Call it before the device exists.
///
/// Returns OK, or ARGUMENT.
///
/// # Safety
/// `requirements` is null or points to a struct whose struct_size is set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_requirements(
    requirements: *mut RidgelightRequirements,
) -> RidgelightResult {
    done(|| {
        let needs = gpu::requirements();
        let value = RidgelightRequirements {
            struct_size: 0,
            api_version: needs.api_version,
            queue_flags: needs.queue_flags,
        };
        // SAFETY: as the caller says.
        unsafe { write(requirements, &value, "requirements") }
    })
}

/// Whether a physical device is suitable. Call it before the VkDevice exists.
///
/// Returns OK; DEVICE where it lacks something, which ridgelight_last_error names; ARGUMENT.
///
/// # Safety
/// `get_instance_proc_addr` is the loader's, the others are of its instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn ridgelight_check_device(
    get_instance_proc_addr: PFN_vkGetInstanceProcAddr,
    instance: vk::Instance,
    physical_device: vk::PhysicalDevice,
) -> RidgelightResult {
    done(|| {
        let null = |name| Failure::argument(name, "null", "a handle");
        let get = get_instance_proc_addr.ok_or_else(|| null("get_instance_proc_addr"))?;
        if instance == vk::Instance::null() || physical_device == vk::PhysicalDevice::null() {
            return Err(null("instance or physical_device"));
        }
        let entry = ash::StaticFn { get_instance_proc_addr: get };
        // SAFETY: the loader's own function, and an instance that the caller guarantees is alive.
        let instance = unsafe { ash::Instance::load(&entry, instance) };
        let missing = gpu::missing(&instance, physical_device);
        if missing.is_empty() {
            return Ok(());
        }
        let sentence = format!("the device lacks {}", missing.join(", "));
        Err(Failure(RidgelightResult::Device, sentence))
    })
}

/// The use of an image at a point of a command buffer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightImageState {
    /// Stages of its last or next use.
    pub stage: vk::PipelineStageFlags2,
    /// Accesses of its last or next use.
    pub access: vk::AccessFlags2,
    /// Its layout. VK_IMAGE_LAYOUT_UNDEFINED is allowed for outputs before a recording: their contents are not
    /// kept.
    pub layout: vk::ImageLayout,
}

impl RidgelightImageState {
    fn of(state: ImageState) -> Self {
        Self { stage: state.stage, access: state.access, layout: state.layout }
    }

    fn state(self) -> ImageState {
        ImageState { stage: self.stage, access: self.access, layout: self.layout }
    }
}

/// A caller's image for one recording: its mip level 0, array layers from 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightImage {
    /// sizeof(RidgelightImage).
    pub struct_size: u32,
    /// Its format, 0: the plan's. Heights may be R32F, R16F or R16_UNORM (0 to 1: cells and lights are then in
    /// units of the range); environment, albedo and light colours RGBA32F, RGBA16F, RGBA8 UNORM or SRGB;
    /// outputs have the plan's.
    pub format: vk::Format,
    /// The image: of usage SAMPLED for an input, STORAGE and SAMPLED for an output.
    pub image: vk::Image,
    /// A view of its colour aspect, 2D.
    pub view: vk::ImageView,
    /// Columns, rows and layers; 0, 0, 0 or the plan's.
    pub extent: [u32; 3],
    /// State before the recording.
    pub before: RidgelightImageState,
    /// State after the recording. Ignored for inputs, which are left as before.
    pub after: RidgelightImageState,
    /// Replaces image and view for an input of ridgelight_plan_take_buffer: its texels, row after row, of usage
    /// TRANSFER_SRC. Only stage and access of `before` are used; it is left in that use.
    pub buffer: vk::Buffer,
    /// Size of the buffer, bytes: nothing beyond is read.
    pub buffer_bytes: u64,
    /// Offset of the first texel, bytes: a multiple of the texel size.
    pub buffer_offset: u64,
    /// Distance between the starts of rows, bytes: a multiple of the texel size, less than 2^31. 0: rows are
    /// consecutive.
    pub row_bytes: u64,
}

// SAFETY: numbers and handles, which are checked for null; the size is first.
unsafe impl SizeFirst for RidgelightImage {}

impl RidgelightImage {
    /// An image argument as a C struct.
    pub(crate) fn of(arg: &ImageArg) -> Self {
        Self {
            struct_size: 0,
            format: arg.format,
            image: arg.image,
            view: arg.view,
            extent: arg.extent,
            before: RidgelightImageState::of(arg.before),
            after: RidgelightImageState::of(arg.after),
            buffer: vk::Buffer::null(),
            buffer_bytes: 0,
            buffer_offset: 0,
            row_bytes: 0,
        }
    }

    /// As an input: a buffer, where there is one.
    pub(crate) fn input(self, resource: Option<&Resource>) -> InputArg {
        if self.buffer == vk::Buffer::null() {
            return self.arg(resource).into();
        }
        BufferArg {
            buffer: self.buffer,
            bytes: self.buffer_bytes,
            offset: self.buffer_offset,
            row_bytes: self.row_bytes,
            stage: self.before.stage,
            access: self.before.access,
        }
        .into()
    }

    /// As an image; fields of 0 are taken from `resource`.
    pub(crate) fn arg(self, resource: Option<&Resource>) -> ImageArg {
        let mut arg = ImageArg {
            image: self.image,
            view: self.view,
            format: self.format,
            extent: self.extent,
            before: self.before.state(),
            after: self.after.state(),
        };
        let kind = resource.map(|r| r.kind);
        if let Some(Kind::Image { format, width, height, layers, .. }) = kind {
            if self.format == vk::Format::UNDEFINED {
                arg.format = format.vk();
            }
            if self.extent == [0; 3] {
                arg.extent = [width, height, layers];
            }
        }
        arg
    }
}

use ash::{ext, vk};
use ridgelight::gpu::{self, BufferArg, Host, ImageArg, ImageState, InputArg};
use ridgelight::plan::{Kind, Resource};

use crate::PFN_vkGetInstanceProcAddr;
use crate::errors::{Done, Failure, RidgelightResult, done};
use crate::read::{SizeFirst, read, write};

/// A device that is borrowed, never destroyed: it outlives every renderer made on it.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightHost {
    /// sizeof(RidgelightHost).
    pub struct_size: u32,
    /// The family of the queue that commands go to: it offers compute. Images of exclusive sharing belong to it
    /// when a recording runs, and still do afterwards.
    pub queue_family: u32,
    /// The instance that the device came from, for Vulkan 1.3.
    pub instance: vk::Instance,
    /// Its physical device.
    pub physical_device: vk::PhysicalDevice,
    /// The device, with what ridgelight_requirements asks for enabled.
    pub device: vk::Device,
    /// The loader's vkGetInstanceProcAddr: all functions are looked up through it.
    pub get_instance_proc_addr: PFN_vkGetInstanceProcAddr,
    /// Where compiled pipelines are looked for and kept, or null; not created as externally synchronised.
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
    // SAFETY: the loader's own function, and handles that the caller says are alive.
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

/// What a device must be made with. No extension, of instance or device.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightRequirements {
    /// sizeof(RidgelightRequirements).
    pub struct_size: u32,
    /// The Vulkan version of instance and device, and the apiVersion that the instance is made for.
    pub api_version: u32,
    /// What the family of the queue must offer.
    pub queue_flags: vk::QueueFlags,
    /// Core features to enable.
    pub features: vk::PhysicalDeviceFeatures,
    /// Features of Vulkan 1.2 to enable: chain it, pNext is null.
    pub features12: vk::PhysicalDeviceVulkan12Features<'static>,
    /// Features of Vulkan 1.3 to enable: chain it, pNext is null.
    pub features13: vk::PhysicalDeviceVulkan13Features<'static>,
}

// SAFETY: numbers, and pointers that may be null; the size is first.
unsafe impl SizeFirst for RidgelightRequirements {}

/// Writes what a device must be made with, beside what its engine wants itself: before there is one.
///
/// Returns OK, or ARGUMENT.
///
/// # Safety
/// `requirements` is null or points at a struct whose struct_size is set.
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
            features: needs.features,
            features12: needs.features12,
            features13: needs.features13,
        };
        // SAFETY: as the caller says.
        unsafe { write(requirements, &value, "requirements") }
    })
}

/// Whether a device will do: before one is made, so that `device` may be anything.
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
        // SAFETY: the loader's own function, and an instance that the caller says is alive.
        let instance = unsafe { ash::Instance::load(&entry, instance) };
        let missing = gpu::missing(&instance, physical_device);
        if missing.is_empty() {
            return Ok(());
        }
        let sentence = format!("the device lacks {}", missing.join(", "));
        Err(Failure(RidgelightResult::Device, sentence))
    })
}

/// What an image is being used for at a point of a command buffer.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightImageState {
    /// Stages that used it last, or will next.
    pub stage: vk::PipelineStageFlags2,
    /// How they did, or will.
    pub access: vk::AccessFlags2,
    /// Its layout. VK_IMAGE_LAYOUT_UNDEFINED is allowed for outputs on entry: their contents are not kept.
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

/// An image of the caller's, handed in for one recording: its mip level 0, array layers from 0.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct RidgelightImage {
    /// sizeof(RidgelightImage).
    pub struct_size: u32,
    /// Its format, 0: the plan's. Heights may be R32F, R16F or R16_UNORM (0 to 1: cells and lights are told in
    /// units of the range); environment, albedo and colours of lights RGBA32F, RGBA16F, RGBA8 UNORM or SRGB; outputs are
    /// the plan's.
    pub format: vk::Format,
    /// The image: of usage SAMPLED for an input, STORAGE for an output.
    pub image: vk::Image,
    /// A view of its colour, 2D.
    pub view: vk::ImageView,
    /// Columns, rows and layers; 0, 0, 0: the plan's, which they must be.
    pub extent: [u32; 3],
    /// How it comes.
    pub before: RidgelightImageState,
    /// How it is left. Inputs are left as they came, whatever stands here.
    pub after: RidgelightImageState,
    /// Instead of image and view, for an input that ridgelight_plan_take_buffer said it of: its texels, row after
    /// row, of usage TRANSFER_SRC. Of `before` stage and access count; it is left so.
    pub buffer: vk::Buffer,
    /// How long all of the buffer is, bytes: nothing beyond is read.
    pub buffer_bytes: u64,
    /// Where its first texel stands, bytes: whole texels.
    pub buffer_offset: u64,
    /// From a row's begin to the next one's, bytes: whole texels, less than 2^31. 0: rows follow one another.
    pub row_bytes: u64,
}

// SAFETY: numbers and handles, which are checked for null; the size is first.
unsafe impl SizeFirst for RidgelightImage {}

impl RidgelightImage {
    /// What C is told of an image.
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

    /// The same of what is read: a buffer, where there is one.
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

    /// What fields of 0 leave to the plan is `resource`'s.
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

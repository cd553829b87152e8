use std::ffi::CStr;

use ash::vk;

use super::Host;
use super::shaders::{self, BindingKind, Shader};
use crate::graph::{Format, GPU_LOOKUPS, Limits, SweepForm};
use crate::{Error, Result};

/// Properties of a device.
#[derive(Clone, Debug)]
pub struct DeviceReport {
    /// Its name.
    pub name: String,
    /// The driver's name and version.
    pub driver: String,
    /// Vulkan version, as "1.3.230".
    pub api: String,
    /// "cpu", "discrete gpu" and so on.
    pub kind: &'static str,
    /// Limits for a plan, as of [`limits`].
    pub limits: Limits,
    /// Subgroup size, in invocations.
    pub subgroup_size: u32,
    /// Nanoseconds per timestamp tick; 0 where timestamps do not work.
    pub timestamp_period_ns: f32,
    /// Requirements that the device lacks; empty where Ridgelight will run.
    pub missing: Vec<String>,
}

/// What to enable when a device is made; known beforehand. No extension, of instance or device.
#[derive(Clone, Copy, Debug)]
pub struct Requirements {
    /// Vulkan version of instance and device; the instance must be created for it.
    pub api_version: u32,
    /// Core features to enable.
    pub features: vk::PhysicalDeviceFeatures,
    /// Features of Vulkan 1.2 to enable.
    pub features12: vk::PhysicalDeviceVulkan12Features<'static>,
    /// Features of Vulkan 1.3 to enable.
    pub features13: vk::PhysicalDeviceVulkan13Features<'static>,
    /// Capabilities of the queue's family.
    pub queue_flags: vk::QueueFlags,
}

/// What an engine enables when it makes its device, besides its own needs: Vulkan 1.3 with `synchronization2`
/// and `hostQueryReset`, `shaderStorageImageWriteWithoutFormat`, `shaderStorageImageExtendedFormats`, and a
/// queue with compute. [`missing`] reports whether a device has it, and subgroup votes in compute shaders.
pub fn requirements() -> Requirements {
    Requirements {
        api_version: vk::API_VERSION_1_3,
        features: vk::PhysicalDeviceFeatures::default()
            .shader_storage_image_write_without_format(true)
            .shader_storage_image_extended_formats(true),
        features12: vk::PhysicalDeviceVulkan12Features::default().host_query_reset(true),
        features13: vk::PhysicalDeviceVulkan13Features::default().synchronization2(true),
        queue_flags: vk::QueueFlags::COMPUTE,
    }
}

/// What a device lacks, by name: of the [`requirements`], subgroup votes in compute shaders, and enough storage
/// images per shader. Empty where Ridgelight will run.
pub fn missing(instance: &ash::Instance, physical_device: vk::PhysicalDevice) -> Vec<String> {
    report(instance, physical_device).missing
}

/// Limits for a plan; `memory_budget` is half of the largest device-local heap, and all of it on a
/// software driver, whose heap is a number and no memory that others use.
pub fn limits(instance: &ash::Instance, physical_device: vk::PhysicalDevice) -> Limits {
    report(instance, physical_device).limits
}

/// What is missing where the host's instance was created for a version below 1.3.
const NEWER_INSTANCE: &str = "an instance created with VkApplicationInfo::apiVersion 1.3 or higher";

/// Whether the instance has vkGetPhysicalDeviceProperties2 and vkGetPhysicalDeviceFeatures2. A loader may withhold
/// them from an instance below Vulkan 1.1; ash then has functions of its own in their place, which panic.
fn has_queries2(instance: &ash::Instance) -> bool {
    let absent = ash::InstanceFnV1_1::load(|_| std::ptr::null());
    let own = instance.fp_v1_1();
    let addresses = |of: &ash::InstanceFnV1_1| {
        [of.get_physical_device_properties2 as usize, of.get_physical_device_features2 as usize]
    };
    addresses(own).iter().zip(addresses(&absent)).all(|(own, absent)| *own != absent)
}

/// Checks that the host's device has the functions of Vulkan 1.2 and 1.3 that a renderer calls. A driver withholds
/// them where the instance was created for a lower version, even if the device supports 1.3.
///
/// # Errors
/// The first function that is missing, and the cause.
pub(super) fn check_functions(host: &Host) -> Result<()> {
    let names = [c"vkResetQueryPool", c"vkCmdPipelineBarrier2", c"vkCmdWriteTimestamp2"];
    let is_missing = |name: &&CStr| {
        let (get, device) = (host.instance.fp_v1_0().get_device_proc_addr, host.device.handle());
        // SAFETY: the device is the instance's and alive; the name is nul-terminated.
        unsafe { get(device, name.as_ptr()) }.is_none()
    };
    let Some(name) = names.into_iter().find(|name| is_missing(name)) else { return Ok(()) };
    Err(Error::Device {
        doing: "making a renderer".into(),
        reason: format!("the device has no {}: it needs {NEWER_INSTANCE}", name.to_string_lossy()),
    })
}

/// Checks that the host's queue family exists and has a capability; returns all its capabilities.
///
/// # Errors
/// A family that the device does not have, or one without the capability, by number.
pub(super) fn family_flags(host: &Host, needed: vk::QueueFlags) -> Result<vk::QueueFlags> {
    // SAFETY: the physical device is the instance's.
    let families =
        unsafe { host.instance.get_physical_device_queue_family_properties(host.physical_device) };
    let wrong =
        |found: String, expected| Err(Error::setting("host: queue_family", found, expected));
    let index = host.queue_family;
    let Some(family) = families.get(index as usize) else {
        let expected =
            format!("an index below {}, the device's number of queue families", families.len());
        return wrong(index.to_string(), expected);
    };
    if family.queue_flags.contains(needed) {
        return Ok(family.queue_flags);
    }
    let all = families.iter().enumerate().filter(|(_, f)| f.queue_flags.contains(needed));
    let all: Vec<_> = all.map(|(i, _)| i.to_string()).collect();
    let others = if all.is_empty() { "the device has none".into() } else { all.join(" or ") };
    let found = format!("{index}, a family with {:?}", family.queue_flags);
    wrong(found, format!("a family with {needed:?}: {others}"))
}

/// Nanoseconds per timestamp tick, and the valid bits; none where the host's queue family has no timestamps.
pub(crate) fn timestamps(host: &Host) -> Option<(f64, u32)> {
    // SAFETY: the physical device is the instance's.
    let (families, properties) = unsafe {
        (
            host.instance.get_physical_device_queue_family_properties(host.physical_device),
            host.instance.get_physical_device_properties(host.physical_device),
        )
    };
    let bits = families.get(host.queue_family as usize)?.timestamp_valid_bits;
    (bits > 0).then(|| (f64::from(properties.limits.timestamp_period), bits))
}

/// The formats for inputs that the device can sample.
pub(crate) fn readable(host: &Host) -> Vec<vk::Format> {
    let is_readable = |format: &vk::Format| {
        // SAFETY: the physical device is the instance's.
        let properties = unsafe {
            host.instance.get_physical_device_format_properties(host.physical_device, *format)
        };
        properties.optimal_tiling_features.contains(vk::FormatFeatureFlags::SAMPLED_IMAGE)
    };
    let all = [Format::R32Float, Format::Rgba32Float].into_iter().flat_map(Format::vk_read);
    all.copied().filter(is_readable).collect()
}

pub(crate) fn report(
    instance: &ash::Instance,
    physical_device: vk::PhysicalDevice,
) -> DeviceReport {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut subgroups = vk::PhysicalDeviceSubgroupProperties::default();
    let mut maintenance = vk::PhysicalDeviceMaintenance3Properties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default()
        .push_next(&mut driver)
        .push_next(&mut subgroups)
        .push_next(&mut maintenance);
    let has_queries2 = has_queries2(instance);
    if has_queries2 {
        // SAFETY: the physical device is the instance's; the chained structs live across the call.
        unsafe { instance.get_physical_device_properties2(physical_device, &mut properties) };
    } else {
        // SAFETY: as above.
        properties.properties = unsafe { instance.get_physical_device_properties(physical_device) };
    }
    let core = properties.properties;
    let is_13 = core.api_version >= vk::API_VERSION_1_3;
    let mut features12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut features13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut features = vk::PhysicalDeviceFeatures2::default();
    if is_13 {
        features = features.push_next(&mut features12).push_next(&mut features13);
    }
    if has_queries2 {
        // SAFETY: as above; the structs of 1.2 and 1.3 are chained only where the device supports them.
        unsafe { instance.get_physical_device_features2(physical_device, &mut features) };
    } else {
        // SAFETY: as above.
        features.features = unsafe { instance.get_physical_device_features(physical_device) };
    }
    let core_features = features.features;
    // SAFETY: the physical device is the instance's.
    let (memory, families) = unsafe {
        (
            instance.get_physical_device_memory_properties(physical_device),
            instance.get_physical_device_queue_family_properties(physical_device),
        )
    };
    let compute = families.iter().find(|f| f.queue_flags.contains(vk::QueueFlags::COMPUTE));
    let mut missing = Vec::new();
    let mut need = |has: bool, what: &str| {
        if !has {
            missing.push(what.to_owned());
        }
    };
    need(is_13, "Vulkan 1.3");
    // Every device of Vulkan 1.3 has both features. Where it reports neither, the instance hides them.
    let is_hidden = is_13
        && features13.synchronization2 == vk::FALSE
        && features12.host_query_reset == vk::FALSE;
    need(!is_hidden, NEWER_INSTANCE);
    need(is_hidden || features13.synchronization2 == vk::TRUE, "synchronization2");
    need(is_hidden || features12.host_query_reset == vk::TRUE, "hostQueryReset");
    need(
        core_features.shader_storage_image_write_without_format == vk::TRUE,
        "shaderStorageImageWriteWithoutFormat",
    );
    need(
        core_features.shader_storage_image_extended_formats == vk::TRUE,
        "shaderStorageImageExtendedFormats",
    );
    need(
        is_hidden
            || subgroups.supported_operations.contains(vk::SubgroupFeatureFlags::VOTE)
                && subgroups.supported_stages.contains(vk::ShaderStageFlags::COMPUTE),
        "subgroup votes in compute shaders",
    );
    let storage_images = |shader: &Shader| {
        let kinds = shader.bindings.iter().map(|b| b.kind);
        kinds.filter(|kind| matches!(kind, BindingKind::StorageImage { .. })).count() as u32
    };
    let most = shaders::ALL.iter().map(storage_images).max().unwrap_or(0);
    need(
        core.limits.max_per_stage_descriptor_storage_images >= most,
        &format!("{most} storage images in a shader"),
    );
    need(compute.is_some(), "a queue family with compute");
    let heaps = &memory.memory_heaps[..memory.memory_heap_count as usize];
    let local = heaps.iter().filter(|h| h.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL));
    let heap = local.map(|h| h.size).max().unwrap_or(0);
    let is_cpu = core.device_type == vk::PhysicalDeviceType::CPU;
    let is_swiftshader = driver.driver_id == vk::DriverId::GOOGLE_SWIFTSHADER;
    let sweep = SweepForm::of_device(is_cpu, is_swiftshader);
    let text = |bytes: &CStr| bytes.to_string_lossy().into_owned();
    let version = core.api_version;
    DeviceReport {
        name: core.device_name_as_c_str().map(text).unwrap_or_default(),
        driver: [driver.driver_name_as_c_str(), driver.driver_info_as_c_str()]
            .map(|s| s.map(text).unwrap_or_default())
            .join(" ")
            .trim()
            .to_owned(),
        api: format!(
            "{}.{}.{}",
            vk::api_version_major(version),
            vk::api_version_minor(version),
            vk::api_version_patch(version)
        ),
        kind: match core.device_type {
            vk::PhysicalDeviceType::CPU => "cpu",
            vk::PhysicalDeviceType::DISCRETE_GPU => "discrete gpu",
            vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated gpu",
            vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual gpu",
            _ => "other",
        },
        limits: Limits {
            image_side: core.limits.max_image_dimension2_d,
            image_layers: core.limits.max_image_array_layers,
            buffer_bytes: u64::from(core.limits.max_storage_buffer_range),
            // An instance below Vulkan 1.1 hides it; 2^30 is the least that Vulkan allows.
            allocation_bytes: maintenance.max_memory_allocation_size.max(1 << 30),
            groups: core.limits.max_compute_work_group_count.into_iter().min().unwrap_or(0),
            texels: core.limits.max_texel_buffer_elements,
            shared_bytes: core.limits.max_compute_shared_memory_size,
            is_cpu,
            lookups: if is_cpu { u64::MAX } else { GPU_LOOKUPS },
            memory_budget: if is_cpu { heap } else { heap / 2 },
            sweep,
            untuned_sweep: sweep,
        },
        subgroup_size: subgroups.subgroup_size,
        timestamp_period_ns: if compute.is_some_and(|f| f.timestamp_valid_bits > 0) {
            core.limits.timestamp_period
        } else {
            0.0
        },
        missing,
    }
}

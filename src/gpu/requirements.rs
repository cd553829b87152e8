use std::ffi::CStr;

use ash::vk;

use super::shaders::{self, BindingKind, Shader};
use crate::plan::Limits;

/// What one device offers.
#[derive(Clone, Debug)]
pub struct DeviceReport {
    /// Its name.
    pub name: String,
    /// Its driver's name and version.
    pub driver: String,
    /// Vulkan version, as "1.3.230".
    pub api: String,
    /// "cpu", "discrete gpu" and so on.
    pub kind: &'static str,
    /// What a plan may count on; the memory budget is half of the largest device-local heap.
    pub limits: Limits,
    /// Invocations that run in step.
    pub subgroup_size: u32,
    /// Nanoseconds of a timestamp's tick; 0 where timestamps do not work.
    pub timestamp_period_ns: f32,
    /// What Ridgelight needs and the device lacks; empty where it will run.
    pub missing: Vec<String>,
}

/// What a device lacks: the features that its maker must enable are those named here.
///
/// Vulkan 1.3 with `synchronization2` (1.3 features); `shaderStorageImageWriteWithoutFormat` and
/// `shaderStorageImageExtendedFormats` (core features); subgroup votes in compute shaders; as many
/// storage images in a shader as one has; a queue family with compute.
pub fn missing(instance: &ash::Instance, physical_device: vk::PhysicalDevice) -> Vec<String> {
    report(instance, physical_device).missing
}

/// What a plan may count on; `memory_budget` is half of the largest device-local heap.
pub fn limits(instance: &ash::Instance, physical_device: vk::PhysicalDevice) -> Limits {
    report(instance, physical_device).limits
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
    // SAFETY: the physical device is the instance's; the chained structs live across the call.
    unsafe { instance.get_physical_device_properties2(physical_device, &mut properties) };
    let core = properties.properties;
    let is_13 = core.api_version >= vk::API_VERSION_1_3;
    let mut features13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut features = vk::PhysicalDeviceFeatures2::default();
    if is_13 {
        features = features.push_next(&mut features13);
    }
    // SAFETY: as above; the 1.3 struct is chained only where the device knows it.
    unsafe { instance.get_physical_device_features2(physical_device, &mut features) };
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
    need(features13.synchronization2 == vk::TRUE, "synchronization2");
    need(
        core_features.shader_storage_image_write_without_format == vk::TRUE,
        "shaderStorageImageWriteWithoutFormat",
    );
    need(
        core_features.shader_storage_image_extended_formats == vk::TRUE,
        "shaderStorageImageExtendedFormats",
    );
    need(
        subgroups.supported_operations.contains(vk::SubgroupFeatureFlags::VOTE)
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
            allocation_bytes: maintenance.max_memory_allocation_size,
            groups: core.limits.max_compute_work_group_count.into_iter().min().unwrap_or(0),
            texels: core.limits.max_texel_buffer_elements,
            shared_bytes: core.limits.max_compute_shared_memory_size,
            is_cpu: core.device_type == vk::PhysicalDeviceType::CPU,
            memory_budget: heap / 2,
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

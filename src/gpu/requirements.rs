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

/// What a device needs; known beforehand. No extension or feature has to be enabled on the instance or the device.
#[derive(Clone, Copy, Debug)]
pub struct Requirements {
    /// Vulkan version of instance and device; the instance must be created for it or a higher one.
    pub api_version: u32,
    /// Capabilities of the queue's family.
    pub queue_flags: vk::QueueFlags,
}

/// What Ridgelight needs from a device: Vulkan 1.1 and a queue with compute. [`missing`] also checks subgroup votes in
/// compute shaders, which not every device has.
pub fn requirements() -> Requirements {
    Requirements { api_version: vk::API_VERSION_1_1, queue_flags: vk::QueueFlags::COMPUTE }
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

/// What is missing where the host's instance was created for a version below 1.1.
const NEWER_INSTANCE: &str = "an instance created with VkApplicationInfo::apiVersion 1.1 or higher";

/// Whether the instance has vkGetPhysicalDeviceProperties2. A loader may withhold it from an instance below Vulkan 1.1;
/// ash then has a function of its own in its place, which panics.
fn has_queries2(instance: &ash::Instance) -> bool {
    let absent = ash::InstanceFnV1_1::load(|_| std::ptr::null());
    let address = |of: &ash::InstanceFnV1_1| of.get_physical_device_properties2 as usize;
    address(instance.fp_v1_1()) != address(&absent)
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
        .push_next(&mut subgroups)
        .push_next(&mut maintenance);
    // Of Vulkan 1.2, or of an extension that need not be enabled.
    // SAFETY: the physical device is the instance's.
    let known = unsafe { instance.enumerate_device_extension_properties(physical_device) };
    let name = ash::khr::driver_properties::NAME;
    if known.iter().flatten().any(|e| e.extension_name_as_c_str() == Ok(name)) {
        properties = properties.push_next(&mut driver);
    }
    let has_queries2 = has_queries2(instance);
    if has_queries2 {
        // SAFETY: the physical device is the instance's; the chained structs live across the call.
        unsafe { instance.get_physical_device_properties2(physical_device, &mut properties) };
    } else {
        // SAFETY: as above.
        properties.properties = unsafe { instance.get_physical_device_properties(physical_device) };
    }
    let core = properties.properties;
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
    let is_11 = core.api_version >= vk::API_VERSION_1_1;
    need(is_11, "Vulkan 1.1");
    // An instance below Vulkan 1.1 may hide the properties of subgroups, whose size is never 0.
    let is_hidden = is_11 && subgroups.subgroup_size == 0;
    need(!is_hidden, NEWER_INSTANCE);
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
            group_invocations: core.limits.max_compute_work_group_invocations,
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

#[cfg(test)]
mod tests {
    use crate::graph::shaders;

    /// Capabilities that every device of Vulkan 1.1 has, and those of subgroup votes, which [`missing`](super::missing)
    /// checks: the table "SPIR-V Capabilities" of the Vulkan specification.
    const ALLOWED: [(u32, &str); 5] = [
        (1, "Shader"),
        (46, "SampledBuffer"),
        (50, "ImageQuery"),
        (61, "GroupNonUniform"),
        (62, "GroupNonUniformVote"),
    ];

    /// No shader needs a feature, such as shaderStorageImageWriteWithoutFormat or
    /// shaderStorageImageExtendedFormats, and all are of SPIR-V 1.3.
    #[test]
    fn shaders_need_no_feature() {
        let mut found = Vec::new();
        for shader in shaders::ALL.iter().chain(shaders::GRAPHICS) {
            assert!(shader.words[1] <= 0x1_0300, "{}: version {:x}", shader.name, shader.words[1]);
            let mut rest = &shader.words[5..];
            // OpCapability: first of all instructions.
            while let [first, capability, ..] = rest
                && first & 0xffff == 17
            {
                let is_allowed = ALLOWED.iter().any(|(number, _)| number == capability);
                assert!(is_allowed, "{}: capability {capability}", shader.name);
                found.push(*capability);
                rest = &rest[2..];
            }
        }
        for (number, name) in ALLOWED {
            assert!(found.contains(&number), "no shader has {name}");
        }
    }
}

//! Hosts that a renderer refuses, with the cause that the host can fix.

use ash::vk;
use ridgelight::Result;
use ridgelight::gpu::{self, BufferArg, Host, ImageArg, ImageState, Renderer, ViewRenderer};
use ridgelight::plan::{self, Picture, Plan, View, ViewOptions};
use ridgelight::scene::{Border, Camera, Lens, Quality, Scene};

use crate::target::Staging;
use crate::{Device, field, under_sky};

fn scene() -> Scene {
    under_sky(field(8, 8, [1.0, 1.0], |r, c| ((r * 31 + c * 17) % 7) as f64), Border::Plane)
}

fn planned(device: &Device) -> Plan {
    let quality = Quality { azimuths: 4, ..Quality::default() };
    plan::picture(&scene(), &quality, &device.limits(), Picture::default()).expect("a plan")
}

/// The error of making something on a host; what is made is destroyed.
fn error<T>(made: Result<T>, destroy: impl FnOnce(T)) -> String {
    match made {
        Ok(made) => {
            destroy(made);
            "none".to_owned()
        }
        Err(error) => error.to_string(),
    }
}

/// The host with another list of queue families, as `listed` gives them. The queue stays the device's own.
pub(super) fn with_families(
    host: &Host,
    queue_family: u32,
    listed: vk::PFN_vkGetPhysicalDeviceQueueFamilyProperties,
) -> Host {
    let own = &host.instance;
    let functions = ash::InstanceFnV1_0 {
        get_physical_device_queue_family_properties: listed,
        ..own.fp_v1_0().clone()
    };
    let (v1_1, v1_3) = (own.fp_v1_1().clone(), own.fp_v1_3().clone());
    let instance = ash::Instance::from_parts_1_3(own.handle(), functions, v1_1, v1_3);
    Host { instance, queue_family, ..host.clone() }
}

/// Everything; transfers alone; compute without graphics.
const FAMILIES: [vk::QueueFlags; 3] = [
    vk::QueueFlags::from_raw(
        vk::QueueFlags::GRAPHICS.as_raw()
            | vk::QueueFlags::COMPUTE.as_raw()
            | vk::QueueFlags::TRANSFER.as_raw(),
    ),
    vk::QueueFlags::TRANSFER,
    vk::QueueFlags::COMPUTE,
];

unsafe extern "system" fn three_families(
    _: vk::PhysicalDevice,
    count: *mut u32,
    families: *mut vk::QueueFamilyProperties,
) {
    // SAFETY: as Vulkan's function: `families` is null, or has room for `count`.
    unsafe {
        if families.is_null() {
            *count = FAMILIES.len() as u32;
            return;
        }
        for (i, queue_flags) in FAMILIES.into_iter().enumerate().take(*count as usize) {
            *families.add(i) = vk::QueueFamilyProperties { queue_flags, ..Default::default() };
        }
    }
}

#[test]
fn a_family_that_does_not_exist_or_cannot_compute_is_refused() {
    let device = Device::new();
    let plan = planned(&device);
    let gpu = device.gpu.as_ref().expect("alive");
    let lens = Lens::Perspective { fov_rad: 0.8 };
    let camera = Camera::around(&scene().field, None, [0.7, 0.5], lens, 1.0);
    let options = ViewOptions { size: [4, 4], samples: 1, ..ViewOptions::default() };
    let view = View::new(&scene(), &plan, &camera, &options, &device.limits()).expect("a view");
    let make = |host: &Host| error(Renderer::new(host, plan.clone(), 1), Renderer::destroy);
    let look = |host: &Host| {
        let format = vk::Format::R32G32B32A32_SFLOAT;
        error(ViewRenderer::new(host, &view, format, 1), ViewRenderer::destroy)
    };
    let own = gpu.host();
    let beyond = Host { queue_family: u32::MAX, ..own.clone() };
    for found in [make(&beyond), look(&beyond)] {
        let (start, end) =
            ("host: queue_family: found 4294967295, expected an index below ", "families");
        assert!(found.starts_with(start) && found.ends_with(end), "{found}");
    }
    let of = |family| with_families(own, family, three_families);
    assert_eq!([make(&of(0)), make(&of(2)), look(&of(0))], ["none"; 3]);
    let transfers = "host: queue_family: found 1, a family with TRANSFER, expected a family with ";
    assert_eq!(make(&of(1)), format!("{transfers}COMPUTE: 0 or 2"));
    assert_eq!(look(&of(1)), format!("{transfers}GRAPHICS: 0"));
    let computes = "host: queue_family: found 2, a family with COMPUTE, expected a family with ";
    assert_eq!(look(&of(2)), format!("{computes}GRAPHICS: 0"));
}

/// An instance for a version and a device without extensions and features, destroyed at the end.
fn on_instance_of(version: u32, check: impl FnOnce(&Host)) {
    // SAFETY: the system's loader; all that is made here is destroyed here, after its last use.
    unsafe {
        let entry = ash::Entry::load().expect("a loader");
        let app = vk::ApplicationInfo::default().api_version(version);
        let info = vk::InstanceCreateInfo::default().application_info(&app);
        let instance = entry.create_instance(&info, None).expect("an instance");
        let physical_device = instance.enumerate_physical_devices().expect("devices")[0];
        let queue = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
        let info = vk::DeviceCreateInfo::default().queue_create_infos(&queue);
        let device = instance.create_device(physical_device, &info, None).expect("a device");
        let host = Host {
            instance: instance.clone(),
            physical_device,
            device: device.clone(),
            queue_family: 0,
            pipeline_cache: vk::PipelineCache::null(),
            debug_utils: None,
        };
        check(&host);
        device.destroy_device(None);
        instance.destroy_instance(None);
    }
}

const NEWER: &str = "an instance created with VkApplicationInfo::apiVersion 1.1 or higher";

/// Every version from 1.1 on renders. For 1.0 the cause is named, where the driver hides anything.
#[test]
fn an_instance_of_an_older_version_is_named_as_the_cause() {
    let device = Device::new();
    let plan = planned(&device);
    for version in
        [vk::API_VERSION_1_0, vk::API_VERSION_1_1, vk::API_VERSION_1_2, vk::API_VERSION_1_3]
    {
        on_instance_of(version, |host| {
            let missing = gpu::missing(&host.instance, host.physical_device);
            let is_hidden = version == vk::API_VERSION_1_0 && !missing.is_empty();
            let expected = if is_hidden { vec![NEWER] } else { vec![] };
            assert_eq!(missing, expected, "{version:x}");
            let limits = gpu::limits(&host.instance, host.physical_device);
            assert!(limits.allocation_bytes >= 1 << 30, "{version:x}: {limits:?}");
            let found = error(Renderer::new(host, plan.clone(), 1), Renderer::destroy);
            assert!(if is_hidden { found.contains(NEWER) } else { found == "none" }, "{found}");
        });
    }
}

/// A loader may withhold vkGetPhysicalDeviceProperties2, and ash panics in its place.
#[test]
fn an_instance_without_queries_of_properties_is_named_as_the_cause() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let own = &gpu.host().instance;
    let withheld = ash::InstanceFnV1_1::load(|_| std::ptr::null());
    let (v1_0, v1_3) = (own.fp_v1_0().clone(), own.fp_v1_3().clone());
    let instance = ash::Instance::from_parts_1_3(own.handle(), v1_0, withheld, v1_3);
    assert_eq!(gpu::missing(&instance, gpu.host().physical_device), [NEWER]);
}

/// Compute without graphics: a barrier on its queue cannot name stages of graphics. All others are accepted.
#[test]
fn stages_that_the_family_lacks_are_refused_by_name() {
    let mut device = Device::new();
    let plan = planned(&device);
    let gpu = device.gpu.as_mut().expect("alive");
    let texels = scene().field.heights_m().to_vec();
    let mut frame = gpu.frame(plan.clone(), &[&texels]).expect("a frame");
    let (inputs, outputs) = (frame.inputs(), frame.outputs());
    gpu.draw(&mut frame).expect("drawn");
    let right = gpu.pixels(&frame, 0).expect("pixels");
    let host = with_families(gpu.host(), 2, three_families);
    let mut renderer = Renderer::new(&host, plan.clone(), 1).expect("a renderer");
    let fragment = vk::PipelineStageFlags2::FRAGMENT_SHADER;
    let sampled = vk::AccessFlags2::SHADER_SAMPLED_READ;
    let drawn = |state: ImageState| ImageState { stage: fragment, access: sampled, ..state };
    let of_before = ImageArg { before: drawn(inputs[0].before), ..inputs[0] };
    let of_after = ImageArg { after: drawn(outputs[0].after), ..outputs[0] };
    let expected = "found FRAGMENT_SHADER, expected stages that a queue family with COMPUTE \
                    supports, or ALL_COMMANDS";
    gpu.run(|commands| {
        let mut refused = |inputs: &[ImageArg], outputs: &[ImageArg]| {
            renderer.record(commands, 0, inputs, outputs).expect_err("no graphics").to_string()
        };
        let before = refused(&[of_before], &outputs);
        assert_eq!(before, format!("heights: stage before: {expected}"));
        let after = refused(&inputs, &[of_after]);
        assert_eq!(after, format!("radiance: stage after: {expected}"));
        renderer.record(commands, 0, &inputs, &outputs)
    })
    .expect("recorded and run");
    assert!(gpu.pixels(&frame, 0).expect("pixels") == right);
    renderer.destroy();
    let mut taken = plan;
    taken.take_buffer("heights", plan::Format::R32Float).expect("heights in a buffer");
    let mut renderer = Renderer::new(&host, taken, 1).expect("a renderer");
    let bytes: Vec<u8> = texels.iter().flat_map(|v| v.to_ne_bytes()).collect();
    let staging = Staging::new(gpu.host(), &bytes);
    let of_graphics = BufferArg { stage: fragment, access: sampled, ..staging.arg() };
    gpu.run(|commands| {
        let refused = renderer.record(commands, 0, &[of_graphics], &outputs);
        let refused = refused.expect_err("no graphics").to_string();
        assert_eq!(refused, format!("heights: stage: {expected}"));
        renderer.record(commands, 0, &[staging.arg()], &outputs)
    })
    .expect("recorded and run");
    assert!(gpu.pixels(&frame, 0).expect("pixels") == right);
    renderer.destroy();
    staging.end(gpu.host());
    gpu.end(frame);
}

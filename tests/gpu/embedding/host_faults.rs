//! Hosts that a renderer refuses, with the cause that the host can fix; and hosts whose device is lost.

use std::ffi::c_void;
use std::sync::Mutex;
use std::sync::atomic::Ordering;

use ash::vk;
use ridgelight::gpu::{self, BufferArg, Host, ImageArg, ImageState, Renderer, ViewRenderer};
use ridgelight::plan::{self, Picture, Plan, Rectangle, View, ViewOptions};
use ridgelight::scene::{Border, Camera, Lens, Quality, Scene};
use ridgelight::{Error, Result};

use super::in_flight::Recorded;
use super::lifetimes::Counting;
use crate::intercepted::with_function;
use crate::target::Staging;
use crate::{Device, bits, field, under_sky};

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

unsafe extern "system" fn lost_submit(
    _: vk::Queue,
    _: u32,
    _: *const vk::SubmitInfo<'_>,
    _: vk::Fence,
) -> vk::Result {
    vk::Result::ERROR_DEVICE_LOST
}

/// The host's device, lost at every submission.
fn lost_at_submission(host: &Host) -> ash::Device {
    // SAFETY: it has the type of that function, and submits nothing.
    unsafe { with_function(host, c"vkQueueSubmit", lost_submit as *const c_void) }
}

/// Holds that something failed because the device is lost, as the driver says it.
fn assert_lost<T>(what: &str, done: Result<T>) {
    match done {
        Err(Error::Device { reason, .. }) => {
            assert_eq!(reason, vk::Result::ERROR_DEVICE_LOST.to_string(), "{what}");
        }
        Err(other) => panic!("{what}: {other}"),
        Ok(_) => panic!("{what}: no error"),
    }
}

/// Destroys the device. Validation has reported nothing, and no object that is still alive.
fn end_without_objects(device: &mut Device) {
    let messages = device.gpu.take().expect("alive").destroy();
    assert!(messages.is_empty(), "validation said:\n{}", messages.join("\n"));
}

/// The comparison of the tests below can fail: validation names an object that outlives its device.
#[test]
fn an_object_that_outlives_its_device_is_reported() {
    let mut device = Device::new();
    let gpu = device.gpu.take().expect("alive");
    // SAFETY: the device is alive. The fence is never used.
    unsafe { gpu.host().device.create_fence(&vk::FenceCreateInfo::default(), None) }
        .expect("a fence");
    let messages = gpu.destroy();
    let is_reported = messages.iter().any(|message| message.contains("not been destroyed"));
    assert_eq!(is_reported, device.validates, "{messages:?}");
}

/// Every call of `Headless` that runs commands returns the loss of the device as an error, and frees what it made. A frame whose
/// submission failed counts as not drawn, so its next edit is refused. With the working device it gives the same bits again.
#[test]
fn headless_calls_return_the_loss_of_the_device() {
    let mut device = Device::new();
    let limits = device.limits();
    let scene = scene();
    let quality = Quality { azimuths: 4, ..Quality::default() };
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let plan = plan::picture(&scene, &quality, &limits, wanted).expect("a plan");
    let lens = Lens::Perspective { fov_rad: 0.8 };
    let camera = Camera::around(&scene.field, None, [0.7, 0.5], lens, 1.0);
    let options = ViewOptions { size: [4, 4], samples: 1, ..ViewOptions::default() };
    let view = View::new(&scene, &plan, &camera, &options, &limits).expect("a view");
    let gpu = device.gpu.as_mut().expect("alive");
    let heights = scene.field.heights_m();
    let edit = Rectangle { col: 2, row: 3, cols: 4, rows: 2 };
    let mut frame = gpu.frame(plan.clone(), &[heights]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    gpu.draw_edit(&mut frame, edit).expect("an edit of a drawn frame");
    let right = bits(gpu, &frame);

    let alive = gpu.host().device.clone();
    gpu.host.device = lost_at_submission(gpu.host());
    assert_lost("an edit", gpu.draw_edit(&mut frame, edit));
    assert_lost("a frame", gpu.draw(&mut frame));
    assert_lost("a pass", gpu.draw_passes(&mut frame, &[0]));
    assert_lost("new heights", gpu.refill(&frame, 0, heights));
    assert_lost("pixels", gpu.pixels(&frame, 0));
    let input = plan.find("heights").expect("an input");
    assert_lost("a resource", gpu.read(&frame, input));
    assert_lost("a camera picture", gpu.look(&frame, &view, None));
    assert_lost("another frame", gpu.frame(plan, &[heights]));

    gpu.host.device = alive;
    let refused = gpu.draw_edit(&mut frame, edit).expect_err("nothing is drawn").to_string();
    assert!(refused.contains("passes must be recorded first"), "{refused}");
    let all: Vec<usize> = (0..frame.plan().passes.len()).collect();
    assert_eq!(frame.renderer().passes_after(&[]), all);
    gpu.refill(&frame, 0, &[0.0; 64]).expect("level ground");
    gpu.draw(&mut frame).expect("drawn");
    assert!(bits(gpu, &frame) != right);
    gpu.refill(&frame, 0, heights).expect("the heights again");
    gpu.draw(&mut frame).expect("drawn");
    assert!(bits(gpu, &frame) == right);
    gpu.end(frame);
    end_without_objects(&mut device);
}

/// A host gets the loss of its device from its own submission. Recording does not fail, before or after: the same slot in another
/// command buffer, on a device that runs, gives the same bits. Then `destroy` gives back every allocation.
#[test]
fn a_renderer_records_and_is_destroyed_after_a_lost_submission() {
    let mut device = Device::new();
    let plan = planned(&device);
    let gpu = device.gpu.as_mut().expect("alive");
    let texels = scene().field.heights_m().to_vec();
    let mut frame = gpu.frame(plan.clone(), &[&texels]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let right = bits(gpu, &frame);
    // Level ground, so that stale contents cannot pass.
    gpu.refill(&frame, 0, &[0.0; 64]).expect("level ground");
    gpu.draw(&mut frame).expect("drawn");
    assert!(bits(gpu, &frame) != right);
    gpu.refill(&frame, 0, &texels).expect("the heights again");

    let (inputs, outputs) = (frame.inputs(), frame.outputs());
    let alive = gpu.host().device.clone();
    let lost = Host { device: lost_at_submission(gpu.host()), ..gpu.host().clone() };
    let memory = Box::new(Counting::new(&lost));
    let held = memory.held.clone();
    let made = Renderer::with_memory(&lost, plan, 1, memory);
    let mut renderer = made.expect("a renderer");
    assert!(held.load(Ordering::Relaxed) > 0);
    let first = Recorded::new(&lost, |commands| {
        renderer.record(commands, 0, &inputs, &outputs).expect("recorded");
    });
    let submitted = first.try_submit(&lost.device, gpu.queue);
    assert_eq!(submitted, Err(vk::Result::ERROR_DEVICE_LOST));
    first.free(&lost.device);
    assert_eq!(renderer.timings(0), None, "nothing has run");
    let second = Recorded::new(&lost, |commands| {
        renderer.record(commands, 0, &inputs, &outputs).expect("recorded");
    });
    second.submit(&alive, gpu.queue);
    second.end(&alive);
    assert!(bits(gpu, &frame) == right);
    // Recorded, and then destroyed without a submission that succeeded.
    let last = Recorded::new(&lost, |commands| {
        renderer.record(commands, 0, &inputs, &outputs).expect("recorded");
    });
    assert!(last.try_submit(&lost.device, gpu.queue).is_err());
    last.free(&lost.device);
    renderer.destroy();
    assert_eq!(held.load(Ordering::Relaxed), 0);
    gpu.end(frame);
    end_without_objects(&mut device);
}

type CreatePipelines = vk::PFN_vkCreateComputePipelines;

/// The driver's own function, and how many pipelines it still makes before the device is lost.
static PIPELINES: Mutex<(Option<CreatePipelines>, usize)> = Mutex::new((None, 0));

unsafe extern "system" fn lost_after_some(
    device: vk::Device,
    cache: vk::PipelineCache,
    count: u32,
    infos: *const vk::ComputePipelineCreateInfo<'_>,
    callbacks: *const vk::AllocationCallbacks<'_>,
    pipelines: *mut vk::Pipeline,
) -> vk::Result {
    let mut state = PIPELINES.lock().expect("no panic");
    let create = state.0.expect("set before the device is used");
    if let Some(rest) = state.1.checked_sub(1) {
        state.1 = rest;
        // SAFETY: as it was called.
        return unsafe { create(device, cache, count, infos, callbacks, pipelines) };
    }
    for i in 0..count as usize {
        // SAFETY: there is room for `count`. Vulkan requires null for a pipeline that is not made.
        unsafe { pipelines.add(i).write(vk::Pipeline::null()) };
    }
    vk::Result::ERROR_DEVICE_LOST
}

/// In place of any function that makes one object of the device.
unsafe extern "system" fn lost_object(
    _: vk::Device,
    _: *const c_void,
    _: *const vk::AllocationCallbacks<'_>,
    _: *mut u64,
) -> vk::Result {
    vk::Result::ERROR_DEVICE_LOST
}

/// A device that is lost while a renderer is made, at each of its pipelines in turn, and at its first object of each kind: an error,
/// and what was made until then is freed.
#[test]
fn losing_the_device_while_a_renderer_is_made_leaks_nothing() {
    let mut device = Device::new();
    let plan = planned(&device);
    let has_timestamps = device.report().timestamp_period_ns > 0.0;
    let own = device.gpu.as_ref().expect("alive").host().clone();
    // A renderer, calls of its allocator, and allocations that are not freed.
    let make = |device: ash::Device| {
        let host = Host { device, ..own.clone() };
        let memory = Box::new(Counting::new(&host));
        let counts = [memory.calls.clone(), memory.held.clone()];
        let made = Renderer::with_memory(&host, plan.clone(), 2, memory);
        (made, counts.map(|count| count.load(Ordering::Relaxed)))
    };

    PIPELINES.lock().expect("no panic").0 = Some(own.device.fp_v1_0().create_compute_pipelines);
    let after = |count: usize| {
        PIPELINES.lock().expect("no panic").1 = count;
        let (name, function) = (c"vkCreateComputePipelines", lost_after_some as *const c_void);
        // SAFETY: it has the type of that function, and calls the device's own or makes nothing.
        let lost = unsafe { with_function(&own, name, function) };
        make(lost)
    };
    let enough = 1000;
    after(enough).0.expect("a renderer").destroy();
    let count = enough - PIPELINES.lock().expect("no panic").1;
    assert!(count > 2, "{count} pipelines");
    for lost in 0..count {
        let (made, [_, held]) = after(lost);
        assert_lost(&format!("after {lost} of {count} pipelines"), made);
        assert_eq!(held, 0, "after {lost} of {count} pipelines");
    }

    let mut calls_of_all = Vec::new();
    for name in [
        c"vkCreateShaderModule",
        c"vkCreateImage",
        c"vkCreateImageView",
        c"vkCreateBuffer",
        c"vkCreateBufferView",
        c"vkCreateDescriptorPool",
        c"vkCreateQueryPool",
    ] {
        if name == c"vkCreateQueryPool" && !has_timestamps {
            continue;
        }
        // SAFETY: these functions differ from `lost_object` only in the types behind pointers, and it never uses those.
        let lost = unsafe { with_function(&own, name, lost_object as *const c_void) };
        let (made, [calls, held]) = make(lost);
        assert_lost(&format!("{name:?}"), made);
        assert_eq!(held, 0, "{name:?}");
        calls_of_all.push(calls);
    }
    // Most of these objects are created after other allocations, so the failure must free them.
    assert!(calls_of_all.iter().filter(|calls| **calls > 1).count() > 2, "{calls_of_all:?}");
    end_without_objects(&mut device);
}

//! Names and labels that an engine's debugger shows.

use std::ffi::{CStr, c_char, c_void};
use std::sync::Mutex;

use ash::{ext, vk};
use ridgelight::gpu::{Host, Renderer};
use ridgelight::plan;

use super::borrowed::{framed, planned, scene};
use crate::Device;

/// The debugger's input: objects by type and name, labels that begin, and an empty name where one ends.
static REPORTED: Mutex<Vec<(vk::ObjectType, String)>> = Mutex::new(Vec::new());

unsafe fn text(name: *const c_char) -> String {
    // SAFETY: Vulkan's names end with a nul.
    unsafe { CStr::from_ptr(name) }.to_string_lossy().into_owned()
}

unsafe extern "system" fn keep_name(
    _device: vk::Device,
    info: *const vk::DebugUtilsObjectNameInfoEXT<'_>,
) -> vk::Result {
    // SAFETY: the caller passes a complete struct.
    let (kind, name) = unsafe { ((*info).object_type, text((*info).p_object_name)) };
    REPORTED.lock().expect("no panic").push((kind, name));
    vk::Result::SUCCESS
}

unsafe extern "system" fn keep_label(
    _commands: vk::CommandBuffer,
    info: *const vk::DebugUtilsLabelEXT<'_>,
) {
    // SAFETY: as above.
    let name = unsafe { text((*info).p_label_name) };
    REPORTED.lock().expect("no panic").push((vk::ObjectType::COMMAND_BUFFER, name));
}

unsafe extern "system" fn keep_end(_commands: vk::CommandBuffer) {
    REPORTED.lock().expect("no panic").push((vk::ObjectType::COMMAND_BUFFER, String::new()));
}

unsafe extern "system" fn debugger(
    _device: vk::Device,
    name: *const c_char,
) -> vk::PFN_vkVoidFunction {
    // SAFETY: the loader's names end with a nul; each name gets the function of its type.
    unsafe {
        let function: *const c_void = match text(name).as_str() {
            "vkSetDebugUtilsObjectNameEXT" => keep_name as *const c_void,
            "vkCmdBeginDebugUtilsLabelEXT" => keep_label as *const c_void,
            "vkCmdEndDebugUtilsLabelEXT" => keep_end as *const c_void,
            _ => std::ptr::null(),
        };
        std::mem::transmute::<*const c_void, vk::PFN_vkVoidFunction>(function)
    }
}

/// A host whose debugger is this test.
fn reporting(host: &Host) -> Host {
    // SAFETY: only the debugger's functions of this instance are looked up.
    let instance = unsafe {
        ash::Instance::load_with(
            |name| match name.to_bytes() {
                b"vkGetDeviceProcAddr" => debugger as *const c_void,
                _ => std::ptr::null(),
            },
            host.instance.handle(),
        )
    };
    let debug_utils = Some(ext::debug_utils::Device::new(&instance, &host.device));
    Host { debug_utils, ..host.clone() }
}

#[test]
fn debuggers_get_the_names_of_all_objects_and_passes() {
    use vk::ObjectType as Type;
    let mut device = Device::new();
    let scene = scene();
    let gpu = device.gpu.as_mut().expect("alive");
    let plan = planned(gpu, &scene);
    let frame = framed(gpu, &scene);
    REPORTED.lock().expect("no panic").clear();
    let mut renderer = Renderer::new(&reporting(gpu.host()), plan.clone(), 2).expect("a renderer");
    let names = std::mem::take(&mut *REPORTED.lock().expect("no panic"));
    let (inputs, outputs) = (frame.inputs(), frame.outputs());
    gpu.run(|commands| renderer.record(commands, 0, &inputs, &outputs)).expect("recorded and run");
    renderer.destroy();
    gpu.end(frame);

    let has = |kind, name: &str| names.iter().any(|n| n.0 == kind && n.1 == name);
    let internal = plan.resources.iter().filter(|r| r.owner == plan::Owner::Internal);
    for resource in internal {
        let kinds: &[Type] = match resource.kind {
            plan::Kind::Image { .. } => &[Type::IMAGE, Type::IMAGE_VIEW],
            plan::Kind::Buffer { texels: true, .. } => &[Type::BUFFER, Type::BUFFER_VIEW],
            plan::Kind::Buffer { .. } => &[Type::BUFFER],
        };
        kinds.iter().for_each(|kind| assert!(has(*kind, &resource.name), "{kind:?} {resource:?}"));
    }
    for pass in &plan.passes {
        for kind in [Type::PIPELINE, Type::PIPELINE_LAYOUT, Type::DESCRIPTOR_SET_LAYOUT] {
            assert!(has(kind, pass.name()), "{kind:?} {}", pass.name());
        }
        for slot in 0..2 {
            let name = format!("{}, slot {slot}", pass.label());
            assert!(has(Type::DESCRIPTOR_SET, &name), "{name}");
        }
    }
    assert!(has(Type::DESCRIPTOR_POOL, "ridgelight"));
    if device.report().timestamp_period_ns > 0.0 {
        assert!(has(Type::QUERY_POOL, "ridgelight, slot 1"));
    }
    // Each pass in a label of its own.
    let labels = std::mem::take(&mut *REPORTED.lock().expect("no panic"));
    let labels: Vec<&str> = labels.iter().map(|l| l.1.as_str()).collect();
    let passes: Vec<String> = plan.passes.iter().map(plan::Pass::label).collect();
    let around: Vec<&str> = passes.iter().flat_map(|label| [label.as_str(), ""]).collect();
    assert_eq!(labels, around);
}

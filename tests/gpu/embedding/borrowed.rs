//! Resources that an engine lends besides a device: images in its own formats, memory, a pipeline cache.

use std::ffi::c_void;
use std::ptr::NonNull;
use std::sync::Mutex;

use ash::vk;
use ridgelight::gpu::{
    Allocation, Allocator, Frame, Headless, Host, ImageArg, MemoryRequest, MemoryUse, Pixels,
    Renderer,
};
use ridgelight::plan::{self, Picture, Plan};
use ridgelight::scene::{Albedo, Border, Environment, HeightField, Normals, Quality, Scene, Sun};
use ridgelight::{Error, Result};

use crate::intercepted::with_function;
use crate::target::{Input, LEAST_BLOCK};
use crate::{Device, field, under_sky};

const COLS: usize = 20;
const ROWS: usize = 12;

fn quality() -> Quality {
    Quality { azimuths: 8, sun_azimuths: 2, table_elevations: 16, ..Quality::default() }
}

/// Heights of 0 and 1, with a median of 0: their own offsets from it.
fn heights() -> Vec<f64> {
    (0..ROWS * COLS).map(|i| f64::from(u8::from((i * i + i / COLS).is_multiple_of(5)))).collect()
}

/// Under a sky, a sun and an environment, on ground of 0 and 1 in each channel.
pub(crate) fn scene() -> Scene {
    let lone = field(ROWS, COLS, [0.5, 1.0], |r, c| heights()[r * COLS + c]);
    let mut scene = under_sky(lone, Border::Plane);
    scene.lights.suns =
        vec![Sun { azimuth_rad: 1.0, elevation_rad: 0.6, diameter_rad: 0.1, irradiance: [1.0; 3] }];
    let texels = (0..128).map(|i| [u8::from(i % 3 == 0), 0, 1].map(f32::from)).collect();
    scene.lights.environment = Some(Environment::new(16, 8, texels, 0.0).expect("an environment"));
    let map = (0..ROWS * COLS).map(|i| [1, u8::from(i % 2 == 0), 0].map(f32::from)).collect();
    scene.surface.albedo = Albedo::Map(map);
    scene
}

pub(crate) fn planned(gpu: &Headless, scene: &Scene) -> Plan {
    plan::picture(scene, &quality(), &crate::limits_of(gpu), Picture::default()).expect("a plan")
}

pub(crate) fn framed(gpu: &mut Headless, scene: &Scene) -> Frame {
    let contents = plan::picture_inputs(scene);
    let texels: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let plan = planned(gpu, scene);
    gpu.frame(plan, &texels).expect("a frame")
}

/// Texels of 0 and 1 as a format packs them.
pub(crate) fn packed(texels: &[f32], format: vk::Format) -> Vec<u8> {
    let one: &[u8] = match format {
        vk::Format::R32_SFLOAT | vk::Format::R32G32B32A32_SFLOAT => &[0, 0, 0x80, 0x3f],
        vk::Format::R16_SFLOAT | vk::Format::R16G16B16A16_SFLOAT => &[0, 0x3c],
        vk::Format::R16_UNORM => &[0xff, 0xff],
        vk::Format::R8G8B8A8_UNORM | vk::Format::R8G8B8A8_SRGB => &[0xff],
        other => panic!("{other:?}"),
    };
    let zero = vec![0; one.len()];
    texels.iter().flat_map(|t| if *t == 1.0 { one.to_vec() } else { zero.clone() }).collect()
}

/// Each input in each format that the device samples, the others unchanged. Alpha, which is 0 here, has no effect.
#[test]
fn inputs_in_an_engines_formats_are_lit_as_f32_are() {
    let mut device = Device::new();
    let scene = scene();
    let contents = plan::picture_inputs(&scene);
    let texels: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let gpu = device.gpu.as_mut().expect("alive");
    let plan = planned(gpu, &scene);
    let wanted: Vec<_> = plan.inputs().map(|(_, r)| (r.name.clone(), r.kind)).collect();
    let mut frame = gpu.frame(plan, &texels).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let right = gpu.pixels(&frame, 0).expect("pixels");
    let (inputs, outputs) = (frame.inputs(), frame.outputs());
    let mut drawn = Vec::new();
    for (which, (name, kind)) in wanted.iter().enumerate() {
        let plan::Kind::Image { format, width, height, .. } = *kind else { panic!("{name}") };
        let mut clear = texels[which].to_vec();
        if name != "heights" {
            clear.iter_mut().skip(3).step_by(4).for_each(|alpha| *alpha = 0.0);
            assert!(clear != texels[which], "{name}: alpha is 1 otherwise");
        }
        for &format in format.vk_read() {
            let bytes = packed(&clear, format);
            let Some(lent) = Input::new(gpu, format, [width, height], &bytes) else {
                // Vulkan requires every format but this.
                assert_eq!(format, vk::Format::R16_UNORM, "{name}");
                continue;
            };
            let mut given = inputs.clone();
            given[which] = lent.arg();
            let recorded =
                gpu.run(|commands| frame.renderer().record(commands, 0, &given, &outputs));
            match recorded {
                Ok(()) => drawn.push(format),
                Err(error) if format == vk::Format::R16_UNORM => {
                    assert!(error.to_string().contains("heights: format"), "{error}");
                }
                Err(error) => panic!("{name} {format:?}: {error}"),
            }
            let lit = gpu.pixels(&frame, 0).expect("pixels");
            assert!(lit == right, "{name} {format:?}");
            lent.end(gpu.host());
        }
    }
    println!("{drawn:?}");
    assert!(drawn.len() >= 2 + 4 + 4, "{drawn:?}");
    gpu.end(frame);
}

/// A path-traced reference accepts only the formats of its plan, with an environment and without.
#[test]
fn a_reference_refuses_narrower_inputs() {
    let mut device = Device::new();
    let around = scene();
    let mut without = around.clone();
    without.lights.environment = None;
    let limits = device.limits();
    let gpu = device.gpu.as_mut().expect("alive");
    for scene in [around, without] {
        let plan = plan::reference(&scene, 0, Normals::Smooth, None, 1, &limits).expect("a plan");
        let inputs: Vec<_> = plan.inputs().map(|(_, r)| (r.name.clone(), r.format())).collect();
        let contents = plan::reference_inputs(&scene);
        let texels: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
        let mut frame = gpu.frame(plan, &texels).expect("a frame");
        let (own, outputs) = (frame.inputs(), frame.outputs());
        for (which, (name, format)) in inputs.iter().enumerate() {
            for &narrow in &format.expect("an image").vk_read()[1..] {
                let mut given = own.clone();
                given[which].format = narrow;
                let recorded =
                    gpu.run(|commands| frame.renderer().record(commands, 0, &given, &outputs));
                let refused = recorded.expect_err("other formats").to_string();
                assert!(refused.starts_with(&format!("{name}: format: found")), "{refused}");
            }
        }
        gpu.run(|commands| frame.renderer().record(commands, 0, &own, &outputs)).expect("recorded");
        gpu.end(frame);
    }
}

/// A plan without their contents draws the same as one with them: heights and albedo exist only on the device.
/// Azimuths do not depend on an environment here, as they are even for an unknown one.
#[test]
fn device_only_inputs_match_host_inputs() {
    let mut device = Device::new();
    let mut known = scene();
    known.lights.environment = None;
    let mut unknown = known.clone();
    unknown.field = HeightField::unknown(ROWS, COLS, known.field.cell_m()).expect("a field");
    unknown.surface.albedo = Albedo::unknown(ROWS * COLS);
    let contents = plan::picture_inputs(&known);
    let texels: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let gpu = device.gpu.as_mut().expect("alive");
    let lit = [known, unknown].map(|scene| {
        let mut frame = gpu.frame(planned(gpu, &scene), &texels).expect("a frame");
        gpu.draw(&mut frame).expect("drawn");
        let lit = gpu.pixels(&frame, 0).expect("pixels");
        gpu.end(frame);
        lit
    });
    assert!(lit[0] == lit[1]);
    let mut values = lit[0].values.iter().filter(|v| **v > 0.0 && **v < 1.0);
    assert!(values.next().is_some(), "neither black nor white");
}

/// An engine's own memory: one allocation of the device for each, as few engines do.
struct Pieces {
    host: Host,
    /// Sizes of the live allocations, by key.
    held: std::sync::Arc<Mutex<Vec<(u64, u64)>>>,
    next: u64,
    /// The fault to make.
    fault: Option<&'static str>,
}

// SAFETY: every piece is an allocation of its own, as large as requested, of a suitable type, mapped as a whole where
// the host reads or writes.
unsafe impl Allocator for Pieces {
    fn allocate(&mut self, request: &MemoryRequest<'_>) -> Result<Allocation> {
        let device = &self.host.device;
        let wanted = match request.used_by {
            MemoryUse::Device => vk::MemoryPropertyFlags::empty(),
            _ => vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT,
        };
        let failed = |reason: String| Error::Device { doing: request.name.to_owned(), reason };
        let size = request.requirements.size;
        // SAFETY: instance and device are alive; the memory is freed in `free` alone.
        unsafe {
            let types =
                self.host.instance.get_physical_device_memory_properties(self.host.physical_device);
            let fits = |i: &u32| {
                request.requirements.memory_type_bits >> i & 1 == 1
                    && types.memory_types[*i as usize].property_flags.contains(wanted)
            };
            let kind = (0..types.memory_type_count).find(fits);
            let kind = kind.ok_or_else(|| failed("no such memory".into()))?;
            let info = vk::MemoryAllocateInfo::default()
                .allocation_size(size.max(LEAST_BLOCK))
                .memory_type_index(kind);
            let memory = device.allocate_memory(&info, None).map_err(|e| failed(e.to_string()))?;
            let mut mapped = None;
            if request.used_by != MemoryUse::Device && self.fault != Some("not mapped") {
                let flags = vk::MemoryMapFlags::empty();
                let begin = device.map_memory(memory, 0, vk::WHOLE_SIZE, flags);
                mapped = NonNull::new(begin.map_err(|e| failed(e.to_string()))?.cast());
            }
            self.next += 1;
            self.held.lock().expect("no panic").push((self.next, size));
            let offset = u64::from(self.fault == Some("not aligned"));
            Ok(Allocation { memory, offset, mapped, key: self.next })
        }
    }

    fn free(&mut self, allocation: Allocation) {
        self.held.lock().expect("no panic").retain(|(key, _)| *key != allocation.key);
        // SAFETY: allocated by `allocate`; nothing uses its memory any more.
        unsafe { self.host.device.free_memory(allocation.memory, None) };
    }

    fn bytes(&self) -> u64 {
        self.held.lock().expect("no panic").iter().map(|(_, size)| size).sum()
    }
}

/// A plan, its frame, and what it has drawn.
fn drawn(gpu: &mut Headless) -> (Plan, Frame, Pixels) {
    let scene = scene();
    let plan = planned(gpu, &scene);
    let mut frame = framed(gpu, &scene);
    gpu.draw(&mut frame).expect("drawn");
    let right = gpu.pixels(&frame, 0).expect("pixels");
    (plan, frame, right)
}

#[test]
fn an_engines_own_memory_does_as_well() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let (plan, frame, right) = drawn(gpu);
    let held = std::sync::Arc::new(Mutex::new(Vec::new()));
    let pieces =
        |fault| Box::new(Pieces { host: gpu.host().clone(), held: held.clone(), next: 0, fault });
    for fault in ["not mapped", "not aligned"] {
        let made = Renderer::with_memory(gpu.host(), plan.clone(), 1, pieces(Some(fault)));
        let error = made.err().expect(fault).to_string();
        assert!(error.contains(fault), "{error}");
        assert_eq!(*held.lock().expect("no panic"), [], "{fault}");
    }
    let mut renderer =
        Renderer::with_memory(gpu.host(), plan.clone(), 1, pieces(None)).expect("a renderer");
    assert!(renderer.device_bytes() >= plan.internal_bytes());
    let taken: u64 = held.lock().expect("no panic").iter().map(|h| h.1).sum();
    assert_eq!(renderer.device_bytes(), taken);
    let (inputs, outputs) = (frame.inputs(), frame.outputs());
    gpu.run(|commands| renderer.record(commands, 0, &inputs, &outputs)).expect("recorded and run");
    assert!(gpu.pixels(&frame, 0).expect("pixels") == right);
    renderer.destroy();
    assert_eq!(*held.lock().expect("no panic"), []);
    gpu.end(frame);
}

type CreatePipelines = vk::PFN_vkCreateComputePipelines;

/// The driver's own function, and the caches that it was called with.
static CACHES: Mutex<(Option<CreatePipelines>, Vec<vk::PipelineCache>)> =
    Mutex::new((None, Vec::new()));

unsafe extern "system" fn keep_cache(
    device: vk::Device,
    cache: vk::PipelineCache,
    count: u32,
    infos: *const vk::ComputePipelineCreateInfo<'_>,
    callbacks: *const vk::AllocationCallbacks<'_>,
    pipelines: *mut vk::Pipeline,
) -> vk::Result {
    let mut caches = CACHES.lock().expect("no panic");
    caches.1.push(cache);
    let create = caches.0.expect("set before the device is used");
    // SAFETY: as it was called.
    unsafe { create(device, cache, count, infos, callbacks, pipelines) }
}

/// A host whose calls for pipelines this test records.
fn heard(host: &Host, pipeline_cache: vk::PipelineCache) -> Host {
    CACHES.lock().expect("no panic").0 = Some(host.device.fp_v1_0().create_compute_pipelines);
    // SAFETY: it has the type of that function, and calls the device's own.
    let device =
        unsafe { with_function(host, c"vkCreateComputePipelines", keep_cache as *const c_void) };
    Host { device, pipeline_cache, ..host.clone() }
}

/// In: the data of an earlier run. Out: the caller reads its own cache.
#[test]
fn pipelines_are_made_through_the_callers_cache() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let (plan, frame, right) = drawn(gpu);
    let (inputs, outputs): (Vec<ImageArg>, Vec<ImageArg>) = (frame.inputs(), frame.outputs());
    let mut kept = Vec::new();
    for run in 0..2 {
        let lent = &gpu.host().device;
        let info = vk::PipelineCacheCreateInfo::default().initial_data(&kept);
        // SAFETY: the device is alive; the data is empty, or the device's own.
        let cache = unsafe { lent.create_pipeline_cache(&info, None) }.expect("a cache");
        CACHES.lock().expect("no panic").1.clear();
        let mut renderer =
            Renderer::new(&heard(gpu.host(), cache), plan.clone(), 1).expect("a renderer");
        let caches = std::mem::take(&mut CACHES.lock().expect("no panic").1);
        assert!(!caches.is_empty() && caches.iter().all(|c| *c == cache), "run {run}");
        gpu.run(|commands| renderer.record(commands, 0, &inputs, &outputs)).expect("run");
        assert!(gpu.pixels(&frame, 0).expect("pixels") == right, "run {run}");
        renderer.destroy();
        let lent = &gpu.host().device;
        // SAFETY: the cache is the device's; nothing uses it any more.
        unsafe {
            kept = lent.get_pipeline_cache_data(cache).expect("what it kept");
            lent.destroy_pipeline_cache(cache, None);
        }
    }
    assert!(!kept.is_empty());
    gpu.end(frame);
}

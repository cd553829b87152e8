//! The functions, called as from C, on a device of the library's own: what a successful C program does not
//! reach.

use std::collections::HashMap;
use std::ffi::{CStr, c_void};
use std::ptr;

use ash::vk;
use ash::vk::Handle;
use ridgelight::gpu::{Frame, Headless, HeadlessOptions, ImageArg, Pixels};
use ridgelight::plan::{self, Picture, View, ViewOptions};
use ridgelight::scene::{Camera, HeightField, Lens, Lights, Quality, Scene, Surface};
use ridgelight_c::*;

use crate::target::{FORMAT, SIZE, Staging, Target};

pub(super) const SIDE: usize = 24;

fn size<T>() -> u32 {
    size_of::<T>() as u32
}

fn last_error() -> String {
    // SAFETY: a text of the library's, which no call replaces meanwhile.
    unsafe { CStr::from_ptr(ridgelight_last_error()) }.to_str().expect("UTF-8").to_owned()
}

#[track_caller]
pub(super) fn good(result: RidgelightResult) {
    assert_eq!(result, RidgelightResult::Ok, "{}", last_error());
}

#[track_caller]
pub(super) fn refused(result: RidgelightResult, code: RidgelightResult, named: &str) {
    assert_eq!(result, code, "{named}");
    assert!(last_error().contains(named), "{named}: {}", last_error());
}

/// All zeros, except for the size that it begins with.
pub(super) fn zeroed<T>() -> T {
    let mut value = std::mem::MaybeUninit::<T>::zeroed();
    // SAFETY: the library's structs take zeros for their defaults, and begin with their size.
    unsafe {
        value.as_mut_ptr().cast::<u32>().write(size::<T>());
        value.assume_init()
    }
}

pub(super) fn heights() -> Vec<f64> {
    (0..SIDE * SIDE).map(|i| f64::from((i / SIDE * 31 + i % SIDE * 17) as u32 % 7) - 3.0).collect()
}

/// A device with validation messages, and its C description.
pub(super) fn device() -> (Headless, RidgelightHost) {
    let validation = crate::is_validated();
    let gpu = Headless::new(&HeadlessOptions { device: None, validation }).expect("a device");
    // SAFETY: the system's loader, as above.
    let entry = unsafe { ash::Entry::load() }.expect("a loader");
    let lent = gpu.host();
    let host = RidgelightHost {
        queue_family: lent.queue_family,
        instance: lent.instance.handle(),
        physical_device: lent.physical_device,
        device: lent.device.handle(),
        get_instance_proc_addr: Some(entry.static_fn().get_instance_proc_addr),
        debug_utils: vk::Bool32::from(validation),
        ..zeroed()
    };
    (gpu, host)
}

pub(super) fn scene() -> RidgelightScene {
    let side = SIDE as u32;
    RidgelightScene { rows: side, cols: side, sky: [1.0, 0.5, 0.25], ..zeroed() }
}

pub(super) fn image(arg: &ImageArg) -> RidgelightImage {
    let state = |s: ridgelight::gpu::ImageState| RidgelightImageState {
        stage: s.stage,
        access: s.access,
        layout: s.layout,
    };
    let (before, after) = (state(arg.before), state(arg.after));
    RidgelightImage { image: arg.image, view: arg.view, before, after, ..zeroed() }
}

pub(super) fn field() -> HeightField {
    let field = HeightField::new(SIDE, SIDE, &heights(), [1.0; 2], None).expect("a field");
    assert_eq!(field.base_m(), 0.0, "offsets are heights");
    field
}

/// A field under the sky of [`scene`].
pub(super) fn under_sky(field: HeightField) -> Scene {
    let lights = Lights { sky: Some([1.0, 0.5, 0.25]), ..Lights::default() };
    Scene { field, surface: Surface::default(), lights }
}

/// A scene as the library lights it.
pub(super) fn drawn_by_rust(gpu: &mut Headless, scene: &Scene, wanted: Picture) -> Frame {
    let planned = plan::picture(scene, &Quality::default(), &gpu.report().limits, wanted);
    let planned = planned.expect("a plan");
    let mut frame = gpu.frame(planned, &[scene.field.heights_m()]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    frame
}

/// The light of a scene, and its frame, which now has level ground and another light.
pub(super) fn lit_by_rust(gpu: &mut Headless, scene: &Scene) -> (Frame, Pixels) {
    let mut frame = drawn_by_rust(gpu, scene, Picture::default());
    let right = gpu.pixels(&frame, 0).expect("pixels");
    gpu.refill(&frame, 0, &[0.0; SIDE * SIDE]).expect("level ground");
    gpu.draw(&mut frame).expect("drawn");
    assert!(gpu.pixels(&frame, 0).expect("pixels") != right);
    (frame, right)
}

/// Runs the commands that a function records.
pub(super) fn submit(gpu: &Headless, record: impl FnOnce(vk::CommandBuffer)) {
    let run = gpu.run(|commands| {
        record(commands);
        Ok(())
    });
    run.expect("run");
}

/// Memory that an engine gives: pieces of the device's, by key.
struct Engine {
    device: ash::Device,
    types: vk::PhysicalDeviceMemoryProperties,
    held: HashMap<u64, String>,
    /// How many pieces are in use.
    left: usize,
}

unsafe extern "C" fn allocate(
    user: *mut c_void,
    request: *const RidgelightMemoryRequest,
    allocation: *mut RidgelightAllocation,
) -> vk::Bool32 {
    // SAFETY: what `allocator` handed in, and the library's structs.
    unsafe {
        let (engine, request) = (&mut *user.cast::<Engine>(), &*request);
        assert_eq!(request.struct_size, size::<RidgelightMemoryRequest>());
        if engine.left == 0 {
            return vk::FALSE;
        }
        engine.left -= 1;
        let is_mapped = request.used_by != RIDGELIGHT_MEMORY_DEVICE;
        let mut wanted = vk::MemoryPropertyFlags::empty();
        if is_mapped {
            wanted = vk::MemoryPropertyFlags::HOST_VISIBLE | vk::MemoryPropertyFlags::HOST_COHERENT;
        }
        let fits = |i: &u32| {
            request.requirements.memory_type_bits >> i & 1 == 1
                && engine.types.memory_types[*i as usize].property_flags.contains(wanted)
        };
        let kind = (0..engine.types.memory_type_count).find(fits).expect("such memory");
        let info = vk::MemoryAllocateInfo::default()
            .allocation_size(request.requirements.size)
            .memory_type_index(kind);
        let memory = engine.device.allocate_memory(&info, None).expect("memory");
        let mut mapped = ptr::null_mut();
        if is_mapped {
            let flags = vk::MemoryMapFlags::empty();
            mapped = engine.device.map_memory(memory, 0, vk::WHOLE_SIZE, flags).expect("mapped");
        }
        let key = memory.as_raw();
        let name = CStr::from_ptr(request.name).to_str().expect("UTF-8").to_owned();
        engine.held.insert(key, name);
        *allocation = RidgelightAllocation { memory, offset: 0, mapped, key };
    }
    vk::TRUE
}

unsafe extern "C" fn free(user: *mut c_void, allocation: *const RidgelightAllocation) {
    // SAFETY: as above; the image or buffer is gone.
    unsafe {
        let (engine, allocation) = (&mut *user.cast::<Engine>(), &*allocation);
        assert!(engine.held.remove(&allocation.key).is_some(), "freed once");
        engine.device.free_memory(allocation.memory, None);
    }
}

#[test]
fn an_engine_in_c_lends_its_memory_and_reads_times() {
    let (mut gpu, host) = device();
    let of_rust = under_sky(field());
    let (frame, right) = lit_by_rust(&mut gpu, &of_rust);
    gpu.refill(&frame, 0, of_rust.field.heights_m()).expect("the heights again");
    let planned = frame.plan().clone();

    let lent = gpu.host().clone();
    // SAFETY: the instance is alive.
    let types =
        unsafe { lent.instance.get_physical_device_memory_properties(lent.physical_device) };
    let held = HashMap::new();
    let mut engine = Engine { device: lent.device.clone(), types, held, left: 2 };
    let user = ptr::from_mut(&mut engine);
    let allocator = RidgelightAllocator {
        user: user.cast(),
        allocate: Some(allocate),
        free: Some(free),
        ..zeroed()
    };
    let (mut plan, mut renderer) = (ptr::null_mut(), ptr::null_mut());
    // SAFETY: structs, handles and callbacks of this function, alive until its end.
    unsafe {
        good(ridgelight_plan_create(&host, &scene(), ptr::null(), 0, 0, &mut plan));
        let short = ridgelight_renderer_create(&host, plan, 1, &allocator, &mut renderer);
        refused(short, RidgelightResult::Device, "the allocator has no such memory");
        assert!(renderer.is_null() && (*user).held.is_empty(), "all is given back");
        (*user).left = usize::MAX;
        good(ridgelight_renderer_create(&host, plan, 1, &allocator, &mut renderer));
        let names: Vec<&String> = (*user).held.values().collect();
        for resource in planned.resources.iter().filter(|r| r.owner == plan::Owner::Internal) {
            assert!(names.contains(&&resource.name), "{}", resource.name);
        }

        let mut info: RidgelightPlanInfo = zeroed();
        good(ridgelight_plan_info(plan, &mut info));
        let passes = planned.passes.len() as u32;
        assert_eq!((info.inputs, info.outputs, info.passes), (1, 1, passes));
        assert_eq!(info.internal_bytes, planned.internal_bytes());
        // The plan is destroyed: renderers have their own copy.
        ridgelight_plan_destroy(plan);

        let (input, output) = (image(&frame.inputs()[0]), image(&frame.outputs()[0]));
        let mut times: Vec<RidgelightTiming> = (0..passes).map(|_| zeroed()).collect();
        let mut count = passes;
        good(ridgelight_timings(renderer, 0, times.as_mut_ptr(), &mut count));
        assert_eq!(count, 0, "nothing has run");
        submit(&gpu, |commands| {
            good(ridgelight_record(renderer, commands, 0, &input, 1, &output, 1));
        });
        assert!(gpu.pixels(&frame, 0).expect("pixels") == right);
        count = passes;
        good(ridgelight_timings(renderer, 0, times.as_mut_ptr(), &mut count));
        if gpu.report().timestamp_period_ns > 0.0 {
            let labels = times.iter().map(|t| CStr::from_ptr(t.label.as_ptr()).to_str());
            let labels: Vec<&str> = labels.map(|l| l.expect("UTF-8")).collect();
            let passes: Vec<String> = planned.passes.iter().map(plan::Pass::label).collect();
            assert_eq!(labels, passes);
            assert!(times.iter().all(|t| t.ns >= 0.0));
        } else {
            assert_eq!(count, 0);
        }

        // The library's own checks pass their message through, and nothing has been recorded.
        let setting = RidgelightResult::Setting;
        let wrong = RidgelightImage { format: vk::Format::R8_UNORM, ..input };
        submit(&gpu, |commands| {
            let record = |slot, input: &RidgelightImage, inputs, output: &RidgelightImage| {
                ridgelight_record(renderer, commands, slot, input, inputs, output, 1)
            };
            refused(record(1, &input, 1, &output), setting, "slot");
            refused(record(0, &input, 0, &output), setting, "inputs");
            refused(record(0, &wrong, 1, &output), setting, "heights: format");
            let nothing = RidgelightImage { image: vk::Image::null(), ..output };
            refused(record(0, &input, 1, &nothing), setting, "radiance");
            let short = RidgelightImage { struct_size: 3, ..output };
            refused(
                record(0, &input, 1, &short),
                RidgelightResult::Argument,
                "output 0: struct_size",
            );
        });
        ridgelight_renderer_destroy(renderer);
        assert!((*user).held.is_empty());
    }
    gpu.end(frame);
    assert_eq!(gpu.take_messages(), [""; 0]);
}

/// Heights in a buffer of C's, with padded rows: the light equals that of the same heights in an image.
#[test]
fn a_buffer_of_c_is_lit_as_an_image_is() {
    let (mut gpu, host) = device();
    let of_rust = under_sky(field());
    let (frame, right) = lit_by_rust(&mut gpu, &of_rust);
    let texels = of_rust.field.heights_m();
    // Two texels between rows, one before the first.
    let mut rows = vec![f32::NAN; 1];
    texels.chunks(SIDE).for_each(|row| rows.extend(row.iter().chain(&[f32::NAN; 2])));
    let bytes: Vec<u8> = rows.iter().flat_map(|v| v.to_ne_bytes()).collect();
    let lent = Staging::new(gpu.host(), &bytes);
    let given = lent.arg();
    let (mut plan, mut renderer) = (ptr::null_mut(), ptr::null_mut());
    let (argument, setting) = (RidgelightResult::Argument, RidgelightResult::Setting);
    // SAFETY: structs and handles of this function, alive until its end.
    unsafe {
        good(ridgelight_plan_create(&host, &scene(), ptr::null(), 0, 0, &mut plan));
        let take = |index, format| ridgelight_plan_take_buffer(plan, index, format);
        refused(take(1, vk::Format::UNDEFINED), argument, "index: found 1");
        refused(take(0, vk::Format::R8_UINT), argument, "format: found R8_UINT");
        refused(take(0, vk::Format::R8G8B8A8_UNORM), setting, "heights: texels");
        good(take(0, vk::Format::UNDEFINED));
        let mut info: RidgelightImageInfo = zeroed();
        good(ridgelight_plan_input(plan, 0, &mut info));
        assert!(info.usage.is_empty() && info.format == vk::Format::R32_SFLOAT);
        good(ridgelight_plan_output(plan, 0, &mut info));
        assert_eq!(info.usage, vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED);
        let scene = RidgelightScene { reserved: 1, ..scene() };
        let mut none = ptr::null_mut();
        let planned = ridgelight_plan_create(&host, &scene, ptr::null(), 0, 0, &mut none);
        refused(planned, argument, "scene: reserved: found 1");
        good(ridgelight_renderer_create(&host, plan, 1, ptr::null(), &mut renderer));
        let output = image(&frame.outputs()[0]);
        let state = RidgelightImageState {
            stage: given.stage,
            access: given.access,
            layout: vk::ImageLayout::UNDEFINED,
        };
        let input = RidgelightImage {
            buffer: given.buffer,
            buffer_bytes: given.bytes,
            buffer_offset: 4,
            row_bytes: 4 * (SIDE as u64 + 2),
            before: state,
            ..zeroed()
        };
        submit(&gpu, |commands| {
            let record = |input: &RidgelightImage| {
                ridgelight_record(renderer, commands, 0, input, 1, &output, 1)
            };
            let of_image = image(&frame.inputs()[0]);
            refused(record(&of_image), setting, "heights: found an image");
            let far = RidgelightImage { buffer_offset: 16, ..input };
            refused(record(&far), setting, "heights: bytes");
            good(record(&input));
        });
        assert!(gpu.pixels(&frame, 0).expect("pixels") == right);
        ridgelight_renderer_destroy(renderer);
        ridgelight_plan_destroy(plan);
    }
    lent.end(gpu.host());
    gpu.end(frame);
    assert_eq!(gpu.take_messages(), [""; 0]);
}

/// A field as the library lights it, and its view by a camera.
pub fn view_by_rust(gpu: &mut Headless, field: &HeightField) -> (Frame, View, Camera) {
    let scene = under_sky(field.clone());
    let frame = drawn_by_rust(gpu, &scene, Picture::default());
    let at = Camera {
        target_m: [11.0, 12.0, 1.0],
        azimuth_rad: 0.7,
        elevation_rad: 0.5,
        distance_m: 30.0,
        lens: Lens::Perspective { fov_rad: 0.8 },
    };
    let options = ViewOptions { size: SIZE, samples: 1, ..ViewOptions::default() };
    let view = View::new(&scene, frame.plan(), &at, &options, &gpu.report().limits);
    let view = view.expect("a view");
    (frame, view, at)
}

/// The camera of [`view_by_rust`].
pub fn camera_of(at: &Camera) -> RidgelightCamera {
    RidgelightCamera {
        samples: 1,
        size: SIZE,
        azimuth_rad: at.azimuth_rad,
        elevation_rad: at.elevation_rad,
        target_m: at.target_m,
        distance_m: at.distance_m,
        fov_rad: 0.8,
        ..zeroed()
    }
}

/// A camera picture, heights from a buffer and from an image: the library's own, byte for byte.
#[test]
fn a_camera_of_c_draws_the_bytes_of_rust() {
    let (mut gpu, host) = device();
    let field = field();
    let (frame, view_of_rust, at) = view_by_rust(&mut gpu, &field);
    let right = gpu.look(&frame, &view_of_rust, None).expect("a picture").radiance;
    let lent = gpu.host().clone();
    let target = Target::new(&lent);
    let bytes: Vec<u8> = field.heights_m().iter().flat_map(|v| v.to_ne_bytes()).collect();
    let buffer = Staging::new(gpu.host(), &bytes);
    let camera = camera_of(&at);
    let [of_heights, of_light, of_picture] =
        [&frame.inputs()[0], &frame.outputs()[0], &target.arg()].map(image);
    let (mut plan, mut view, mut renderer) = (ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
    let (argument, setting) = (RidgelightResult::Argument, RidgelightResult::Setting);
    // SAFETY: structs and handles of this function, alive until its end.
    unsafe {
        good(ridgelight_plan_create(&host, &scene(), ptr::null(), 0, 0, &mut plan));
        good(ridgelight_plan_take_buffer(plan, 0, vk::Format::UNDEFINED));
        good(ridgelight_renderer_create(&host, plan, 1, ptr::null(), &mut renderer));
        let mut make = |camera: &RidgelightCamera, format| {
            let (scene, none) = (scene(), ptr::null());
            ridgelight_view_create(&host, &scene, plan, camera, format, 2, none, &mut view)
        };
        let low = RidgelightCamera { elevation_rad: 2.0, ..camera };
        refused(make(&low, FORMAT), setting, "elevation");
        let none = RidgelightCamera { size: [0, 12], ..camera };
        refused(make(&none, FORMAT), setting, "picture size");
        refused(make(&camera, vk::Format::R8_UINT), setting, "picture: format");
        good(make(&camera, FORMAT));

        let input = RidgelightImage {
            image: vk::Image::null(),
            view: vk::ImageView::null(),
            buffer: buffer.arg().buffer,
            buffer_bytes: buffer.arg().bytes,
            ..of_heights
        };
        let mut taken: RidgelightImage = zeroed();
        refused(ridgelight_taken(renderer, 1, &mut taken), argument, "index: found 1");
        good(ridgelight_taken(renderer, 0, &mut taken));
        let images = RidgelightViewImages {
            heights: &of_heights,
            radiance: &of_light,
            picture: &of_picture,
            ..zeroed()
        };
        for (slot, heights) in [(0, &of_heights), (1, &taken)] {
            submit(&gpu, |commands| {
                let record = |camera: *const RidgelightCamera, images: &RidgelightViewImages| {
                    ridgelight_view_record(view, commands, slot, camera, images)
                };
                let lost = RidgelightViewImages { picture: ptr::null(), ..images };
                refused(record(&camera, &lost), argument, "picture: found a null pointer");
                let of_buffer = RidgelightViewImages { heights: &input, ..images };
                refused(record(&camera, &of_buffer), argument, "heights: found a buffer");
                let wide = RidgelightCamera { size: [64, 64], ..camera };
                refused(record(&wide, &images), setting, "view: found another shape");
                let vast = RidgelightCamera { size: [1 << 30, 1], ..camera };
                refused(
                    record(&vast, &images),
                    RidgelightResult::Limit,
                    "a picture of 1073741824 × 1",
                );
                good(ridgelight_record(renderer, commands, 0, &input, 1, &of_light, 1));
                let of = RidgelightViewImages { heights, ..images };
                good(record(if slot == 0 { ptr::null() } else { &camera }, &of));
                target.copy(&lent, commands);
            });
            assert!(target.texels(&lent) == right, "slot {slot}");
            let mut times: Vec<RidgelightTiming> = (0..3).map(|_| zeroed()).collect();
            let mut count = 3;
            good(ridgelight_view_timings(view, slot, times.as_mut_ptr(), &mut count));
            assert!(count == 2 || gpu.report().timestamp_period_ns == 0.0, "{count}");
        }
        let mut distance_m = 0.0;
        good(ridgelight_view_distance(view, 0.25, &mut distance_m));
        assert_eq!(distance_m, view_of_rust.distance_m(0.25));
        ridgelight_view_destroy(view);
        ridgelight_renderer_destroy(renderer);
        ridgelight_plan_destroy(plan);
    }
    target.end(&lent);
    buffer.end(gpu.host());
    gpu.end(frame);
    assert_eq!(gpu.take_messages(), [""; 0]);
}

#[test]
fn refused_plans_name_the_field() {
    let (gpu, host) = device();
    let mut plan = ptr::null_mut();
    let (argument, setting) = (RidgelightResult::Argument, RidgelightResult::Setting);
    let mut refuse = |scene: RidgelightScene, quality: RidgelightQuality, flags, code, named| {
        // SAFETY: structs of this function; pointers that are null, or of this function, too.
        let made = unsafe { ridgelight_plan_create(&host, &scene, &quality, flags, 0, &mut plan) };
        refused(made, code, named);
        assert!(plan.is_null());
    };
    let sun: RidgelightSun = RidgelightSun { elevation_rad: 2.0, irradiance: [1.0; 3], ..zeroed() };
    let of_scene: [(RidgelightScene, _, &str); 6] = [
        (RidgelightScene { rows: 0, ..scene() }, argument, "scene: rows and cols"),
        (RidgelightScene { border: 4, ..scene() }, argument, "scene: border"),
        (RidgelightScene { has_environment: 1, ..scene() }, argument, "environment_width"),
        (RidgelightScene { sky: [0.0; 3], ..scene() }, setting, "lights: found none"),
        (RidgelightScene { suns: &sun, sun_count: 1, ..scene() }, setting, "sun 1: elevation"),
        (RidgelightScene { sun_count: 1, ..scene() }, argument, "sun 0: found a null pointer"),
    ];
    for (scene, code, named) in of_scene {
        refuse(scene, zeroed(), 0, code, named);
    }
    let of_quality: [(RidgelightQuality, _, &str); 3] = [
        (RidgelightQuality { fuse: 7, ..zeroed() }, argument, "quality: fuse"),
        (RidgelightQuality { azimuths: 3, ..zeroed() }, setting, "azimuths"),
        (RidgelightQuality { level_offset_plus_1: 6, ..zeroed() }, setting, "level_offset"),
    ];
    for (quality, code, named) in of_quality {
        refuse(scene(), quality, 0, code, named);
    }
    refuse(scene(), zeroed(), 16, argument, "picture: found 16");
    let light: RidgelightSphereLight = RidgelightSphereLight { radius_m: 1.0, ..zeroed() };
    let with_light = RidgelightScene { spheres: &light, sphere_count: 1, ..scene() };
    let flag = RIDGELIGHT_PICTURE_COLOURS_ON_DEVICE;
    refuse(with_light, zeroed(), flag, setting, "picture: colours_on_device: found a sphere light");
    // SAFETY: as above.
    let made = unsafe { ridgelight_plan_create(&host, &scene(), ptr::null(), 0, 1, &mut plan) };
    refused(made, RidgelightResult::Limit, "the limit is");
    drop(gpu);
}

/// Zeros are the defaults, and no two fields are mixed up.
#[test]
fn every_setting_of_c_is_the_one_of_rust() {
    let (gpu, host) = device();
    let settings = |quality: RidgelightQuality| {
        let mut plan = ptr::null_mut();
        let scene = RidgelightScene {
            has_environment: 1,
            environment_width: 16,
            environment_height: 8,
            ..scene()
        };
        // SAFETY: structs of this function; a handle that is given up.
        unsafe {
            good(ridgelight_plan_create(&host, &scene, &quality, 0, 0, &mut plan));
            let settings = (*plan).settings().to_vec();
            ridgelight_plan_destroy(plan);
            settings
        }
    };
    let default = settings(zeroed());
    let changed = |quality: RidgelightQuality, name: &str, value: &str| {
        let of = settings(quality);
        let has = of.iter().any(|s| s.0 == name && s.1 == value);
        let had = default.iter().any(|s| s.0 == name && s.1 == value);
        assert!(has && !had, "{name} {value}: {of:?}, of zeros {default:?}");
    };
    let zero = zeroed::<RidgelightQuality>;
    changed(RidgelightQuality { azimuths: 64, ..zero() }, "azimuths", "64");
    changed(RidgelightQuality { method: 4, ..zero() }, "method", "brute-force");
    changed(RidgelightQuality { fuse: 5, ..zero() }, "fuse", "aimed");
    changed(RidgelightQuality { table_elevations: 64, ..zero() }, "table_elevations", "64");
    let sh = || RidgelightQuality { basis: 3, ..zero() };
    changed(sh(), "basis", "sh");
    changed(RidgelightQuality { sh_order: 3, ..sh() }, "sh_order", "3");
    changed(RidgelightQuality { wedges: 2, ..sh() }, "wedges", "nlp");
    changed(RidgelightQuality { receiver: 2, ..sh() }, "receiver", "cosine");
    changed(RidgelightQuality { window: 3, ..sh() }, "window", "hann");
    changed(RidgelightQuality { subsample: 2, ..sh() }, "subsample", "2");
    let levels = || RidgelightQuality { method: 3, ..zero() };
    changed(RidgelightQuality { level_step: 2, ..levels() }, "level_step", "2");
    changed(RidgelightQuality { level_offset_plus_1: 1, ..levels() }, "level_offset", "0");
    changed(RidgelightQuality { levels: 2, ..levels() }, "levels", "pyramid");
    changed(RidgelightQuality { bounces: 1, ..zero() }, "bounces", "1");
    drop(gpu);
}

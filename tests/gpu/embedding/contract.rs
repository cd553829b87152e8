//! The embedding contract: record only, check first, leave the requested states.

use ash::vk;
use ridgelight::gpu::Renderer;
use ridgelight::plan::{self, Limits, Picture, missing_barriers};
use ridgelight::scene::{Border, Environment, Fuse, Hull, Lines, Method, Quality, Sun};

use crate::{Device, field, under_sky};

#[test]
fn wrong_contents_are_refused_by_name_and_the_device_goes_on() {
    let mut device = Device::new();
    let scene = under_sky(field(8, 8, [1.0, 1.0], |_, _| 0.0), Border::Plane);
    let plan = plan::picture(&scene, &Quality::default(), &device.limits(), Picture::default())
        .expect("a plan");
    let gpu = device.gpu.as_mut().expect("alive");
    let error = gpu.frame(plan.clone(), &[&[0.0; 63]]).err().expect("63 values are not 64");
    assert!(error.to_string().contains("heights"), "{error}");
    let error = gpu.frame(plan.clone(), &[] as &[&[f32]]).err().expect("an input is missing");
    assert!(error.to_string().contains("inputs"), "{error}");
    let mut frame = gpu.frame(plan, &[&[0.0; 64]]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let pass = gpu.draw_passes(&mut frame, &[99]).expect_err("no such pass");
    assert!(pass.to_string().contains("pass"), "{pass}");
    gpu.end(frame);
}

#[test]
fn a_field_that_changes_gives_what_a_new_field_gives() {
    let mut device = Device::new();
    let scene = |h: f64| {
        under_sky(field(16, 16, [1.0, 1.0], |r, c| h * ((r * c) % 5) as f64), Border::Plane)
    };
    let (first, second) = (scene(1.0), scene(-2.0));
    let quality = Quality { azimuths: 8, ..Quality::default() };
    let fresh = device.picture(&second, &quality).values;
    let plan =
        plan::picture(&first, &quality, &device.limits(), Picture::default()).expect("a plan");
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = gpu.frame(plan, &[first.field.heights_m()]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    gpu.refill(&frame, 0, second.field.heights_m()).expect("new heights");
    gpu.draw(&mut frame).expect("drawn again");
    let again = gpu.pixels(&frame, 0).expect("pixels").values;
    gpu.end(frame);
    assert_eq!(again, fresh);
}

/// A plan with images beyond the device's limits is refused before Vulkan is called, so validation reports nothing.
#[test]
fn a_plan_beyond_the_device_is_refused() {
    let mut device = Device::new();
    let side = 2 * device.limits().image_side as usize;
    let scene = under_sky(field(4, side, [1.0, 1.0], |_, c| (c % 5) as f64), Border::Plane);
    let quality = Quality { azimuths: 4, ..Quality::default() };
    let limits = Limits::boundless(true, 8 << 30);
    let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
    let gpu = device.gpu.as_mut().expect("alive");
    let error = gpu.frame(plan, &[scene.field.heights_m()]).err().expect("an error").to_string();
    assert!(error.contains(&format!("{side} ×")) && error.contains("of this device"), "{error}");
}

/// Half of the largest heap of the device's own memory; all of it where a software driver states it.
#[test]
fn a_plan_may_take_half_of_a_devices_memory_and_all_of_a_software_drivers() {
    let device = Device::new();
    let gpu = device.gpu.as_ref().expect("alive");
    let host = gpu.host();
    // SAFETY: the physical device is the instance's.
    let memory =
        unsafe { host.instance.get_physical_device_memory_properties(host.physical_device) };
    let heaps = &memory.memory_heaps[..memory.memory_heap_count as usize];
    let local = heaps.iter().filter(|h| h.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL));
    let heap = local.map(|h| h.size).max().expect("a heap of its own");
    let limits = gpu.report().limits;
    let share = if limits.is_cpu { 1 } else { 2 };
    assert_eq!(limits.memory_budget, heap / share);
}

/// Silent validation must be able to fail: it reports a plan without its barriers.
#[test]
fn missing_barriers_are_reported() {
    let mut device = Device::new();
    let scene = under_sky(field(16, 16, [1.0, 1.0], |_, c| c as f64), Border::Plane);
    let mut plan = plan::picture(&scene, &Quality::default(), &device.limits(), Picture::default())
        .expect("a plan");
    for pass in &mut plan.passes {
        pass.barrier_before = false;
    }
    assert!(!missing_barriers(&plan.passes).is_empty(), "the audit of the plan sees them");
    if !device.validates {
        println!("not validated: RIDGELIGHT_VALIDATION is not 1");
        return;
    }
    device.draw(plan, &[scene.field.heights_m()]);
    let messages = device.gpu.as_ref().expect("alive").take_messages();
    assert!(
        messages.iter().any(|m| m.contains("hazard detected")),
        "validation reports nothing: {messages:?}"
    );
}

#[test]
fn timings_name_every_pass() {
    let mut device = Device::new();
    let scene = under_sky(field(16, 16, [1.0, 1.0], |_, c| c as f64), Border::Plane);
    let plan = plan::picture(&scene, &Quality::default(), &device.limits(), Picture::default())
        .expect("a plan");
    let labels: Vec<String> = plan.passes.iter().map(plan::Pass::label).collect();
    let has_timestamps = device.report().timestamp_period_ns > 0.0;
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = gpu.frame(plan, &[scene.field.heights_m()]).expect("a frame");
    let times = gpu.draw(&mut frame).expect("drawn");
    gpu.end(frame);
    if has_timestamps {
        assert_eq!(times.iter().map(|t| t.label.clone()).collect::<Vec<_>>(), labels);
    } else {
        assert!(times.is_empty());
    }
}

#[test]
fn every_kind_of_plan_runs_silently_and_has_all_its_barriers() {
    let mut device = Device::new();
    let environment =
        Environment::new(16, 8, vec![[0.5, 0.4, 0.3]; 128], 0.3).expect("an environment");
    let mut scene =
        under_sky(field(24, 20, [1.0, 1.0], |r, c| ((r * 31 + c * 17) % 7) as f64), Border::Plane);
    scene.lights.environment = Some(environment);
    let sun = |diameter_rad| Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.5,
        diameter_rad,
        irradiance: [1.0, 0.9, 0.8],
    };
    scene.lights.suns = vec![sun(0.0), sun(0.02)];
    let qualities = [
        Quality { method: Method::BruteForce, ..Quality::default() },
        Quality {
            method: Method::Sweep,
            hull: Hull::Shared,
            fuse: Fuse::Own,
            ..Quality::default()
        },
        Quality {
            method: Method::Sweep,
            hull: Hull::OccluderList,
            fuse: Fuse::Slopes,
            ..Quality::default()
        },
        Quality { lines: Lines::TwoCells, fuse: Fuse::Aimed, ..Quality::default() },
        Quality { lines: Lines::HalfCell, fuse: Fuse::Nearest, ..Quality::default() },
    ];
    let borders = [Border::Plane, Border::Open, Border::Periodic];
    // Every quality once, borders in turn: software drivers take seconds to compile each pipeline.
    for (i, quality) in qualities.into_iter().enumerate() {
        scene.surface.border = borders[i % 3];
        {
            let quality = Quality { azimuths: 8, ..quality };
            let plan = plan::picture(
                &scene,
                &quality,
                &device.limits(),
                Picture { light_layers: true, sky_view: true, ..Picture::default() },
            )
            .expect("a plan");
            assert_eq!(missing_barriers(&plan.passes), []);
            let texels: Vec<f32> = [0.5, 0.4, 0.3, 1.0].repeat(128);
            let outputs = device.draw(plan, &[scene.field.heights_m(), &texels]);
            assert_eq!(outputs.len(), 6, "the whole, four lights and the sky view");
            // The whole is the sum of its lights, in the order of adding.
            let names: Vec<&str> = outputs.iter().map(|o| o.name.as_str()).collect();
            assert_eq!(
                names,
                ["radiance", "direct.sky", "direct.env", "direct.sun1", "direct.sun2", "sky_view"]
            );
            for i in (0..outputs[0].values.len()).filter(|i| i % 4 < 3) {
                let sum = outputs[1..5].iter().fold(0.0_f32, |s, o| s + o.values[i]);
                assert_eq!(sum.to_bits(), outputs[0].values[i].to_bits());
                assert!(sum.is_finite() && sum >= 0.0);
            }
        }
    }
}

/// Small plans share a block of 4 MiB in each type of memory. At most four of the device's are used: for images, buffers, uploads and
/// readbacks. Larger plans have their own blocks, and each block wastes less than the size that did not fit: at most half of all memory held.
#[test]
fn memory_taken_is_near_the_planned_bytes() {
    const BLOCK: u64 = 4 << 20;
    let mut device = Device::new();
    for side in [16, 512] {
        let heights = field(side, side, [1.0, 1.0], |r, c| ((r * 31 + c * 17) % 7) as f64);
        let scene = under_sky(heights, Border::Plane);
        let plan = plan::picture(&scene, &Quality::default(), &device.limits(), Picture::default())
            .expect("a plan");
        let needed = plan.internal_bytes();
        let gpu = device.gpu.as_mut().expect("alive");
        let host = gpu.host();
        // SAFETY: the physical device is the instance's.
        let memory =
            unsafe { host.instance.get_physical_device_memory_properties(host.physical_device) };
        // lavapipe has one type, for the device's blocks and the host's.
        let blocks = u64::from(memory.memory_type_count.clamp(2, 4));
        let renderer = Renderer::new(host, plan, 1).expect("a renderer");
        let taken = renderer.device_bytes();
        renderer.destroy();
        println!("{side}²: {needed} bytes needed, {taken} taken");
        assert!(taken >= needed && taken <= 2 * needed + blocks * BLOCK, "{needed} {taken}");
    }
}

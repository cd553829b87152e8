//! Pictures of a camera against f64 rays that test every triangle, and against closed forms.

mod plinth;
mod rays;

use std::f64::consts::FRAC_PI_2;

use ash::vk::{self, Handle};
use ridgelight::gpu::{ImageArg, ImageState, ViewInputs, ViewOutputs, ViewRenderer};
use ridgelight::plan::{self, Picture, View, ViewOptions};
use ridgelight::scene::Tone;
use ridgelight::scene::{Border, Camera, Environment, HeightField, Lens, Scene};
use ridgelight_cpu::picture_tone::picture_tone;

use crate::{Device, field, under_sky};
use rays::{LENSES, ROUNDING, Shot, around, quality, shoot, uneven};

#[test]
fn pictures_match_ray_casting() {
    let mut device = Device::new();
    let options = ViewOptions { size: [32, 24], samples: 1, ..ViewOptions::default() };
    for (lens, (compass, elevation)) in
        LENSES.into_iter().flat_map(|l| [(200.0, 25.0), (40.0, 70.0)].map(|a| (l, a)))
    {
        let scene = uneven(7);
        let camera = around(&scene, compass, elevation, lens, &options);
        let shot = shoot(&mut device, scene, camera, options);
        let held = shot.check();
        let ground = shot.visible.distances_m.iter().filter(|d| d.is_finite()).count();
        println!("{lens:?}, {compass}°, {elevation}°: {held} of 768 held, {ground} of ground");
        assert!(held > 600 && ground > 170, "{held}, {ground}");
    }
}

/// From within, near the ground: geometry behind the eye and beside the picture is clipped.
#[test]
fn a_camera_above_the_field_draws_the_ground_before_it() {
    let mut device = Device::new();
    let options = ViewOptions { size: [32, 24], samples: 1, ..ViewOptions::default() };
    let scene = uneven(3);
    let camera = Camera {
        target_m: [40.0, 50.0, 103.0],
        azimuth_rad: -1.2,
        elevation_rad: 0.1,
        distance_m: 15.0,
        lens: Lens::Perspective { fov_rad: 1.2 },
    };
    let shot = shoot(&mut device, scene, camera, options);
    let held = shot.check();
    println!("{held} of 768 held");
    assert!(held > 570, "{held}");
}

/// The comparison fails for a picture whose camera is a pixel aside.
#[test]
fn a_picture_from_elsewhere_is_refused() {
    let mut device = Device::new();
    let options = ViewOptions { size: [24, 18], samples: 1, ..ViewOptions::default() };
    let scene = uneven(7);
    let camera = around(&scene, 200.0, 25.0, LENSES[0], &options);
    let mut shot = shoot(&mut device, scene, camera, options);
    let compared = |shot: &Shot| {
        std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| shot.check())).is_ok()
    };
    assert!(compared(&shot));
    shot.camera.azimuth_rad += 0.02;
    assert!(!compared(&shot), "0.02 rad were not visible");
    shot.camera.azimuth_rad -= 0.02;
    shot.options.mesh_step = 2;
    assert!(!compared(&shot), "another mesh was not visible");
}

#[test]
fn reduced_meshes_and_holes_match_ray_casting() {
    let mut device = Device::new();
    let options =
        ViewOptions { size: [32, 24], samples: 1, mesh_step: 3, ..ViewOptions::default() };
    let scene = uneven(5);
    let camera = around(&scene, 150.0, 40.0, LENSES[0], &options);
    let held = shoot(&mut device, scene.clone(), camera, options).check();
    assert!(held > 570, "{held}");
    let Scene { field, .. } = &scene;
    let heights: Vec<f64> = field.heights_m().iter().map(|h| f64::from(*h)).collect();
    let voids = (0..heights.len()).map(|i| (i / 33 + i % 33) % 11 == 5 && i % 33 > 12).collect();
    let holed = HeightField::new(29, 33, &heights, field.cell_m(), Some(voids)).expect("a field");
    let scene = Scene { field: holed, ..scene };
    for mesh_step in [1, 3] {
        let options = ViewOptions { mesh_step, background: [0.1, 0.7, 0.2], ..options };
        let camera = around(&scene, 150.0, 40.0, LENSES[0], &options);
        let shot = shoot(&mut device, scene.clone(), camera, options);
        let held = shot.check();
        println!("step {mesh_step}: {held} of 768 held");
        assert!(held > 380, "{held}");
    }
}

/// An environment with a constant gradient, so that a small error of direction is a small error of light.
#[test]
fn behind_the_field_is_the_environment() {
    let mut device = Device::new();
    let texel = |i: usize| {
        let (row, col) = (i / 32, i % 32);
        let round = (col as f32 - 15.5).abs() / 16.0;
        [0.2 + round, 1.0 + row as f32 / 16.0, 0.5]
    };
    let mut scene = uneven(9);
    scene.lights.sky = None;
    scene.lights.environment =
        Some(Environment::new(32, 16, (0..512).map(texel).collect(), 0.8).expect("texels"));
    for elevation in [3.0, -20.0] {
        let options = ViewOptions { size: [24, 24], samples: 1, ..ViewOptions::default() };
        let camera = Camera {
            distance_m: 90.0,
            ..around(&scene, 100.0, elevation, Lens::Perspective { fov_rad: 1.6 }, &options)
        };
        let shot = shoot(&mut device, scene.clone(), camera, options);
        let held = shot.check();
        println!("{elevation}°: {held} of 576 held");
        assert!(held > 480, "{held}");
    }
}

/// From straight above, a pixel a texel: pixels' middles are texels, and the picture is the map. The mesh ends on the
/// outermost texels, so either ground or background may be visible there.
#[test]
fn a_level_field_from_straight_above_is_its_map() {
    let mut device = Device::new();
    let (rows, cols) = (20_u32, 24_u32);
    let mut scene =
        under_sky(field(rows as usize, cols as usize, [2.0, 2.0], |_, _| 5.0), Border::Plane);
    let map = (0..rows * cols).map(|i| [i as f32 / 480.0, (i % 7) as f32 / 7.0, 0.5]).collect();
    scene.surface.albedo = ridgelight::scene::Albedo::Map(map);
    let camera = Camera {
        target_m: [f64::from(cols - 1), f64::from(rows - 1), 5.0],
        azimuth_rad: -FRAC_PI_2,
        elevation_rad: FRAC_PI_2,
        distance_m: 100.0,
        lens: Lens::Orthographic { height_m: 2.0 * f64::from(rows) },
    };
    let options = ViewOptions { size: [cols, rows], samples: 1, ..ViewOptions::default() };
    let shot = shoot(&mut device, scene, camera, options);
    for (i, (got, want)) in shot.visible.radiance.iter().zip(&shot.lit).enumerate() {
        let (row, col) = (i as u32 / cols, i as u32 % cols);
        let is_edge = row == 0 || col == 0 || row == rows - 1 || col == cols - 1;
        for k in (0..3).filter(|_| !is_edge) {
            // A vertex and a middle with an error of one rounding of the picture, within one cell.
            let off = (got[k] - want[k]).abs();
            assert!(f64::from(off) <= 24.0 * ROUNDING, "({row}, {col}): {got:?} for {want:?}");
            let far = f64::from(shot.visible.distances_m[i]);
            assert!((far - 100.0).abs() <= 100.0 * ROUNDING, "{far}");
        }
    }
}

/// The device's own MSAA sample counts for pictures of floats and depths.
fn offered(device: &Device) -> Vec<u32> {
    let host = device.gpu.as_ref().expect("alive").host();
    let both = [
        (vk::Format::R32G32B32A32_SFLOAT, vk::ImageUsageFlags::COLOR_ATTACHMENT),
        (vk::Format::D32_SFLOAT, vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT),
    ];
    let counts = both.map(|(format, usage)| {
        let (kind, tiling) = (vk::ImageType::TYPE_2D, vk::ImageTiling::OPTIMAL);
        let flags = vk::ImageCreateFlags::empty();
        // SAFETY: the physical device is the instance's.
        let properties = unsafe {
            host.instance.get_physical_device_image_format_properties(
                host.physical_device,
                format,
                kind,
                tiling,
                usage,
                flags,
            )
        };
        properties.expect("images that are drawn into").sample_counts
    });
    let has = |n: &u32| counts.iter().all(|c| c.contains(vk::SampleCountFlags::from_raw(*n)));
    [1, 2, 4, 8].into_iter().filter(has).collect()
}

/// The western edge of level ground of radiance 1 passes through the middle of a column of pixels, before a black
/// background: half of 2, of 4 and of 8 standard sample positions are east of it (Vulkan, standard sample locations).
/// Counts that a device lacks are refused with those that it has.
#[test]
fn a_pixel_half_covered_is_half_as_bright() {
    let mut device = Device::new();
    let offered = offered(&device);
    assert!(offered.contains(&1) && offered.contains(&4), "every device has these: {offered:?}");
    let scene = under_sky(field(9, 9, [2.0, 2.0], |_, _| 0.0), Border::Plane);
    let camera = Camera {
        target_m: [0.0, 8.0, 0.0],
        azimuth_rad: -FRAC_PI_2,
        elevation_rad: FRAC_PI_2,
        distance_m: 10.0,
        lens: Lens::Orthographic { height_m: 9.0 },
    };
    for samples in [1, 2, 4, 8] {
        let options = ViewOptions { size: [9, 9], samples, ..ViewOptions::default() };
        if !offered.contains(&samples) {
            let limits = device.limits();
            let lit = plan::picture(&scene, &quality(), &limits, Picture::default());
            let lit = lit.expect("a plan");
            let view = View::new(&scene, &lit, &camera, &options, &limits).expect("a view");
            let host = device.gpu.as_ref().expect("alive").host();
            let made = ViewRenderer::new(host, &view, vk::Format::R32G32B32A32_SFLOAT, 1);
            let all: Vec<String> = offered.iter().map(u32::to_string).collect();
            let says = format!(
                "samples a pixel: found {samples}, expected {}, which this device has",
                all.join(" or ")
            );
            assert_eq!(made.err().expect("refused").to_string(), says);
            println!("{says}");
            continue;
        }
        let middle = if samples == 1 { [0.0, 1.0] } else { [0.5, 0.5] };
        let shot = shoot(&mut device, scene.clone(), camera, options);
        for (i, got) in shot.visible.radiance.iter().enumerate() {
            let want = match i % 9 {
                0..=3 => [0.0; 2],
                4 => middle,
                _ => [1.0; 2],
            };
            let is_one = want.iter().any(|w| (f64::from(got[0]) - w).abs() <= 1e-6);
            assert!(is_one, "{samples} samples, column {}: {got:?}", i % 9);
        }
    }
}

/// On a screen that encodes and on one that takes codes, the picture is a PNG's, to one code: powers are not exact.
#[test]
fn screen_formats_match_float_pictures() {
    let mut device = Device::new();
    let options = ViewOptions { size: [32, 24], ..ViewOptions::default() };
    let scene = uneven(11);
    let camera = around(&scene, 200.0, 25.0, LENSES[0], &options);
    let limits = device.limits();
    let plan = plan::picture(&scene, &quality(), &limits, Picture::default()).expect("a plan");
    let view = View::new(&scene, &plan, &camera, &options, &limits).expect("a view");
    let gpu = device.gpu.as_mut().expect("alive");
    let exposure = 0.9;
    let drawn = gpu.with_frame(plan, &[scene.field.heights_m()], |gpu, frame| {
        gpu.draw(frame)?;
        let linear = gpu.look(frame, &view, None)?.radiance;
        let mut shown = Vec::new();
        for format in [vk::Format::R8G8B8A8_UNORM, vk::Format::R8G8B8A8_SRGB] {
            shown.push(gpu.look_encoded(frame, (&view, exposure), format, None)?);
        }
        Ok((linear, shown))
    });
    let (linear, shown) = drawn.expect("pictures");
    let tone = Tone::picture(exposure);
    // The CPU reference, where the shader encodes: either code beside the value, within the error of powers: 3 units
    // of a logarithm of up to 9 over 2.4, as many of its exponential, and a rounding of each other step.
    let power = 32.0 * f64::from(f32::EPSILON);
    let channels =
        |codes: &[[u8; 4]]| codes.iter().flat_map(|c| c[..3].to_vec()).collect::<Vec<_>>();
    for (code, radiance) in channels(&shown[0]).into_iter().zip(linear.as_flattened()) {
        let off = f64::from(code) - 255.0 * picture_tone(*radiance, exposure);
        assert!(off.abs() < 1.0 + 255.0 * power, "{code} for {radiance}: {off}");
    }
    for codes in shown {
        let mut differ = 0;
        for (code, radiance) in codes.iter().zip(&linear) {
            for k in 0..3 {
                let want = tone.code(radiance[k]);
                assert!(code[k].abs_diff(want) <= 1, "{code:?} for {radiance:?}");
                differ += usize::from(code[k] != want);
            }
            assert_eq!(code[3], 255);
        }
        println!("{differ} of {} codes differ by one", 3 * linear.len());
        assert!(codes.iter().any(|c| c[0] > 20 && c[0] < 235), "all black or white");
    }
}

/// An error names the argument, and nothing is recorded: validation would report missing images.
#[test]
fn wrong_arguments_are_refused_by_name() {
    let mut device = Device::new();
    let options = ViewOptions { size: [8, 6], samples: 1, ..ViewOptions::default() };
    let scene = under_sky(field(9, 9, [1.0, 1.0], |r, _| r as f64), Border::Plane);
    let camera = around(&scene, 200.0, 25.0, LENSES[0], &options);
    let limits = device.limits();
    let plan = plan::picture(&scene, &quality(), &limits, Picture::default()).expect("a plan");
    let view = |options| View::new(&scene, &plan, &camera, &options, &limits).expect("a view");
    let (right, wide) = (view(options), view(ViewOptions { size: [9, 6], ..options }));
    let gpu = device.gpu.as_mut().expect("alive");
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let strange = ViewRenderer::new(gpu.host(), &right, vk::Format::R8_UINT, 1);
    assert!(strange.err().expect("no format of pictures").to_string().contains("picture: format"));
    let mut frame = gpu.frame(plan.clone(), &[scene.field.heights_m()]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let mut renderer = ViewRenderer::new(gpu.host(), &right, format, 1).expect("a renderer");
    let (heights, radiance) = (frame.inputs()[0], frame.outputs()[0]);
    // Never drawn into.
    let picture = ImageArg { format, extent: [8, 6, 1], image: vk::Image::from_raw(1), ..radiance };
    let inputs = ViewInputs { heights, radiance, environment: None, voids: None };
    let outputs = ViewOutputs { picture, depth: None };
    let small = |arg: ImageArg| ImageArg { extent: [8, 9, 1], ..arg };
    let before = |arg: ImageArg| ImageArg {
        before: ImageState { layout: vk::ImageLayout::UNDEFINED, ..arg.before },
        ..arg
    };
    let after = |arg: ImageArg| ImageArg {
        after: ImageState { layout: vk::ImageLayout::UNDEFINED, ..arg.after },
        ..arg
    };
    let nowhere = |state: ImageState| ImageState { stage: vk::PipelineStageFlags2::NONE, ..state };
    let of_depth = |state: ImageState| ImageState {
        layout: vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL,
        ..state
    };
    let depth = ImageArg {
        format: vk::Format::D32_SFLOAT,
        image: vk::Image::from_raw(2),
        after: ImageState { layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, ..picture.after },
        ..picture
    };
    let other = |arg: ImageArg| ImageArg { format: vk::Format::R8G8B8A8_UNORM, ..arg };
    let read = |heights, radiance| ViewInputs { heights, radiance, ..inputs };
    let drawn = |picture| ViewOutputs { picture, ..outputs };
    let cases = [
        (1, &right, inputs, outputs, "slot: found 1"),
        (0, &wide, inputs, outputs, "view: found another shape"),
        (0, &right, read(small(heights), radiance), outputs, "heights: extent"),
        (0, &right, read(other(heights), radiance), outputs, "heights: format"),
        (0, &right, read(before(heights), radiance), outputs, "heights: layout before"),
        (0, &right, read(heights, small(radiance)), outputs, "radiance: extent"),
        (0, &right, read(heights, heights), outputs, "radiance: found the image of heights"),
        (0, &right, inputs, drawn(small(picture)), "picture: extent"),
        (0, &right, inputs, drawn(other(picture)), "picture: format"),
        (0, &right, inputs, drawn(after(picture)), "picture: layout after"),
        (0, &right, inputs, ViewOutputs { depth: Some(picture), ..outputs }, "depth: format"),
        (0, &right, inputs, ViewOutputs { depth: Some(depth), ..outputs }, "depth: layout after"),
        (
            0,
            &right,
            read(ImageArg { before: nowhere(heights.before), ..heights }, radiance),
            outputs,
            "heights: stage before: found NONE",
        ),
        (
            0,
            &right,
            read(heights, ImageArg { before: of_depth(radiance.before), ..radiance }),
            outputs,
            "radiance: layout before: found DEPTH_ATTACHMENT_OPTIMAL",
        ),
        (
            0,
            &right,
            inputs,
            drawn(ImageArg { after: of_depth(picture.after), ..picture }),
            "picture: layout after: found DEPTH_ATTACHMENT_OPTIMAL",
        ),
    ];
    for (slot, view, inputs, outputs, says) in cases {
        let refused = gpu
            .run(|commands| renderer.record(commands, slot, (view, 1.0), &inputs, &outputs))
            .expect_err(says);
        assert!(refused.to_string().contains(says), "{refused} does not say {says}");
    }
    assert_eq!(renderer.timings(0), None);
    renderer.destroy();
    gpu.end(frame);
}

//! Pictures before a camera, beside rays in f64 against every triangle, and where they are derived.

use std::f64::consts::{FRAC_PI_2, PI};

use ash::vk::{self, Handle};
use ridgelight::cpu::picture_tone::picture_tone;
use ridgelight::cpu::sky_draw::sky_draw;
use ridgelight::cpu::terrain_draw::{Met, colour, ray, terrain_draw};
use ridgelight::files::Tone;
use ridgelight::gpu::{ImageArg, ImageState, Seen, ViewInputs, ViewOutputs, ViewRenderer};
use ridgelight::plan::{self, Picture, View, ViewOptions};
use ridgelight::scene::{
    Border, Camera, Environment, HeightField, Lens, Method, Quality, Scene, Sun,
};

use crate::{Device, field, random, under_sky};

/// Bits of a picture's place that every device keeps: `subPixelPrecisionBits` is 4 or more. Vertices are moved to the
/// nearest such place.
const SNAP: f64 = 0.5 / 16.0;

/// Parts of the picture that a vertex is off by before that: a few roundings of numbers about as large as the picture.
const ROUNDING: f64 = 1.0 / (1 << 20) as f64;

/// Radiance, and distance, infinite where there is no ground.
type Truth = ([f64; 3], f64);

struct Shot {
    scene: Scene,
    camera: Camera,
    options: ViewOptions,
    /// The lit field.
    lit: Vec<[f32; 3]>,
    seen: Seen,
}

fn quality() -> Quality {
    Quality { method: Method::Sweep, azimuths: 8, ..Quality::default() }
}

/// Lights a scene, and draws it as a camera sees it.
fn shoot(device: &mut Device, scene: Scene, camera: Camera, options: ViewOptions) -> Shot {
    let limits = device.limits();
    let plan = plan::picture(&scene, &quality(), &limits, Picture::default()).expect("a plan");
    let view = View::new(&scene, &plan, &camera, &options, &limits).expect("a view");
    let contents = plan::picture_inputs(&scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let gpu = device.gpu.as_mut().expect("alive");
    let (lit, seen) = gpu
        .with_frame(plan, &contents, |gpu, frame| {
            gpu.draw(frame)?;
            let lit = gpu.pixels(frame, 0)?;
            let channels = lit.channels;
            let texel = |t: &[f32]| [t[0], t[channels.min(3) / 2], t[(channels - 1).min(2)]];
            let lit: Vec<[f32; 3]> = lit.values.chunks_exact(channels).map(texel).collect();
            Ok((lit, gpu.look(frame, &view, scene.field.voids())?))
        })
        .expect("a picture");
    Shot { scene, camera, options, lit, seen }
}

impl Shot {
    fn met(&self, pixel: [f64; 2]) -> Option<Met> {
        let Shot { scene, camera, options, .. } = self;
        terrain_draw(&scene.field, camera, (options.size, pixel), options.mesh_step)
    }

    /// Radiance and distance at a place of the picture, in f64.
    fn truth(&self, pixel: [f64; 2]) -> Truth {
        match self.met(pixel) {
            Some(met) => (colour(&self.scene.field, &self.lit, &met), met.distance_m),
            None => {
                let [_, along] = ray(&self.camera, self.options.size, pixel);
                (sky_draw(&self.scene, self.options.background, along), f64::INFINITY)
            }
        }
    }

    /// Compares every pixel with the rays about its middle: a triangle whose vertices have moved shows there what is
    /// true at a place no farther away than they have moved. Where all of these rays meet ground, or none does, the
    /// pixel must; its distance and its light must be between theirs, give or take as much as they differ (a crease
    /// between two rays stands out by no more) and roundings. Returns how many pixels were held to it: elsewhere an
    /// edge of the ground passes.
    fn check(&self) -> usize {
        let [width, height] = self.options.size;
        let away = SNAP + ROUNDING * f64::from(width.max(height));
        let mut held = 0;
        for i in 0..self.seen.radiance.len() {
            let at = [i % width as usize, i / width as usize].map(|v| v as f64 + 0.5);
            let around = [-1.0, 0.0, 1.0].map(|y| [-1.0, 0.0, 1.0].map(|x| [x * away, y * away]));
            let truths: Vec<Truth> =
                around.iter().flatten().map(|d| self.truth([at[0] + d[0], at[1] + d[1]])).collect();
            let met = truths.iter().filter(|t| t.1.is_finite()).count();
            if met != 0 && met != truths.len() {
                continue;
            }
            held += 1;
            let got = f64::from(self.seen.distances_m[i]);
            assert_eq!(got.is_finite(), met > 0, "pixel {at:?}: {got} for {truths:?}");
            let edge = f64::from(width.max(height));
            let range = |of: &dyn Fn(&Truth) -> f64| {
                let low = truths.iter().map(of).fold(f64::INFINITY, f64::min);
                let high = truths.iter().map(of).fold(f64::NEG_INFINITY, f64::max);
                (low, high, (high - low) / away)
            };
            let check = |got: f64, (low, high, _): (f64, f64, f64), rounding: f64| {
                let give = high - low + rounding;
                assert!(
                    (low - give..=high + give).contains(&got),
                    "pixel {at:?}: {got} beyond {low} to {high}, give or take {give}"
                );
            };
            if met > 0 {
                // Interpolated over the picture: as large a part of its change from edge to edge is lost, and of it.
                let distances = range(&|t| t.1);
                check(got, distances, ROUNDING * (distances.1 + distances.2 * edge));
            }
            for k in 0..3 {
                let light = range(&|t| t.0[k]);
                // An angle of the sky is off by 4096 roundings (Vulkan, precision of atan).
                let turned = if met > 0 { 0.0 } else { PI * 4096.0 * f64::from(f32::EPSILON) };
                let pixels = (turned + ROUNDING) * edge;
                check(
                    f64::from(self.seen.radiance[i][k]),
                    light,
                    ROUNDING * light.1 + light.2 * pixels,
                );
            }
        }
        held
    }
}

/// Uneven ground under a coloured sky and a sun, cells that are not square.
fn uneven(seed: u64) -> Scene {
    let mut next = random(seed);
    let heights: Vec<f64> = (0..33 * 29).map(|_| 100.0 + 3.0 * next()).collect();
    let rough = HeightField::new(29, 33, &heights, [2.0, 3.0], None).expect("a field");
    let mut scene = under_sky(rough, Border::Plane);
    scene.lights.sky = Some([0.3, 0.5, 0.9]);
    scene.lights.suns = vec![Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.6,
        diameter_rad: 0.0,
        irradiance: [3.0, 2.0, 1.0],
    }];
    scene
}

fn around(
    scene: &Scene,
    compass: f64,
    elevation: f64,
    lens: Lens,
    options: &ViewOptions,
) -> Camera {
    let angles = [(90.0 - compass).to_radians(), elevation.to_radians()];
    Camera::around(&scene.field, None, angles, lens, options.aspect())
}

const LENSES: [Lens; 2] =
    [Lens::Perspective { fov_rad: 0.7 }, Lens::Orthographic { height_m: 1.0 }];

#[test]
fn pictures_are_what_rays_meet() {
    let mut device = Device::new();
    let options = ViewOptions { size: [32, 24], samples: 1, ..ViewOptions::default() };
    for (lens, (compass, elevation)) in
        LENSES.into_iter().flat_map(|l| [(200.0, 25.0), (40.0, 70.0)].map(|a| (l, a)))
    {
        let scene = uneven(7);
        let camera = around(&scene, compass, elevation, lens, &options);
        let shot = shoot(&mut device, scene, camera, options);
        let held = shot.check();
        let ground = shot.seen.distances_m.iter().filter(|d| d.is_finite()).count();
        println!("{lens:?}, {compass}°, {elevation}°: {held} of 768 held, {ground} of ground");
        assert!(held > 600 && ground > 170, "{held}, {ground}");
    }
}

/// From within, near the ground: what is behind the eye and beside the picture is cut off.
#[test]
fn an_eye_above_the_field_sees_what_is_before_it() {
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

/// A comparator must be seen to fail: a picture of a camera a pixel beside is no picture of this one.
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
    assert!(!compared(&shot), "0.02 rad were not seen");
    shot.camera.azimuth_rad -= 0.02;
    shot.options.mesh_step = 2;
    assert!(!compared(&shot), "another mesh was not seen");
}

#[test]
fn reduced_meshes_and_holes_are_what_rays_meet() {
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

/// An environment that rises evenly, so that a direction off by little is light off by little.
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

/// From straight above, a pixel a sample: pixels' middles are samples, and the picture is the map. On the outermost
/// samples the mesh ends, so that either ground or what is behind may be seen there.
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
    for (i, (got, want)) in shot.seen.radiance.iter().zip(&shot.lit).enumerate() {
        let (row, col) = (i as u32 / cols, i as u32 % cols);
        let is_edge = row == 0 || col == 0 || row == rows - 1 || col == cols - 1;
        for k in (0..3).filter(|_| !is_edge) {
            // A vertex and a middle that are off by a rounding of the picture, within one cell.
            let off = (got[k] - want[k]).abs();
            assert!(f64::from(off) <= 24.0 * ROUNDING, "({row}, {col}): {got:?} for {want:?}");
            let far = f64::from(shot.seen.distances_m[i]);
            assert!((far - 100.0).abs() <= 100.0 * ROUNDING, "{far}");
        }
    }
}

/// Samples a pixel that pictures of floats and depths may have here: what the device itself says.
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

/// The western edge of level ground of radiance 1 passes through the middle of a column of pixels, nothing behind it:
/// half of 2, of 4 and of 8 standard sample places are east of it (Vulkan, standard sample locations). What a device
/// does not have is refused, with what it has.
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
        for (i, got) in shot.seen.radiance.iter().enumerate() {
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

/// On a screen that encodes and on one that is told codes, the picture is a PNG's, to one code: powers are not exact.
#[test]
fn screens_show_what_pictures_hold() {
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
    let tone = Tone { exposure };
    // The twin, where the shader encodes: either code beside the value, which powers err by: 3 units of a logarithm of
    // up to 9 over 2.4, as many of its exponential, and a rounding of each other step.
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

/// What is refused names the argument, and nothing has been recorded: validation would hear of what is not there.
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

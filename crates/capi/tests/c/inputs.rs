//! Inputs that an engine in C fills or masks itself: heights with voids, light colours.

use std::ffi::CStr;
use std::ptr;

use ash::vk;
use ridgelight::scene::{HeightField, Lights, Scene, Sun, Surface};
use ridgelight_c::*;

use crate::abi::{
    SIDE, camera_of, device, field, good, heights, image, lit_by_rust, refused, scene, submit,
    view_by_rust, zeroed,
};
use crate::target::{FORMAT, Input, Target};

fn bytes(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_ne_bytes()).collect()
}

/// Marked, or NaN: both kinds of void.
fn is_void(i: usize) -> bool {
    i % 29 == 3 || (100..110).contains(&i)
}

/// Heights filled through C are the field's own and give the same light; a camera picture has holes at the same
/// triangles.
#[test]
fn voids_of_c_are_filled_and_masked() {
    let (mut gpu, host) = device();
    let voids: Vec<bool> = (0..SIDE * SIDE).map(is_void).collect();
    let field = HeightField::new(SIDE, SIDE, &heights(), [1.0; 2], Some(voids.clone()));
    let field = field.expect("a field");
    assert_eq!(field.base_m(), 0.0, "offsets are heights");
    let mut filled: Vec<f32> = heights().iter().map(|h| *h as f32).collect();
    let mut marks = vec![0_u8; SIDE * SIDE];
    for i in (0..SIDE * SIDE).filter(|i| is_void(*i)) {
        if i % 2 == 0 { marks[i] = 7 } else { filled[i] = f32::NAN }
    }
    let side = SIDE as u32;
    let (argument, setting) = (RidgelightResult::Argument, RidgelightResult::Setting);
    // SAFETY: arrays of this function, of these sizes, or null.
    unsafe {
        let mut infinite = filled.clone();
        infinite[SIDE + 2] = f32::INFINITY;
        let (at, before) = (infinite.as_mut_ptr(), infinite.clone());
        let refuse = |rows, heights, code, named: &str| {
            refused(ridgelight_fill_voids(rows, side, heights, ptr::null_mut()), code, named);
        };
        refuse(side, ptr::null_mut(), argument, "heights: found a null pointer");
        refuse(0, at, argument, "rows and cols: found 0 x 24");
        refuse(side, at, setting, "height at row 1, column 2: found inf");
        assert!(infinite.iter().zip(&before).all(|(a, b)| a.to_bits() == b.to_bits()));
        good(ridgelight_fill_voids(side, side, filled.as_mut_ptr(), marks.as_mut_ptr()));
    }
    assert_eq!(filled, field.heights_m());
    assert!(marks.iter().zip(&voids).all(|(mark, void)| *mark == u8::from(*void)));

    let (frame, view_of_rust, at) = view_by_rust(&mut gpu, &field);
    let right = gpu.look(&frame, &view_of_rust, Some(&voids)).expect("a picture").radiance;
    let mut whole = view_of_rust;
    whole.has_voids = false;
    assert!(
        gpu.look(&frame, &whole, None).expect("a picture").radiance != right,
        "holes are visible"
    );
    let numbers: Vec<f32> = marks.iter().map(|mark| f32::from(*mark)).collect();
    let lent = Input::new(&gpu, vk::Format::R32_SFLOAT, [side; 2], &bytes(&numbers));
    let lent = lent.expect("an image");
    let of_device = gpu.host().clone();
    let target = Target::new(&of_device);
    let [of_heights, of_light, of_picture, of_voids] =
        [&frame.inputs()[0], &frame.outputs()[0], &target.arg(), &lent.arg()].map(image);
    let camera = camera_of(&at);
    let (mut plan, mut view) = (ptr::null_mut(), ptr::null_mut());
    // SAFETY: structs and handles of this function, alive until its end.
    unsafe {
        let with_voids = RidgelightScene { has_voids: 1, ..scene() };
        good(ridgelight_plan_create(&host, &with_voids, ptr::null(), 0, 0, &mut plan));
        let none = ptr::null();
        good(ridgelight_view_create(&host, &with_voids, plan, &camera, FORMAT, 1, none, &mut view));
        submit(&gpu, |commands| {
            let images = RidgelightViewImages {
                heights: &of_heights,
                radiance: &of_light,
                picture: &of_picture,
                ..zeroed()
            };
            let record = |images: &RidgelightViewImages| {
                ridgelight_view_record(view, commands, 0, &camera, images)
            };
            refused(record(&images), setting, "voids: found no image");
            good(record(&RidgelightViewImages { voids: &of_voids, ..images }));
            target.copy(&of_device, commands);
        });
        ridgelight_view_destroy(view);
        ridgelight_plan_destroy(plan);
    }
    assert!(target.texels(&of_device) == right);
    target.end(&of_device);
    lent.end(gpu.host());
    gpu.end(frame);
    assert_eq!(gpu.take_messages(), [""; 0]);
}

/// One more input of a plan: texels instead of the scene's colours.
#[test]
fn colours_of_c_come_on_the_device() {
    let (mut gpu, host) = device();
    let sun = Sun {
        azimuth_rad: 1.0,
        elevation_rad: 0.5,
        diameter_rad: 0.0,
        irradiance: [3.0, 2.0, 1.0],
    };
    let lights = Lights { sky: Some([0.25, 0.5, 1.0]), suns: vec![sun], ..Lights::default() };
    let of_rust = Scene { field: field(), surface: Surface::default(), lights };
    let (frame, right) = lit_by_rust(&mut gpu, &of_rust);
    gpu.refill(&frame, 0, of_rust.field.heights_m()).expect("the heights again");
    let colours = [0.25, 0.5, 1.0, 1.0, 3.0, 2.0, 1.0, 1.0];
    let format = vk::Format::R32G32B32A32_SFLOAT;
    let lent = Input::new(&gpu, format, [2, 1], &bytes(&colours)).expect("an image");
    let (mut plan, mut renderer) = (ptr::null_mut(), ptr::null_mut());
    let of_c = RidgelightSun { azimuth_rad: 1.0, elevation_rad: 0.5, ..zeroed() };
    // Whatever is not 0: that there is one.
    let scene = RidgelightScene { sky: [9.0; 3], suns: &of_c, sun_count: 1, ..scene() };
    // SAFETY: structs and handles of this function, alive until its end.
    unsafe {
        let flags = RIDGELIGHT_PICTURE_COLOURS_ON_DEVICE;
        good(ridgelight_plan_create(&host, &scene, ptr::null(), flags, 0, &mut plan));
        let mut info: RidgelightImageInfo = zeroed();
        good(ridgelight_plan_input(plan, 1, &mut info));
        assert_eq!((info.format, info.extent), (format, [2, 1, 1]));
        assert_eq!(CStr::from_ptr(info.name.as_ptr()).to_str(), Ok("light_colours"));
        good(ridgelight_renderer_create(&host, plan, 1, ptr::null(), &mut renderer));
        let inputs = [image(&frame.inputs()[0]), image(&lent.arg())];
        let output = image(&frame.outputs()[0]);
        submit(&gpu, |commands| {
            good(ridgelight_record(renderer, commands, 0, inputs.as_ptr(), 2, &output, 1));
        });
        ridgelight_renderer_destroy(renderer);
        ridgelight_plan_destroy(plan);
    }
    assert!(gpu.pixels(&frame, 0).expect("pixels") == right);
    lent.end(gpu.host());
    gpu.end(frame);
    assert_eq!(gpu.take_messages(), [""; 0]);
}

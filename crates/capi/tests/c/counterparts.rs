//! C's counterparts of what Rust has: a frame in slices, one time for all passes, a plinth, an eye. Each gives the
//! bytes of Rust.

use std::ffi::CStr;
use std::ptr;

use ash::vk;
use ridgelight::gpu::Headless;
use ridgelight::plan::{self, Picture, View, ViewOptions};
use ridgelight::scene::{Albedo, Lights, PhongSpecular, Quality, Scene, Specular, Sun, Surface};
use ridgelight_c::*;

use crate::abi::{
    SIDE, camera_of, device, drawn_by_rust, field, good, image, lit_by_rust, refused, scene,
    submit, under_sky, view_by_rust, zeroed,
};
use crate::target::{FORMAT, SIZE, Target};

/// What shadow heights refuse, by code and by a word of the sentence.
#[test]
fn c_shadow_heights_refuse_wrong_fields() {
    let (_gpu, host) = device();
    let sun = RidgelightSun { elevation_rad: 0.5, irradiance: [1.0; 3], ..zeroed() };
    let suns = [sun, sun];
    let with = |suns: &[RidgelightSun]| RidgelightScene {
        suns: suns.as_ptr(),
        sun_count: suns.len() as u32,
        ..scene()
    };
    let side = SIDE as u32;
    let around = RidgelightOuter { rows: side, cols: side, ..zeroed() };
    let (argument, setting) = (RidgelightResult::Argument, RidgelightResult::Setting);
    let one = with(&suns[..1]);
    let periodic = RidgelightScene { border: RIDGELIGHT_BORDER_PERIODIC, ..one };
    let beside = RidgelightOuter { place: [1.0, 0.0], ..around };
    let cases: [(RidgelightScene, Option<RidgelightOuter>, u32, RidgelightResult, &str); 7] = [
        (scene(), None, 1, argument, "scene: sun_count: found 0"),
        (with(&suns), None, 1, argument, "scene: sun_count: found 2"),
        (periodic, None, 1, argument, "scene: border"),
        (one, Some(RidgelightOuter { reserved: 1, ..around }), 1, argument, "outer: reserved"),
        (one, Some(RidgelightOuter { rows: 0, ..around }), 1, argument, "outer: rows and cols"),
        (one, Some(beside), 1, setting, "contains this one"),
        (one, None, 2, setting, "1 to 1"),
    ];
    // SAFETY: structs and handles of this function, alive until its end.
    unsafe {
        let mut plan = ptr::null_mut();
        for (scene, outer, parts, code, named) in &cases {
            let outer = outer.as_ref().map_or(ptr::null(), ptr::from_ref);
            let found = ridgelight_shadow_heights_create(&host, scene, outer, *parts, &mut plan);
            refused(found, *code, named);
            assert!(plan.is_null(), "{named}");
        }
        good(ridgelight_shadow_heights_create(&host, &one, &around, 0, &mut plan));
        ridgelight_plan_destroy(plan);
    }
}

/// One pass in each command buffer, in slots by turns: the light of the whole frame. Then one time for all passes.
#[test]
fn c_slices_match_the_whole_frame() {
    let (mut gpu, host) = device();
    let of_rust = under_sky(field());
    let (frame, right) = lit_by_rust(&mut gpu, &of_rust);
    gpu.refill(&frame, 0, of_rust.field.heights_m()).expect("the heights again");
    let passes = frame.plan().passes.len() as u32;
    assert!(passes > 2, "slices");

    let (input, output) = (image(&frame.inputs()[0]), image(&frame.outputs()[0]));
    let (mut plan, mut renderer) = (ptr::null_mut(), ptr::null_mut());
    let (argument, setting) = (RidgelightResult::Argument, RidgelightResult::Setting);
    // SAFETY: structs and handles of this function, alive until its end.
    unsafe {
        good(ridgelight_plan_create(&host, &scene(), ptr::null(), 0, 0, &mut plan));
        good(ridgelight_renderer_create(&host, plan, 2, ptr::null(), &mut renderer));
        ridgelight_plan_destroy(plan);
        let record = |commands, slot, passes: &[u32]| {
            let (at, count) = (passes.as_ptr(), passes.len() as u32);
            ridgelight_record_passes(renderer, commands, slot, &input, 1, &output, 1, at, count)
        };
        for pass in 0..passes {
            submit(&gpu, |commands| {
                let wrong: [(&[u32], &str); 4] = [
                    (&[passes], "pass: found"),
                    (&[pass, pass], "passes: found"),
                    (&[pass + 1], if pass + 1 < passes { "passes: found" } else { "pass: found" }),
                    (&[], "passes: found"),
                ];
                for (passes, named) in wrong {
                    refused(record(commands, pass % 2, passes), setting, named);
                }
                let none = ptr::null();
                let null =
                    ridgelight_record_passes(renderer, commands, 0, &input, 1, &output, 1, none, 2);
                refused(null, argument, "passes: found a null pointer, expected 2 indices");
                good(record(commands, pass % 2, &[pass]));
            });
        }
        assert!(gpu.pixels(&frame, 0).expect("pixels") == right);

        // Another sky needs only some passes. The first calls pass no array, then a capacity of 0.
        let other = RidgelightScene { sky: [0.5, 2.0, 1.0], ..scene() };
        good(ridgelight_plan_create(&host, &other, ptr::null(), 0, 0, &mut plan));
        let mut count = passes;
        let null = ridgelight_replace_plan(renderer, plan, ptr::null_mut(), &mut count);
        refused(null, argument, "passes: found a null pointer, expected room for");
        let none_at_all =
            ridgelight_replace_plan(ptr::null_mut(), plan, ptr::null_mut(), &mut count);
        refused(none_at_all, argument, "renderer: found a null pointer");
        assert_eq!(count, passes, "as it was");
        // Nothing is pending: the old plan has stayed, and a late pass may run alone.
        submit(&gpu, |commands| {
            good(record(commands, 0, &[passes - 1]));
        });
        assert!(gpu.pixels(&frame, 0).expect("pixels") == right);
        good(ridgelight_replace_plan(renderer, plan, ptr::null_mut(), ptr::null_mut()));
        let mut due_room = vec![passes; 1 + passes as usize];
        let mut none = 0;
        good(ridgelight_replace_plan(renderer, plan, due_room.as_mut_ptr(), &mut none));
        good(ridgelight_replace_plan(renderer, plan, due_room.as_mut_ptr(), &mut count));
        assert!(none == count && (1..passes).contains(&count), "{count} of {passes} passes");
        let (due, beyond) = due_room.split_at(count as usize);
        assert!(due.iter().all(|pass| *pass < passes) && beyond.iter().all(|b| *b == passes));
        let draw = |gpu: &mut Headless, passes: &[u32]| {
            submit(gpu, |commands| {
                good(record(commands, 0, passes));
            });
            gpu.pixels(&frame, 0).expect("pixels")
        };
        let changed = draw(&mut gpu, due);
        assert!(changed != right);
        assert!(draw(&mut gpu, &(0..passes).collect::<Vec<_>>()) == changed);
        good(ridgelight_replace_plan(renderer, plan, due_room.as_mut_ptr(), &mut none));
        assert_eq!(none, 0);
        ridgelight_plan_destroy(plan);

        // New heights need all passes of a sky, no change needs none; the plan has one input.
        let mut after = |changed: &[u32], capacity| {
            let (at, number) = (changed.as_ptr(), changed.len() as u32);
            let (passes, mut count) = (due_room.as_mut_ptr(), capacity);
            good(ridgelight_passes_after(renderer, at, number, passes, &mut count));
            due_room[..count.min(capacity) as usize].to_vec()
        };
        assert_eq!(after(&[0], passes), (0..passes).collect::<Vec<_>>());
        assert_eq!(after(&[0], 1), [0]);
        assert_eq!(after(&[], passes), [0_u32; 0]);
        let (none, no_count) = (ptr::null_mut(), ptr::null_mut());
        let beyond = ridgelight_passes_after(renderer, &1, 1, none, no_count);
        refused(beyond, argument, "changed: found 1, expected less than 1");
        let null = ridgelight_passes_after(renderer, ptr::null(), 1, none, no_count);
        refused(null, argument, "changed: found a null pointer, expected 1 indices");
        let no_renderer = ridgelight_passes_after(ptr::null(), ptr::null(), 0, none, no_count);
        refused(no_renderer, argument, "renderer: found a null pointer");

        let mut times: Vec<RidgelightTiming> = (0..passes).map(|_| zeroed()).collect();
        let mut timed = |each, commands: &[u32]| {
            good(ridgelight_time_passes(renderer, each));
            submit(&gpu, |buffer| {
                good(record(buffer, 1, commands));
            });
            let mut count = passes;
            good(ridgelight_timings(renderer, 1, times.as_mut_ptr(), &mut count));
            let text = |t: &RidgelightTiming| CStr::from_ptr(t.label.as_ptr()).to_owned();
            times[..count as usize].iter().map(text).collect::<Vec<_>>()
        };
        let all: Vec<u32> = (0..passes).collect();
        if gpu.report().timestamp_period_ns > 0.0 {
            assert_eq!(timed(vk::FALSE, &all), [c"all passes".to_owned()]);
            assert_eq!(timed(vk::TRUE, &all).len(), all.len());
            assert_eq!(timed(vk::TRUE, &all[1..]).len(), all.len() - 1);
        }
        refused(ridgelight_time_passes(ptr::null_mut(), 1), argument, "renderer: found a null");
        ridgelight_renderer_destroy(renderer);
    }
    gpu.end(frame);
    assert_eq!(gpu.take_messages(), [""; 0]);
}

#[test]
fn a_c_plinth_matches_rust() {
    let (mut gpu, host) = device();
    let field = field();
    let (frame, without, at) = view_by_rust(&mut gpu, &field);
    let of_rust = under_sky(field);
    let limits = gpu.report().limits;
    let options =
        ViewOptions { size: SIZE, samples: 1, plinth_base_m: Some(-9.0), ..ViewOptions::default() };
    let view_of_rust = View::new(&of_rust, frame.plan(), &at, &options, &limits).expect("a view");
    let right = gpu.look(&frame, &view_of_rust, None).expect("a picture").radiance;
    let bare = gpu.look(&frame, &without, None).expect("a picture").radiance;
    assert!(bare != right, "the plinth is visible");

    let of_device = gpu.host().clone();
    let target = Target::new(&of_device);
    let [of_heights, of_light, of_picture] =
        [&frame.inputs()[0], &frame.outputs()[0], &target.arg()].map(image);
    let camera = RidgelightCamera { plinth_base_m: -9.0, has_plinth: 1, ..camera_of(&at) };
    let images = RidgelightViewImages {
        heights: &of_heights,
        radiance: &of_light,
        picture: &of_picture,
        ..zeroed()
    };
    let (mut plan, mut view) = (ptr::null_mut(), ptr::null_mut());
    let setting = RidgelightResult::Setting;
    // SAFETY: structs and handles of this function, alive until its end.
    unsafe {
        good(ridgelight_plan_create(&host, &scene(), ptr::null(), 0, 0, &mut plan));
        let (of_c, none) = (scene(), ptr::null());
        let make = |camera: &RidgelightCamera, view: &mut *mut RidgelightView| {
            ridgelight_view_create(&host, &of_c, plan, camera, FORMAT, 1, none, view)
        };
        let infinite = RidgelightCamera { plinth_base_m: f64::INFINITY, ..camera };
        refused(make(&infinite, &mut view), setting, "plinth base: found inf");
        // Without has_plinth, or in a struct of an older header, the base is not read.
        let older = RidgelightCamera { struct_size: 104, ..infinite };
        let not_drawn = RidgelightCamera { has_plinth: 0, ..infinite };
        for (camera, picture) in [(older, &bare), (not_drawn, &bare), (camera, &right)] {
            good(make(&camera, &mut view));
            submit(&gpu, |commands| {
                good(ridgelight_view_record(view, commands, 0, &camera, &images));
                target.copy(&of_device, commands);
            });
            assert!(target.texels(&of_device) == *picture);
            ridgelight_view_destroy(view);
        }
        ridgelight_plan_destroy(plan);
    }
    target.end(&of_device);
    gpu.end(frame);
    assert_eq!(gpu.take_messages(), [""; 0]);
}

/// The highlight of a sun, from an eye and from straight above.
#[test]
fn a_c_eye_matches_rust() {
    let (mut gpu, host) = device();
    let sun = Sun { azimuth_rad: 0.0, elevation_rad: 0.8, diameter_rad: 0.0, irradiance: [1.0; 3] };
    let phong = PhongSpecular { exponent: 20.0, scale: 0.5 };
    let of_rust = Scene {
        field: field(),
        surface: Surface {
            albedo: Albedo::Constant([0.5; 3]),
            specular: Some(Specular::Constant(phong)),
            ..Surface::default()
        },
        lights: Lights { suns: vec![sun], ..Lights::default() },
    };
    let eye_m = [-6.0, 10.0, 8.0];
    let limits = gpu.report().limits;
    let [right, above] = [Some(eye_m), None].map(|eye_m| {
        let wanted = Picture { eye_m, ..Picture::default() };
        let frame = drawn_by_rust(&mut gpu, &of_rust, wanted);
        let lit = gpu.pixels(&frame, 0).expect("pixels");
        gpu.end(frame);
        lit
    });
    assert!(right != above, "the eye moves the highlight");

    let sun = RidgelightSun { irradiance: [1.0; 3], elevation_rad: 0.8, ..zeroed() };
    let side = SIDE as u32;
    let of_c = RidgelightScene {
        rows: side,
        cols: side,
        albedo: [0.5; 3],
        specular_exponent: 20.0,
        specular_scale: 0.5,
        suns: &sun,
        sun_count: 1,
        eye_m,
        has_eye: 1,
        ..zeroed()
    };
    let without = RidgelightScene { has_eye: 0, ..of_c };
    let older = RidgelightScene { struct_size: 144, ..of_c };
    let mut plan = ptr::null_mut();
    // SAFETY: structs and handles of this function, alive until its end.
    unsafe {
        let far = RidgelightScene { eye_m: [0.0, f64::NAN, 0.0], ..of_c };
        let made = ridgelight_plan_create(&host, &far, ptr::null(), 0, 0, &mut plan);
        refused(made, RidgelightResult::Setting, "picture: eye_m: found [0.0, NaN, 0.0]");
    }
    for (of_c, light) in [(of_c, &right), (without, &above), (older, &above)] {
        let wanted = plan::picture(&of_rust, &Quality::default(), &limits, Picture::default());
        let texels = of_rust.field.heights_m();
        let frame = gpu.frame(wanted.expect("a plan"), &[texels]).expect("a frame");
        let (input, output) = (image(&frame.inputs()[0]), image(&frame.outputs()[0]));
        let mut renderer = ptr::null_mut();
        // SAFETY: as above.
        unsafe {
            good(ridgelight_plan_create(&host, &of_c, ptr::null(), 0, 0, &mut plan));
            good(ridgelight_renderer_create(&host, plan, 1, ptr::null(), &mut renderer));
            submit(&gpu, |commands| {
                good(ridgelight_record(renderer, commands, 0, &input, 1, &output, 1));
            });
            assert!(gpu.pixels(&frame, 0).expect("pixels") == *light);
            ridgelight_renderer_destroy(renderer);
            ridgelight_plan_destroy(plan);
        }
        gpu.end(frame);
    }
    assert_eq!(gpu.take_messages(), [""; 0]);
}

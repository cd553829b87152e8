//! Heights that are NaN or infinite: refused where the host knows them; on the device they give wrong light until the
//! next recording, and nothing worse.

use ridgelight::plan::{self, Limits, Picture, Rectangle, SweepForm};
use ridgelight::scene::{Border, HeightField, Method, Quality, Scene, Sun};

use crate::{Device, bits, field, under_sky};

const SIDE: usize = 32;

fn rough_under_sky() -> Scene {
    let heights = field(SIDE, SIDE, [1.0, 1.0], |r, c| ((r * 31 + c * 17) % 7) as f64);
    under_sky(heights, Border::Plane)
}

#[test]
fn heights_of_the_host_that_are_not_finite_are_refused_by_place() {
    for wrong in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut heights = vec![0.0; 6 * 5];
        heights[5 * 4 + 3] = wrong;
        let error = HeightField::new(6, 5, &heights, [1.0; 2], None).expect_err("not finite");
        assert!(error.to_string().contains("height at row 4, column 3"), "{error}");
    }
}

/// One texel of the image of heights, under a sky and a sun. Nothing reports it: the recording runs, without a validation
/// message, and the next recording of finite heights has the bits of one before. Sweeps with four lines per invocation and with
/// one end at an empty hull: the products that they compare are both -inf, so that an infinite height removes every vertex.
#[test]
fn heights_of_the_device_that_are_not_finite_spoil_one_recording() {
    let mut device = Device::new();
    let limits = device.limits();
    let under_sky = rough_under_sky();
    let mut under_sun = under_sky.clone();
    under_sun.lights.suns = vec![Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.3,
        diameter_rad: 0.02,
        irradiance: [1.0; 3],
    }];
    let texels = under_sky.field.heights_m().to_vec();
    let gpu = device.gpu.as_mut().expect("alive");
    let all = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN];
    for (scene, wrong) in [&under_sun, &under_sky].iter().flat_map(|s| all.map(|wrong| (s, wrong)))
    {
        let [on_cpu, on_gpu] = [true, false].map(|is_cpu| Limits::boundless(is_cpu, 0).sweep);
        // The shallow ones lose lines, which are swept again.
        let shallow =
            [on_cpu, on_gpu].map(|form| SweepForm { hull_depth: 4, private_depth: 4, ..form });
        for (method, sweep) in [
            (Method::Sweep, on_cpu),
            (Method::Sweep, on_gpu),
            (Method::Sweep, shallow[0]),
            (Method::Sweep, shallow[1]),
            (Method::Pyramid, on_cpu),
            (Method::BruteForce, on_cpu),
        ] {
            let limits = Limits { sweep, ..limits };
            let quality = Quality { method, azimuths: 8, ..Quality::default() };
            let plan = plan::picture(scene, &quality, &limits, Picture::default());
            let mut frame = gpu.frame(plan.expect("a plan"), &[&texels]).expect("a frame");
            gpu.draw(&mut frame).expect("drawn");
            let right = bits(gpu, &frame);
            let mut spoilt = texels.clone();
            spoilt[SIDE / 2 * SIDE + SIDE / 2] = wrong;
            gpu.refill(&frame, 0, &spoilt).expect("other heights");
            gpu.draw(&mut frame).expect("drawn");
            let lit = gpu.pixels(&frame, 0).expect("pixels").values;
            let other = bits(gpu, &frame).iter().zip(&right).filter(|(a, b)| a != b).count();
            let nan = lit.iter().filter(|v| v.is_nan()).count();
            let suns = scene.lights.suns.len();
            println!("{method:?}, {suns} suns, {wrong}: {other} texels differ, {nan} are NaN");
            // The texel's own light and that of the eight around it, whose slopes read its height.
            assert!(other >= 9, "{method:?} {wrong}");
            gpu.refill(&frame, 0, &texels).expect("the heights again");
            gpu.draw(&mut frame).expect("drawn");
            assert!(bits(gpu, &frame) == right, "{method:?} {wrong}");
            gpu.end(frame);
        }
    }
}

/// Kept horizons hold what the wrong height left in them: a whole recording replaces all of it.
#[test]
fn kept_horizons_are_right_again_after_a_whole_recording() {
    let mut device = Device::new();
    let limits = device.limits();
    let scene = rough_under_sky();
    let texels = scene.field.heights_m().to_vec();
    let quality = Quality { azimuths: 8, ..Quality::default() };
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let plan = plan::picture(&scene, &quality, &limits, wanted).expect("a plan");
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = gpu.frame(plan, &[&texels]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let right = bits(gpu, &frame);
    let at = Rectangle { col: SIDE as u32 / 2, row: SIDE as u32 / 2, cols: 1, rows: 1 };
    for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        let mut spoilt = texels.clone();
        spoilt[SIDE / 2 * SIDE + SIDE / 2] = wrong;
        gpu.refill(&frame, 0, &spoilt).expect("other heights");
        gpu.draw_edit(&mut frame, at).expect("edited");
        assert!(bits(gpu, &frame) != right, "{wrong}");
        gpu.refill(&frame, 0, &texels).expect("the heights again");
        gpu.draw(&mut frame).expect("drawn");
        assert!(bits(gpu, &frame) == right, "{wrong}");
    }
    gpu.end(frame);
}

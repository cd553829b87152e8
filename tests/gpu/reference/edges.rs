//! Rays and Phong lobes of the path tracer where a rounding decides: suns along lines of texels, exponents of 1e4.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use ridgelight::plan;
use ridgelight::scene::{Albedo, Border, Lights, Normals, PhongSpecular, Specular, Sun};
use ridgelight_cpu::light;
use ridgelight_cpu::oracle::Oracle;

use crate::reference::quadrature::{traced, traced_by};
use crate::{Device, field, under_sky};

fn point(azimuth_rad: f64, elevation_rad: f64) -> Sun {
    Sun { azimuth_rad, elevation_rad, diameter_rad: 0.0, irradiance: [3.0; 3] }
}

/// A point sun at horizontal, at the zenith and along lines of texels, those at the rim too: lit or not as by the
/// oracle, without noise.
#[test]
fn suns_along_lines_of_samples_are_the_oracles() {
    let mut device = Device::new();
    let all = &[Border::Plane, Border::Open, Border::Periodic][..];
    for (rows, cols, borders) in [(5, 5, all), (1, 7, &all[..1]), (7, 1, &all[..1])] {
        let peaks = field(rows, cols, [1.0, 1.0], |r, c| {
            if r + c == 4 { 3.0 } else { 0.5 * c as f64 + 0.3 * r as f64 }
        });
        for &border in borders {
            let oracle = Oracle::new(&peaks, border);
            let angles = [0.0_f64, 90.0, 180.0, 270.0].map(|a| [(a, 0.0_f64), (a, 10.0)]);
            for (azimuth, elevation) in angles.into_iter().flatten().chain([(0.0, 90.0)]) {
                let sun = point(azimuth.to_radians(), elevation.to_radians());
                let mut scene = under_sky(peaks.clone(), border);
                scene.lights = Lights { suns: vec![sun], ..Lights::default() };
                let [light, _] = traced(&mut device, &scene, 0, 1, 1);
                for (i, found) in light.iter().enumerate() {
                    let ground_truth = light::sun_of(&oracle, i / cols, i % cols, &sun, 1)[0];
                    let says =
                        format!("{border:?} {rows}×{cols} {azimuth}° {elevation}° texel {i}");
                    // A direction and a normal of f32, irradiance 3.
                    assert!(
                        (found[0] - ground_truth).abs() < 1e-6,
                        "{says}: {} for {ground_truth}",
                        found[0]
                    );
                }
            }
        }
    }
}

/// A ramp that rises eastwards reflects the view from above westwards, twice its tilt from the zenith; a point sun
/// `off` beside that gives E · scale · (n + 1) / 2π · cosⁿ off.
#[test]
fn a_narrow_lobe_keeps_its_digits() {
    let mut device = Device::new();
    let tilt = 0.4_f64;
    let ramp = field(5, 5, [1.0, 1.0], |_, c| tilt.tan() * c as f64);
    let mut scene = under_sky(ramp, Border::Open);
    scene.surface.albedo = Albedo::Constant([0.0; 3]);
    for (off, exponent) in [(0.0, 1e4), (0.004, 1e4), (0.2, 30.0), (0.7, 1.0), (0.5, 0.0)] {
        scene.lights =
            Lights { suns: vec![point(PI, FRAC_PI_2 - 2.0 * tilt + off)], ..Lights::default() };
        scene.surface.specular = Some(Specular::Constant(PhongSpecular { exponent, scale: 0.6 }));
        let [light, _] = traced(&mut device, &scene, 0, 1, 1);
        let n = f64::from(exponent);
        let expected = 3.0 * f64::from(0.6_f32) * (n + 1.0) / TAU * off.cos().powf(n);
        // Directions of f32 err by 3e-7, the power with their angle: n · off · 3e-7, and second order beside it; the
        // exponential by a few ulp.
        let bound = expected * (4e-6 + n * (off + 1e-3) * 3e-7);
        let found = light[12][0];
        assert!(
            (found - expected).abs() < bound,
            "{exponent} {off}: {found} for {expected} ± {bound}"
        );
    }
}

/// The bound on steps, MOST_STEPS of `path_trace`, set too low for rays over a ridge: the lost rays are counted.
#[test]
fn lost_rays_are_counted() {
    let mut device = Device::new();
    let ridge = field(40, 40, [1.0, 1.0], |_, c| 9.0 - (c as f64 - 20.0).abs().min(9.0));
    let scene = under_sky(ridge, Border::Plane);
    let mut plan =
        plan::reference(&scene, 0, Normals::Smooth, None, 1, &device.limits()).expect("a plan");
    assert_eq!(traced_by(&mut device, &scene, plan.clone(), 1, &[]).1, 0);
    let pass = plan.passes.last_mut().expect("path_trace");
    let bound = pass.shader.constants.iter().position(|c| c.name == "most_steps");
    pass.constants[bound.expect("the bound")] = 2;
    assert!(traced_by(&mut device, &scene, plan, 1, &[]).1 > 0);
}

/// A reference in bands, recorded piece by piece, has the bits of one that is recorded whole; pieces out of order are
/// refused, the first may come again.
#[test]
fn pieces_of_a_batch_are_the_batch() {
    let mut device = Device::new();
    let hills =
        field(37, 21, [1.0, 1.0], |r, c| 3.0 * (r as f64 / 4.0).sin() * (c as f64 / 3.0).cos());
    let scene = under_sky(hills, Border::Plane);
    let limits = device.limits();
    let contents = plan::reference_inputs(&scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let gpu = device.gpu.as_mut().expect("alive");
    let whole = plan::reference(&scene, 1, Normals::Smooth, None, 3, &limits).expect("a plan");
    let want = gpu
        .with_frame(whole, &contents, |gpu, frame| {
            gpu.draw(frame)?;
            gpu.pixels(frame, 0)
        })
        .expect("drawn");
    let banded =
        plan::reference_in_bands(&scene, 1, Normals::Smooth, None, 3, &limits, 8).expect("a plan");
    let count = banded.passes.len();
    let first = banded.passes.iter().position(|p| p.name() == "path_trace").expect("traces");
    assert_eq!(count - first, 5);
    let got = gpu
        .with_frame(banded, &contents, |gpu, frame| {
            let mut pieces = vec![0..first, 0..first + 1];
            pieces.extend((first + 1..count).map(|n| n..n + 1));
            let error = gpu.draw_passes(frame, &[first]).expect_err("nothing recorded");
            assert!(error.to_string().contains("first, or a recording of all passes"), "{error}");
            for piece in pieces {
                gpu.draw_passes(frame, &piece.collect::<Vec<_>>())?;
            }
            // From here on any: another batch is another mean.
            let got = gpu.pixels(frame, 0)?;
            gpu.draw_passes(frame, &(first..count).collect::<Vec<_>>())?;
            assert!(gpu.pixels(frame, 0)? != got);
            Ok(got)
        })
        .expect("drawn");
    assert!(got == want);
}

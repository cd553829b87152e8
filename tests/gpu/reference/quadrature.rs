//! The path tracer against the f64 quadrature and closed forms.

use ridgelight::plan::{self, Plan};
use ridgelight::scene::{Albedo, Border, Environment, Lights, Normals, Scene, Sun, Surface};
use ridgelight_cpu::indirect::{Fineness, ground_truth as expected_light, smooth_ground_truth};

use crate::scenes::{Agreement, scenes};
use crate::{Device, field, under_sky};

/// Radiance and its standard error.
pub(crate) type Traced = [Vec<[f64; 3]>; 2];

/// `batches` of a scene of flat triangles with up to these bounces.
pub(crate) fn traced(
    device: &mut Device,
    scene: &Scene,
    bounces: u32,
    seed: u32,
    batches: usize,
) -> Traced {
    traced_on(device, scene, Normals::Flat, (bounces, seed), batches)
}

pub(crate) fn traced_on(
    device: &mut Device,
    scene: &Scene,
    normals: Normals,
    (bounces, seed): (u32, u32),
    batches: usize,
) -> Traced {
    let plan =
        plan::reference(scene, bounces, normals, None, seed, &device.limits()).expect("a plan");
    let (light, lost) = traced_by(device, scene, plan, batches, &[]);
    assert_eq!(lost, 0, "rays were lost");
    light
}

/// `batches` of direct light whose specular is viewed from an eye.
pub(crate) fn traced_from(
    device: &mut Device,
    scene: &Scene,
    eye_m: [f64; 3],
    batches: usize,
) -> Traced {
    let limits = device.limits();
    let plan = plan::reference(scene, 0, Normals::Smooth, Some(eye_m), 1, &limits).expect("a plan");
    let (light, lost) = traced_by(device, scene, plan, batches, &[]);
    assert_eq!(lost, 0, "rays were lost");
    light
}

/// `batches` by this plan, which may have `more` inputs, and how many rays were lost.
pub(crate) fn traced_by(
    device: &mut Device,
    scene: &Scene,
    plan: Plan,
    batches: usize,
    more: &[Vec<f32>],
) -> (Traced, u32) {
    let paths: Vec<usize> =
        (0..plan.passes.len()).filter(|p| plan.passes[*p].name() == "path_trace").collect();
    let lost = plan.find("lost_rays").expect("a buffer");
    let contents = plan::reference_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().chain(more).map(Vec::as_slice).collect();
    let gpu = device.gpu.as_mut().expect("alive");
    let all = gpu.with_frame(plan, &contents, |gpu, frame| {
        gpu.draw(frame)?;
        for _ in 1..batches {
            gpu.draw_passes(frame, &paths)?;
        }
        let pictures = [0, 1].map(|output| {
            let pixels = gpu.pixels(frame, output).expect("pixels");
            let texels = pixels.values.chunks_exact(4);
            texels.map(|t| [0, 1, 2].map(|c| f64::from(t[c]))).collect()
        });
        Ok((pictures, gpu.read(frame, lost)?[0]))
    });
    all.expect("traced")
}

/// Bounced light alone of some texels, some of them twice.
fn traced_at(device: &mut Device, scene: &Scene, bounces: u32, grid_points: &[usize]) -> Traced {
    let normals = Normals::Smooth;
    let limits = device.limits();
    let plan = plan::reference_at(scene, bounces, normals, None, 1, grid_points.len(), &limits)
        .expect("a plan");
    let list = plan::listed_places(scene, grid_points).expect("of the field");
    let ([light, error], lost) = traced_by(device, scene, plan, BATCHES, &[list]);
    assert_eq!(lost, 0, "rays were lost");
    [light, error].map(|texels| texels[..grid_points.len()].to_vec())
}

/// Indirect light alone is the quadrature's with bounces less its own without, at any listed texel, under lights of
/// every kind. A texel that is listed twice takes other paths. The comparison fails against all light.
#[test]
fn paths_from_listed_samples_bring_indirect_light() {
    let mut device = Device::new();
    for (name, scene) in scenes() {
        let expected_light = smooth_ground_truth(&scene, 2, 24, 12).expect("a ground truth");
        let count = expected_light.radiance[0].len();
        // From the last texel, then others; some are in both lists.
        let first: Vec<usize> = (1..count).rev().step_by(2).collect();
        let listed: Vec<usize> = first.iter().copied().chain((0..count).step_by(3)).collect();
        let at = |picture: &[[f64; 3]]| listed.iter().map(|i| picture[*i]).collect::<Vec<_>>();
        let (all, straight) = (at(&expected_light.radiance[2]), at(&expected_light.radiance[0]));
        let bounced: Vec<_> =
            all.iter().zip(&straight).map(|(a, s)| [0, 1, 2].map(|c| a[c] - s[c])).collect();
        // Both pictures' errors are of the same quadrature; rounding is a share of all light, not of indirect light:
        // rounding decides whether rays that graze a slope hit it.
        let stated = at(&expected_light.error[2]);
        let error = stated.iter().zip(&all);
        let error: Vec<_> = error.map(|(e, a)| [0, 1, 2].map(|c| e[c] + 1e-5 * a[c])).collect();
        let both = traced_at(&mut device, &scene, 2, &listed);
        // Convex ground gets little light, by few paths: the standard error of unsampled light counts, too.
        let unsampled =
            ridgelight_trade::auto::unsampled_bounce_error(&scene, 2, (PATHS as u32, 1), 0.05);
        let sigma: Vec<_> =
            both[1].iter().map(|e| [0, 1, 2].map(|c| e[c].hypot(unsampled[c]))).collect();
        let agreement = |right: &[[f64; 3]]| {
            Agreement::of([&both[0], &sigma], [right, &error], f64::INFINITY, 1e-5)
        };
        println!("{name}: {:?}", agreement(&bounced));
        assert!(agreement(&bounced).holds(), "{name}: {:?}", agreement(&bounced));
        assert!(!agreement(&all).holds(), "{name}: passes with direct light");
        let twice = (first.len()..listed.len())
            .filter_map(|k| Some((k, first.iter().position(|i| *i == listed[k])?)));
        for (k, first) in twice.filter(|(k, _)| both[1][*k] != [0.0; 3]) {
            assert_ne!(both[0][k], both[0][first], "{name}: the same paths");
        }
    }
}

/// Batches of the comparisons, and a texel's paths in them.
const BATCHES: usize = 64;
const PATHS: f64 = (BATCHES as u32 * plan::REFERENCE_BATCH) as f64;

/// The comparison fails for light without bounces against the quadrature with two.
#[test]
fn paths_agree_with_the_quadrature_on_every_scene() {
    let mut device = Device::new();
    for (name, scene) in scenes() {
        let fineness = Fineness { azimuths: 24, divisions: 1, strips: 12 };
        let flat = expected_light(&scene, 2, fineness).expect("a ground truth");
        let smooth = smooth_ground_truth(&scene, 2, 24, 12).expect("a ground truth");
        let cases = [(0, Normals::Flat), (2, Normals::Flat), (2, Normals::Smooth)];
        for (b, normals) in cases {
            let expected_light = if normals == Normals::Flat { &flat } else { &smooth };
            let agreement = |[light, error]: &Traced, b: usize| {
                let right = [&expected_light.radiance[b][..], &expected_light.error[b]];
                Agreement::of([light, error], right, PATHS, 1e-5)
            };
            let both = &traced_on(&mut device, &scene, normals, (b as u32, 1), BATCHES);
            let of = agreement(both, b);
            println!(
                "{name}, {b} bounces, {normals:?}: rms {:.3}, worst {:.2}, mean {:.2} of {}",
                of.rms, of.worst, of.mean, of.count
            );
            assert!(of.holds(), "{name}, {b} bounces: {of:?}");
            // Convex ground sees little or nothing of itself.
            let sum = |b: usize| expected_light.radiance[b].iter().flatten().sum::<f64>();
            if b == 0 && sum(2) > 1.01 * sum(0) {
                let wrong = agreement(both, 2);
                assert!(!wrong.holds(), "{name}: passes without bounces: {wrong:?}");
            }
        }
    }
}

/// Every path from level ground leaves to the sky with albedo × 1.
#[test]
fn level_ground_under_a_sky_has_no_noise() {
    let mut device = Device::new();
    let scene = under_sky(field(5, 7, [1.0, 3.0], |_, _| 8.0), Border::Plane);
    let [light, error] = traced(&mut device, &scene, 1, 0, 2);
    assert!(light.iter().flatten().all(|v| *v == 1.0), "{light:?}");
    assert!(error.iter().flatten().all(|v| *v == 0.0), "{error:?}");
}

/// White ground, light of radiance 1 from all other directions: radiance 1 at every bounce's end. After 64 bounces no
/// path is left: each leaves a texel of this field with a probability above a third.
#[test]
fn white_ground_in_white_light_is_white() {
    let mut device = Device::new();
    let rough = field(12, 11, [1.0, 1.0], |r, c| ((r * 31 + c * 17) % 7) as f64 / 3.0);
    let mut scene = under_sky(rough, Border::Open);
    for normals in [Normals::Smooth, Normals::Flat] {
        let [light, _] = traced_on(&mut device, &scene, normals, (64, 3), 2);
        assert!(light.iter().flatten().all(|v| *v == 1.0), "{normals:?}: {light:?}");
    }
    // The same light as an environment, sampled or hit: each path's share is right in the mean alone.
    let white = Environment::new(6, 5, vec![[1.0; 3]; 30], 0.5).expect("an environment");
    scene.lights = Lights { environment: Some(white), ..Lights::default() };
    let [light, error] = traced(&mut device, &scene, 64, 4, BATCHES);
    let ones = vec![[1.0; 3]; light.len()];
    let none = vec![[0.0; 3]; light.len()];
    let of = Agreement::of([&light, &error], [&ones, &none], f64::INFINITY, 1e-5);
    assert!(of.holds(), "{of:?}");
}

/// A field without cells does not see itself, whichever way it is thin.
#[test]
fn a_single_line_of_texels_sees_all_of_the_sky() {
    let mut device = Device::new();
    let (plane, open, periodic) = (Border::Plane, Border::Open, Border::Periodic);
    for (rows, cols, border) in [(1, 1, plane), (1, 9, open), (9, 1, plane), (9, 1, periodic)] {
        let scene = under_sky(field(rows, cols, [1.0, 1.0], |_, _| 2.0), border);
        let [light, _] = traced(&mut device, &scene, 1, 0, 2);
        assert!(light.iter().flatten().all(|v| *v == 1.0), "{rows} × {cols}, {border:?}");
    }
}

/// Of two independent pictures, z = difference / √(sum of squared standard errors) is nearly Student's t:
/// z² of n batches has the mean (n - 1)/(n - 3), and N of them a standard deviation of √(2/N) about it.
#[test]
fn standard_errors_predict_the_difference_of_two_seeds() {
    let mut device = Device::new();
    let surface = Surface { albedo: Albedo::Constant([0.5; 3]), ..Surface::default() };
    let lights = Lights { sky: Some([1.0; 3]), ..Lights::default() };
    let field = ridgelight::scene::fractal(32, 5).expect("a field");
    let scene = Scene { field, surface, lights };
    let first = traced(&mut device, &scene, 1, 1, BATCHES);
    assert!(first == traced(&mut device, &scene, 1, 1, BATCHES), "the same seed, other bits");
    let second = traced(&mut device, &scene, 1, 2, BATCHES);
    assert!(first[0] != second[0], "another seed, the same bits");
    let squares: Vec<f64> = (0..first[0].len())
        .map(|i| {
            let variance = first[1][i][0].powi(2) + second[1][i][0].powi(2);
            (first[0][i][0] - second[0][i][0]).powi(2) / variance
        })
        .filter(|z| z.is_finite())
        .collect();
    let count = squares.len() as f64;
    assert!(count > 500.0, "{count} texels with noise");
    let mean = squares.iter().sum::<f64>() / count;
    let expected = (BATCHES - 1) as f64 / (BATCHES - 3) as f64;
    println!("mean z² {mean:.3}, expected {expected:.3}, of {count}");
    assert!((mean - expected).abs() < 5.0 * (2.0 / count).sqrt(), "{mean} of {count}");
}

/// A needle in the shadow of a wall reaches into bright sun with its tip alone: few paths from the shade hit that. By
/// their spread alone, texels without such a path would be dark with certainty.
#[test]
fn unsampled_light_counts_as_error() {
    const FEW: usize = 8;
    let mut device = Device::new();
    let needle = field(13, 13, [1.0, 1.0], |r, c| match (r, c) {
        (_, 0) => 6.0,
        (6, 4) => 3.0,
        _ => 0.0,
    });
    let mut scene = under_sky(needle, Border::Plane);
    let sun = Sun {
        azimuth_rad: std::f64::consts::PI,
        elevation_rad: 0.8,
        diameter_rad: 0.0,
        irradiance: [100.0; 3],
    };
    scene.lights = Lights { suns: vec![sun], ..Lights::default() };
    let fineness = Fineness { azimuths: 48, divisions: 1, strips: 16 };
    let expected_light = expected_light(&scene, 1, fineness).expect("a ground truth");
    let [light, error] = traced(&mut device, &scene, 1, 1, FEW);
    let unsampled = (0..light.len())
        .filter(|i| error[*i][0] == 0.0 && expected_light.radiance[1][*i][0] > 1e-3);
    assert!(unsampled.count() > 0, "every texel has met the light");
    let against = |sigma: &[[f64; 3]]| {
        let right = [&expected_light.radiance[1][..], &expected_light.error[1]];
        Agreement::of([&light, sigma], right, f64::INFINITY, 1e-5)
    };
    let unsampled = plan::unsampled_light_error(&scene, 1, FEW as u32 * plan::REFERENCE_BATCH);
    let sigma: Vec<_> = error.iter().map(|e| [0, 1, 2].map(|c| e[c].hypot(unsampled[c]))).collect();
    assert!(against(&sigma).holds(), "{:?}", against(&sigma));
    assert!(!against(&error).holds(), "passes without unsampled light");
}

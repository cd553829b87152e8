//! The path tracer against the f64 quadrature, and against what is known without either.

use ridgelight::cpu::bounce::{Fineness, truth};
use ridgelight::plan;
use ridgelight::scene::{Albedo, Border, Environment, Lights, Scene, Surface};

use crate::scenes::{Agreement, scenes};
use crate::{Device, field, under_sky};

/// Radiance and its standard error.
type Traced = [Vec<[f64; 3]>; 2];

/// `batches` of a scene.
fn traced(device: &mut Device, scene: &Scene, bounces: u32, seed: u32, batches: usize) -> Traced {
    let plan = plan::reference(scene, bounces, seed, &device.limits()).expect("a plan");
    let last = plan.passes.len() - 1;
    let lost = plan.find("lost_rays").expect("a buffer");
    let contents = plan::reference_inputs(scene);
    let contents: Vec<&[f32]> = contents.iter().map(Vec::as_slice).collect();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = gpu.frame(plan, &contents).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    for _ in 1..batches {
        gpu.draw_passes(&mut frame, &[last]).expect("drawn on");
    }
    assert_eq!(gpu.read(&frame, lost).expect("read back")[0], 0, "rays were lost");
    let both = [0, 1].map(|output| {
        let pixels = gpu.pixels(&frame, output).expect("pixels");
        let texels = pixels.values.chunks_exact(4);
        texels.map(|t| [0, 1, 2].map(|c| f64::from(t[c]))).collect()
    });
    gpu.end(frame);
    both
}

#[test]
fn paths_agree_with_the_quadrature_on_every_scene() {
    let mut device = Device::new();
    for (name, scene) in scenes() {
        let fineness = Fineness { azimuths: 24, divisions: 1, strips: 12 };
        let truth = truth(&scene, 2, fineness).expect("a truth");
        for b in [0, 2] {
            let [light, error] = traced(&mut device, &scene, b as u32, 1, 64);
            let agreement =
                Agreement::of(&light, &error, &truth.radiance[b], &truth.error[b], 1e-5);
            println!("{name}, {b} bounces: {agreement:?}");
            assert!(agreement.holds(), "{name}, {b} bounces: {agreement:?}");
        }
    }
}

//! Views into an engine's own images: two frames in flight, lit and drawn in the same command buffers.

use ash::vk;
use ridgelight::gpu::{ViewInputs, ViewOutputs, ViewRenderer};
use ridgelight::plan::{self, Picture, View, ViewOptions};
use ridgelight::scene::{Border, Camera, Lens, Quality};

use crate::target::{FORMAT, SIZE, Target};
use crate::{Device, field, under_sky};

/// Two slots, each lit and drawn from another camera into an image of its own, submitted as one: each has the bits of
/// the same view alone. Synchronisation validation checks across the command buffers.
#[test]
fn two_views_in_flight_are_what_each_is_alone() {
    let mut device = Device::new();
    let heights = field(18, 16, [1.0, 1.0], |r, c| ((r * 31 + c * 17) % 7) as f64 * 0.3);
    let scene = under_sky(heights, Border::Plane);
    let quality = Quality { azimuths: 4, ..Quality::default() };
    let limits = device.limits();
    let plan = plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan");
    let options = ViewOptions { size: SIZE, samples: 4, ..ViewOptions::default() };
    let views = [0.3, 2.0].map(|azimuth| {
        let lens = Lens::Perspective { fov_rad: 0.8 };
        let camera = Camera::around(&scene.field, None, [azimuth, 0.6], lens, options.aspect());
        View::new(&scene, &plan, &camera, &options, &limits).expect("a view")
    });
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frame = gpu.frame(plan, &[scene.field.heights_m()]).expect("a frame");
    gpu.draw(&mut frame).expect("drawn");
    let alone = views.each_ref().map(|v| gpu.look(&frame, v, None).expect("a picture").radiance);
    assert!(alone[0] != alone[1]);
    let host = gpu.host().clone();
    let targets = [Target::new(&host), Target::new(&host)];
    let mut renderer = ViewRenderer::new(&host, &views[0], FORMAT, 2).expect("a renderer");
    let (heights, radiance) = (frame.inputs()[0], frame.outputs()[0]);
    let inputs = ViewInputs { heights, radiance, environment: None, voids: None };
    let (lit_inputs, lit_outputs) = (frame.inputs(), frame.outputs());
    type Record<'a> = Box<dyn FnOnce(vk::CommandBuffer) -> ridgelight::Result<()> + 'a>;
    let shared = std::cell::RefCell::new((&mut renderer, frame.renderer()));
    let records = (0..2).map(|slot| -> Record<'_> {
        let (shared, views, targets, host) = (&shared, &views, &targets, &host);
        let (inputs, lit_inputs, lit_outputs) = (&inputs, &lit_inputs, &lit_outputs);
        Box::new(move |commands| {
            let (renderer, lit) = &mut *shared.borrow_mut();
            // The frame's renderer has one slot: it is recorded once.
            if slot == 0 {
                lit.record(commands, 0, lit_inputs, lit_outputs)?;
            }
            let outputs = ViewOutputs { picture: targets[slot].arg(), depth: None };
            renderer.record(commands, slot, (&views[slot], 1.0), inputs, &outputs)?;
            targets[slot].copy(host, commands);
            Ok(())
        })
    });
    gpu.run_all(records.collect::<Vec<_>>()).expect("both");
    for (target, alone) in targets.iter().zip(&alone) {
        assert!(target.texels(&host) == *alone, "another picture in flight");
    }
    if device.report().timestamp_period_ns > 0.0 {
        for slot in 0..2 {
            let labels = renderer.timings(slot).expect("times").into_iter().map(|t| t.label);
            assert_eq!(labels.collect::<Vec<_>>(), ["terrain_draw", "sky_draw"]);
        }
    }
    renderer.destroy();
    targets.into_iter().for_each(|target| target.end(&host));
    device.gpu.as_mut().expect("alive").end(frame);
}

//! Renderers beside each other: ended in any order, used by two threads, recorded for many frames.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use ash::vk;
use ridgelight::Result;
use ridgelight::gpu::{Allocation, Allocator, Blocks, Host, MemoryRequest, Renderer, ViewRenderer};
use ridgelight::plan::{self, Picture, Rectangle, View, ViewOptions};
use ridgelight::scene::{Border, Camera, Lens, Quality};

use super::in_flight::{Recorded, frame, planned, scene};
use crate::{Device, bits, field, under_sky};

/// Two renderers and one of views on one device, ended in each order. Those that are left draw what they drew before.
#[test]
fn renderers_are_destroyed_in_any_order() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let scene = scene(16, 1);
    let plan = planned(gpu, &scene);
    let mut frame = frame(gpu, &scene);
    gpu.draw(&mut frame).expect("drawn");
    let right = bits(gpu, &frame);
    let (inputs, outputs) = (frame.inputs(), frame.outputs());
    let lens = Lens::Perspective { fov_rad: 0.8 };
    let camera = Camera::around(&scene.field, None, [0.7, 0.5], lens, 1.0);
    let options = ViewOptions { size: [8, 8], samples: 1, ..ViewOptions::default() };
    let limits = crate::limits_of(gpu);
    let view = View::new(&scene, &plan, &camera, &options, &limits).expect("a view");
    let format = vk::Format::R32G32B32A32_SFLOAT;
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let make = || Renderer::new(gpu.host(), plan.clone(), 1).expect("a renderer");
        let mut renderers = [Some(make()), Some(make())];
        let mut of_view =
            Some(ViewRenderer::new(gpu.host(), &view, format, 1).expect("a renderer of views"));
        for ended in order {
            for renderer in renderers.iter_mut().flatten() {
                gpu.refill(&frame, 0, &[0.0; 16 * 16]).expect("level ground");
                gpu.run(|commands| renderer.record(commands, 0, &inputs, &outputs)).expect("run");
                assert!(bits(gpu, &frame) != right);
                gpu.refill(&frame, 0, scene.field.heights_m()).expect("the heights again");
                gpu.run(|commands| renderer.record(commands, 0, &inputs, &outputs)).expect("run");
                assert!(bits(gpu, &frame) == right, "{order:?}, before {ended}");
            }
            match renderers.get_mut(ended) {
                Some(renderer) => renderer.take().expect("ended once").destroy(),
                None => of_view.take().expect("ended once").destroy(),
            }
        }
    }
    gpu.draw(&mut frame).expect("drawn");
    assert!(bits(gpu, &frame) == right);
    gpu.end(frame);
}

/// Each thread makes a renderer, records frames and ends the renderer. They share the device and, in turn, its queue.
#[test]
fn two_threads_have_a_renderer_each() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let scenes = [scene(24, 1), scene(24, 2)];
    let mut frames = scenes.each_ref().map(|scene| frame(gpu, scene));
    let right = frames.each_mut().map(|frame| {
        gpu.draw(frame).expect("drawn");
        bits(gpu, frame)
    });
    assert!(right[0] != right[1]);
    // Level ground, so that stale contents cannot pass.
    for frame in &mut frames {
        gpu.refill(frame, 0, &[0.0; 24 * 24]).expect("level ground");
        gpu.draw(frame).expect("drawn");
    }
    for (frame, scene) in frames.iter().zip(&scenes) {
        gpu.refill(frame, 0, scene.field.heights_m()).expect("the heights again");
    }
    let host = gpu.host().clone();
    // SAFETY: the device is alive, the family its own; `gpu` submits nothing until the threads have ended.
    let queue = Mutex::new(unsafe { host.device.get_device_queue(host.queue_family, 0) });
    let plans = scenes.each_ref().map(|scene| planned(gpu, scene));
    std::thread::scope(|scope| {
        for (frame, plan) in frames.iter().zip(plans) {
            let (inputs, outputs) = (frame.inputs(), frame.outputs());
            let (host, queue) = (&host, &queue);
            scope.spawn(move || {
                let mut renderer = Renderer::new(host, plan, 2).expect("a renderer");
                let both = [0, 1].map(|slot| {
                    let recorded = Recorded::new(host, |commands| {
                        renderer.record(commands, slot, &inputs, &outputs).expect("recorded");
                    });
                    recorded.submit(&host.device, *queue.lock().expect("no panic"));
                    recorded
                });
                both.into_iter().for_each(|recorded| recorded.end(&host.device));
                renderer.destroy();
            });
        }
    });
    for (frame, right) in frames.iter().zip(&right) {
        assert!(bits(gpu, frame) == *right);
    }
    frames.into_iter().for_each(|frame| gpu.end(frame));
}

/// Blocks that count their calls, and the allocations that are not freed yet.
pub(super) struct Counting {
    blocks: Blocks,
    pub(super) calls: Arc<AtomicUsize>,
    pub(super) held: Arc<AtomicUsize>,
}

impl Counting {
    pub(super) fn new(host: &Host) -> Self {
        let blocks = Blocks::new(host).expect("blocks");
        Self { blocks, calls: Arc::default(), held: Arc::default() }
    }
}

// SAFETY: what `Blocks` hands out.
unsafe impl Allocator for Counting {
    fn allocate(&mut self, request: &MemoryRequest<'_>) -> Result<Allocation> {
        self.calls.fetch_add(1, Ordering::Relaxed);
        let allocation = self.blocks.allocate(request)?;
        self.held.fetch_add(1, Ordering::Relaxed);
        Ok(allocation)
    }

    fn free(&mut self, allocation: Allocation) {
        self.calls.fetch_add(1, Ordering::Relaxed);
        self.held.fetch_sub(1, Ordering::Relaxed);
        self.blocks.free(allocation);
    }

    fn bytes(&self) -> u64 {
        self.blocks.bytes()
    }
}

#[test]
fn three_hundred_frames_take_no_more_memory() {
    take_no_more_memory(300);
}

#[test]
#[ignore = "tools/test --all"]
fn ten_thousand_frames_take_no_more_memory() {
    take_no_more_memory(10_000);
}

/// Whole frames, edits and plans with another light in turn: the renderer takes no memory and gives none back.
fn take_no_more_memory(frames: usize) {
    let mut device = Device::new();
    let scenes = [0.5, 0.7].map(|sky| {
        let heights = field(8, 8, [1.0, 1.0], |r, c| ((r * 31 + c * 17) % 7) as f64);
        let mut scene = under_sky(heights, Border::Plane);
        scene.lights.sky = Some([sky; 3]);
        scene
    });
    let quality = Quality { azimuths: 4, ..Quality::default() };
    let wanted = Picture { keeps_horizons: true, ..Picture::default() };
    let limits = device.limits();
    let plans = scenes
        .each_ref()
        .map(|scene| plan::picture(scene, &quality, &limits, wanted).expect("a plan"));
    let gpu = device.gpu.as_mut().expect("alive");
    let texels = scenes[0].field.heights_m();
    let frame = gpu.frame(plans[0].clone(), &[texels]).expect("a frame");
    let (inputs, outputs) = (frame.inputs(), frame.outputs());
    let memory = Box::new(Counting::new(gpu.host()));
    let calls = memory.calls.clone();
    let made = Renderer::with_memory(gpu.host(), plans[0].clone(), 2, memory);
    let mut renderer = made.expect("a renderer");
    let (bytes, made) = (renderer.device_bytes(), calls.load(Ordering::Relaxed));
    assert!(bytes > 0 && made > 0);
    let all = Rectangle { col: 2, row: 3, cols: 4, rows: 2 };
    for number in 0..frames {
        let slot = number % 2;
        gpu.run(|commands| match number % 3 {
            0 => {
                renderer.replace_plan(plans[number / 3 % 2].clone())?;
                renderer.record(commands, slot, &inputs, &outputs)
            }
            1 => renderer.record(commands, slot, &inputs, &outputs),
            _ => renderer.record_edit(commands, slot, &inputs, &outputs, all),
        })
        .expect("recorded and run");
        let found = (renderer.device_bytes(), calls.load(Ordering::Relaxed));
        assert_eq!(found, (bytes, made), "frame {number}");
    }
    renderer.destroy();
    // Each allocation is given back.
    assert_eq!(calls.load(Ordering::Relaxed), 2 * made);
    gpu.end(frame);
}

//! Frames in flight: several command buffers submitted at once, one wait. Synchronisation validation checks across
//! them.

use ash::prelude::VkResult;
use ash::vk;
use ridgelight::Result;
use ridgelight::gpu::{Frame, Headless, Host, Renderer};
use ridgelight::plan::{self, Picture, Plan};
use ridgelight::scene::fractal;
use ridgelight::scene::{Basis, Border, Environment, Quality, Scene, Sun};

use crate::{Device, bits, under_sky};

/// Records into a command buffer.
type Record<'a> = Box<dyn FnOnce(vk::CommandBuffer) -> Result<()> + 'a>;

pub(super) fn scene(side: usize, seed: u64) -> Scene {
    let mut scene = under_sky(fractal(side, seed).expect("a field"), Border::Plane);
    scene.lights.suns = vec![Sun {
        azimuth_rad: 2.0,
        elevation_rad: 0.3,
        diameter_rad: 0.02,
        irradiance: [1.0, 0.9, 0.8],
    }];
    scene
}

pub(super) fn planned(gpu: &Headless, scene: &Scene) -> Plan {
    let quality = Quality { azimuths: 8, sun_azimuths: 2, ..Quality::default() };
    let wanted = Picture { light_layers: true, ..Picture::default() };
    plan::picture(scene, &quality, &crate::limits_of(gpu), wanted).expect("a plan")
}

pub(super) fn frame(gpu: &mut Headless, scene: &Scene) -> Frame {
    let plan = planned(gpu, scene);
    gpu.frame(plan, &[scene.field.heights_m()]).expect("a frame")
}

#[test]
fn two_slots_in_flight_draw_what_each_draws_alone() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let scenes = [scene(48, 1), scene(48, 2)];
    let mut alone = Vec::new();
    let mut frames = Vec::new();
    for scene in &scenes {
        let mut drawn = frame(gpu, scene);
        gpu.draw(&mut drawn).expect("drawn");
        alone.push(bits(gpu, &drawn));
        gpu.end(drawn);
        frames.push(frame(gpu, scene));
    }
    assert!(alone[0] != alone[1]);
    // Only heights differ: one plan serves both, and its own images serve both in turn.
    let plan = planned(gpu, &scenes[0]);
    let passes = plan.passes.len();
    let mut renderer = Renderer::new(gpu.host(), plan, 2).expect("a renderer");
    for _ in 0..2 {
        let renderer = std::cell::RefCell::new(&mut renderer);
        let records = [0, 1].map(|slot| {
            let (inputs, outputs) = (frames[slot].inputs(), frames[slot].outputs());
            let renderer = &renderer;
            move |commands| renderer.borrow_mut().record(commands, slot, &inputs, &outputs)
        });
        gpu.run_all(records).expect("recorded and run");
        let renderer = renderer.into_inner();
        for (slot, (frame, alone)) in frames.iter().zip(&alone).enumerate() {
            assert!(bits(gpu, frame) == *alone, "slot {slot}");
            if gpu.report().timestamp_period_ns > 0.0 {
                assert_eq!(renderer.timings(slot).map(|t| t.len()), Some(passes), "slot {slot}");
            }
        }
    }
    renderer.destroy();
    frames.into_iter().for_each(|frame| gpu.end(frame));
}

/// A sun that moves and an environment that turns from frame to frame, without a wait: frames in flight keep the
/// values of their recording. The host has two tables: the sun's azimuths are in one, the environment's rotation in
/// the other.
#[test]
fn lights_change_while_frames_are_in_flight() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let quality = Quality { azimuths: 8, sun_azimuths: 2, basis: Basis::Sh, ..Quality::default() };
    let limits = crate::limits_of(gpu);
    let mut texels = Vec::new();
    let plans = [0.0, 0.1].map(|turn| {
        let mut scene = scene(24, 1);
        let light = (0..128).map(|i| [1.0, (i % 16) as f32, 0.5]).collect();
        scene.lights.environment = Some(Environment::new(16, 8, light, turn).expect("light"));
        scene.lights.suns[0].azimuth_rad += turn;
        texels = plan::picture_inputs(&scene);
        plan::picture(&scene, &quality, &limits, Picture::default()).expect("a plan")
    });
    assert!(plans[0].azimuths != plans[1].azimuths && plans[0].constants != plans[1].constants);
    let contents: Vec<&[f32]> = texels.iter().map(Vec::as_slice).collect();
    let mut frames = plans.each_ref().map(|p| gpu.frame(p.clone(), &contents).expect("a frame"));
    let alone = frames.each_mut().map(|frame| {
        gpu.draw(frame).expect("drawn");
        bits(gpu, frame)
    });
    assert!(alone[0] != alone[1]);
    let mut renderer = Renderer::new(gpu.host(), plans[1].clone(), 2).expect("a renderer");
    for turn in [0, 1] {
        // Either plan from either slot.
        let order = [turn, 1 - turn];
        let renderer = std::cell::RefCell::new(&mut renderer);
        let records = [0, 1].map(|slot| {
            let which = order[slot];
            let (inputs, outputs) = (frames[which].inputs(), frames[which].outputs());
            let (renderer, plan) = (&renderer, plans[which].clone());
            move |commands| {
                let mut renderer = renderer.borrow_mut();
                renderer.replace_plan(plan)?;
                renderer.record(commands, slot, &inputs, &outputs)
            }
        });
        gpu.run_all(records).expect("recorded and run");
        for (which, (frame, alone)) in frames.iter().zip(&alone).enumerate() {
            assert!(bits(gpu, frame) == *alone, "light {which}");
        }
    }
    renderer.destroy();
    frames.into_iter().for_each(|frame| gpu.end(frame));
}

/// A size that changes is a new plan: its renderer draws while the old one's last frame is in flight, and continues
/// after the old one is gone.
#[test]
fn a_new_size_is_drawn_beside_the_old_one() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let mut frames = [frame(gpu, &scene(40, 1)), frame(gpu, &scene(57, 1))];
    let mut alone = Vec::new();
    for frame in &mut frames {
        gpu.draw(frame).expect("drawn");
        alone.push(bits(gpu, frame));
    }
    frames.into_iter().for_each(|frame| gpu.end(frame));

    let mut old = frame(gpu, &scene(40, 1));
    let mut new = frame(gpu, &scene(57, 1));
    let records = [&mut old, &mut new].map(|frame| -> Record<'_> {
        Box::new(|commands| {
            let (inputs, outputs) = (frame.inputs(), frame.outputs());
            frame.renderer().record(commands, 0, &inputs, &outputs)
        })
    });
    gpu.run_all(records).expect("recorded and run");
    assert!([bits(gpu, &old), bits(gpu, &new)] == alone[..]);
    gpu.end(old);
    gpu.draw(&mut new).expect("drawn");
    assert!(bits(gpu, &new) == alone[1]);
    gpu.end(new);
}

/// A command buffer of its own pool, which another thread may own.
pub(super) struct Recorded {
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
}

impl Recorded {
    /// Records `what` and does not submit it.
    pub(super) fn new(host: &Host, what: impl FnOnce(vk::CommandBuffer)) -> Self {
        let device = &host.device;
        let pool_info = vk::CommandPoolCreateInfo::default().queue_family_index(host.queue_family);
        // SAFETY: the device is alive; only this thread uses pool and buffer until they are passed on.
        unsafe {
            let pool = device.create_command_pool(&pool_info, None).expect("a pool");
            let info = vk::CommandBufferAllocateInfo::default().command_pool(pool);
            let buffers = device.allocate_command_buffers(&info.command_buffer_count(1));
            let commands = buffers.expect("a command buffer")[0];
            let begin = vk::CommandBufferBeginInfo::default();
            device.begin_command_buffer(commands, &begin).expect("begun");
            what(commands);
            device.end_command_buffer(commands).expect("recorded");
            let fence = device.create_fence(&vk::FenceCreateInfo::default(), None);
            Self { pool, commands, fence: fence.expect("a fence") }
        }
    }

    pub(super) fn submit(&self, device: &ash::Device, queue: vk::Queue) {
        self.try_submit(device, queue).expect("submitted");
    }

    /// The same, where the device may refuse it.
    pub(super) fn try_submit(&self, device: &ash::Device, queue: vk::Queue) -> VkResult<()> {
        let buffers = [self.commands];
        let submit = [vk::SubmitInfo::default().command_buffers(&buffers)];
        // SAFETY: recorded above; nobody else uses the queue meanwhile.
        unsafe { device.queue_submit(queue, &submit, self.fence) }
    }

    /// Submits it and waits for it, after which it may be submitted again.
    pub(super) fn run(&self, device: &ash::Device, queue: vk::Queue) {
        self.submit(device, queue);
        // SAFETY: the fence is that of the submission, which has ended when it is reset.
        unsafe {
            device.wait_for_fences(&[self.fence], true, u64::MAX).expect("done");
            device.reset_fences(&[self.fence]).expect("reset");
        }
    }

    /// Waits for it, and frees it.
    pub(super) fn end(self, device: &ash::Device) {
        // SAFETY: submitted above.
        unsafe { device.wait_for_fences(&[self.fence], true, u64::MAX) }.expect("done");
        self.free(device);
    }

    /// Frees it where it has run, or was refused.
    pub(super) fn free(self, device: &ash::Device) {
        // SAFETY: made above; the device does not use it any more.
        unsafe {
            device.destroy_fence(self.fence, None);
            device.destroy_command_pool(self.pool, None);
        }
    }
}

/// Another thread records the second frame while the first is in flight.
#[test]
fn a_frame_is_recorded_on_another_thread_while_one_is_in_flight() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let scenes = [scene(33, 1), scene(33, 2)];
    let mut frames = scenes.each_ref().map(|scene| frame(gpu, scene));
    let alone = frames.each_mut().map(|frame| {
        gpu.draw(frame).expect("drawn");
        bits(gpu, frame)
    });
    // Other light in the images, so that stale contents cannot pass.
    for ((frame, other), alone) in frames.iter_mut().zip([1, 0]).zip(&alone) {
        gpu.refill(frame, 0, scenes[other].field.heights_m()).expect("other heights");
        gpu.draw(frame).expect("drawn");
        assert!(bits(gpu, frame) != *alone);
        gpu.refill(frame, 0, scenes[1 - other].field.heights_m()).expect("the heights again");
    }
    let plan = planned(gpu, &scenes[0]);
    let mut renderer = Renderer::new(gpu.host(), plan, 2).expect("a renderer");
    let args = frames.each_ref().map(|frame| (frame.inputs(), frame.outputs()));
    let host = gpu.host().clone();
    let lent = &host.device;
    // SAFETY: the device is alive, the family its own; `gpu` submits nothing until the end.
    let queue = unsafe { lent.get_device_queue(host.queue_family, 0) };
    let first = Recorded::new(&host, |commands| {
        renderer.record(commands, 0, &args[0].0, &args[0].1).expect("recorded");
    });
    first.submit(lent, queue);
    let (renderer, second) = std::thread::scope(|scope| {
        let (host, args) = (&host, &args);
        let recording = scope.spawn(move || {
            let second = Recorded::new(host, |commands| {
                renderer.record(commands, 1, &args[1].0, &args[1].1).expect("recorded");
            });
            (renderer, second)
        });
        recording.join().expect("recorded")
    });
    second.submit(lent, queue);
    first.end(lent);
    second.end(lent);
    if gpu.report().timestamp_period_ns > 0.0 {
        assert!((0..2).all(|slot| renderer.timings(slot).is_some()));
    }
    for (frame, alone) in frames.iter().zip(&alone) {
        assert!(bits(gpu, frame) == *alone);
    }
    renderer.destroy();
    frames.into_iter().for_each(|frame| gpu.end(frame));
}

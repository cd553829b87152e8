//! Recordings that run more than once, in a primary command buffer and in a secondary one.

use ash::vk;
use ridgelight::gpu::{Host, Renderer};

use super::in_flight::{Recorded, frame, planned, scene};
use crate::{Device, bits};

/// A secondary command buffer with `what`, and its pool.
fn secondary(
    host: &Host,
    what: impl FnOnce(vk::CommandBuffer),
) -> (vk::CommandPool, vk::CommandBuffer) {
    let device = &host.device;
    let pool_info = vk::CommandPoolCreateInfo::default().queue_family_index(host.queue_family);
    // SAFETY: the device is alive; only this thread uses pool and buffer.
    unsafe {
        let pool = device.create_command_pool(&pool_info, None).expect("a pool");
        let info = vk::CommandBufferAllocateInfo::default()
            .command_pool(pool)
            .level(vk::CommandBufferLevel::SECONDARY)
            .command_buffer_count(1);
        let commands = device.allocate_command_buffers(&info).expect("a command buffer")[0];
        let outside = vk::CommandBufferInheritanceInfo::default();
        let begin = vk::CommandBufferBeginInfo::default().inheritance_info(&outside);
        device.begin_command_buffer(commands, &begin).expect("begun");
        what(commands);
        device.end_command_buffer(commands).expect("recorded");
        (pool, commands)
    }
}

/// Two recordings of one renderer run in turn, each with both heights, also after the other has run. Each run has other
/// heights than the run before, so the light of that run cannot pass.
#[test]
fn recordings_run_again_with_new_heights() {
    let mut device = Device::new();
    let gpu = device.gpu.as_mut().expect("alive");
    let scenes = [scene(33, 1), scene(33, 2)];
    let mut drawn = frame(gpu, &scenes[0]);
    let alone = scenes.each_ref().map(|scene| {
        gpu.refill(&drawn, 0, scene.field.heights_m()).expect("heights");
        gpu.draw(&mut drawn).expect("drawn");
        bits(gpu, &drawn)
    });
    assert!(alone[0] != alone[1]);
    let (inputs, outputs) = (drawn.inputs(), drawn.outputs());
    let plan = planned(gpu, &scenes[0]);
    let mut renderer = Renderer::new(gpu.host(), plan, 2).expect("a renderer");
    let host = gpu.host().clone();
    let lent = &host.device;
    // SAFETY: the device is alive, the family its own; this thread alone submits, and waits for each submission.
    let queue = unsafe { lent.get_device_queue(host.queue_family, 0) };
    let first = Recorded::new(&host, |commands| {
        renderer.record(commands, 0, &inputs, &outputs).expect("recorded");
    });
    let (pool, inner) = secondary(&host, |commands| {
        renderer.record(commands, 1, &inputs, &outputs).expect("recorded");
    });
    let second = Recorded::new(&host, |commands| {
        // SAFETY: both are of the same family; `inner` has been recorded outside a render pass.
        unsafe { lent.cmd_execute_commands(commands, &[inner]) };
    });
    let runs = [(&first, 0), (&second, 1), (&second, 1), (&first, 0), (&first, 0), (&second, 1)];
    for (n, (recorded, slot)) in runs.into_iter().enumerate() {
        let heights = n % 2;
        gpu.refill(&drawn, 0, scenes[heights].field.heights_m()).expect("new heights");
        recorded.run(lent, queue);
        assert!(bits(gpu, &drawn) == alone[heights], "run {n}, slot {slot}");
        if gpu.report().timestamp_period_ns > 0.0 {
            assert!(renderer.timings(slot).is_some(), "run {n}, slot {slot}");
        }
    }
    [first, second].into_iter().for_each(|recorded| recorded.free(lent));
    // SAFETY: all of its command buffers have run.
    unsafe { lent.destroy_command_pool(pool, None) };
    renderer.destroy();
    gpu.end(drawn);
}

use crate::graph::{Builder, Format, Limits, Owner, shaders};

/// Texels along each side of the image that is fetched from: 1 MiB.
pub(crate) const SIDE: u32 = 512;
/// Larger than the caches of most GPUs, and of most processors.
const MOST_BYTES: [u64; 2] = [256 << 20, 64 << 20];
const GROUP_SIZE: u64 = shaders::DEVICE_PEAK.group_size()[0] as u64;
/// Copies of 16 bytes of an invocation.
const COPIES: u64 = 8;
const INVOCATIONS: [u64; 2] = [1 << 20, 1 << 18];
/// The parts, by the shader's number.
pub(crate) const PARTS: [&str; 5] = ["fill", "copy", "fetch", "shared", "fma"];

/// A pass that fills the memory, then one for each unit of the device. Of a copy, `bytes` counts; of the others, `texels`
/// counts fetches, reads of 8 bytes, and floating-point operations.
pub(crate) fn plan(builder: &mut Builder, limits: &Limits) {
    let most = MOST_BYTES[usize::from(limits.is_cpu)]
        .min(limits.buffer_bytes)
        .min(limits.allocation_bytes);
    // Beside another plan.
    let most = most.min(limits.memory_budget / 16);
    let groups = most / (16 * COPIES * GROUP_SIZE);
    let groups = groups.clamp(1, limits.groups.into());
    let copying = groups * GROUP_SIZE;
    let bytes = 16 * COPIES * copying;
    let invocations = INVOCATIONS[usize::from(limits.is_cpu)].min(copying);
    let source = builder.buffer("source", bytes, false);
    let result = builder.buffer("result", bytes, false);
    let texels = builder.image("texels", Owner::Internal, Format::R32Float, [SIDE, SIDE, 1], false);
    let image_bytes = 4 * u64::from(SIDE * SIDE);
    let filled: &[_] = &[("source", source), ("filled", texels)];
    let copied: &[_] = &[("source", source), ("result", result)];
    let fetched: &[_] = &[("texels", texels), ("result", result)];
    let written: &[_] = &[("result", result)];
    let [filling, fetching] = [bytes + image_bytes, 16 * invocations + image_bytes];
    let writing = 16 * invocations;
    // Reason, invocations, rounds, bindings, bytes, operations of a round. Of fetch, shared and fma, rounds and
    // operations stay the same in every version: `bench --against` compares times of equal bytes.
    let parts = [
        ("writes every page, so that none share memory", copying, COPIES, filled, filling, 0),
        ("the peak rate of memory", copying, COPIES, copied, 2 * bytes, 0),
        ("the peak rate of texel fetches", invocations, 32, fetched, fetching, 1),
        ("the peak rate of shared memory", invocations, 128, written, writing, 1),
        ("the peak rate of arithmetic", invocations, 256, written, writing, 16),
    ];
    for (number, (why, count, rounds, bound, traffic, operations)) in (0..).zip(parts) {
        builder.pass(
            shaders::DevicePeak { part: number },
            PARTS[number as usize],
            why,
            [(count / GROUP_SIZE) as u32, 1, 1],
            &shaders::DevicePeakPush {
                invocations: count as i32,
                rounds: rounds as i32,
                side: SIDE as i32,
                factor: 0.5,
                summand: 1.0,
            },
            bound,
            traffic,
            operations * rounds * count,
        );
    }
}

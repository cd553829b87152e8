//! Results of work that one unit of a device limits.

/// Entries in shared memory.
const ENTRIES: usize = 256;
/// Invocations of a workgroup.
const GROUP_SIZE: usize = 64;

/// What "fill" writes and "copy" copies, by `invocations` of `rounds` texels.
pub fn filled(invocations: usize, rounds: usize) -> Vec<[f32; 4]> {
    let texel = |i: usize| {
        let (i, k) = (i % invocations, i / invocations);
        [(i & 1023) as f32, k as f32, (i & 255) as f32, 1.0]
    };
    (0..invocations * rounds).map(texel).collect()
}

/// The image that "fill" writes: a texel by its position, row after row.
pub fn texel(position: usize) -> f32 {
    (position & 7) as f32
}

/// "fetch": a column of the image, repeated, from the texel of invocation `i` on.
pub fn fetch(i: usize, rounds: usize, side: usize) -> [f32; 4] {
    let at = |k: usize| texel((i / side + k) % side * side + i % side);
    [(0..rounds).map(at).sum(); 4]
}

/// "shared": entries from that of invocation `i` on, repeated.
pub fn shared(i: usize, rounds: usize) -> [f32; 4] {
    let entry = |k: usize| (i % GROUP_SIZE + k) % ENTRIES;
    let sum = |mask: usize| (0..rounds).map(|k| (entry(k) & mask) as f32).sum::<f32>();
    let [low, high] = [sum(15), sum(7)];
    [low, high, low, high]
}

/// "fma": `rounds` of x = `factor` x + `summand`. With a factor of 1/2 the product is exact, so a fused operation gives the
/// same bits.
pub fn fma(i: usize, rounds: usize, factor: f32, summand: f32) -> [f32; 4] {
    let last = |x: f32| (0..rounds).fold(x, |x, _| x * factor + summand);
    [(i & 255) as f32, 1.0, 2.0, 3.0].map(|x| last(x) + last(x + 256.0))
}

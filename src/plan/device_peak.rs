use super::Plan;
use crate::graph::{Builder, Limits};
use crate::passes::device_peak::SIDE;
use crate::{Result, passes};

/// Passes whose times give the peak rates of a device, which `bench` prints: "fill", which must run first, then "copy"
/// (its `bytes` are traffic), "fetch", "shared" and "fma" (their `texels` are fetches of one f32, reads of 8 bytes from
/// shared memory, and floating-point operations). "copy" also clears caches of their contents: it copies up to 256 MiB,
/// 64 MiB on a processor.
///
/// No inputs, no outputs.
///
/// # Errors
/// A device without room for it.
pub fn device_peak(limits: &Limits) -> Result<Plan> {
    let mut builder = Builder::new(limits);
    passes::device_peak::plan(&mut builder, limits);
    let size = [SIDE, SIDE];
    Plan::finish(builder, size, Vec::new(), Vec::new(), Vec::new(), limits)
}

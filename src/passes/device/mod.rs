//! Work that one unit of the device limits: what its memory, texel fetches, shared memory and arithmetic reach at most.

/// Copies, fetches, reads of shared memory, multiplications and additions.
pub(crate) mod device_peak;

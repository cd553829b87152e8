//! The path-traced reference.
//! One pass, dispatched once per batch of paths.

/// `reference`: 64 more paths per texel, the mean of all and its standard error.
pub(crate) mod path_trace;

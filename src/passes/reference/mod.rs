//! The path-traced reference.
//! One pass, dispatched once per batch of paths.

pub(crate) mod path_trace;

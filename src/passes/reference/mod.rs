pub(crate) mod path_trace;

pub(crate) mod dirty_list;
pub(crate) mod dirty_mark;
pub(crate) mod edits;
pub(crate) mod horizon_resweep;

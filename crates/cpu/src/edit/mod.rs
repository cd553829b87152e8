pub mod dirty_list;
pub mod dirty_mark;
pub mod horizon_resweep;

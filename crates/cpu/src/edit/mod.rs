//! CPU references of the passes that update horizons after a rectangle of heights has changed:
//! marking, listing and sweeping again what the edit can reach.

pub mod dirty_list;
pub mod dirty_mark;
pub mod horizon_resweep;

//! Edits of a rectangle of heights: which texels change, and the sweeps that find their new horizons.
//! `edits` holds their resources; the other files are one per pass.

pub(crate) mod dirty_list;
pub(crate) mod dirty_mark;
pub(crate) mod edits;
pub(crate) mod horizon_resweep;

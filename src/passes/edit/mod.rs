//! Edits of a rectangle of heights: which texels change, and the sweeps that find their new horizons.
//! `edits` holds their resources; the other files are one per pass.

/// After an edit: the compact list of the marked texels.
pub(crate) mod dirty_list;
/// After an edit: marks of the texels that it changes directly.
pub(crate) mod dirty_mark;
pub(crate) mod edits;
/// After an edit: the lines that it reaches, and marks of the texels from which it is visible.
pub(crate) mod horizon_resweep;

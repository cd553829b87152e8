//! Horizons: azimuths, line sweeps, exact sweeps, brute force and height pyramids.
//! `sweep` chooses the form, `sweeping` and `batch` cut it into dispatches; the other files are one per pass.

pub mod azimuths;
pub mod batch;
pub(crate) mod height_expand;
pub(crate) mod height_reduce;
pub(crate) mod height_transpose;
pub(crate) mod horizon_march;
pub(crate) mod horizon_sweep;
pub mod nodes;
pub mod pyramid;
pub(crate) mod pyramid_march;
pub(crate) mod surface_sweep;
pub mod sweep;
pub(crate) mod sweep_fuse;
pub mod sweeping;

//! CPU references of the passes that compute horizons: sweeps and their lattice, marches, height
//! pyramids. [`scalar_sweep`] is a plain CPU implementation to compare speed with.

pub mod height_expand;
pub mod height_reduce;
pub mod height_transpose;
pub mod horizon_march;
pub mod horizon_sweep;
pub mod lattice;
pub mod pyramid_march;
pub mod scalar_sweep;
pub mod surface_sweep;
pub mod sweep_fuse;

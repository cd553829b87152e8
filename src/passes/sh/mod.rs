//! Light by spherical harmonics: visibility as a series, the environment's series, and their product.
//! `sh_layout` holds the constants; the other files are one per pass.

pub(crate) mod env_rotation;
pub(crate) mod env_wedges;
pub(crate) mod light_matrix;
pub mod sh_layout;
pub(crate) mod sh_shade;
pub(crate) mod sh_visibility;
pub(crate) mod sh_wedges;

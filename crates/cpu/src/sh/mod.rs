//! CPU references of the passes that light by spherical harmonics: visibility series, light
//! matrices and shading, for environments and sphere lights.

pub mod env_rotation;
pub mod env_wedges;
pub mod harmonics;
pub mod light_matrix;
pub mod sh_shade;
pub mod sh_visibility;
pub mod sh_wedges;

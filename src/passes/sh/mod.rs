//! Light by spherical harmonics: visibility as a series, the environment's series, and their product.
//! `sh_layout` holds the constants; the other files are one per pass.

/// `--basis sh`: an environment as SH.
pub(crate) mod env_rotation;
/// An environment summed over each azimuth's wedge, row by row.
pub(crate) mod env_wedges;
/// `--basis sh`: the product matrix of an environment with visibility.
pub(crate) mod light_matrix;
pub mod sh_layout;
/// `--basis sh`: the light of all texels from visibility as SH; specular light of sky and environment too.
pub(crate) mod sh_shade;
/// `--basis sh`: visibility as SH at every, second or fourth grid point.
pub(crate) mod sh_visibility;
/// `--wedges table`: visibility as SH by a table of wedges between two horizons.
pub(crate) mod sh_wedges;

//! CPU references of the passes that add Phong specular: of sky, environment and key lights by slices of the lobe; incident light as
//! series of spherical harmonics, and its reflection towards the view and the next bounce.

pub mod key_arriving;
pub mod key_specular;
pub mod mirror_map;
pub mod specular_exit;
pub mod specular_light;
pub mod specular_tables;
pub mod specular_visibility;
pub mod sun_specular;

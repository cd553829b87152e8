//! CPU references of the passes that add Phong specular: incident light as series of spherical
//! harmonics, and its reflection towards the view and the next bounce.

pub mod specular_exit;
pub mod specular_visibility;
pub mod sun_specular;

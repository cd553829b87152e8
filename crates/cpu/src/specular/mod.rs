pub mod specular_exit;
pub mod specular_gather;
pub mod specular_visibility;
pub mod sun_specular;

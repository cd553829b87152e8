//! Phong specular reflection of suns and of indirect light.
//! `bounced_specular` holds the images of bounced specular light; the other files are one per pass.

pub(crate) mod bounced_specular;
pub(crate) mod specular_exit;
pub(crate) mod specular_visibility;
pub(crate) mod sun_specular;

//! Phong specular reflection of suns and of indirect light.
//! `bounced_specular` holds the images of bounced specular light; the other files are one per pass.

pub(crate) mod bounced_specular;
/// Specular with bounces: leaving light by direction or straight upwards.
pub(crate) mod specular_exit;
/// Specular with bounces: arriving light as SH.
pub(crate) mod specular_visibility;
/// Specular light of suns.
pub(crate) mod sun_specular;

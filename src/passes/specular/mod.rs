//! Phong specular reflection of sky and environment, of suns and of indirect light.
//! The passes of their diffuse light, `sun_shade` and `sphere_shade`, also reflect key lights and sphere lights.
//! `bounced_specular` holds the images of bounced specular light; the other files are one per pass.

pub(crate) mod bounced_specular;
/// Specular with bounces: arriving light of key lights as SH.
pub(crate) mod key_arriving;
/// Specular light of sky and environment without occlusion, by mirror direction.
pub(crate) mod mirror_map;
/// Specular with bounces: leaving light by direction or straight upwards.
pub(crate) mod specular_exit;
/// Specular light of sky and environment.
pub(crate) mod specular_light;
/// Light of sky and environment in a Phong lobe, by azimuth and elevation.
pub(crate) mod specular_tables;
/// Specular with bounces: arriving light as SH.
pub(crate) mod specular_visibility;
/// Specular light of suns.
pub(crate) mod sun_specular;

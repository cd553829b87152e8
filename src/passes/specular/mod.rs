pub(crate) mod glossy;
pub(crate) mod specular_exit;
pub(crate) mod specular_visibility;
pub(crate) mod sun_specular;

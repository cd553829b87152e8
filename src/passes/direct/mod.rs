//! Direct light: uniform sky, environment, suns, key lights and sphere lights.
//! `light_resolve` adds each light's sum to the picture.

pub(crate) mod env_tables;
pub(crate) mod light_resolve;
pub(crate) mod sky_shade;
pub(crate) mod sphere_sh;
pub(crate) mod sphere_sh_shade;
pub(crate) mod sphere_shade;
pub(crate) mod spheres;
pub(crate) mod sun_shade;

//! CPU references of the passes that compute direct light: sky, environment, suns, key lights
//! and sphere lights, and their resolve into radiance.

pub mod env_tables;
pub mod light_resolve;
pub mod shadow_height;
pub mod shadow_settle;
pub mod shadow_shade;
pub mod shadow_sweep;
pub mod sky_shade;
pub mod soft_sphere;
pub mod sphere_sh_shade;
pub mod sphere_shade;
pub mod sun_shade;

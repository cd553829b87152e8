pub mod env_tables;
pub mod light_resolve;
pub mod sky_shade;
pub mod soft_sphere;
pub mod sphere_shade;
pub mod sun_shade;

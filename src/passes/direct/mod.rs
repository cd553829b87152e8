//! Direct light: uniform sky, environment, suns, key lights and sphere lights.
//! `light_resolve` adds each light's sum to the picture.

/// An environment above every elevation, linear in the normal.
pub(crate) mod env_tables;
/// Sums to a picture and layers.
pub(crate) mod light_resolve;
/// The shadow heights of a sun at each grid point.
pub(crate) mod shadow_height;
/// Light of suns at the texels that shadow heights leave open, by their exact horizons.
pub(crate) mod shadow_settle;
/// Light of suns where shadow heights decide it.
pub(crate) mod shadow_shade;
/// How high the ground ahead casts shadows from a sun, along lines.
pub(crate) mod shadow_sweep;
pub(crate) mod shadows;
/// Light of sky and environment through the horizons.
pub(crate) mod sky_shade;
pub(crate) mod sphere_sh;
/// `--light-basis sh`: sphere lights by SH of visibility up to them.
pub(crate) mod sphere_sh_shade;
/// Sphere lights: each texel marches slices of the light over the surface, no farther than the light.
pub(crate) mod sphere_shade;
pub(crate) mod sphere_shading;
pub(crate) mod spheres;
/// Light of suns and key lights through the horizons.
pub(crate) mod sun_shade;

//! The twins of the GPU passes, and the brute-force truth they are all judged by.
//!
//! A twin has its shader's name and reads like it. Geometry (sweeps, fusing) does the shader's own
//! operations in f32 and in the shader's order, so that a driver that contracts nothing gives equal
//! bits; light is summed in f64 and compared within a tolerance. [`path_trace`]'s follows the same paths, and carries along
//! what f32 may be off by; [`indirect`] finds the same light without chance.
//!
//! To be judged by: [`oracle`], brute force over every triangle, and [`indirect`]. To read a shader with its twin
//! beside it: `shaders_glsl/NAME.comp` and `cpu::NAME`, the same names in both.

#![deny(clippy::missing_errors_doc)]

mod bake;
mod bounce;
mod direct;
mod edit;
mod horizon;
mod rays;
mod reference;
mod sh;
pub mod shared;
mod specular;
pub mod tolerance;
mod view;

pub use bake::{
    bent_directions, ellipse_fit, facet_mask, fan_weights, scatter_gather, visible_points,
};
pub use bounce::{
    bounce_gather, bounce_march, bounce_shade, bounce_walk, cache_gather, shade_expand,
    shade_reduce, vector_reduce,
};
pub use direct::{env_tables, light_resolve, sky_shade, soft_sphere, sphere_shade, sun_shade};
pub use edit::{dirty_list, dirty_mark, horizon_resweep};
pub use horizon::{
    height_expand, height_reduce, height_transpose, horizon_march, horizon_sweep, lattice,
    pyramid_march, scalar_sweep, surface_sweep, sweep_fuse,
};
pub use rays::{height_bounds, height_cells};
pub use reference::{indirect, key, light, lit, oracle, path_trace, profile, sphere};
pub use sh::{
    env_rotation, env_wedges, harmonics, light_matrix, sh_shade, sh_visibility, sh_wedges,
    sphere_sh_shade,
};
pub use specular::{specular_exit, specular_gather, specular_visibility, sun_specular};
pub use view::{map_draw, picture_tone, sky_draw, terrain_draw};

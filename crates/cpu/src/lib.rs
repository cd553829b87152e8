//! CPU references of the GPU passes, the ground truth that both are tested against, and the tolerances between them.
//!
//! The CPU reference of a pass has its shader's name and structure: `shaders_glsl/ROOM/NAME.comp` and `cpu::NAME`.
//! Geometry (sweeps, fusing) repeats the shader's f32 operations in its order, so a driver that fuses no operations
//! gives equal bits. Light is summed in f64 and compared within a [`tolerance`].
//!
//! [`path_trace`] follows the same random paths as its shader and carries the f32 error bound of every value along.
//! The ground truth is independent of the shaders: [`oracle`] tests every triangle by brute force, [`indirect`]
//! computes direct and indirect light by quadrature, without Monte Carlo noise.

#![deny(clippy::missing_errors_doc)]

mod bake;
pub mod basis;
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
    shade_reduce, specular_gather, vector_reduce,
};
pub use direct::{
    env_tables, light_resolve, sky_shade, soft_sphere, sphere_sh_shade, sphere_shade, sun_shade,
};
pub use edit::{dirty_list, dirty_mark, horizon_resweep};
pub use horizon::{
    height_expand, height_reduce, height_transpose, horizon_march, horizon_sweep, lattice,
    pyramid_march, scalar_sweep, surface_sweep, sweep_fuse,
};
pub use rays::{height_bounds, height_cells};
pub use reference::{indirect, light, lit, oracle, path_trace, profile, sphere};
pub use sh::{
    env_rotation, env_wedges, harmonics, light_matrix, sh_shade, sh_visibility, sh_wedges,
};
pub use specular::{specular_exit, specular_visibility, sun_specular};
pub use view::{map_draw, picture_tone, sky_draw, terrain_draw};

//! The twins of the GPU passes, and the brute-force truth they are all judged by.
//!
//! A twin has its shader's name and reads like it. Geometry (sweeps, fusing) does the shader's own
//! operations in f32 and in the shader's order, so that a driver that contracts nothing gives equal
//! bits; light is summed in f64 and compared within a tolerance. [`path_trace`]'s follows the same paths, and carries along
//! what f32 may be off by; [`bounce`] finds the same light without chance.
//!
//! To be judged by: [`oracle`], brute force over every triangle, and [`bounce`]. To read a shader with its twin
//! beside it: `shaders_glsl/NAME.comp` and `cpu::NAME`, the same names in both.

#![deny(clippy::missing_errors_doc)]

pub mod bounce;
pub mod bounce_gather;
pub mod bounce_march;
pub mod bounce_shade;
pub mod bounce_walk;
pub mod cast_gather;
pub mod dirty_list;
pub mod dirty_mark;
pub mod ellipse_fit;
pub mod env_tables;
pub mod env_turns;
pub mod env_wedges;
pub mod facet_mask;
pub mod fan_weigh;
pub mod gloss_exit;
pub mod gloss_gather;
pub mod gloss_seen;
pub mod harmonics;
pub mod height_bounds;
pub mod height_cells;
pub mod height_expand;
pub mod height_reduce;
pub mod height_transpose;
pub mod horizon_march;
pub mod horizon_resweep;
pub mod horizon_sweep;
pub mod key;
pub mod lattice;
pub mod light;
pub mod light_matrix;
pub mod light_resolve;
pub mod lit;
pub mod map_draw;
pub mod oracle;
pub mod path_trace;
pub mod picture_tone;
pub mod points_bend;
pub mod profile;
pub mod pyramid_march;
pub mod scalar_sweep;
pub mod scatter_gather;
pub mod sh_shade;
pub mod sh_visibility;
pub mod sh_wedges;
pub mod shade_expand;
pub mod shade_reduce;
pub mod shared;
pub mod sky_draw;
pub mod sky_shade;
pub mod soft_ball;
pub mod sphere;
pub mod sphere_sh_shade;
pub mod sphere_shade;
pub mod sun_gloss;
pub mod sun_shade;
pub mod surface_sweep;
pub mod sweep_fuse;
pub mod terrain_draw;
pub mod tolerance;
pub mod vector_reduce;
pub mod visible_points;

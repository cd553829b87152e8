//! One file a pass: what it binds, how large it is, and why it is there; `push` has what
//! several push alike.

pub(crate) mod dirty_list;
pub(crate) mod dirty_mark;
pub(crate) mod env_tables;
pub(crate) mod env_turns;
pub(crate) mod env_wedges;
pub(crate) mod height_bounds;
pub(crate) mod height_cells;
pub(crate) mod height_expand;
pub(crate) mod height_reduce;
pub(crate) mod height_transpose;
pub(crate) mod horizon_march;
pub(crate) mod horizon_resweep;
pub(crate) mod horizon_sweep;
pub(crate) mod light_matrix;
pub(crate) mod light_resolve;
pub(crate) mod path_trace;
mod push;
pub(crate) mod pyramid_march;
pub(crate) mod sh_shade;
pub(crate) mod sh_visibility;
pub(crate) mod sh_wedges;
pub(crate) mod sky_shade;
pub(crate) mod sphere_shade;
pub(crate) mod sun_shade;
pub(crate) mod surface_sweep;
pub(crate) mod sweep_fuse;

pub(crate) mod env_rotation;
pub(crate) mod env_wedges;
pub(crate) mod light_matrix;
pub mod sh_layout;
pub(crate) mod sh_shade;
pub(crate) mod sh_visibility;
pub(crate) mod sh_wedges;

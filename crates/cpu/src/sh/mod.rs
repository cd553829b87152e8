pub mod env_rotation;
pub mod env_wedges;
pub mod harmonics;
pub mod light_matrix;
pub mod sh_shade;
pub mod sh_visibility;
pub mod sh_wedges;
pub mod sphere_sh_shade;

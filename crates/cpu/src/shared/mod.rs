//! What several shaders include, file by file as in `shaders_glsl/shared/`.

pub mod bounced;
pub mod field;
pub mod fuse;
pub mod gather;
pub mod levels;
pub mod lobe;
pub mod random;
pub mod segment;
pub mod surface;
pub mod sweep;
pub mod trace;
pub mod walk;

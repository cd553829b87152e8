//! Code that several CPU references share, file by file as the shaders' include files.

pub mod bounced;
pub mod field;
pub mod fuse;
pub mod gather;
pub mod levels;
pub mod phong_lobe;
pub mod random;
pub mod surface;
pub mod sweep;
pub mod trace;
pub mod walk;

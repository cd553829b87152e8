//! Output files that are complete or absent, and their formats.

pub mod atomic;
pub mod codes;
pub mod component;
pub mod ktx2;
pub mod room;

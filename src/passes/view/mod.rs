//! Pictures: maps from above, and the mesh of the terrain.
//! Dispatches and draws are recorded by `gpu::view` and the viewer.

pub mod map_draw;
pub(crate) mod terrain_draw;

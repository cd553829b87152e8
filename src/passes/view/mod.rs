//! Pictures: maps from above, and the push constants of the graphics passes (terrain, sky, tone curve).
//! Dispatches and draws are recorded by `gpu::view` and the viewer.

pub mod map_draw;
pub(crate) mod picture_tone;
pub(crate) mod sky_draw;
pub(crate) mod terrain_draw;

//! Pictures: maps from above, and the mesh of the terrain.
//! Dispatches and draws are recorded by `gpu::view` and the viewer.

/// The field from above, as a map.
pub mod map_draw;
/// Walls and base below the field's edges, in pictures only.
pub(crate) mod plinth_draw;
/// Light of a coarse grid on a finer one.
pub(crate) mod preview;
/// `--camera`: the ground as a mesh without vertex buffers. The background (`sky_draw`) and exposure with sRGB
/// (`picture_tone`) have no more than push constants; `plan::view` makes them.
pub(crate) mod terrain_draw;

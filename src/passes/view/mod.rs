//! Pictures: maps from above, and the mesh of the terrain.
//! Dispatches and draws are recorded by `gpu::view` and the viewer. Exposure with sRGB (`picture_tone`) has one push
//! constant, the exposure of a recording, and the depths of sample 0 (`depth_resolve`) have none: so no files here.

/// The field from above, as a map.
pub mod map_draw;
/// Walls and base below the field's edges, in pictures only.
pub(crate) mod plinth_draw;
/// Grids of a preview: the light of a coarse one on the slopes of a finer one.
pub(crate) mod preview;
/// Light of the coarse grid, without its slopes.
pub(crate) mod preview_gather;
/// That light on the slopes of the fine grid.
pub(crate) mod preview_shade;
/// What is behind the ground of a camera's picture: sky and environment.
pub(crate) mod sky_draw;
/// `--camera`: the ground as a mesh without vertex buffers.
pub(crate) mod terrain_draw;

//! CPU references of the passes that draw pictures: the map from above, and the terrain mesh
//! and background in a perspective view.

pub mod map_draw;
pub mod picture_tone;
pub mod plinth_draw;
pub mod preview;
pub mod preview_gather;
pub mod preview_shade;
pub mod sky_draw;
pub mod terrain_draw;

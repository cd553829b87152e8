pub mod map_draw;
pub(crate) mod picture_tone;
pub(crate) mod sky_draw;
pub(crate) mod terrain_draw;

pub mod map_draw;
pub mod picture_tone;
pub mod sky_draw;
pub mod terrain_draw;

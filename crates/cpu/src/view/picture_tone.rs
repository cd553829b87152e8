//! How radiance becomes a channel of a picture: what pictures are written with.

pub use ridgelight::scene::picture_tone;

//! Conversion of radiance to a channel of a picture, as for written image files.

pub use ridgelight::scene::picture_tone;

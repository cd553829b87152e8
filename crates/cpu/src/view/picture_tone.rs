//! Conversion of radiance to a channel of a picture, as for written image files.

use ridgelight::scene::Tone;

/// Channel of a pixel, [0..1].
pub fn picture_tone(radiance: f32, exposure: f32) -> f64 {
    Tone::picture(exposure).channel(radiance)
}

//! Conversion of radiance to a channel of a picture, as for written image files.

/// Where the shoulder begins.
const SHOULDER: f64 = 0.8;

/// Channel of a pixel, [0..1]: radiance times `exposure`, the shoulder, sRGB (IEC 61966-2-1). Negative gives 0.
///
/// The shoulder is s + (1 - s) o / (o + 1 - s) at o beyond s: written otherwise than in `Tone`.
pub fn picture_tone(radiance: f32, exposure: f32) -> f64 {
    let light = (f64::from(radiance) * f64::from(exposure)).max(0.0);
    let (over, rest) = ((light - SHOULDER).clamp(0.0, 1e30), 1.0 - SHOULDER);
    let light = light.min(SHOULDER) + rest * over / (over + rest);
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

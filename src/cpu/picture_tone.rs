//! How radiance becomes a channel of a picture.

/// Times `exposure`, clipped to [0..1] (what is no number is 0), sRGB-encoded (IEC 61966-2-1), [0..1].
pub fn picture_tone(radiance: f32, exposure: f32) -> f64 {
    let light = (f64::from(radiance) * f64::from(exposure)).clamp(0.0, 1.0).max(0.0);
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

//! How radiance becomes a channel of a picture.

/// Times `exposure`, clipped to [0..1] (what is no number is 0), sRGB-encoded (IEC 61966-2-1), [0..1].
pub fn picture_tone(radiance: f32, exposure: f32) -> f64 {
    let light = (f64::from(radiance) * f64::from(exposure)).clamp(0.0, 1.0).max(0.0);
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// How radiance becomes a picture: times `exposure`, clipped to [0..1], sRGB-encoded.
///
/// No shoulder: what is not clipped can be decoded back to radiance, to the step of 8 bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// The factor before clipping, finite and 0 or more; 1 by default. Radiance 1/exposure is white.
    pub exposure: f32,
}

impl Default for Tone {
    fn default() -> Self {
        Self { exposure: 1.0 }
    }
}

impl Tone {
    /// The 8-bit code of a radiance. Negative is black, infinity white; NaN is the caller's to catch.
    pub fn code(self, radiance: f32) -> u8 {
        (255.0 * picture_tone(radiance, self.exposure)).round() as u8
    }

    /// The least radiance of each 8-bit code, 0 of the first; NaN where no radiance has a code so high. A radiance's
    /// code is how many steps but the first it reaches.
    pub fn steps(self) -> [f32; 256] {
        std::array::from_fn(|code| {
            // Bits of f32 from 0 up to infinity are in order.
            let (mut below, mut reached) = (-1_i64, i64::from(f32::INFINITY.to_bits()) + 1);
            while below + 1 < reached {
                let middle = (below + reached) / 2;
                let has = usize::from(self.code(f32::from_bits(middle as u32))) >= code;
                if has { reached = middle } else { below = middle }
            }
            let light = f32::from_bits(reached as u32);
            if light.is_nan() { f32::NAN } else { light }
        })
    }
}

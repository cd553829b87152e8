//! How radiance becomes a channel of a picture.

/// Channel of a pixel, [0..1]: radiance times `exposure`, clipped to [0..1] (NaN gives 0), sRGB-encoded (IEC 61966-2-1).
pub fn picture_tone(radiance: f32, exposure: f32) -> f64 {
    let light = (f64::from(radiance) * f64::from(exposure)).clamp(0.0, 1.0).max(0.0);
    if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

/// The tone curve: radiance times `exposure`, clipped to [0..1], sRGB-encoded.
///
/// It has no shoulder: values that are not clipped decode back to radiance, to the step of 8 bits.
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
    /// The 8-bit code of a radiance. Negative gives 0, infinity 255. The caller has to catch NaN.
    pub fn code(self, radiance: f32) -> u8 {
        (255.0 * picture_tone(radiance, self.exposure)).round() as u8
    }

    /// The smallest radiance of each 8-bit code; 0 for the first, NaN where no radiance reaches the code. The code of a
    /// radiance is the number of steps after the first that it reaches.
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

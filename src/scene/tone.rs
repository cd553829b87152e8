//! How radiance becomes a channel of a picture.

/// The tone curve: radiance times `exposure`, a shoulder, sRGB-encoded (IEC 61966-2-1).
///
/// Below the shoulder, codes decode back to radiance, to the step of 8 bits. Above it, at x with s the shoulder, the
/// curve is 1 - (1 - s)² / (x + 1 - 2 s). This hyperbola continues the line with its slope and reaches 1 at infinity:
/// Reinhard's x / (1 + x), scaled and moved (E. Reinhard et al., Photographic tone reproduction for digital images,
/// 2002, eq. 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tone {
    /// The factor before the curve, finite and 0 or more; 1 by default.
    pub exposure: f32,
    /// Where the shoulder begins, 0 to 1; 1, the default, clips.
    pub shoulder: f32,
}

impl Default for Tone {
    fn default() -> Self {
        Self { exposure: 1.0, shoulder: 1.0 }
    }
}

impl Tone {
    /// The curve of all pictures of light: the shoulder is 0.8, code 231.
    pub fn picture(exposure: f32) -> Self {
        Self { exposure, shoulder: 0.8 }
    }

    /// Channel of a pixel, [0..1]. Negative radiance and NaN give 0.
    fn channel(self, radiance: f32) -> f64 {
        let light = (f64::from(radiance) * f64::from(self.exposure)).max(0.0);
        let (shoulder, rest) = (f64::from(self.shoulder), 1.0 - f64::from(self.shoulder));
        let light = match light > shoulder {
            true => 1.0 - rest * rest / (light - shoulder + rest),
            false => light,
        };
        if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
    }

    /// The 8-bit code of a radiance. Negative gives 0, infinity 255. The caller has to catch NaN.
    pub fn code(self, radiance: f32) -> u8 {
        (255.0 * self.channel(radiance)).round() as u8
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

//! Components of texels.

use half::f16;

/// Format of a texel's component, as Vulkan reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    /// 0..255 for 0..1.
    Unorm8,
    /// 0..65535 for 0..1.
    Unorm16,
    /// -127..127 for -1..1.
    Snorm8,
    /// -32767..32767 for -1..1.
    Snorm16,
    /// Half precision.
    F16,
    /// Single precision.
    F32,
}

impl Component {
    /// Size in bytes.
    pub fn bytes(self) -> usize {
        match self {
            Component::Unorm8 | Component::Snorm8 => 1,
            Component::Unorm16 | Component::Snorm16 | Component::F16 => 2,
            Component::F32 => 4,
        }
    }

    /// The code of 1; for floats 1 itself.
    pub fn one(self) -> f64 {
        match self {
            Component::Unorm8 => 255.0,
            Component::Unorm16 => 65535.0,
            Component::Snorm8 => 127.0,
            Component::Snorm16 => 32767.0,
            Component::F16 | Component::F32 => 1.0,
        }
    }

    /// Whether it is a fraction of a fixed range, not a float.
    pub fn is_normalised(self) -> bool {
        !matches!(self, Component::F16 | Component::F32)
    }

    /// Whether it can be negative.
    pub fn is_signed(self) -> bool {
        !matches!(self, Component::Unorm8 | Component::Unorm16)
    }

    /// Largest rounding error of a normalised component: half a step. 0 for floats.
    pub fn half_step(self) -> f64 {
        if self.is_normalised() { 0.5 / self.one() } else { 0.0 }
    }

    /// The nearest representable value; values out of range are clamped.
    pub fn rounded(self, value: f64) -> f64 {
        match self {
            Component::F16 => f16::from_f64(value).to_f64(),
            Component::F32 => f64::from(value as f32),
            _ => self.code(value) / self.one(),
        }
    }

    /// The integer of a normalised component.
    pub fn code(self, value: f64) -> f64 {
        let least = if self.is_signed() { -1.0 } else { 0.0 };
        (value.clamp(least, 1.0) * self.one()).round()
    }

    /// Appends the nearest representable value, little-endian.
    pub fn put(self, value: f64, bytes: &mut Vec<u8>) {
        match self {
            Component::Unorm8 => bytes.push(self.code(value) as u8),
            Component::Snorm8 => bytes.extend((self.code(value) as i8).to_le_bytes()),
            Component::Unorm16 => bytes.extend((self.code(value) as u16).to_le_bytes()),
            Component::Snorm16 => bytes.extend((self.code(value) as i16).to_le_bytes()),
            Component::F16 => bytes.extend(f16::from_f64(value).to_le_bytes()),
            Component::F32 => bytes.extend((value as f32).to_le_bytes()),
        }
    }
}

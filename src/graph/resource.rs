use crate::graph::shaders::BindingKind;

/// Pixel formats of images.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Format {
    /// One f32.
    R32Float,
    /// Four f16.
    Rgba16Float,
    /// Four f32.
    Rgba32Float,
    /// One u32.
    R32Uint,
    /// Four u16, or the bits of four f16 or of two f32.
    Rgba16Uint,
    /// Four u32: four lines' f32 bits.
    Rgba32Uint,
    /// One f16: heights in a buffer of the caller.
    R16Float,
    /// One u16, 0 to 1: heights in a buffer of the caller.
    R16Unorm,
    /// Four u8, 0 to 1: colours in a buffer of the caller.
    Rgba8Unorm,
    /// As `Rgba8Unorm`, with the first three channels sRGB-encoded.
    Rgba8Srgb,
}

impl Format {
    /// Bytes per texel.
    pub fn bytes(self) -> u64 {
        match self {
            Format::R16Float | Format::R16Unorm => 2,
            Format::R32Float | Format::R32Uint => 4,
            Format::Rgba8Unorm | Format::Rgba8Srgb => 4,
            Format::Rgba16Uint | Format::Rgba16Float => 8,
            Format::Rgba32Float | Format::Rgba32Uint => 16,
        }
    }

    /// Whether texels are unsigned integers.
    pub(crate) fn is_uint(self) -> bool {
        matches!(self, Format::R32Uint | Format::Rgba16Uint | Format::Rgba32Uint)
    }

    /// Name in SPIR-V; sRGB, which SPIR-V lacks, is named in the same style.
    pub(crate) fn spirv(self) -> &'static str {
        match self {
            Format::R32Float => "R32f",
            Format::Rgba16Float => "Rgba16f",
            Format::Rgba32Float => "Rgba32f",
            Format::R32Uint => "R32ui",
            Format::Rgba16Uint => "Rgba16ui",
            Format::Rgba32Uint => "Rgba32ui",
            Format::R16Float => "R16f",
            Format::R16Unorm => "R16",
            Format::Rgba8Unorm => "Rgba8",
            Format::Rgba8Srgb => "Rgba8srgb",
        }
    }
}

/// Kind of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A 2D image.
    Image {
        /// Texel format.
        format: Format,
        /// Columns.
        width: u32,
        /// Rows.
        height: u32,
        /// Layers.
        layers: u32,
        /// Whether shaders bind it as an array, even with one layer.
        layered: bool,
    },
    /// A buffer of words, or of texels of four f32.
    Buffer {
        /// Size.
        bytes: u64,
        /// Whether shaders fetch texels from it.
        texels: bool,
    },
}

/// Owner of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Owner {
    /// Created by the renderer.
    Internal,
    /// Handed in by the caller with each frame; not written.
    Input,
    /// Handed in by the caller with each frame as a buffer of texels; not written. The renderer copies it to an image of its
    /// own ([`Plan::take_buffer`](crate::plan::Plan::take_buffer)).
    InputBuffer,
    /// Handed in by the caller with each frame; written.
    Output,
}

/// An image or a buffer of a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Resource {
    /// Named by content: "lane_heights_cols".
    pub name: String,
    /// Its kind.
    pub kind: Kind,
    /// Its owner.
    pub owner: Owner,
}

impl Resource {
    /// The format of an image.
    pub fn format(&self) -> Option<Format> {
        match self.kind {
            Kind::Image { format, .. } => Some(format),
            Kind::Buffer { .. } => None,
        }
    }

    /// Whether the caller's input may have a narrower format than the plan states: [`Format::vk_read`].
    pub(crate) fn may_be_narrow(&self) -> bool {
        let is_input = matches!(self.owner, Owner::Input | Owner::InputBuffer);
        let name = self.name.as_str();
        is_input && matches!(name, "heights" | "environment" | "albedo" | "light_colours")
    }

    /// Bytes on the device.
    pub fn bytes(&self) -> u64 {
        match self.kind {
            Kind::Image { format, width, height, layers, .. } => {
                format.bytes() * u64::from(width) * u64::from(height) * u64::from(layers)
            }
            Kind::Buffer { bytes, .. } => bytes,
        }
    }

    /// Whether a binding of this kind can take this resource.
    pub(crate) fn fits(&self, binding: BindingKind) -> bool {
        match (self.kind, binding) {
            (Kind::Buffer { .. }, BindingKind::StorageBuffer) => true,
            (Kind::Buffer { texels, .. }, BindingKind::TexelBuffer) => texels,
            (
                Kind::Image { format, layered, .. },
                BindingKind::SampledImage { uint, layered: wants },
            ) => format.is_uint() == uint && layered == wants,
            (
                Kind::Image { format, layered, .. },
                BindingKind::StorageImage { format: wanted, uint, layered: wants },
            ) => layered == wants && format.is_uint() == uint && format.spirv() == wanted,
            _ => false,
        }
    }
}

//! The compiled shaders and what each binds, as `build.rs` found by reflection.

/// How a shader uses a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// A buffer of structs or words.
    StorageBuffer,
    /// A buffer of texels, fetched from.
    TexelBuffer,
    /// An image that is fetched from.
    SampledImage {
        /// Unsigned integers, else floats.
        uint: bool,
        /// Has layers.
        layered: bool,
    },
    /// An image that is stored to, perhaps loaded from.
    StorageImage {
        /// SPIR-V's name of the format; `Unknown` takes any.
        format: &'static str,
        /// Unsigned integers, else floats.
        uint: bool,
        /// Has layers.
        layered: bool,
    },
}

/// One binding of a shader.
#[derive(Clone, Copy, Debug)]
pub struct Binding {
    /// Binding number in set 0.
    pub binding: u32,
    /// The variable's name.
    pub name: &'static str,
    /// What it is.
    pub kind: BindingKind,
    /// Whether the shader may write it.
    pub written: bool,
}

/// One compiled shader.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// Its file's name without the extension: also the pass's.
    pub name: &'static str,
    /// Size of its push constants.
    pub push_bytes: u32,
    /// Its bindings, by number.
    pub bindings: &'static [Binding],
    /// SPIR-V.
    pub words: &'static [u32],
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

/// Checks at compile time that a host struct lies in memory as the shaders read it.
macro_rules! same_layout {
    ($host:ty, [$($shader:ident),+ $(,)?], { $($fields:tt)+ }) => {
        $crate::gpu::shaders::same_layout!(@each $host, [$($shader),+], { $($fields)+ });
    };
    (@each $host:ty, [$($shader:ident),+], $fields:tt) => {
        $($crate::gpu::shaders::same_layout!(@one $host, $shader, $fields);)+
    };
    (@one $host:ty, $shader:ident, { $($fields:tt)+ }) => {
        $crate::gpu::shaders::same_layout!($host, $shader, $($fields)+);
    };
    ($host:ty, $shader:ident, $($field:ident = $member:ident),+ $(,)?) => {
        const _: () = {
            $(assert!(std::mem::offset_of!($host, $field) == $crate::gpu::shaders::offsets::$shader::$member);)+
        };
    };
}
pub(crate) use same_layout;

//! The compiled shaders with their bindings, specialisation constants and push constants, reflected by `build.rs`.

/// Kind of a binding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// A buffer of structs or words.
    StorageBuffer,
    /// A uniform texel buffer.
    TexelBuffer,
    /// An image read by texel fetch.
    SampledImage {
        /// Unsigned integers, else floats.
        uint: bool,
        /// Has layers.
        layered: bool,
    },
    /// A storage image, written and perhaps read.
    StorageImage {
        /// Name of the format in SPIR-V.
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
    /// Its kind.
    pub kind: BindingKind,
    /// Whether the shader may write it.
    pub written: bool,
}

/// One specialisation constant of a shader.
#[derive(Clone, Copy, Debug)]
pub struct Constant {
    /// `constant_id`.
    pub id: u32,
    /// Its name in the shader, in lower case.
    pub name: &'static str,
}

/// One compiled shader.
#[derive(Clone, Copy, Debug)]
pub struct Shader {
    /// File name without extension; also the name of the pass.
    pub name: &'static str,
    /// Size of its push constants.
    pub push_bytes: u32,
    /// Its bindings, by number.
    pub bindings: &'static [Binding],
    /// Its specialisation constants, by number.
    pub constants: &'static [Constant],
    /// SPIR-V.
    pub words: &'static [u32],
    /// Invocations of a workgroup along each axis, unless constants set them.
    group_size: Option<[u32; 3]>,
}

impl Shader {
    /// Invocations of a workgroup along each axis.
    ///
    /// # Panics
    /// Where constants set them; at compile time in a constant.
    pub(crate) const fn group_size(&self) -> [u32; 3] {
        self.group_size.expect("constants set no workgroup size")
    }

    /// Workgroups for so many invocations along each axis.
    ///
    /// # Panics
    /// As [`group_size`](Self::group_size).
    pub(crate) fn groups(&self, invocations: [u32; 3]) -> [u32; 3] {
        let size = self.group_size();
        [0, 1, 2].map(|axis| invocations[axis].div_ceil(size[axis]))
    }
}

/// A shader and a word for each of its specialisation constants, in order. Made only from the struct of that shader, so no
/// constant is addressed by number.
#[derive(Clone, Debug)]
pub(crate) struct Specialised {
    pub shader: &'static Shader,
    pub constants: Vec<u32>,
}

/// The struct of a shader's specialisation constants.
pub(crate) trait Specialise: Into<Specialised> {
    /// Its push constants; `()` without any.
    type Push: bytemuck::Pod;
}

/// A type of specialisation constants.
trait Word {
    fn word(self) -> u32;
}

impl Word for u32 {
    fn word(self) -> u32 {
        self
    }
}

impl Word for i32 {
    fn word(self) -> u32 {
        self.cast_unsigned()
    }
}

impl Word for bool {
    fn word(self) -> u32 {
        u32::from(self)
    }
}

impl Word for f32 {
    fn word(self) -> u32 {
        self.to_bits()
    }
}

/// A shader: its name, struct of push constants, first word of SPIR-V and their count; each binding; then the struct of its
/// specialisation constants with their ids and defaults. The host dispatches it only through that struct.
macro_rules! shader {
    (
        $(#[$doc:meta])*
        $constant:ident: $name:literal, push $push:ty, words $first:literal $count:literal,
        $($binding:literal $access:ident $variable:literal $kind:ident $({ $($flag:tt)* })?,)*
        $([groups of $x:literal $y:literal $z:literal])?
        $shape:ident $({ $($id:literal $field:ident: $type:ty = $default:literal,)* })? $(;)?
    ) => {
        $(#[$doc])*
        pub(crate) const $constant: Shader = Shader {
            name: $name,
            push_bytes: size_of::<$push>() as u32,
            bindings: &[$(Binding {
                binding: $binding,
                name: $variable,
                kind: BindingKind::$kind $({ $($flag)* })?,
                written: shader!(@$access),
            },)*],
            constants: &[$($(Constant { id: $id, name: stringify!($field) },)*)?],
            words: words_at($first, $count),
            group_size: shader!(@group $($x $y $z)?),
        };

        $(#[$doc])*
        #[derive(Clone, Copy, Debug)]
        pub(crate) struct $shape { $($(pub $field: $type,)*)? }

        impl Default for $shape {
            fn default() -> Self {
                Self { $($($field: $default,)*)? }
            }
        }

        impl Specialise for $shape {
            type Push = $push;
        }

        impl From<$shape> for Specialised {
            fn from(_of: $shape) -> Self {
                Self { shader: &$constant, constants: vec![$($(_of.$field.word(),)*)?] }
            }
        }
    };
    (@group) => { None };
    (@group $x:literal $y:literal $z:literal) => { Some([$x, $y, $z]) };
    (@reads) => { false };
    (@writes) => { true };
}

/// The structs that shaders share with the host, by member: its byte offset, its name and the field's. Those of push
/// constants are Rust structs, too, checked to lie in memory as the shaders read them.
macro_rules! layouts {
    (
        $(push $push:ident $bytes:literal { $($at:literal $field:ident: $type:ty,)* })*
        $(other $other:ident { $($offset:literal $name:ident,)* })*
    ) => {
        $(
            #[repr(C)]
            #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
            pub(crate) struct $push { $(pub $field: $type,)* }

            const _: () = {
                assert!(size_of::<$push>() == $bytes);
                $(assert!(std::mem::offset_of!($push, $field) == $at);)*
            };
        )*

        const OFFSETS: &[(&str, &[(&str, usize)])] = &[
            $((stringify!($push), &[$((stringify!($field), $at)),*]),)*
            $((stringify!($other), &[$((stringify!($name), $offset)),*]),)*
        ];
    };
}

/// Byte offset of a member, as the shaders see it, of a struct that they share with the host.
///
/// # Panics
/// Without such a member; at compile time in a constant.
pub const fn offset(structure: &str, member: &str) -> usize {
    let mut i = 0;
    while i < OFFSETS.len() {
        let (name, members) = OFFSETS[i];
        let mut m = 0;
        while is_same(name, structure) && m < members.len() {
            if is_same(members[m].0, member) {
                return members[m].1;
            }
            m += 1;
        }
        i += 1;
    }
    panic!("no such member");
}

const fn is_same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

/// SPIR-V of all shaders, one after the other. Cast, as the compiler is slow to evaluate a loop over the words.
static WORDS: [u32; WORD_COUNT] =
    bytemuck::must_cast(*include_bytes!(concat!(env!("OUT_DIR"), "/shaders.spv")));

const _: () = assert!(
    cfg!(target_endian = "little"),
    "shaders.spv is little-endian: big-endian targets are not supported"
);

const fn words_at(first: usize, count: usize) -> &'static [u32] {
    WORDS.split_at(first).1.split_at(count).0
}

include!(concat!(env!("OUT_DIR"), "/shaders.rs"));

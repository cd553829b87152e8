//! Passes as a plan lists them.

use std::ops::Range;

use crate::graph::Reach;
use crate::graph::shaders::Shader;

/// A resource of a plan, by position in [`Plan::resources`](crate::plan::Plan::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ResourceId(pub usize);

/// One dispatch.
#[derive(Clone, Debug)]
pub struct Pass {
    /// The shader; its name is also the pass's.
    pub shader: &'static Shader,
    /// The part, where several passes share a shader: "sky 0..16", "sun 1"; else empty.
    pub part: String,
    /// Why the plan contains it.
    pub why: String,
    /// Workgroups.
    pub groups: [u32; 3],
    /// One word for each specialisation constant of the shader, in order.
    pub constants: Vec<u32>,
    /// Push constants.
    pub push: Vec<u8>,
    /// The resource of each binding of the shader, in order; `None` where its constants leave the binding unused.
    pub bindings: Vec<Option<ResourceId>>,
    /// The range of [`Plan::azimuths`](crate::plan::Plan::azimuths) that it reads; empty where it binds none.
    pub azimuths: Range<u32>,
    /// Minimal bytes read and written; 0 where they depend on the heights.
    pub bytes: u64,
    /// Texels processed, for rates; 0 where they depend on the heights.
    pub texels: u64,
    /// The part that an edit needs, where the push constants hold the edited rectangle.
    pub reach: Option<Reach>,
    /// For an indirect dispatch, the buffer (also bound) and the byte offset of its workgroups; `groups` is then an upper
    /// bound.
    pub indirect: Option<(ResourceId, u64)>,
    /// Whether a compute-to-compute barrier precedes it.
    pub barrier_before: bool,
}

impl Pass {
    /// The pass's name: its shader's.
    pub fn name(&self) -> &'static str {
        self.shader.name
    }

    /// Name and part: the debug label and the timing row.
    pub fn label(&self) -> String {
        if self.part.is_empty() {
            self.name().to_owned()
        } else {
            format!("{} {}", self.name(), self.part)
        }
    }

    /// The word of a specialisation constant by its name in lower case; `None` if the shader has no such constant.
    pub fn constant(&self, name: &str) -> Option<u32> {
        let place = self.shader.constants.iter().position(|c| c.name == name)?;
        self.constants.get(place).copied()
    }

    /// Resources that its shader writes.
    pub fn writes(&self) -> impl Iterator<Item = ResourceId> + '_ {
        self.select(true)
    }

    /// Resources that its shader only reads.
    pub fn reads(&self) -> impl Iterator<Item = ResourceId> + '_ {
        self.select(false)
    }

    fn select(&self, written: bool) -> impl Iterator<Item = ResourceId> + '_ {
        let bound = self.shader.bindings.iter().zip(&self.bindings);
        bound.filter_map(move |(binding, id)| id.filter(|_| binding.written == written))
    }
}

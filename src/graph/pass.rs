use std::collections::HashMap;
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

/// Moves each pass to the earliest place that its hazards allow, which leaves the fewest barriers and the most passes between two of
/// them. A sweep of a few thousand lines alone leaves most of a GPU idle. Passes with hazards between them keep their order.
pub(crate) fn moved_earlier(passes: Vec<Pass>) -> Vec<Pass> {
    // For each resource, the stages of its last writer and of its last reader so far.
    let mut written: HashMap<ResourceId, u32> = HashMap::new();
    let mut read: HashMap<ResourceId, u32> = HashMap::new();
    let mut staged = Vec::new();
    for pass in passes {
        let stage = {
            let next = |of: &HashMap<ResourceId, u32>, id| of.get(&id).map_or(0, |last| last + 1);
            let reads = pass.reads().map(|r| next(&written, r));
            let writes = pass.writes().map(|w| next(&written, w).max(next(&read, w)));
            reads.chain(writes).max().unwrap_or(0)
        };
        for id in pass.reads() {
            let last = read.entry(id).or_default();
            *last = stage.max(*last);
        }
        written.extend(pass.writes().map(|w| (w, stage)));
        staged.push((stage, pass));
    }
    staged.sort_by_key(|(stage, _)| *stage);
    staged.into_iter().map(|(_, pass)| pass).collect()
}

/// Sets [`Pass::barrier_before`] where a pass reads or writes what an earlier one wrote, or writes what an earlier one
/// read, without a barrier in between.
pub(crate) fn place_barriers(passes: &mut [Pass]) {
    let mut read: Vec<ResourceId> = Vec::new();
    let mut written: Vec<ResourceId> = Vec::new();
    for pass in passes {
        let reads: Vec<_> = pass.reads().collect();
        let writes: Vec<_> = pass.writes().collect();
        let hazard = reads.iter().any(|r| written.contains(r))
            || writes.iter().any(|w| written.contains(w) || read.contains(w));
        pass.barrier_before = hazard;
        if hazard {
            read.clear();
            written.clear();
        }
        read.extend(reads);
        written.extend(writes);
    }
}

/// Every pair of passes (earlier, later) with a hazard and no barrier in between: empty for a correct plan.
///
/// Written independently of the placement of barriers, as its check: it tests each pair alone.
pub fn missing_barriers(passes: &[Pass]) -> Vec<(usize, usize)> {
    let mut missing = Vec::new();
    for later in 0..passes.len() {
        for earlier in (0..later).rev() {
            if passes[earlier + 1..=later].iter().any(|p| p.barrier_before) {
                break;
            }
            let touches = |p: &Pass, id: ResourceId| p.bindings.contains(&Some(id));
            let hazard = passes[earlier].writes().any(|w| touches(&passes[later], w))
                || passes[later].writes().any(|w| touches(&passes[earlier], w));
            if hazard {
                missing.push((earlier, later));
            }
        }
    }
    missing
}

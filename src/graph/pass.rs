use std::ops::Range;

use crate::graph::Reach;
use crate::graph::shaders::Shader;

/// A resource of a plan, by position in [`Plan::resources`](crate::plan::Plan::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ResourceId(pub usize);

/// One dispatch.
#[derive(Clone, Debug)]
pub struct Pass {
    /// What runs; its name is the pass's.
    pub shader: &'static Shader,
    /// Which of several: "sky 0..16", "sun 1"; empty where there is one.
    pub part: String,
    /// Why it is in the plan.
    pub why: String,
    /// Workgroups.
    pub groups: [u32; 3],
    /// Words of the shader's specialisation constants, in their order.
    pub constants: Vec<u32>,
    /// Push constants.
    pub push: Vec<u8>,
    /// What each of the shader's bindings is, in their order; none where its constants leave the
    /// binding unused.
    pub bindings: Vec<Option<ResourceId>>,
    /// Which of [`Plan::azimuths`](crate::plan::Plan::azimuths) it reads; none where it does not bind them.
    pub azimuths: Range<u32>,
    /// Bytes that it must at least read and write.
    pub bytes: u64,
    /// Samples (or texels) it works on, for rates.
    pub samples: u64,
    /// What of it an edit asks for, where it is told the edited rectangle.
    pub reach: Option<Reach>,
    /// The buffer, bound too, and the byte in it that has its workgroups when it runs; `groups` are
    /// then the most.
    pub indirect: Option<(ResourceId, u64)>,
    /// Whether a barrier between compute and compute stands before it.
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

    /// The word of a specialisation constant by its name in lower case; none where the shader has no such constant.
    pub fn constant(&self, name: &str) -> Option<u32> {
        let place = self.shader.constants.iter().position(|c| c.name == name)?;
        self.constants.get(place).copied()
    }

    /// Resources that its shader may write.
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

/// Sets [`Pass::barrier_before`] where a pass touches what an earlier one wrote, or writes what an
/// earlier one touched, with no barrier between them yet.
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

/// Every pair of passes (earlier, later) with a hazard and no barrier between: none in a right plan.
///
/// Written apart from the placement of barriers, as a check of it: each pair is looked at alone.
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

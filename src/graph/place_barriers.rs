//! The order of a plan's passes and the barriers between them, by what each reads and writes. A recording follows them.

use std::collections::HashMap;

use super::{Pass, ResourceId};

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
/// Written independently of the placement of barriers, to check it: each pair is tested alone.
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

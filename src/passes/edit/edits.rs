use crate::graph::{Builder, ResourceId};
use crate::passes;

/// What edits keep: marks of the samples that they reach, and the list of those.
#[derive(Clone, Copy)]
pub(crate) struct Edits {
    pub dirty: ResourceId,
    pub list: ResourceId,
}

impl Edits {
    pub fn make(builder: &mut Builder, size: [u32; 2]) -> Self {
        let [across, down] = passes::dirty_mark::words(size).map(u64::from);
        Self {
            dirty: builder.buffer("dirty_samples", 4 * across * down, false),
            list: builder.buffer("edit_list", passes::dirty_list::bytes(size), false),
        }
    }
}

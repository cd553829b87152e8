use crate::graph::{Builder, ResourceId};
use crate::passes;

/// Resources of edits: the mask of changed texels, and the list of its words.
#[derive(Clone, Copy)]
pub(crate) struct Edits {
    pub dirty: ResourceId,
    pub list: ResourceId,
}

impl Edits {
    pub(crate) fn make(builder: &mut Builder, size: [u32; 2]) -> Self {
        let [across, down] = passes::dirty_mark::words(size).map(u64::from);
        Self {
            dirty: builder.buffer("dirty_texels", 4 * across * down, false),
            list: builder.buffer("edit_list", passes::dirty_list::bytes(size), false),
        }
    }
}

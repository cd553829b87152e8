use crate::graph::shaders::offset;
use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::dirty_mark;

/// Byte offset in the list of the workgroup counts for the passes that light it.
pub(crate) const LIGHT_GROUPS_AT: u64 = offset("EditList", "light_groups") as u64;
pub(crate) const RESOLVE_GROUPS_AT: u64 = offset("EditList", "resolve_groups") as u64;

/// Bytes of the list: every word of the mask may be on it.
pub(crate) fn bytes(size: [u32; 2]) -> u64 {
    let [across, down] = dirty_mark::words(size).map(u64::from);
    offset("EditList", "dirty_words") as u64 + 4 * across * down
}

/// Lists the words of the mask that are not 0, for the passes that light them.
pub(crate) fn plan(builder: &mut Builder, size: [u32; 2], [dirty, list]: [ResourceId; 2]) {
    let [across, down] = dirty_mark::words(size);
    let all = u64::from(across) * u64::from(down);
    let [cols, rows] = size.map(|n| n as i32);
    builder.pass(
        shaders::DirtyList {},
        "",
        "light is summed only where a texel is marked",
        shaders::DIRTY_LIST.groups([across, down, 1]),
        &shaders::DirtyListPush { cols, rows },
        &[("dirty_texels", dirty), ("edit_list", list)],
        8 * all,
        32 * all,
    );
}

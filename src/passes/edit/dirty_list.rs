use crate::graph::shaders;
use crate::graph::shaders::{offsets, same_layout};
use crate::graph::{Builder, ResourceId};
use crate::passes::dirty_mark;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct DirtyListPush {
    cols: i32,
    rows: i32,
}

same_layout!(DirtyListPush, dirty_list_push, cols = COLS, rows = ROWS);

/// Where the passes that light the list find their workgroups: bytes from the list's begin.
pub(crate) const LIGHT_GROUPS_AT: u64 = offsets::edit_list::LIGHT_GROUPS as u64;
pub(crate) const RESOLVE_GROUPS_AT: u64 = offsets::edit_list::RESOLVE_GROUPS as u64;

/// Bytes of the list for a field, whose words may all be on it.
pub(crate) fn bytes(size: [u32; 2]) -> u64 {
    let [across, down] = dirty_mark::words(size).map(u64::from);
    offsets::edit_list::DIRTY_WORDS as u64 + 4 * across * down
}

/// The words of the map that mark anything, for the passes that light them.
pub(crate) fn plan(builder: &mut Builder, size: [u32; 2], [dirty, list]: [ResourceId; 2]) {
    let [across, down] = dirty_mark::words(size);
    let all = u64::from(across) * u64::from(down);
    let [cols, rows] = size.map(|n| n as i32);
    builder.pass(
        shaders::DirtyList,
        "",
        "light is summed only where some sample is marked",
        [across.div_ceil(8), down.div_ceil(8), 1],
        &DirtyListPush { cols, rows },
        &[("dirty_samples", dirty), ("edit_list", list)],
        8 * all,
        32 * all,
    );
}

use crate::graph::shaders;
use crate::graph::shaders::same_layout;
use crate::graph::{Builder, Reach, Rectangle, ResourceId};

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct DirtyMarkPush {
    cols: i32,
    rows: i32,
    rectangle: [i32; 4],
}

same_layout!(DirtyMarkPush, dirty_mark_push, cols = COLS, rows = ROWS, rectangle = FIRST_COL);

/// Size of the mask in words; each marks eight columns of four rows.
pub(crate) fn words([cols, rows]: [u32; 2]) -> [u32; 2] {
    [cols.div_ceil(8), rows.div_ceil(4)]
}

/// Marks the texels that an edit changes directly. Sweeps add those whose horizon changes.
pub(crate) fn plan(builder: &mut Builder, size: [u32; 2], [dirty, list]: [ResourceId; 2]) {
    let [across, down] = words(size);
    let all = u64::from(across) * u64::from(down);
    let [cols, rows] = size.map(|n| n as i32);
    let pass = builder.pass(
        shaders::DirtyMark {},
        "",
        "texels whose own surface was edited; clears the mask of the last edit",
        [across.div_ceil(8), down.div_ceil(8), 1],
        &DirtyMarkPush { cols, rows, rectangle: Rectangle::whole(size).words() },
        &[("dirty_texels", dirty), ("edit_list", list)],
        4 * all,
        32 * all,
    );
    pass.reach = Some(Reach::Whole);
}

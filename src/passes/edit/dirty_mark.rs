use crate::graph::{Builder, Reach, Rectangle, ResourceId, shaders};

/// Size of the mask in words; each marks eight columns of four rows.
pub(crate) fn words([cols, rows]: [u32; 2]) -> [u32; 2] {
    [cols.div_ceil(8), rows.div_ceil(4)]
}

/// Marks the texels that an edit changes directly. Sweeps add those whose horizon changes.
pub(crate) fn plan(builder: &mut Builder, size: [u32; 2], [dirty, list]: [ResourceId; 2]) {
    let [across, down] = words(size);
    let all = u64::from(across) * u64::from(down);
    let [cols, rows] = size.map(|n| n as i32);
    let [first_col, first_row, last_col, last_row] = Rectangle::whole(size).words();
    let pass = builder.pass(
        shaders::DirtyMark {},
        "",
        "texels whose own surface was edited; clears the mask of the last edit",
        shaders::DIRTY_MARK.groups([across, down, 1]),
        &shaders::DirtyMarkPush { cols, rows, first_col, first_row, last_col, last_row },
        &[("dirty_texels", dirty), ("edit_list", list)],
        4 * all,
        32 * all,
    );
    pass.reach = Some(Reach::Whole);
}

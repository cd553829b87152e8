use crate::graph::{Builder, ResourceId, shaders};

/// The maximum height of each block of 4^level by 4^level cells.
pub(crate) fn plan(
    builder: &mut Builder,
    [cells_x, cells_y]: [u32; 2],
    padded_rows: u32,
    level: u32,
    [cells, maxima]: [ResourceId; 2],
) {
    let [across, down] = [cells_x, cells_y].map(|n| n.div_ceil(1 << (2 * level)));
    let blocks = u64::from(across) * u64::from(down);
    builder.pass(
        shaders::HeightBounds {},
        &format!("level {level}"),
        "so that rays above a block skip it",
        [across.div_ceil(8), down.div_ceil(8), 1],
        &shaders::HeightBoundsPush {
            cells_x: cells_x as i32,
            cells_y: cells_y as i32,
            padded_rows: padded_rows as i32,
            level: level as i32,
        },
        &[("cells", cells), ("maxima", maxima)],
        blocks * (4 + 16 * if level == 1 { 16 } else { 4 }),
        blocks,
    );
}

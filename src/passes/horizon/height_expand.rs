use crate::graph::shaders;
use crate::graph::shaders::same_layout;
use crate::graph::{Builder, ResourceId};
use crate::passes::pyramid::Pyramid;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct HeightExpandPush {
    size: [i32; 2],
    width_shift: i32,
}

same_layout!(HeightExpandPush, height_expand_push, size = COLS, width_shift = WIDTH_SHIFT);

/// All levels at the field's own resolution.
pub(crate) fn plan(
    builder: &mut Builder,
    pyramid: &Pyramid,
    [levels, table, stack]: [ResourceId; 3],
) {
    let [cols, rows] = pyramid.size;
    let grid_points = u64::from(cols) * u64::from(rows) * u64::from(pyramid.levels());
    builder.pass(
        shaders::HeightExpand { periodic: pyramid.periodic },
        "",
        "so that a march reads levels like the field",
        [cols.div_ceil(8), rows.div_ceil(8), pyramid.levels()],
        &HeightExpandPush {
            size: pyramid.size.map(|n| n as i32),
            width_shift: pyramid.width_shift() as i32,
        },
        &[("height_levels", levels), ("level_table", table), ("height_stack", stack)],
        4 * (grid_points + pyramid.all_texels()),
        grid_points,
    );
}

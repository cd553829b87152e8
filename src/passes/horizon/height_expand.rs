use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::pyramid::Pyramid;

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
        shaders::HEIGHT_EXPAND.groups([cols, rows, pyramid.levels()]),
        &shaders::HeightExpandPush {
            cols: cols as i32,
            rows: rows as i32,
            width_shift: pyramid.width_shift() as i32,
        },
        &[("height_levels", levels), ("level_table", table), ("height_stack", stack)],
        4 * (grid_points + pyramid.all_texels()),
        grid_points,
    );
}

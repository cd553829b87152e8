use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::bounces::Bounce;
use crate::passes::pyramid::Pyramid;

/// Every level of exit radiance at every grid point.
pub(crate) fn plan(
    builder: &mut Builder,
    pyramid: &Pyramid,
    bounce: &Bounce,
    [levels, table, stack]: [ResourceId; 3],
) {
    let [cols, rows] = pyramid.size;
    let texels = u64::from(cols) * u64::from(rows) * u64::from(pyramid.levels());
    builder.pass(
        shaders::ShadeExpand { periodic: pyramid.periodic, grey: bounce.grey },
        &bounce.name,
        format!("{} levels of radiance at every texel, by B-splines", pyramid.levels()),
        shaders::SHADE_EXPAND.groups([cols, rows, pyramid.levels()]),
        &shaders::ShadeExpandPush {
            cols: cols as i32,
            rows: rows as i32,
            width_shift: pyramid.width_shift() as i32,
        },
        &[
            ("shade_levels", levels),
            ("shade_table", table),
            (if bounce.grey { "shade_stack_grey" } else { "shade_stack" }, stack),
        ],
        if bounce.grey { 4 } else { 16 } * texels + 16 * pyramid.all_texels(),
        texels,
    );
}

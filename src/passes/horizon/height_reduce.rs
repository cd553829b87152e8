use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::pyramid::Pyramid;

/// One level from the one an octave finer.
pub(crate) fn plan(
    builder: &mut Builder,
    pyramid: &Pyramid,
    number: u32,
    [heights, levels, table]: [ResourceId; 3],
) {
    let from = pyramid.source(number);
    let (level, source) = (pyramid.level(number), pyramid.level(from));
    let [cols, rows] = level.size;
    let apart = (f64::from(number) / f64::from(pyramid.level_step)).exp2();
    let away = apart * f64::from(1 << pyramid.level_offset);
    builder.pass(
        shaders::HeightReduce { periodic: pyramid.periodic, from_field: from == 0 },
        &format!("level {number}"),
        format!("every {apart:.1} texels, for marches {away:.0} steps away"),
        [cols.div_ceil(8), rows.div_ceil(8), 1],
        &shaders::ReducePush::of(pyramid, number),
        &[("heights", heights), ("height_levels", levels), ("level_table", table)],
        4 * (level.texels() + source.texels()),
        level.texels(),
    );
}

use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::bounces::Bounce;
use crate::passes::pyramid::Pyramid;

/// One level of exit radiance from the one an octave finer.
pub(crate) fn plan(
    builder: &mut Builder,
    pyramid: &Pyramid,
    number: u32,
    bounce: &Bounce,
    [levels, table]: [ResourceId; 2],
) {
    let from = pyramid.source(number);
    let (level, source) = (pyramid.level(number), pyramid.level(from));
    let [cols, rows] = level.size;
    let apart = (f64::from(number) / f64::from(pyramid.level_step)).exp2();
    builder.pass(
        shaders::ShadeReduce {
            periodic: pyramid.periodic,
            from_field: from == 0,
            grey: bounce.grey,
        },
        &format!("{} level {number}", bounce.name),
        format!("radiance every {apart:.1} texels"),
        [cols.div_ceil(8), rows.div_ceil(8), 1],
        &shaders::ReducePush::of(pyramid, number),
        &[("exit_radiance", bounce.exit), ("shade_levels", levels), ("shade_table", table)],
        16 * (level.texels() + source.texels()),
        level.texels(),
    );
}

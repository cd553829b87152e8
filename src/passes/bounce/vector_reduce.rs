use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::bounced_specular::BouncedSpecular;
use crate::passes::pyramid::Pyramid;

/// One level of exit radiance as SH from the one an octave finer.
pub(crate) fn plan(
    builder: &mut Builder,
    (pyramid, number): (&Pyramid, u32),
    specular: &BouncedSpecular,
    name: &str,
    [exit, levels, table]: [ResourceId; 3],
) {
    let from = pyramid.source(number);
    let (level, source) = (pyramid.level(number), pyramid.level(from));
    let [cols, rows] = level.size;
    let apart = (f64::from(number) / f64::from(pyramid.level_step)).exp2();
    let layers = specular.layers();
    builder.pass(
        shaders::VectorReduce { periodic: pyramid.periodic, from_field: from == 0 },
        &format!("{name} level {number}"),
        format!("radiance by direction every {apart:.1} texels"),
        [cols.div_ceil(8), rows.div_ceil(8), layers],
        &shaders::ReducePush::of(pyramid, number),
        &[
            ("exit_vectors", exit),
            ("vector_source", levels),
            ("vector_levels", levels),
            ("shade_table", table),
        ],
        specular.texel_bytes() * u64::from(layers) * (level.texels() + source.texels()),
        level.texels() * u64::from(layers),
    );
}

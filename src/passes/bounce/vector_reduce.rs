use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::bounced_specular::BouncedSpecular;
use crate::passes::pyramid::Octave;

/// Levels of exit radiance as SH of an octave, each from the one an octave finer.
pub(crate) fn plan(
    builder: &mut Builder,
    octave: &Octave,
    specular: &BouncedSpecular,
    name: &str,
    [exit, levels, table]: [ResourceId; 3],
) {
    let layers = specular.layers();
    let [finest, coarsest] = octave.apart();
    let [made, touched] = octave.texels();
    builder.pass(
        shaders::VectorReduce {
            periodic: octave.pyramid.periodic,
            from_field: octave.reads_field(),
            halves: specular.halves(),
        },
        &format!("{name} {}", octave.part()),
        format!("radiance by direction every {finest:.1} to {coarsest:.1} texels"),
        octave.groups(layers),
        &octave.push,
        &[
            ("exit_vectors", exit),
            ("vector_source", levels),
            (if specular.halves() { "vector_levels_f16" } else { "vector_levels" }, levels),
            ("shade_table", table),
            ("constants", octave.constants),
        ],
        specular.texel_bytes() * u64::from(layers) * touched,
        made * u64::from(layers),
    );
}

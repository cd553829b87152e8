use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::bounces::Bounce;
use crate::passes::pyramid::Octave;

/// Levels of exit radiance of an octave, each from the one an octave finer.
pub(crate) fn plan(
    builder: &mut Builder,
    octave: &Octave,
    bounce: &Bounce,
    [levels, table]: [ResourceId; 2],
) {
    let [finest, coarsest] = octave.apart();
    let [made, touched] = octave.texels();
    builder.pass(
        shaders::ShadeReduce {
            periodic: octave.pyramid.periodic,
            from_field: octave.reads_field(),
            grey: bounce.grey,
        },
        &format!("{} {}", bounce.name, octave.part()),
        format!("radiance every {finest:.1} to {coarsest:.1} texels"),
        octave.groups(1),
        &octave.push,
        &[
            ("exit_radiance", bounce.exit),
            ("shade_levels", levels),
            ("shade_table", table),
            ("constants", octave.constants),
        ],
        16 * touched,
        made,
    );
}

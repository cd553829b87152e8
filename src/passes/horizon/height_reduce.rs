use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::pyramid::Octave;

/// The levels of an octave, each from the one an octave finer.
pub(crate) fn plan(
    builder: &mut Builder,
    octave: &Octave,
    [heights, levels, table]: [ResourceId; 3],
) {
    let pyramid = octave.pyramid;
    let [finest, coarsest] = octave.apart();
    let away = coarsest * f64::from(1 << pyramid.level_offset);
    let [made, touched] = octave.texels();
    builder.pass(
        shaders::HeightReduce { periodic: pyramid.periodic, from_field: octave.reads_field() },
        &octave.part(),
        format!(
            "every {finest:.1} to {coarsest:.1} texels, for marches up to {away:.0} steps away"
        ),
        octave.groups(1),
        &octave.push,
        &[
            ("heights", heights),
            ("height_levels", levels),
            ("level_table", table),
            ("constants", octave.constants),
        ],
        4 * touched,
        made,
    );
}

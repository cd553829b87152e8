use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::sh_layout::Sh;

/// The matrix from an SH series of visibility to light, for the environment and for a sky that SH light.
pub(crate) fn plan(
    builder: &mut Builder,
    sh: &Sh,
    sky: Option<[f32; 3]>,
    turns: Option<ResourceId>,
    [constants, matrix]: [ResourceId; 2],
) {
    let Sh { order, light_order, receivers, rows, .. } = *sh;
    let entries = (receivers * order * order) as u64;
    let mut bound = vec![("constants", constants), ("light_matrix", matrix)];
    bound.extend(turns.map(|t| ("env_rotation", t)));
    let [r, g, b] = sky.unwrap_or_default();
    builder.pass(
        shaders::LightMatrix {},
        sh.part(),
        format!("light of order {light_order} times visibility: {receivers} × {}", order * order),
        [1, 1, 1],
        &shaders::LightMatrixPush {
            rows: rows as i32,
            light_order: light_order as i32,
            order: order as i32,
            receivers: receivers as i32,
            row_first: sh.row_first as i32,
            matrix_first: sh.matrix_first as i32,
            pads: [0; 2],
            sky: [r, g, b, 0.0],
        },
        &bound,
        (rows * (2 * light_order - 1)) as u64 * 16 + entries * 16,
        entries,
    );
}

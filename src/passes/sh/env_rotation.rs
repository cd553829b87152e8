use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::sh_layout::Sh;
use crate::scene::Environment;

/// The environment's Fourier sums around each of its rows.
pub(crate) fn plan(
    builder: &mut Builder,
    environment: &Environment,
    sh: &Sh,
    [image, constants, turns]: [ResourceId; 3],
) {
    let count = 2 * sh.light_order - 1;
    let texels = (environment.width() * sh.rows) as u64;
    builder.pass(
        shaders::EnvRotation {},
        sh.part(),
        format!("the environment around each row, up to Fourier order {}", sh.light_order - 1),
        shaders::ENV_ROTATION.groups([(sh.rows * count) as u32, 1, 1]),
        &shaders::EnvRotationPush {
            width: environment.width() as i32,
            rows: sh.rows as i32,
            turns: count as i32,
            column_first: sh.column_first as i32,
        },
        &[("environment", image), ("constants", constants), ("env_rotation", turns)],
        texels * 16 + (sh.rows * count) as u64 * 16,
        texels,
    );
}

use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::{Border, Environment};

/// The environment summed over each azimuth's wedge, row by row.
pub(crate) fn plan(
    builder: &mut Builder,
    part: &str,
    (environment, border): (&Environment, Border),
    azimuths: u32,
    [image, directions, rows]: [ResourceId; 3],
) {
    let width = environment.width() as u32;
    let kept = environment.rows_above_ground(border) as u32;
    let texels = u64::from(width) * u64::from(kept);
    let turn = environment.rotation_rad().rem_euclid(std::f64::consts::TAU);
    let pass = builder.pass(
        shaders::EnvWedges {},
        part,
        format!(
            "the environment's light in each azimuth's wedge: {kept} of {} rows can be visible",
            environment.height()
        ),
        shaders::ENV_WEDGES.groups([kept, azimuths, 1]),
        &shaders::EnvWedgesPush {
            width: width as i32,
            rows: kept as i32,
            rotation_rad: turn as f32,
        },
        &[("environment", image), ("azimuths", directions), ("wedge_rows", rows)],
        texels * 16 + u64::from(azimuths) * u64::from(kept) * 48,
        texels,
    );
    // The others are constants.
    if part.is_empty() {
        pass.azimuths = 0..azimuths;
    }
}

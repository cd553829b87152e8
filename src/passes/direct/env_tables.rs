use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::{Border, Environment};

/// Tabulates the light of each azimuth's wedge above each elevation.
pub(crate) fn plan(
    builder: &mut Builder,
    (environment, border): (&Environment, Border),
    nodes: u32,
    count: u32,
    [rows, azimuths, tables]: [ResourceId; 3],
) {
    let bottom_sine = if border == Border::Open { -1.0 } else { 0.0 };
    let rows_kept = environment.rows_above_ground(border) as u32;
    let words = u64::from(count) * 3 * u64::from(rows_kept + nodes);
    let pass = builder.pass(
        shaders::EnvTables {},
        "",
        format!("light above each of {nodes} elevations, so that shading looks up instead of integrating"),
        shaders::ENV_TABLES.groups([3, count, 1]),
        &shaders::EnvTablesPush {
            height: environment.height() as i32,
            rows: rows_kept as i32,
            nodes: nodes as i32,
            azimuth_count: count as i32,
            bottom_sine,
        },
        &[("wedge_rows", rows), ("env_tables", tables), ("azimuths", azimuths)],
        words * 16,
        u64::from(count) * u64::from(nodes),
    );
    pass.azimuths = 0..count;
}

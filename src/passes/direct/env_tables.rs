use crate::graph::{Builder, ResourceId, shaders};
use crate::scene::{Border, Environment};

/// Tabulates the light of each azimuth's wedge above each elevation.
pub(crate) fn plan(
    builder: &mut Builder,
    (environment, border): (&Environment, Border),
    nodes: u32,
    azimuths: u32,
    [rows, tables]: [ResourceId; 2],
) {
    let bottom_rad = if border == Border::Open { -std::f32::consts::FRAC_PI_2 } else { 0.0 };
    let rows_kept = environment.rows_above_ground(border) as u32;
    let words = u64::from(azimuths) * 3 * u64::from(rows_kept + nodes);
    builder.pass(
        shaders::EnvTables {},
        "",
        format!("light above each of {nodes} elevations, so that shading looks up instead of integrating"),
        [1, azimuths.div_ceil(4), 1],
        &shaders::EnvTablesPush {
            height: environment.height() as i32,
            rows: rows_kept as i32,
            nodes: nodes as i32,
            azimuth_count: azimuths as i32,
            bottom_rad,
        },
        &[("wedge_rows", rows), ("env_tables", tables)],
        words * 16,
        u64::from(azimuths) * u64::from(nodes),
    );
}

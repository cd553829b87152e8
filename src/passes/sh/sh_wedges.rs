use crate::graph::{Axis, Builder, ResourceId, shaders};
use crate::passes::sh_layout::{Sh, WedgeTexels};
use crate::scene::Border;

/// What the pass reads and writes.
pub(crate) struct Images {
    pub lane_heights: ResourceId,
    pub angles: ResourceId,
    pub constants: ResourceId,
    pub visibility: ResourceId,
    pub nodes: Option<ResourceId>,
}

/// Visibility at texels, or at nodes, between neighbouring horizons, from a table of wedges.
pub(crate) fn plan(
    builder: &mut Builder,
    (axis, border, cell_m): (Axis, Border, [f64; 2]),
    sh: &Sh,
    table: &WedgeTexels,
    images: &Images,
) {
    let [cols, rows] = axis.size();
    let [lanes, steps] = sh.nodes.size([axis.lanes, axis.steps]);
    let nodes = u64::from(lanes) * u64::from(steps);
    let mut bound = vec![
        ("lane_heights", images.lane_heights),
        ("horizon_angles", images.angles),
        ("constants", images.constants),
        ("visibility", images.visibility),
    ];
    bound.extend(images.nodes.map(|n| ("nodes", n)));
    let layers = sh.layers() as u64;
    builder.pass(
        shaders::ShWedges {
            border: border as u32,
            marches_rows: axis.marches_rows,
            order: sh.order as i32,
            own_plane_hides: sh.own_plane_hides,
            lane_stride: sh.nodes.stride as i32,
        },
        "env",
        format!("visibility as SH, from a table of {0} × {0} wedges", table.side),
        shaders::SH_WEDGES.groups([steps, lanes.div_ceil(4), 1]),
        &shaders::ShWedgesPush {
            cols: cols as i32,
            rows: rows as i32,
            cell_x_m: cell_m[0] as f32,
            cell_y_m: cell_m[1] as f32,
            azimuth_count: table.azimuths as i32,
            azimuth_first: table.azimuth_first as i32,
            table_first: table.table_first as i32,
            side: table.side as i32,
            lowest_rad: table.lowest_rad as f32,
        },
        &bound,
        nodes * (4 + 16 * layers + table.azimuths as u64 * (4 + 64 * layers)),
        nodes * table.azimuths as u64,
    );
}

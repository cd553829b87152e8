use crate::graph::{Builder, Part, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::nodes::Nodes;
use crate::passes::sweeping::Lanes;

/// Brute force: every crossing of every grid point's own line.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    (distances, nodes): (bool, Nodes),
    lanes_read: Lanes,
    [azimuths, slopes]: [ResourceId; 2],
) {
    let axis = batch.axis;
    let [lanes, steps] = nodes.size([axis.lanes, axis.steps]);
    // Half the field, on average; and a repeating one's periods.
    let each = u64::from(axis.steps / 2 + axis.warm_up);
    let all = batch.azimuths();
    let bound =
        vec![("lane_heights", lanes_read.read()), ("azimuths", azimuths), ("slopes", slopes)];
    for cut in builder.parts(all.clone(), [lanes, steps], each, u32::MAX) {
        let Part { azimuths: few, rows } = &cut;
        let (count, height) = (few.len() as u32, rows.len() as u32);
        let grid_points = u64::from(lanes) * u64::from(height) * u64::from(count);
        let pass = builder.pass(
            shaders::HorizonMarch {
                periodic: axis.warm_up > 0,
                writes_distances: distances,
                node_stride: nodes.stride as i32,
                reads_lane_windows: lanes_read.windows.is_some(),
            },
            &cut.label(part, "azimuths", &all, steps),
            format!("brute-force horizons of {count} azimuths along {}", axis.name()),
            shaders::HORIZON_MARCH.groups([lanes, height, count]),
            &shaders::MarchPush {
                first_azimuth: few.start,
                first: rows.start as i32,
                ..shaders::MarchPush::of(batch)
            },
            &bound,
            grid_points * 8,
            grid_points,
        );
        pass.azimuths = few.clone();
    }
}

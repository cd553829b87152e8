use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::sweep::{HullStorage, LineSweep};

/// Hull sweeps along all lines of a batch, one line an invocation. `lane_buffer` holds the heights.
pub(crate) fn plan(
    builder: &mut Builder,
    sweep: &LineSweep,
    batch: &Batch,
    part: &str,
    [lane_buffer, azimuths, occluders]: [ResourceId; 3],
    lost_lines: Option<ResourceId>,
) {
    let axis = batch.axis;
    let depth = sweep.hull_depth as i32;
    let shared = sweep.hull == HullStorage::Shared;
    let mut bound =
        vec![("lane_buffer", lane_buffer), ("azimuths", azimuths), ("occluders", occluders)];
    bound.extend(lost_lines.map(|l| ("lost_lines", l)));
    let pass = builder.pass(
        shaders::LineSweep {
            local_size_x: sweep.group_size,
            hull_in_shared: shared,
            hull_depth: depth,
            private_entries: sweep.private_depth as i32,
            shared_entries: if shared { depth * sweep.group_size as i32 } else { 1 },
            hull_holds_line: sweep.holds_line,
            periodic: axis.warm_up > 0,
            line_shift: sweep.line_shift as i32,
            written_words: 2 * (2 * sweep.group_size as i32 + 2),
        },
        part,
        format!(
            "horizons of {} azimuths along {}, one line an invocation, hull in {} memory",
            batch.count,
            axis.name(),
            sweep.hull.name()
        ),
        [batch.most_lines.div_ceil(sweep.group_size), 1, batch.count],
        &shaders::LineSweepPush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
        },
        &bound,
        batch.line_texels * (8 + 2),
        batch.line_texels,
    );
    pass.azimuths = batch.azimuths();
}

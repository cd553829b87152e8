use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::sweep::{HullStorage, LineSweep};

/// What a sweep reads and writes.
pub(crate) struct Images {
    pub heights: ResourceId,
    pub lane_heights: Option<ResourceId>,
    /// The same as a buffer, set if an invocation sweeps one line.
    pub lane_buffer: Option<ResourceId>,
    pub azimuths: ResourceId,
    pub occluders: Option<ResourceId>,
    pub slopes: Option<ResourceId>,
    /// Marks the lines whose hull overflowed its storage.
    pub lost_lines: Option<ResourceId>,
}

/// Hull sweeps along all lines of a batch.
pub(crate) fn plan(
    builder: &mut Builder,
    sweep: &LineSweep,
    batch: &Batch,
    part: &str,
    images: &Images,
) {
    match (images.lane_buffer, images.occluders) {
        (Some(buffer), Some(occluders)) if sweep.lines_each == 1 => {
            let ids = [buffer, images.azimuths, occluders];
            one_each(builder, sweep, batch, part, ids, images.lost_lines);
        }
        _ => run(builder, sweep, batch, part, images, false),
    }
}

/// Sweeps along the lines whose hull overflowed its storage, where any can.
pub(crate) fn plan_again(
    builder: &mut Builder,
    sweep: &LineSweep,
    batch: &Batch,
    part: &str,
    images: &Images,
) {
    if images.lost_lines.is_some() {
        let again = LineSweep {
            hull: HullStorage::Occluders,
            hull_depth: 1,
            group_size: sweep.group_lines() / 4,
            lines_each: 4,
            ..*sweep
        };
        run(builder, &again, batch, format!("{part} again").trim(), images, true);
    }
}

fn run(
    builder: &mut Builder,
    sweep: &LineSweep,
    batch: &Batch,
    part: &str,
    images: &Images,
    again: bool,
) {
    let axis = batch.axis;
    let depth = sweep.hull_depth as i32;
    let private = sweep.hull == HullStorage::Private;
    let shared_words = 4 * depth * sweep.group_size as i32 * if sweep.packed { 1 } else { 2 };
    let mut bound = vec![("azimuths", images.azimuths)];
    // Lines one cell apart share texels of four lanes; all others fetch one height at a time.
    match images.lane_heights {
        Some(lanes) => bound.push(("lane_heights", lanes)),
        None => bound.push(("heights", images.heights)),
    }
    if sweep.hull == HullStorage::Occluders && images.lane_heights.is_some() {
        bound.push(("heights", images.heights));
    }
    bound.extend(images.occluders.map(|o| ("occluders", o)));
    bound.extend(images.slopes.map(|s| ("slopes", s)));
    bound.extend(images.lost_lines.map(|l| ("lost_lines", l)));
    let lines = batch.most_lines;
    let value_bytes = if images.occluders.is_some() { 2 } else { 0 }
        + if images.slopes.is_some() { u64::from(sweep.slope_format) * 4 % 6 } else { 0 };
    let pass = builder.pass(
        shaders::HorizonSweep {
            local_size_x: sweep.group_size,
            hull_place: sweep.hull as u32,
            hull_depth: depth,
            private_entries: if private && !sweep.packed { depth } else { 1 },
            private_words: if private && sweep.packed { depth } else { 1 },
            shared_words: if sweep.hull == HullStorage::Shared { shared_words } else { 1 },
            hull_holds_line: sweep.holds_line,
            hull_packed: sweep.packed,
            writes_occluders: images.occluders.is_some(),
            slope_format: if images.slopes.is_some() { sweep.slope_format } else { 0 },
            periodic: axis.warm_up > 0,
            line_shift: sweep.line_shift as i32,
            redoes_lost: again,
        },
        part,
        if again {
            "lines whose hull overflowed its storage; ends at once where there are none".to_owned()
        } else {
            format!(
                "horizons of {} azimuths along {}, hull in {}",
                batch.count,
                axis.name(),
                match sweep.hull {
                    HullStorage::Private => "private memory",
                    HullStorage::Shared => "shared memory",
                    HullStorage::Occluders => "the stored occluders",
                }
            )
        },
        [lines.div_ceil(4 * sweep.group_size), 1, batch.count],
        &shaders::HorizonSweepPush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
            height_scale: sweep.height_scale,
        },
        &bound,
        if again { u64::from(batch.layers) * 32 } else { batch.line_texels * (4 + value_bytes) },
        if again { 0 } else { batch.line_texels },
    );
    pass.azimuths = batch.azimuths();
}

/// Hull sweeps along all lines of a batch, one line per invocation. `lane_buffer` holds the heights.
fn one_each(
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
            "horizons of {} azimuths along {}, one line per invocation, hull in {} memory",
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

use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::sweep::{HullStorage, LineSweep};

/// What a sweep reads and writes.
pub(crate) struct Images {
    pub heights: ResourceId,
    pub lane_heights: Option<ResourceId>,
    /// The same as a buffer, set if an invocation of some sweep along this axis sweeps one line.
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
    run(builder, sweep, batch, part, images, false);
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
    let one_line = sweep.lines_each == 1;
    let [shared, private] = [HullStorage::Shared, HullStorage::Private].map(|h| h == sweep.hull);
    let group_entries = depth * sweep.group_size as i32;
    let shared_words = 4 * group_entries * if sweep.packed { 1 } else { 2 };
    let mut bound = vec![("azimuths", images.azimuths)];
    // Lines one cell apart share texels of four lanes; all others fetch one height at a time.
    match (images.lane_buffer.filter(|_| one_line), images.lane_heights) {
        (Some(buffer), _) => bound.push(("lane_buffer", buffer)),
        (None, Some(lanes)) => bound.push(("lane_heights", lanes)),
        (None, None) => bound.push(("heights", images.heights)),
    }
    if sweep.hull == HullStorage::Occluders && images.lane_heights.is_some() {
        bound.push(("heights", images.heights));
    }
    bound.extend(images.occluders.map(|o| ("occluders", o)));
    let slopes = if sweep.slope_format == 2 { "slopes_f16" } else { "slopes" };
    bound.extend(images.slopes.map(|s| (slopes, s)));
    bound.extend(images.lost_lines.map(|l| ("lost_lines", l)));
    let lines = batch.most_lines;
    let value_bytes = if images.occluders.is_some() { 2 } else { 0 }
        + if images.slopes.is_some() { u64::from(sweep.slope_format) * 4 % 6 } else { 0 };
    // Four lines share the heights between them.
    let heights = if one_line { 8 } else { 4 };
    let pass = builder.pass(
        shaders::HorizonSweep {
            layer_shift: batch.layer_shift as i32,
            local_size_x: sweep.group_size,
            hull_place: sweep.hull as u32,
            hull_depth: depth,
            private_entries: if private && !sweep.packed && !one_line { depth } else { 1 },
            private_words: if private && sweep.packed { depth } else { 1 },
            shared_words: if shared && !one_line { shared_words } else { 1 },
            hull_holds_line: sweep.holds_line,
            hull_packed: sweep.packed,
            writes_occluders: images.occluders.is_some(),
            slope_format: if images.slopes.is_some() { sweep.slope_format } else { 0 },
            periodic: axis.warm_up > 0,
            line_shift: sweep.line_shift as i32,
            redoes_lost: again,
            one_line,
            line_private_entries: if one_line { sweep.private_depth as i32 } else { 1 },
            line_shared_entries: if shared && one_line { group_entries } else { 1 },
            written_words: if one_line { 2 * (2 * sweep.group_size as i32 + 2) } else { 1 },
        },
        part,
        if again {
            "lines whose hull overflowed its storage; ends at once where there are none".to_owned()
        } else {
            format!(
                "horizons of {} azimuths along {}, {}hull in {}",
                batch.count,
                axis.name(),
                if one_line { "one line per invocation, " } else { "" },
                match sweep.hull {
                    HullStorage::Private => "private memory",
                    HullStorage::Shared => "shared memory",
                    HullStorage::Occluders => "the stored occluders",
                }
            )
        },
        [lines.div_ceil(sweep.group_lines()), 1, batch.count],
        &shaders::HorizonSweepPush {
            lanes: axis.lanes as i32,
            steps: axis.steps as i32,
            warm_up: axis.warm_up as i32,
            first_azimuth: batch.first,
            height_scale: sweep.height_scale,
        },
        &bound,
        if again {
            u64::from(batch.layers) << batch.layer_shift
        } else {
            batch.line_texels * (heights + value_bytes)
        },
        if again { 0 } else { batch.line_texels },
    );
    pass.azimuths = batch.azimuths();
}

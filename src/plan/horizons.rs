use super::Plan;
use crate::graph::{Builder, Format, Limits, Owner};
use crate::passes::azimuths::Azimuth;
use crate::passes::nodes::Nodes;
use crate::passes::sweep::Sweep;
use crate::passes::sweeping::{Held, circle, part, prepare, settings};
use crate::scene::{Border, HeightField, Quality};
use crate::{Error, Result, passes};

/// Passes that write the horizons of `count` azimuths of the quality's circle, from number `first` on. Outputs:
/// "horizon_angles" (f32 elevation, radians, one layer per azimuth, counter-clockwise: layer i is azimuth `first` + i) and, if
/// requested, "horizon_distances" (metres, 0 without an occluder).
///
/// # Errors
/// As [`picture`](super::picture()).
pub fn horizons(
    field: &HeightField,
    border: Border,
    quality: &Quality,
    limits: &Limits,
    (first, count): (u32, u32),
    distances: bool,
) -> Result<Plan> {
    quality.check()?;
    let size = limits.check_size(field.rows(), field.cols())?;
    let mut notes = Vec::new();
    let sweep = Sweep::choose(field, border, quality, limits, distances, &mut notes)?;
    if distances && matches!(&sweep, Sweep::Lines(l) if !l.writes_occluders || l.slope_format > 0) {
        return Err(Error::setting(
            "distances to the horizon",
            format!("`fuse {}`", quality.fuse.name()),
            "a fuse that knows its occluders: own, aimed-nearest, aimed or aimed-around",
        ));
    }
    let mut list = circle(quality, &sweep, field.cell_m())?;
    let range = first as usize..first as usize + count as usize;
    list = list.get(range).map(<[Azimuth]>::to_vec).unwrap_or_default();
    if list.is_empty() {
        return Err(Error::setting(
            "azimuths",
            format!("{count} from {first}"),
            format!("some of 0..{}", quality.azimuths),
        ));
    }
    let mut builder = Builder::new(limits);
    let [cols, rows] = size;
    let heights = builder.image("heights", Owner::Input, Format::R32Float, [cols, rows, 1], false);
    let extent = [cols, rows, list.len() as u32];
    let angles = builder.image("horizon_angles", Owner::Output, Format::R32Float, extent, true);
    let distances = distances
        .then(|| builder.image("horizon_distances", Owner::Output, Format::R32Float, extent, true));
    let (sweeping, lists) = prepare(
        &mut builder,
        field,
        border,
        sweep,
        heights,
        vec![list],
        &Held {
            limits,
            kept_from: None,
            nodes: Nodes { stride: 1 },
            shadows: Vec::new(),
            later_bytes: 0,
        },
    )?;
    let batches = &lists.batches[0];
    for batch in batches {
        let part = part("", batch, batches);
        sweeping.plan_all(&mut builder, &[(*batch, part.clone())]);
        let written = sweeping.written(batch);
        let ids = [sweeping.azimuths, angles];
        passes::sweep_fuse::plan(
            &mut builder,
            &sweeping.sweep,
            border,
            batch,
            &part,
            ids,
            (sweeping.lanes(batch), Some(written), distances),
        );
    }
    let used = settings(Some(&sweeping.sweep), border);
    Plan::finish(builder, size, lists.lists.concat(), notes, used, limits)
}

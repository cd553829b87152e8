use crate::graph::{Builder, ResourceId, shaders};
use crate::passes::batch::Batch;
use crate::passes::sweep::{SURFACE_GROUP_SIZE, SurfaceHull};

/// Exact sweeps along grid vectors. With a hull in a buffer each dispatch sweeps some lines of one azimuth.
pub(crate) fn plan(
    builder: &mut Builder,
    batch: &Batch,
    part: &str,
    (hull, buffer): (SurfaceHull, Option<ResourceId>),
    distances: bool,
    [lane_heights, azimuths, slopes]: [ResourceId; 3],
) {
    let axis = batch.axis;
    let mut bound = vec![("lane_heights", lane_heights), ("azimuths", azimuths)];
    bound.push(("slopes", slopes));
    bound.extend(buffer.map(|buffer| ("hull_buffer", buffer)));
    let at_once = hull.lines_at_once.map_or(batch.count, |_| 1);
    let lines_at_once = hull.lines_at_once.unwrap_or(batch.most_lines).min(batch.most_lines);
    for first in batch.azimuths().step_by(at_once as usize) {
        for line in (0..batch.most_lines).step_by(lines_at_once as usize) {
            let lines = lines_at_once.min(batch.most_lines - line);
            let part = match hull.lines_at_once {
                Some(_) => format!("{part} azimuth {first} lines {line}..{}", line + lines),
                None => part.to_owned(),
            };
            let share = |all: u64| {
                let lines_of_all = u64::from(batch.count) * u64::from(batch.most_lines);
                all * u64::from(at_once) * u64::from(lines) / lines_of_all
            };
            let pass = builder.pass(
                shaders::SurfaceSweep {
                    local_size_x: SURFACE_GROUP_SIZE,
                    private_entries: if buffer.is_some() { 1 } else { hull.depth as i32 },
                    periodic: axis.warm_up > 0,
                    writes_distances: distances,
                    hull_in_buffer: buffer.is_some(),
                },
                part.trim(),
                format!("exact horizons of {at_once} azimuths along {}", axis.name()),
                [lines.div_ceil(SURFACE_GROUP_SIZE), 1, at_once],
                &shaders::MarchPush {
                    first_azimuth: first,
                    first: line as i32,
                    ..shaders::MarchPush::of(batch)
                },
                &bound,
                share(batch.line_texels * 4 + axis.texels() * u64::from(batch.count) * 4),
                share(batch.line_texels),
            );
            pass.azimuths = first..first + at_once;
        }
    }
}
